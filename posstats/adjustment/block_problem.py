"""A block as the arrays of a bundle adjustment."""

from collections.abc import Sequence

import numpy as np

from posstats.arrays import Bools, Floats
from posstats.block.model import Block
from posstats.errors import GeometryError
from posstats.numerics.bundle.parameters import CommonParameter, Exposures
from posstats.numerics.bundle.pos_observations import PosObservations
from posstats.numerics.bundle.problem import BundleProblem, Control
from posstats.numerics.kernels.collinearity import INTERSECTED, intersect_rays

_SURVEY_M = 0.01  # standard deviation of surveys that state none


def bundle_problem(
    block: Block, parameters: Sequence[CommonParameter] = (), *, control: Bools | None = None
) -> BundleProblem:
    """The adjustment of a block from its POS.

    All measured points take part as tie points, check points too; to leave them out, take them
    from the block's tie points. Points that the POS orientations do not intersect are left out.

    Parameters
    ----------
    block
        Its ground points are control where `control` is true.
    parameters
        Additional unknowns.
    control
        (g,) which of the block's ground points are control; those that are no check points
        where None.

    Raises
    ------
    GeometryError
        If Bauer's parameters are wanted and a pixel size is not known, or a control point has a
        standard deviation of 0.
    """
    pos, ties = block.orientations, block.tie_points
    distance = np.array([camera.principal_distance_px for camera in block.cameras])
    ground = _start(block, distance)
    used = np.isfinite(ground[ties.point, 0])
    return BundleProblem(
        exposures=Exposures(
            pos.time_s, pos.strip, pos.camera, tuple(camera.id for camera in block.cameras)
        ),
        ground_from_image=pos.ground_from_image,
        position_m=pos.position_m,
        distance_px=distance,
        mm_per_px=_pixel_sizes(block, parameters),
        point=ties.point[used],
        image=ties.image[used],
        xy_px=ties.xy_px[used],
        sigma_px=np.full(int(used.sum()), block.accuracy.image_px),
        ground_m=ground,
        pos=PosObservations(
            pos.position_m, pos.sigma_position_m, pos.angles_rad, pos.sigma_angles_rad, pos.system
        ),
        control=_control(block, control),
        parameters=tuple(parameters),
    )


def _pixel_sizes(block: Block, parameters: Sequence[CommonParameter]) -> Floats:
    """(c,) mm; 1 where not known and not needed."""
    sizes = [camera.pixel_size_mm for camera in block.cameras]
    if None in sizes and any(parameter.name.startswith("bauer") for parameter in parameters):
        raise GeometryError("Bauer's parameters count in millimetres: a pixel size is missing")
    return np.array([1.0 if size is None else size for size in sizes])


def _start(block: Block, distance_px: Floats) -> Floats:
    """(p, 3) intersections from POS, NaN where there is none."""
    pos, ties = block.orientations, block.tie_points
    vectors = np.column_stack([ties.xy_px, -distance_px[pos.camera[ties.image]]])
    ends = np.searchsorted(ties.point, np.arange(len(ties.point_id)), side="right")
    first = np.append(0, ends[:-1])
    ground, status = intersect_rays(
        vectors, ties.image, first, ends, pos.ground_from_image, pos.position_m
    )
    ground[status != INTERSECTED] = np.nan
    return ground


def _control(block: Block, chosen: Bools | None) -> Control:
    """The chosen ground points that are measured."""
    surveyed = block.ground_points
    if surveyed is None:
        return Control(np.empty(0, dtype=np.intp), np.empty((0, 3)), np.empty((0, 3, 3)))
    number = {point: at for at, point in enumerate(block.tie_points.point_id)}
    wanted = ~surveyed.is_check if chosen is None else chosen
    rows = [g for g in np.flatnonzero(wanted) if surveyed.point[g] in number]
    sigma = np.column_stack([surveyed.sigma_xy_m, surveyed.sigma_xy_m, surveyed.sigma_z_m])[rows]
    exact = [surveyed.point[g] for g, each in zip(rows, sigma, strict=True) if (each == 0.0).any()]
    if exact:
        raise GeometryError(
            f"control points {', '.join(exact)}: found a standard deviation (sigma_xy, sigma_z) of"
            " 0, expected a positive one or none"
        )
    return Control(
        np.array([number[surveyed.point[g]] for g in rows], dtype=np.intp),
        surveyed.position_m[rows],
        np.where(np.isnan(sigma), _SURVEY_M, sigma)[:, :, None] ** 2 * np.eye(3),
    )
