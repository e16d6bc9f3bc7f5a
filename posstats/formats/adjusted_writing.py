"""An adjusted block -> files: orientations beside the input, and all points."""

from collections.abc import Mapping
from os import PathLike
from typing import Any

import numpy as np
import pandas as pd

from posstats.arrays import Floats, Ints
from posstats.block.model import Block, Orientations
from posstats.formats.block_writing import POSITION_DECIMALS, source_of
from posstats.formats.convention import Convention
from posstats.formats.orientation_files import POSITION_COLUMNS
from posstats.numerics.kernels.rotation import wrapped

_SIGMA_FORMAT = "{:.6g}"
_PAIRS = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))


def write_adjusted(
    block: Block, orientations: Orientations, pose_covariance: Floats, path: str | PathLike[str]
) -> None:
    """Write adjusted orientations with the columns, units and angle system of the input.

    They are those of the cameras: projection centres, no boresight. The file can serve as the
    block's ``adjusted.csv``. Standard deviations, in the units of the columns, follow as sigma_x
    and so on; those of the input are replaced.

    Parameters
    ----------
    block
        As read, or of memory.
    orientations
        n adjusted ones, computing frame, in the order of the block's.
    pose_covariance
        (n, 6, 6) of rotation vector (computing frame) and projection centre.
    path
        The file to write, CSV.
    """
    source, convention, decimals = source_of(block, Convention.of_adjusted)
    table, angle_names = source.table.copy(), list(source.angle_columns)
    position = block.frame.to_crs(orientations.position_m)
    rotation = orientations.ground_from_image
    before = table[angle_names].to_numpy(dtype=float)[source.row]
    turned = (convention.file_angles(position, rotation) - before) * convention.unit_rad
    angles = before + wrapped(turned) / convention.unit_rad
    _fill(table, source.row, list(POSITION_COLUMNS), position, f"{{:.{POSITION_DECIMALS}f}}")
    _fill(table, source.row, angle_names, angles, f"{{:.{decimals}f}}")
    axes = block.frame.computing_from_crs_axes(position)
    sigma = np.sqrt(np.diagonal(_turned(pose_covariance[:, 3:, 3:], axes), axis1=1, axis2=2))
    sigma_angles = convention.file_angle_sigmas(position, rotation, pose_covariance[:, :3, :3])
    _fill(table, source.row, [f"sigma_{n}" for n in POSITION_COLUMNS], sigma, _SIGMA_FORMAT)
    _fill(table, source.row, [f"sigma_{n}" for n in angle_names], sigma_angles, _SIGMA_FORMAT)
    table.to_csv(path, index=False)


def _fill(table: pd.DataFrame, row: Ints, names: list[str], values: Floats, style: str) -> None:
    """Write numbers (n, 3) as text into three columns."""
    for axis, name in enumerate(names):
        text = np.empty(len(table), dtype=object)
        text[row] = [style.format(value) for value in values[:, axis]]
        table[name] = text


def _turned(covariance: Floats, axes: Floats) -> Floats:
    """Covariances (n, 3, 3) along the columns of axes (n, 3, 3)."""
    along: Floats = np.swapaxes(axes, -1, -2) @ covariance @ axes
    return along


def write_points(
    block: Block,
    position_m: Floats,
    covariance_m2: Floats,
    columns: Mapping[str, Any],
    path: str | PathLike[str],
) -> None:
    """Write points with coordinates in the crs and their covariances along its axes.

    Parameters
    ----------
    block
        Its tie points name the points.
    position_m, covariance_m2
        (p, 3), (p, 3, 3), computing frame; points with NaN are left out.
    columns
        Further columns of p values, beside the ids.
    path
        The file to write, CSV.
    """
    known = np.isfinite(position_m).all(axis=1)
    position = block.frame.to_crs(position_m[known])
    along = _turned(covariance_m2[known], block.frame.computing_from_crs_axes(position))
    table = pd.DataFrame({"point": block.tie_points.point_id[known]})
    for axis, name in enumerate(POSITION_COLUMNS):
        table[name] = np.round(position[:, axis], POSITION_DECIMALS)
    for i, j in _PAIRS:
        name = f"cov_{POSITION_COLUMNS[i]}{POSITION_COLUMNS[j]}"
        table[name] = [_SIGMA_FORMAT.format(value) for value in along[:, i, j]]
    for name, values in columns.items():
        table[name] = np.asarray(values)[known]
    table.to_csv(path, index=False)
