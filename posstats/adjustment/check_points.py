"""Points that took no part in a bundle adjustment, intersected from its orientations.

Their image coordinates are freed of the deformation that the adjustment estimated, and their
covariance holds that of all their images and of the camera's parameters together:

    cov X = N^-1 + U C U',    U = N^-1 B'W [A D],    N = B'W B,

with A, B, D the derivatives of the image coordinates by the orientations, the point and the
camera's parameters, W the weights and C the covariance of orientations and parameters.
"""

from dataclasses import replace

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.block.model import Block, Orientations, TiePoints
from posstats.errors import GeometryError
from posstats.geometry.ground.intersection import IntersectedPoints, intersect
from posstats.numerics.bundle.parameters import ParameterEffects, parameter_effects
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem
from posstats.numerics.bundle.rays import CAMERA_PARAMETERS, Cameras, Images, project_rays
from posstats.numerics.bundle.system import BundleSystem, State
from posstats.numerics.solvers.arrow import SelectedInverse

_STEPS = 20
_SETTLED_PX = 1e-7


def intersect_apart(
    block: Block,
    problem: BundleProblem,
    adjusted: AdjustedBundle,
    orientations: Orientations,
    points: Ints,
) -> tuple[IntersectedPoints, Floats]:
    """Positions of points from the adjusted orientations, and their covariances (k, 3, 3).

    Parameters
    ----------
    block
        With the measurements of the points.
    problem, adjusted
        Of the adjustment, in which none of the points has a ray.
    orientations
        The adjusted ones.
    points
        (k,) indices into the tie points' `point_id`; negative: in no image.

    Raises
    ------
    GeometryError
        If the image deformation cannot be inverted at a measurement.
    """
    rays = block.tie_points.subset(np.isin(block.tie_points.point, points[points >= 0]))
    cameras = camera_values(problem, adjusted)
    ideal = replace(rays, xy_px=ideal_xy(rays.xy_px, orientations.camera[rays.image], cameras))
    computed = intersect(
        ideal, orientations, block.cameras, points, sigma_image_px=block.accuracy.image_px
    )
    covariance = np.full((len(points), 3, 3), np.nan)
    good = np.flatnonzero(computed.is_ok)
    if len(good):
        covariance[good] = _covariances(problem, adjusted, cameras, rays, computed, good)
    return computed, covariance


def camera_values(problem: BundleProblem, adjusted: AdjustedBundle) -> Cameras:
    """The cameras with their adjusted parameters."""
    effects = parameter_effects(problem.parameters, problem.exposures)
    values = np.append(adjusted.common[effects.camera], 0.0)[effects.camera_column]
    return Cameras(
        problem.distance_px,
        problem.mm_per_px,
        problem.bauer_radius_mm,
        np.ascontiguousarray(values),
        effects.camera_column,
    )


def ideal_xy(xy_px: Floats, camera: Ints, cameras: Cameras) -> Floats:
    """Image coordinates (m, 2) without the cameras' deformation, at the stated distance.

    Newton's method: a camera at the origin that looks down sees the point (a, b, -1) at the
    ratios a, b of an ideal image point.

    Raises
    ------
    GeometryError
        If it does not settle.
    """
    if len(xy_px) == 0 or not cameras.value.any():
        return xy_px
    m, distance = len(xy_px), cameras.distance_px[camera][:, None]
    images = Images(np.tile(np.eye(3), (m, 1, 1)), np.zeros((m, 3)), camera)
    place = np.arange(m)
    direction = np.column_stack([xy_px / distance, np.full(m, -1.0)])
    for _ in range(_STEPS):
        seen, _, by_direction, _ = project_rays(direction, place, place, images, cameras)
        missing = xy_px - seen
        if np.abs(missing).max() < _SETTLED_PX:
            return direction[:, :2] * distance
        direction[:, :2] += np.linalg.solve(by_direction[:, :, :2], missing[:, :, None])[:, :, 0]
    raise GeometryError("the estimated image deformation cannot be inverted over the image format")


def _covariances(
    problem: BundleProblem,
    adjusted: AdjustedBundle,
    cameras: Cameras,
    rays: TiePoints,
    computed: IntersectedPoints,
    good: Ints,
) -> Floats:
    """(len(good), 3, 3) of the points that could be intersected."""
    sigma_px = float(np.median(problem.sigma_px))
    effects = parameter_effects(problem.parameters, problem.exposures)
    inverse = _inverse_with(problem, adjusted, rays, computed)
    images = Images(adjusted.ground_from_image, adjusted.position_m, problem.exposures.camera)
    covariance = np.empty((len(good), 3, 3))
    for row, at in enumerate(good):
        own = rays.image[rays.point == computed.point[at]]
        ground, point = computed.position_m[[at]], np.zeros(len(own), dtype=np.intp)
        _, by_pose, by_ground, by_camera = project_rays(ground, point, own, images, cameras)
        by = _by_unknowns(by_pose, by_camera, problem.exposures.camera[own], effects)
        b = by_ground.reshape(-1, 3) / sigma_px
        cofactors = np.linalg.inv(b.T @ b)
        u = cofactors @ b.T @ (by / sigma_px)
        covariance[row] = cofactors + u @ _joint(inverse, own, effects) @ u.T
    return covariance


def _by_unknowns(
    by_pose: Floats, by_camera: Floats, camera: Ints, effects: ParameterEffects
) -> Floats:
    """(2 n, 6 n + r) derivatives of a point's rays by its n images and r camera parameters."""
    n, r = len(by_pose), len(effects.camera)
    by = np.zeros((n, 2, 6 * n + r))
    for k in range(n):
        by[k, :, 6 * k : 6 * k + 6] = by_pose[k]
        column = effects.camera_column[camera[k]]
        for parameter in range(len(CAMERA_PARAMETERS)):
            if column[parameter] >= 0:
                by[k, :, 6 * n + column[parameter]] = by_camera[k, :, parameter]
    return by.reshape(2 * n, -1)


def _joint(inverse: SelectedInverse, images: Ints, effects: ParameterEffects) -> Floats:
    """(6 n + r)^2 covariance of n images and the r camera parameters."""
    n, camera = len(images), effects.camera
    blocks = inverse.blocks(np.repeat(images, n), np.tile(images, n)).reshape(n, n, 6, 6)
    poses = np.swapaxes(blocks, 1, 2).reshape(6 * n, 6 * n)
    border = inverse.border[images][:, :, camera].reshape(6 * n, -1)
    return np.block([[poses, border], [border.T, inverse.corner[np.ix_(camera, camera)]]])


def _inverse_with(
    problem: BundleProblem, adjusted: AdjustedBundle, rays: TiePoints, computed: IntersectedPoints
) -> SelectedInverse:
    """The adjustment's inverse with the pairs of images that only points apart have in common.

    Their rays take part without weight, so that the pairs belong to the normal equations.
    """
    kept = ~adjusted.rejected
    known = np.isin(rays.point, computed.point[computed.is_ok])
    ground = np.where(np.isnan(adjusted.ground_m), problem.ground_m, adjusted.ground_m)
    ground[computed.point[computed.is_ok]] = computed.position_m[computed.is_ok]
    extended = replace(
        problem,
        point=np.append(problem.point[kept], rays.point[known]),
        image=np.append(problem.image[kept], rays.image[known]),
        xy_px=np.concatenate([problem.xy_px[kept], rays.xy_px[known]]),
        sigma_px=np.append(problem.sigma_px[kept], np.full(int(known.sum()), np.inf)),
        ground_m=ground,
    )
    system = BundleSystem.of(extended)
    state = State(
        adjusted.ground_from_image,
        adjusted.position_m,
        ground[system.rays.point],
        adjusted.common,
    )
    return system.precision(system.equations(state))[0]
