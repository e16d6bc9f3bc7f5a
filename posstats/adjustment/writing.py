"""Adjusted orientations and points as the files that they are written to."""

from os import PathLike
from pathlib import Path

import numpy as np

from posstats.adjustment.steps import Adjustment
from posstats.arrays import Floats, Ids
from posstats.formats.adjusted_writing import write_adjusted, write_points


def write_adjustment(adjustment: Adjustment, folder: str | PathLike[str]) -> None:
    """Write ``adjusted_orientations.csv`` and ``points.csv`` into a folder."""
    target = Path(folder)
    write_adjusted(
        adjustment.block,
        adjustment.orientations,
        adjustment.pose_covariance,
        target / "adjusted_orientations.csv",
    )
    position, covariance, role = all_points(adjustment)
    used = adjustment.stated.point[~adjustment.adjusted.rejected]
    n_rays = np.bincount(used, minlength=len(position))
    check = role == "check"
    n_rays[check] = np.bincount(adjustment.block.tie_points.point, minlength=len(position))[check]
    columns = {"n_rays": n_rays, "role": role}
    write_points(adjustment.block, position, covariance, columns, target / "points.csv")


def all_points(adjustment: Adjustment) -> tuple[Floats, Floats, Ids]:
    """Positions (p, 3), covariances (p, 3, 3), computing frame, and roles (p,) of all points."""
    adjusted, block = adjustment.adjusted, adjustment.block
    position = adjusted.ground_m.copy()
    covariance = adjustment.scale**2 * adjusted.ground_covariance_m2
    role = np.full(len(position), "tie", dtype=object)
    role[adjustment.problem.control.point] = "control"
    role[block.check_points] = "check"
    number = {point: k for k, point in enumerate(block.tie_points.point_id)}
    for row, point in enumerate(adjustment.check_points.point):
        if point in number:
            position[number[point]] = adjustment.check_point_position_m[row]
            covariance[number[point]] = adjustment.check_point_covariance_m2[row]
    return position, covariance, role
