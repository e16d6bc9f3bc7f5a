"""Where the images lie on the ground, for the plan of the block."""

import numpy as np

from posstats.arrays import Floats
from posstats.block.camera import Camera
from posstats.block.model import Block
from posstats.geometry.ground.intersection import intersect

SAMPLE = 500
"""Tie points from which the mean ground height is taken."""


def ground_height_m(block: Block) -> float:
    """Median height of a sample of the tie points, computing frame; NaN if none intersects."""
    rays = np.bincount(block.tie_points.point, minlength=len(block.tie_points.point_id))
    seen = np.flatnonzero(rays >= 2)
    sample = seen[:: max(1, len(seen) // SAMPLE)]
    points = intersect(block.tie_points, block.orientations, block.cameras, sample)
    heights = points.position_m[points.is_ok, 2]
    return float(np.median(heights)) if len(heights) else np.nan


def footprints(block: Block) -> list[Floats | None]:
    """Corners (4, 2) of every image on the level of the mean ground height, crs axes.

    Lens distortion is neglected. None where a corner looks above the horizon or the ground
    height is unknown.
    """
    height = ground_height_m(block)
    pos = block.orientations
    rotation = pos.ground_from_image
    return [
        _footprint(block, pos.position_m[k], rotation[k], _corners(block.cameras[camera]), height)
        for k, camera in enumerate(pos.camera)
    ]


def _corners(camera: Camera) -> Floats:
    """(4, 3) image vectors of the format's corners, going round."""
    columns = np.array([0.0, camera.width_px, camera.width_px, 0.0])
    rows = np.array([0.0, 0.0, camera.height_px, camera.height_px])
    column, row = camera.principal_point_px
    depth = np.full(4, -camera.principal_distance_px)
    return np.column_stack([columns - column, row - rows, depth])


def _footprint(
    block: Block, centre_m: Floats, ground_from_image: Floats, corners: Floats, height_m: float
) -> Floats | None:
    directions = corners @ ground_from_image.T
    if not np.all(directions[:, 2] < 0.0) or not centre_m[2] > height_m:
        return None
    reach = (height_m - centre_m[2]) / directions[:, 2]
    ground = block.frame.to_crs(centre_m + reach[:, None] * directions)
    return ground[:, :2] if np.isfinite(ground).all() else None
