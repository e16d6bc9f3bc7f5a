"""Block -> files: corrected orientations beside the input, and whole block folders."""

import json
from collections.abc import Callable, Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from posstats.arrays import Floats
from posstats.block.camera import Camera
from posstats.block.frames import GroundFrame
from posstats.block.model import Block, GroundPoints, Orientations, OrientationTable
from posstats.errors import BlockFormatError, GeometryError
from posstats.formats.block_toml import (
    DISTORTION_COEFFICIENTS,
    FILE,
    RADIANS_PER_UNIT,
    BlockSettings,
    settings_from,
)
from posstats.formats.convention import Convention
from posstats.numerics.kernels.rotation import ANGLE_NAMES, rotation_from_angles, wrapped

# Decimals that lose nothing: 0.1 um on the ground, 1e-8 px, 1e-14 rad.
POSITION_DECIMALS = 7
_IMAGE_DECIMALS = 8
ANGLE_DECIMALS = {"deg": 12, "gon": 12, "rad": 14}
_TABLES = ("orientations", "tie_points", "ground_points", "adjusted")


def write_orientations(block: Block, angles_rad: Floats, path: str | PathLike[str]) -> None:
    """Write orientations.csv of a block with other angles, to be read with the same block.toml.

    Columns, unit, angle system and order of rows are those of the input; everything but the angles
    stands as it stood. Angles are those of the IMU again (boresight put back), next to the input's
    (no jump of a full turn), and an angle that did not change keeps its text. Positions stay,
    with a lever arm too: they are measurements of the antenna, which a corrected attitude does not
    move. Reading the file therefore gives projection centres X - R lever with the corrected R.

    Parameters
    ----------
    block
        As read, or of memory (then the columns are those of `write_block`).
    angles_rad
        (n, 3) omega, phi, kappa of the block's system in the computing frame, in the order of
        the block's orientations.
    path
        The file to write, CSV.

    Raises
    ------
    GeometryError
        If an angle is not finite.
    """
    lacking = block.orientations.image[~np.isfinite(angles_rad).all(axis=1)]
    if len(lacking):
        raise GeometryError(f"no finite angles to write for image {lacking[0]}")
    source, convention, decimals = source_of(block, Convention.of_pos)
    table = source.table.copy()
    columns = list(source.angle_columns)
    position = table[["x", "y", "z"]].to_numpy(dtype=float)[source.row]
    before = table[columns].to_numpy(dtype=float)[source.row]
    rotation = rotation_from_angles(angles_rad, block.orientations.system)
    change = convention.file_angles(position, rotation) - before
    change = wrapped(change * convention.unit_rad) / convention.unit_rad
    text = table[columns].to_numpy(dtype=object, copy=True)
    for k, row in enumerate(source.row):
        for axis in range(3):
            if abs(change[k, axis]) >= 10.0**-decimals:
                text[row, axis] = f"{before[k, axis] + change[k, axis]:.{decimals}f}"
    table[columns] = text
    table.to_csv(path, index=False)


def write_block(block: Block, folder: str | PathLike[str]) -> None:
    """Write a block folder that `read_block` reads as the same block.

    Orientations are written as those of the cameras (so without [pos]), in the crs, degrees and
    the block's angle system; image coordinates as measured column and row. Tables of a block that
    stood in the folder are replaced, or removed if this block has none.
    """
    target = Path(folder)
    target.mkdir(parents=True, exist_ok=True)
    for stem in _TABLES:
        for ending in ("csv", "parquet"):
            (target / f"{stem}.{ending}").unlink(missing_ok=True)
    (target / FILE).write_text(_block_toml(block), encoding="utf-8")
    _write(_orientation_columns(block), target / "orientations.csv")
    _write(_tie_point_columns(block), target / "tie_points.csv")
    if block.ground_points is not None:
        _write(_ground_point_columns(block, block.ground_points), target / "ground_points.csv")
    if block.adjusted is not None:
        known = ~np.isnan(block.adjusted.angles_rad).any(axis=1)
        columns = {"image": block.adjusted.image, **_pose_columns(block, block.adjusted)}
        _write({name: values[known] for name, values in columns.items()}, target / "adjusted.csv")


def source_of(
    block: Block, convention_of: Callable[[BlockSettings, GroundFrame], Convention]
) -> tuple[OrientationTable, Convention, int]:
    """The table of orientations to write into, its convention and the decimals of its angles.

    Parameters
    ----------
    block
        As read, or of memory.
    convention_of
        `Convention.of_pos`, or `Convention.of_adjusted` for the cameras' own orientations.
    """
    if block.source is None:
        table = pd.DataFrame(_orientation_columns(block), dtype=object)
        row = np.arange(len(block.orientations))
        source = OrientationTable(table, row, (ANGLE_NAMES[0], ANGLE_NAMES[1], ANGLE_NAMES[2]))
        return source, _plain_convention(block), ANGLE_DECIMALS["deg"]
    findings: list[str] = []
    settings = settings_from(block.settings, block.name, findings)
    if settings is None:
        raise BlockFormatError(findings)
    decimals = ANGLE_DECIMALS[settings.angle_unit]
    return block.source, convention_of(settings, block.frame), decimals


def _plain_convention(block: Block) -> Convention:
    """The convention of written blocks: cameras' orientations, the block's system, degrees."""
    return Convention(block.orientations.system, RADIANS_PER_UNIT["deg"], block.frame)


def _write(columns: Mapping[str, Any], path: Path) -> None:
    pd.DataFrame(columns).to_csv(path, index=False)


def _pose_columns(block: Block, orientations: Orientations) -> dict[str, Floats]:
    position = np.round(block.frame.to_crs(orientations.position_m), POSITION_DECIMALS)
    angles = np.full_like(position, np.nan)
    known = np.isfinite(position).all(axis=1)
    angles[known] = _plain_convention(block).file_angles(
        position[known], orientations.ground_from_image[known]
    )
    angles = np.round(angles, ANGLE_DECIMALS["deg"])
    return {
        **dict(zip(("x", "y", "z"), position.T, strict=True)),
        **dict(zip(ANGLE_NAMES, angles.T, strict=True)),
    }


def _orientation_columns(block: Block) -> dict[str, Any]:
    orientations = block.orientations
    columns: dict[str, Any] = {
        "image": orientations.image,
        "strip": orientations.strip,
        "time_s": orientations.time_s,
        **_pose_columns(block, orientations),
    }
    if len(block.cameras) > 1:
        columns["camera"] = np.array(_camera_ids(block), dtype=object)[orientations.camera]
    accuracy = block.accuracy
    if np.any(orientations.sigma_position_m != accuracy.position_m):
        for axis, name in enumerate(("x", "y", "z")):
            columns[f"sigma_{name}"] = orientations.sigma_position_m[:, axis]
    if np.any(orientations.sigma_angles_rad != accuracy.angle_rad):
        for axis, name in enumerate(ANGLE_NAMES):
            columns[f"sigma_{name}"] = np.degrees(orientations.sigma_angles_rad[:, axis])
    return columns


def _tie_point_columns(block: Block) -> dict[str, Any]:
    ties = block.tie_points
    camera = block.orientations.camera[ties.image]
    column_row = np.empty_like(ties.xy_px)
    for number, interior in enumerate(block.cameras):
        rows = camera == number
        column_row[rows] = interior.measured_from_ideal(ties.xy_px[rows])
    column_row = np.round(column_row, _IMAGE_DECIMALS)
    return {
        "point": ties.point_id[ties.point],
        "image": block.orientations.image[ties.image],
        "x": column_row[:, 0],
        "y": column_row[:, 1],
    }


def _ground_point_columns(block: Block, ground: GroundPoints) -> dict[str, Any]:
    position = np.round(block.frame.to_crs(ground.position_m), POSITION_DECIMALS)
    return {
        "point": ground.point,
        **dict(zip(("x", "y", "z"), position.T, strict=True)),
        "role": np.where(ground.is_check, "check", "control"),
        "sigma_xy": ground.sigma_xy_m,
        "sigma_z": ground.sigma_z_m,
    }


def _camera_ids(block: Block) -> list[str]:
    return [camera.id or str(number) for number, camera in enumerate(block.cameras, start=1)]


def _block_toml(block: Block) -> str:
    """block.toml; numbers by `repr`, so that they are read back as they are."""
    frame = block.frame
    settings: dict[str, Any] = {"name": block.name}
    if frame.crs is not None:
        settings |= {"crs": frame.crs, "frame": "tangent" if frame.is_tangent else "grid"}
        settings["heights"] = "ellipsoidal" if frame.geoid is None else "orthometric"
    if frame.geoid is not None:
        settings["geoid"] = str(frame.geoid.resolve())
    settings |= {
        "angles": block.orientations.system,
        "angle_unit": "deg",
        "image_coordinates": "px",
        "simulated": block.simulated,
    }
    several = len(block.cameras) > 1
    sections = [_section("[block]", settings)]
    for camera, identity in zip(block.cameras, _camera_ids(block), strict=True):
        known = {"id": identity} if several or camera.id else {}
        title = "[[camera]]" if several else "[camera]"
        sections.append(_section(title, known | _camera_values(camera)))
    accuracy = {
        "position_m": block.accuracy.position_m,
        "angle_deg": float(f"{np.degrees(block.accuracy.angle_rad):.15g}"),
        "image_px": block.accuracy.image_px,
    }
    return "\n".join([*sections, _section("[accuracy]", accuracy)])


def _camera_values(camera: Camera) -> dict[str, Any]:
    values: dict[str, Any] = {
        "name": camera.name,
        "width_px": camera.width_px,
        "height_px": camera.height_px,
        "principal_distance_px": camera.principal_distance_px,
        "principal_point_px": list(camera.principal_point_px),
    }
    if camera.pixel_size_mm is not None:
        values["pixel_size_mm"] = camera.pixel_size_mm
    distortion = camera.distortion
    names = DISTORTION_COEFFICIENTS[distortion.model]
    coefficients = {name: getattr(distortion, name) for name in names}
    values["distortion"] = {"model": distortion.model, **coefficients}
    return values


def _section(title: str, values: Mapping[str, Any]) -> str:
    return "\n".join([title, *(f"{key} = {_toml(value)}" for key, value in values.items()), ""])


def _toml(value: Any) -> str:
    """One TOML value. Basic strings are those of JSON, but for DEL, which must be escaped too."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key} = {_toml(item)}" for key, item in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(_toml(item) for item in value) + "]"
    return repr(float(value))
