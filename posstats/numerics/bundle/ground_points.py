"""Ground points of a bundle adjustment between two solutions, and their residuals; compiled.

With N, n and K of `point_normals`, a point's step is -N^-1 (n + K s) for a step s of all other
unknowns.
"""

import numpy as np

from posstats.arrays import Floats
from posstats.numerics.bundle.point_groups import PointGroups
from posstats.numerics.bundle.point_normals import (
    Ground,
    Measured,
    Network,
    add_control,
    factorise_point,
    linearise,
    normals_of_point,
    solve_lower,
    solve_upper,
)
from posstats.numerics.bundle.rays import Cameras, Images, Ray, new_ray
from posstats.numerics.kernels.compiled import inner_kernel, kernel

_INTERSECTION_STEPS = 3


@kernel
def move_points(
    first_group: int,
    last_group: int,
    network: Network,
    image_step: Floats,
    common_step: Floats,
    damping: float,
    new_position_m: Floats,
) -> None:
    """Move the points of some groups as a step of the other unknowns asks for.

    Parameters are those of `normals.accumulate`, and

    image_step, common_step
        (n, 6), (k,) solution of the reduced normal equations.
    new_position_m
        (p, 3) written; a point that is not determined stays.
    """
    groups, measured, ground, images, cameras = network
    points = range(groups.offsets[first_group], groups.offsets[last_group])
    most = 0
    for point in points:
        most = max(most, groups.first_ray[point + 1] - groups.first_ray[point])
    ray, normals, side = new_ray(len(common_step)), np.empty((3, 3)), np.empty((3, 1))
    store = np.empty((3, 6 * most + len(common_step)))
    for point in points:
        first, n = groups.first_ray[point], groups.first_ray[point + 1] - groups.first_ray[point]
        rows = store[:, : 6 * n + len(common_step)]
        normals_of_point(
            point, groups, measured, ground, images, cameras, ray, normals, side[:, 0], rows
        )
        for i in range(3):
            normals[i, i] *= 1.0 + damping
            for place in range(n):
                for j in range(6):
                    moved = image_step[groups.ray_image[first + place], j]
                    side[i, 0] += rows[i, 6 * place + j] * moved
            for j in range(len(common_step)):
                side[i, 0] += rows[i, 6 * n + j] * common_step[j]
        if factorise_point(normals):
            solve_lower(normals, side)
            solve_upper(normals, side)
        else:
            side[:] = 0.0
        for i in range(3):
            new_position_m[point, i] = ground.position_m[point, i] - side[i, 0]


@inner_kernel
def _square_sum(
    point: int,
    groups: PointGroups,
    measured: Measured,
    ground: Ground,
    images: Images,
    cameras: Cameras,
    ray: Ray,
    normals: Floats,
    side: Floats,
) -> float:
    """The sum v'Wv of a point's rays and control, infinite behind a camera; overwrites N, n."""
    total = add_control(point, ground, normals, side)
    for k in range(groups.first_ray[point], groups.first_ray[point + 1]):
        if measured.weight[k] > 0.0:
            image = groups.ray_image[k]
            if not linearise(k, point, image, measured, ground.position_m, images, cameras, ray):
                return np.inf
            squares = ray.residual[0] ** 2 + ray.residual[1] ** 2
            total += measured.weight[k] * squares
    return total


@kernel
def intersect_points(first_group: int, last_group: int, network: Network) -> None:
    """Intersect the points of some groups anew, each for itself, the images held.

    Parameters are those of `normals.accumulate`; the ground positions are the start, and
    overwritten.
    """
    groups, measured, ground, images, cameras = network
    most = 0
    for group in range(first_group, last_group):
        point = groups.offsets[group]
        most = max(most, groups.first_ray[point + 1] - groups.first_ray[point])
    ray, normals, side = new_ray(0), np.empty((3, 3)), np.empty((3, 1))
    rows, before = np.empty((3, 6 * most)), np.empty(3)
    for point in range(groups.offsets[first_group], groups.offsets[last_group]):
        least = _square_sum(
            point, groups, measured, ground, images, cameras, ray, normals, side[:, 0]
        )
        for _ in range(_INTERSECTION_STEPS):
            normals_of_point(
                point, groups, measured, ground, images, cameras, ray, normals, side[:, 0], rows
            )
            if not factorise_point(normals):
                break
            solve_lower(normals, side)
            solve_upper(normals, side)
            for i in range(3):
                before[i] = ground.position_m[point, i]
                ground.position_m[point, i] -= side[i, 0]
            after = _square_sum(
                point, groups, measured, ground, images, cameras, ray, normals, side[:, 0]
            )
            if not after < least:
                for i in range(3):
                    ground.position_m[point, i] = before[i]
                break
            least = after


@kernel
def ray_residuals(first_group: int, last_group: int, network: Network, residual_px: Floats) -> None:
    """Write the residuals (m, 2) of the rays of some groups, NaN behind a camera.

    Parameters are those of `normals.accumulate`; a residual is computed minus measured.
    """
    groups, measured, ground, images, cameras = network
    ray = new_ray(0)
    for point in range(groups.offsets[first_group], groups.offsets[last_group]):
        for k in range(groups.first_ray[point], groups.first_ray[point + 1]):
            image = groups.ray_image[k]
            seen = linearise(k, point, image, measured, ground.position_m, images, cameras, ray)
            for axis in range(2):
                residual_px[k, axis] = ray.residual[axis] if seen else np.nan
