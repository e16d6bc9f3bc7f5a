"""tie_points.csv and ground_points.csv: tables -> checked points."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
import pyarrow as pa
import pyarrow.compute as pc

from posstats.arrays import Floats, Ids, Ints
from posstats.block.camera import Camera
from posstats.block.frames import GroundFrame
from posstats.block.model import GroundPoints, TiePoints
from posstats.errors import GeometryError
from posstats.formats.orientation_files import LARGEST_M, read_positions
from posstats.formats.text_table import FileTable

FORMAT_MARGIN = 0.05
ROLES = ("control", "check")


def read_tie_points(
    table: FileTable,
    images: Sequence[str],
    camera_of_image: Ints,
    cameras: Sequence[Camera],
    unit: str,
    findings: list[str],
) -> TiePoints | None:
    """The tie points sorted by point id, then image; None with findings if anything is wrong.

    Parameters
    ----------
    images
        Ids of the n images, in the block's order.
    camera_of_image
        (n,) index into `cameras`.
    unit
        ``px`` (column, row) or ``mm`` (x, y from the principal point).
    """
    before = len(findings)
    if not table.require(("point", "image", "x", "y"), findings):
        return None
    point_id, point = _sorted_ids(table.ids("point", findings))
    image = _image_numbers(table, images, findings)
    xy = np.column_stack([table.numbers(name, findings) for name in ("x", "y")])
    known = image >= 0
    camera = np.where(known, camera_of_image[np.maximum(image, 0)], -1)
    _refuse_outside(table, xy, camera, cameras, unit, findings)
    order = np.argsort(point * (len(images) + 1) + image, kind="stable")
    _refuse_repeated(table, point_id, point[order], images, image[order], order, findings)
    if len(findings) > before:
        return None
    try:
        xy_px = ideal_coordinates(xy, camera, cameras, unit)
    except GeometryError as error:
        findings.append(f"{table.file}: {error}")
        return None
    return TiePoints(point_id, point[order], image[order], xy_px[order])


def ideal_coordinates(xy: Floats, camera: Ints, cameras: Sequence[Camera], unit: str) -> Floats:
    """Ideal (m, 2) image coordinates, px, of file coordinates (m, 2) in px or mm."""
    ideal = np.empty_like(xy)
    for number, interior in enumerate(cameras):
        rows = camera == number
        ideal[rows] = interior.ideal_from_measured(_column_row(xy[rows], interior, unit))
    return ideal


def _column_row(xy: Floats, camera: Camera, unit: str) -> Floats:
    """Measured column, row, px."""
    if unit == "px":
        return xy
    scale = np.array([1.0, -1.0]) / (camera.pixel_size_mm or np.nan)
    return np.array(camera.principal_point_px) + xy * scale


def read_ground_points(
    table: FileTable, frame: GroundFrame, findings: list[str]
) -> GroundPoints | None:
    """The ground points, sorted by id, in the computing frame; None with findings if wrong."""
    before = len(findings)
    if not table.require(("point", "x", "y", "z", "role"), findings):
        return None
    point = np.array(table.ids("point", findings).to_pylist(), dtype=object)
    position = read_positions(table, findings)
    role = np.array(table.text("role"), dtype=object)
    findings += [
        f"{table.place(row, 'role')}: found {role[row]!r}, expected control or check"
        for row in np.flatnonzero(~np.isin(role, ROLES))
    ]
    sigma_xy, sigma_z = (_survey_sigma(table, name, findings) for name in ("sigma_xy", "sigma_z"))
    order = np.array(sorted(range(len(point)), key=lambda row: point[row]), dtype=np.intp)
    findings += [
        f"{table.place(row, 'point')}: found point {point[row]!r} again, expected once"
        for previous, row in pairwise(order)
        if point[previous] == point[row] and point[row]
    ]
    if len(findings) > before:
        return None
    refuse_outside_crs(table, position, frame, findings)
    return GroundPoints(
        point[order],
        frame.to_computing(position)[order],
        (role == "check")[order],
        sigma_xy[order],
        sigma_z[order],
    )


def refuse_outside_crs(
    table: FileTable,
    position_crs: Floats,
    frame: GroundFrame,
    findings: list[str],
    row_of_position: Ints | None = None,
) -> None:
    """A finding for every position that the crs (or the geoid grid) does not cover."""
    given = np.isfinite(position_crs).all(axis=1)
    covered = np.isfinite(frame.to_computing(position_crs)).all(axis=1)
    rows = np.arange(len(table)) if row_of_position is None else row_of_position
    area = f"{frame.crs}{' or its geoid grid' if frame.geoid is not None else ''}"
    findings += [
        f"{table.place(row, 'x')}: found a position outside {area}, expected one inside"
        for row in rows[given & ~covered]
    ]


def _survey_sigma(table: FileTable, name: str, findings: list[str]) -> Floats:
    if name not in table.columns:
        return np.full(len(table), np.nan)
    sigma = table.numbers(name, findings, optional=True, largest=LARGEST_M)
    findings += [
        f"{table.place(row, name)}: found {sigma[row]:g}, expected no negative number"
        for row in np.flatnonzero(sigma < 0.0)
    ]
    return sigma


def _sorted_ids(ids: Any) -> tuple[Ids, Ints]:
    """Distinct ids in order (p,), and the number of each row's id (m,)."""
    coded = pc.dictionary_encode(ids)
    order = pc.sort_indices(coded.dictionary).to_numpy()
    number = np.empty(len(order), dtype=np.intp)
    number[order] = np.arange(len(order))
    sorted_ids = coded.dictionary.take(pa.array(order)).to_numpy(zero_copy_only=False)
    return np.asarray(sorted_ids, dtype=object), number[coded.indices.to_numpy()]


def _image_numbers(table: FileTable, images: Sequence[str], findings: list[str]) -> Ints:
    """Index (m,) into `images`, -1 with a finding where there is no such image."""
    ids = table.ids("image", findings)
    found = pc.index_in(ids, value_set=pa.array(list(images), pa.string()))
    number = pc.fill_null(found, -1).to_numpy().astype(np.intp)
    findings += [
        f"{table.place(row, 'image')}: found image {ids[int(row)].as_py()!r},"
        " expected one of orientations"
        for row in np.flatnonzero(number < 0)
        if ids[int(row)].as_py()
    ]
    return np.asarray(number)


def _refuse_outside(
    table: FileTable,
    xy: Floats,
    camera: Ints,
    cameras: Sequence[Camera],
    unit: str,
    findings: list[str],
) -> None:
    """Findings for coordinates more than 5 % outside the image format."""
    for number, interior in enumerate(cameras):
        rows = np.flatnonzero(camera == number)
        size = np.array([interior.width_px, interior.height_px])
        column_row = _column_row(xy[rows], interior, unit)
        outside = (column_row < -FORMAT_MARGIN * size) | (column_row > (1 + FORMAT_MARGIN) * size)
        for index, axis in np.argwhere(outside):
            row = rows[index]
            findings.append(
                f"{table.place(row, 'xy'[axis])}: found {xy[row, axis]:g} {unit}, expected it in"
                f" the image format of {size[0]:g} x {size[1]:g} px (5 % beyond it are allowed)"
            )


def _refuse_repeated(
    table: FileTable,
    point_id: Ids,
    point: Ints,
    images: Sequence[str],
    image: Ints,
    order: Ints,
    findings: list[str],
) -> None:
    """Findings for points measured twice in one image; arguments sorted by point and image."""
    again = (point[1:] == point[:-1]) & (image[1:] == image[:-1]) & (image[1:] >= 0)
    again &= (point_id != "")[point[1:]]  # an id that is missing has its own finding
    findings += [
        f"{table.place(order[k + 1], 'point')}: found point {point_id[point[k]]!r} again in"
        f" image {images[image[k]]!r} ({table.place(order[k], 'point')}), expected once"
        for k in np.flatnonzero(again)
    ]
