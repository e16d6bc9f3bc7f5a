"""Block folders: files -> Block, and back.

The format is described in ``docs/block-format.md``. Whatever is wrong with a folder is collected
and raised at once as a `BlockFormatError`.
"""

from dataclasses import replace
from os import PathLike
from pathlib import Path

import numpy as np

from posstats.arrays import Floats
from posstats.block.frames import GroundFrame
from posstats.block.model import Block
from posstats.contract.notice import Notice
from posstats.errors import BlockFormatError, GeometryError
from posstats.formats.block_notices import block_notices, settings_notices, time_notices
from posstats.formats.block_toml import FILE, BlockSettings, parse_settings
from posstats.formats.block_writing import write_block, write_orientations
from posstats.formats.convention import Convention
from posstats.formats.orientation_files import (
    PosRows,
    pos_orientations,
    read_adjusted,
    read_pos_rows,
    source_table,
)
from posstats.formats.point_files import read_ground_points, read_tie_points, refuse_outside_crs
from posstats.formats.text_table import FileTable, read_bytes, read_table, sha256

__all__ = ["read_block", "write_block", "write_orientations"]

TABLES = ("orientations", "tie_points", "ground_points", "adjusted")
_REQUIRED = TABLES[:2]


def read_block(path: str | PathLike[str]) -> Block:
    """Read and check a block folder.

    Returns
    -------
    Block
        In the computing frame, orientations sorted by time (ties by image id), tie points by
        point and image, lever arm and boresight of [pos] taken off.

    Raises
    ------
    BlockFormatError
        With a finding for everything that is wrong: file, line, column, what was found and what
        was expected.

    Examples
    --------
    >>> import posstats
    >>> block = posstats.read_block("block")
    >>> len(block.orientations), block.orientations.strips
    (32, ('1', '2', '3', '4'))
    """
    folder = Path(path)
    if not folder.is_dir():
        found = "a file" if folder.exists() else "nothing"
        raise BlockFormatError([f"{folder}: found {found}, expected a block folder"])
    findings: list[str] = []
    inputs: dict[str, str] = {}
    settings = _settings(folder, inputs, findings)
    tables = _tables(folder, inputs, findings)
    if settings is None:
        raise BlockFormatError(findings)
    block = _block(folder, settings, tables, findings)
    if block is None or findings:
        raise BlockFormatError(findings)
    return replace(block, inputs=tuple(sorted(inputs.items())))


def _settings(folder: Path, inputs: dict[str, str], findings: list[str]) -> BlockSettings | None:
    path = folder / FILE
    if not path.exists():
        findings.append(f"{FILE}: found no such file in {folder}, expected it")
        return None
    content = read_bytes(path, findings)
    if content is None:
        return None
    inputs[FILE] = sha256(content)
    settings = parse_settings(content, folder.resolve().name, findings)
    if settings is not None and settings.geoid is not None:
        grid = read_bytes(folder / settings.geoid, findings)
        if grid is not None:
            inputs[settings.geoid] = sha256(grid)
    return settings


def _tables(folder: Path, inputs: dict[str, str], findings: list[str]) -> dict[str, FileTable]:
    """The tables that are there; a missing required one is a finding."""
    tables = {}
    for stem in TABLES:
        before = len(findings)
        table = read_table(folder, stem, findings)
        if table is not None:
            tables[stem] = table
            inputs[table.file] = table.sha256
        elif stem in _REQUIRED and len(findings) == before:
            findings.append(f"{stem}: found neither {stem}.csv nor {stem}.parquet, expected one")
    return tables


def _block(
    folder: Path, settings: BlockSettings, tables: dict[str, FileTable], findings: list[str]
) -> Block | None:
    rows = ties = None
    if "orientations" in tables:
        rows = read_pos_rows(tables["orientations"], settings, findings)
    if rows is not None and "tie_points" in tables:
        ties = read_tie_points(
            tables["tie_points"],
            list(rows.image),
            rows.camera,
            settings.cameras,
            settings.image_unit,
            findings,
        )
    frame = None if rows is None else _frame(folder, settings, rows.position_crs, findings)
    if rows is None or frame is None or (rows.camera < 0).any():
        return None
    orientations = pos_orientations(rows, settings, Convention.of_pos(settings, frame))
    refuse_outside_crs(rows.table, rows.position_crs, frame, findings, rows.row)
    adjusted = ground_points = None
    if "adjusted" in tables:
        convention = Convention.of_adjusted(settings, frame)
        adjusted = read_adjusted(tables["adjusted"], orientations, settings, convention, findings)
    if "ground_points" in tables:
        ground_points = read_ground_points(tables["ground_points"], frame, findings)
    if ties is None or findings:
        return None
    block = Block(
        name=settings.name,
        cameras=settings.cameras,
        orientations=orientations,
        tie_points=ties,
        frame=frame,
        accuracy=settings.accuracy,
        ground_points=ground_points,
        adjusted=adjusted,
        simulated=settings.simulated,
        settings=settings.raw,
        source=source_table(rows, settings),
        folder=folder,
    )
    return replace(block, notices=_notices(block, settings, rows))


def _frame(
    folder: Path, settings: BlockSettings, position_crs: Floats, findings: list[str]
) -> GroundFrame | None:
    """The block's ground frame; None, with a finding, if the crs does not fit the positions."""
    if settings.crs is None or not settings.tangent:
        return GroundFrame(settings.crs)
    known = ~np.isnan(position_crs).any(axis=1)
    if not known.any():
        return None
    geoid = None if settings.geoid is None else folder / settings.geoid
    if geoid is not None and not geoid.is_file():
        return None
    try:
        return GroundFrame.tangent(settings.crs, position_crs[known], geoid)
    except GeometryError as error:
        findings.append(f"{FILE}, block.crs: {error}")
        return None


def _notices(block: Block, settings: BlockSettings, rows: PosRows) -> tuple[Notice, ...]:
    file_order = np.argsort(rows.row)
    return (
        *settings_notices(settings),
        *time_notices(rows.time_s[file_order], [str(i) for i in rows.image[file_order]]),
        *block_notices(block),
    )
