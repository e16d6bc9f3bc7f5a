"""orientations.csv and adjusted.csv: tables -> checked orientations in the computing frame."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from posstats.arrays import Floats, Ids, Ints
from posstats.block.model import BLOCK_SCOPE, Orientations, OrientationTable
from posstats.formats.block_toml import BlockSettings
from posstats.formats.convention import Convention
from posstats.formats.text_table import FileTable
from posstats.formats.times import read_times

POSITION_COLUMNS = ("x", "y", "z")
LARGEST_M = 1e9
"""Beyond every map grid, zone numbers and all; a double still resolves 0.1 micrometre."""
_LARGEST_ANGLE = 1e6


@dataclass(frozen=True, eq=False)
class PosRows:
    """The rows of orientations.csv, checked, sorted by time (ties by image id), in file units."""

    table: FileTable
    row: Ints
    image: Ids
    strip: Ids
    time_s: Floats
    position_crs: Floats
    file_angles: Floats
    camera: Ints
    file_sigma_position: Floats
    file_sigma_angles: Floats


def read_pos_rows(table: FileTable, settings: BlockSettings, findings: list[str]) -> PosRows | None:
    """Check orientations.csv; None if columns are missing, whatever else is wrong as findings."""
    angle_columns = settings.angle_columns
    if not table.require(("image", "strip", *POSITION_COLUMNS, *angle_columns), findings):
        return None
    image = unique_images(table, findings)
    time_s = read_times(table, findings)
    row = np.array(sorted(range(len(table)), key=lambda i: (time_s[i], image[i])), dtype=np.intp)
    sigma_names = [f"sigma_{name}" for name in (*POSITION_COLUMNS, *angle_columns)]
    sigmas = np.column_stack([_sigmas(table, name, findings) for name in sigma_names])
    return PosRows(
        table=table,
        row=row,
        image=image[row],
        strip=_strips(table, findings)[row],
        time_s=time_s[row],
        position_crs=read_positions(table, findings)[row],
        file_angles=read_angles(table, settings, findings)[row],
        camera=_camera_numbers(table, settings, findings)[row],
        file_sigma_position=sigmas[row, :3],
        file_sigma_angles=sigmas[row, 3:],
    )


def pos_orientations(
    rows: PosRows, settings: BlockSettings, convention: Convention
) -> Orientations:
    """The orientations of the cameras, lever arm and boresight taken off."""
    accuracy = settings.accuracy
    rotation = convention.ground_from_image(rows.position_crs, rows.file_angles)
    sigma_angles = convention.sigma_angles_rad(rows.file_sigma_angles, rows.file_angles)
    sigma_position = rows.file_sigma_position
    return Orientations(
        image=rows.image,
        strip=rows.strip,
        time_s=rows.time_s,
        position_m=convention.projection_centre(rows.position_crs, rotation),
        angles_rad=convention.computing_angles(rotation),
        camera=rows.camera,
        sigma_position_m=np.where(np.isnan(sigma_position), accuracy.position_m, sigma_position),
        sigma_angles_rad=np.where(np.isnan(sigma_angles), accuracy.angle_rad, sigma_angles),
        system=convention.system,
    )


def source_table(rows: PosRows, settings: BlockSettings) -> OrientationTable:
    """orientations.csv as text, to be written again with other angles."""
    columns = {name: rows.table.text(name) for name in rows.table.columns}
    return OrientationTable(pd.DataFrame(columns, dtype=object), rows.row, settings.angle_columns)


def read_adjusted(
    table: FileTable,
    pos: Orientations,
    settings: BlockSettings,
    convention: Convention,
    findings: list[str],
) -> Orientations | None:
    """adjusted.csv in the order of the POS, NaN where an image is missing; accuracy unknown."""
    if not table.require(("image", *POSITION_COLUMNS, *settings.angle_columns), findings):
        return None
    image = unique_images(table, findings)
    number = {name: index for index, name in enumerate(pos.image)}
    target = np.array([number.get(name, -1) for name in image], dtype=np.intp)
    findings += [
        f"{table.place(row, 'image')}: found image {image[row]!r}, which orientations has not"
        for row in np.flatnonzero(target < 0)
    ]
    position_crs = read_positions(table, findings)
    file_angles = read_angles(table, settings, findings)
    if (target < 0).any():
        return None
    position, angles = np.full((2, len(pos), 3), np.nan)
    rotation = convention.ground_from_image(position_crs, file_angles)
    position[target] = convention.projection_centre(position_crs, rotation)
    angles[target] = convention.computing_angles(rotation)
    unknown = np.full((len(pos), 3), np.nan)
    return replace(
        pos,
        position_m=position,
        angles_rad=angles,
        sigma_position_m=unknown,
        sigma_angles_rad=unknown,
    )


def unique_images(table: FileTable, findings: list[str]) -> Ids:
    """Image ids (n,), a finding for each that stands twice."""
    image = np.array(table.ids("image", findings).to_pylist(), dtype=object)
    first: dict[str, int] = {}
    for row, name in enumerate(image):
        if name in first and name:
            before = table.place(first[name], "image")
            findings.append(
                f"{table.place(row, 'image')}: found image {name!r} again ({before}), expected once"
            )
        first.setdefault(name, row)
    return image


def read_angles(table: FileTable, settings: BlockSettings, findings: list[str]) -> Floats:
    """Angles (n, 3) in the file's unit."""
    angles = _columns(table, settings.angle_columns, _LARGEST_ANGLE, findings)
    if settings.angle_unit == "rad":
        for row, column in np.argwhere(np.abs(angles) > 2.0 * np.pi):
            findings.append(
                f"{table.place(row, settings.angle_columns[column])}: found {angles[row, column]:g}"
                " rad, expected at most 2 pi; degrees given as radians?"
            )
    return angles


def read_positions(table: FileTable, findings: list[str]) -> Floats:
    """Positions x, y, z (n, 3) as they stand."""
    return _columns(table, POSITION_COLUMNS, LARGEST_M, findings)


def _columns(table: FileTable, names: Sequence[str], largest: float, findings: list[str]) -> Floats:
    return np.column_stack([table.numbers(name, findings, largest=largest) for name in names])


def _strips(table: FileTable, findings: list[str]) -> Ids:
    """Strip ids (n,), a finding for each that results could not tell from the whole block."""
    strip = np.array(table.ids("strip", findings).to_pylist(), dtype=object)
    findings += [
        f"{table.place(row, 'strip')}: found {BLOCK_SCOPE!r}, which in results means all strips;"
        " expected another id"
        for row in np.flatnonzero(strip == BLOCK_SCOPE)
    ]
    return strip


def _sigmas(table: FileTable, name: str, findings: list[str]) -> Floats:
    """Standard deviations (n,), NaN where they are not given."""
    if name not in table.columns:
        return np.full(len(table), np.nan)
    sigmas = table.numbers(name, findings, optional=True, largest=LARGEST_M)
    findings += [
        f"{table.place(row, name)}: found {sigmas[row]:g}, expected a positive number"
        for row in np.flatnonzero(sigmas <= 0.0)
    ]
    return sigmas


def _camera_numbers(table: FileTable, settings: BlockSettings, findings: list[str]) -> Ints:
    """Index (n,) into the cameras, -1 with a finding where there is no such camera."""
    if "camera" not in table.columns and len(settings.cameras) == 1:
        return np.zeros(len(table), dtype=np.intp)
    if not table.require(("camera",), findings):
        return np.full(len(table), -1, dtype=np.intp)
    number = {camera.id: index for index, camera in enumerate(settings.cameras)}
    if len(settings.cameras) == 1 and not settings.cameras[0].id:
        return np.zeros(len(table), dtype=np.intp)
    names = table.ids("camera", findings).to_pylist()
    findings += [
        f"{table.place(row, 'camera')}: found camera {name!r}, expected {_one_of(number)}"
        for row, name in enumerate(names)
        if name not in number
    ]
    return np.array([number.get(name, -1) for name in names], dtype=np.intp)


def _one_of(names: Iterable[str]) -> str:
    return " or ".join(repr(name) for name in names)
