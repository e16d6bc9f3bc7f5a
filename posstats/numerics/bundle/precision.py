"""Covariances of ground points and redundancy numbers after a bundle adjustment; compiled.

With C the covariance of the other unknowns of a point's rays, and K, N and A, B of
`point_normals`, U = N^-1 K gives

    cov X = N^-1 + U C U',       cov (A dx + B dX) = h C h' + B N^-1 B',    h = A - B U,

and the redundancy number of an image coordinate is 1 - w times its diagonal element. C is needed
for pairs of images of one point only: a selected inverse of the normal equations holds it.
"""

from typing import NamedTuple

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.numerics.bundle.point_groups import PointGroups
from posstats.numerics.bundle.point_normals import (
    Ground,
    Measured,
    Network,
    factorise_point,
    linearise,
    normals_of_point,
    solve_lower,
    solve_upper,
)
from posstats.numerics.bundle.rays import Cameras, Images, Ray, new_ray
from posstats.numerics.kernels.compiled import inner_kernel, kernel


class Cofactors(NamedTuple):
    """Covariance of n images and k camera unknowns for observations of the stated weights.

    Attributes
    ----------
    blocks
        (P, 6, 6) of the pairs of images.
    border
        (n, 6, k).
    corner
        (k, k).
    """

    blocks: Floats
    border: Floats
    corner: Floats


class PointPrecision(NamedTuple):
    """Results of p points and m rays.

    Attributes
    ----------
    covariance_m2
        (p, 3, 3); NaN of a point that is not determined.
    redundancy
        (m, 2) of the rays' x, y; NaN of a ray that is taken out.
    """

    covariance_m2: Floats
    redundancy: Floats


@inner_kernel
def _gather(members: Ints, pairs: Ints, cofactors: Cofactors, local: Floats) -> None:
    """Write the covariance (6 n + k)^2 of a group's images and of the camera unknowns."""
    n, n_common, at = len(members), cofactors.corner.shape[0], 0
    for i in range(n):
        for j in range(i, n):
            block = cofactors.blocks[pairs[at]]
            at += 1
            for a in range(6):
                for b in range(6):
                    local[6 * i + a, 6 * j + b] = block[a, b]
                    local[6 * j + b, 6 * i + a] = block[a, b]
        for a in range(6):
            for b in range(n_common):
                local[6 * i + a, 6 * n + b] = cofactors.border[members[i], a, b]
                local[6 * n + b, 6 * i + a] = cofactors.border[members[i], a, b]
    for a in range(n_common):
        for b in range(n_common):
            local[6 * n + a, 6 * n + b] = cofactors.corner[a, b]


@inner_kernel
def _shift_covariance(
    d: Floats,
    at: int,
    local: Floats,
    shared: Floats,
    point: int,
    covariance: Floats,
    turned: Floats,
    out: Floats,
) -> None:
    """Write cov(M s + dX) (3, 3), M = [[d]x, -1]: what a ray sees of its image and its point.

    `shared` is U C (3, 6 n + k), `covariance` cov X, `turned` room for M C (3, 6).
    """
    for j in range(6):
        x, y, z = local[at, at + j], local[at + 1, at + j], local[at + 2, at + j]
        turned[0, j] = d[1] * z - d[2] * y - local[at + 3, at + j]
        turned[1, j] = d[2] * x - d[0] * z - local[at + 4, at + j]
        turned[2, j] = d[0] * y - d[1] * x - local[at + 5, at + j]
    for i in range(3):
        for j in range(6):
            turned[i, j] -= 2.0 * shared[i, at + j]
    for i in range(3):
        x, y, z = turned[i, 0], turned[i, 1], turned[i, 2]
        out[i, 0] = d[1] * z - d[2] * y - turned[i, 3] + covariance[point, i, 0]
        out[i, 1] = d[2] * x - d[0] * z - turned[i, 4] + covariance[point, i, 1]
        out[i, 2] = d[0] * y - d[1] * x - turned[i, 5] + covariance[point, i, 2]


@inner_kernel
def _camera_variance(
    ray: Ray,
    axis: int,
    at: int,
    n_images: int,
    camera: int,
    column: Ints,
    local: Floats,
    shared: Floats,
) -> float:
    """What the camera's unknowns add to the variance of an adjusted image coordinate."""
    b, d, variance = ray.by_ground, ray.offset, 0.0
    for k in range(ray.by_camera.shape[1]):
        if column[camera, k] < 0:
            continue
        row, across = 6 * n_images + column[camera, k], 0.0
        x, y, z = local[row, at], local[row, at + 1], local[row, at + 2]
        across += b[axis, 0] * (d[1] * z - d[2] * y - local[row, at + 3] - shared[0, row])
        across += b[axis, 1] * (d[2] * x - d[0] * z - local[row, at + 4] - shared[1, row])
        across += b[axis, 2] * (d[0] * y - d[1] * x - local[row, at + 5] - shared[2, row])
        across *= 2.0
        for j in range(ray.by_camera.shape[1]):
            if column[camera, j] >= 0:
                other = 6 * n_images + column[camera, j]
                across += ray.by_camera[axis, j] * local[row, other]
        variance += ray.by_camera[axis, k] * across
    return variance


@inner_kernel
def _propagate(lower: Floats, rows: Floats, local: Floats, shared: Floats, out: Floats) -> None:
    """Write U to `rows` (K before), U C to `shared` and cov X to `out`."""
    width = rows.shape[1]
    out[:] = 0.0
    for i in range(3):
        out[i, i] = 1.0
    solve_lower(lower, out)
    solve_upper(lower, out)
    solve_lower(lower, rows)
    solve_upper(lower, rows)
    shared[:] = 0.0
    for i in range(3):
        for a in range(width):
            factor = rows[i, a]
            for b in range(width):
                shared[i, b] += factor * local[a, b]
    for i in range(3):
        for j in range(3):
            for a in range(width):
                out[i, j] += shared[i, a] * rows[j, a]


@inner_kernel
def _point(
    point: int,
    groups: PointGroups,
    measured: Measured,
    ground: Ground,
    images: Images,
    cameras: Cameras,
    local: Floats,
    ray: Ray,
    normals: Floats,
    side: Floats,
    rows: Floats,
    shared: Floats,
    turned: Floats,
    seen: Floats,
    out: PointPrecision,
) -> None:
    """Write the results of one point and its rays."""
    first, n = groups.first_ray[point], groups.first_ray[point + 1] - groups.first_ray[point]
    covariance = out.covariance_m2[point]
    normals_of_point(point, groups, measured, ground, images, cameras, ray, normals, side, rows)
    if not factorise_point(normals):
        covariance[:] = np.nan
        out.redundancy[first : first + n] = np.nan
        return
    _propagate(normals, rows, local, shared, covariance)
    for place in range(n):
        k, i = first + place, groups.ray_image[first + place]
        weight, camera = measured.weight[k], images.camera[i]
        if weight == 0.0:
            out.redundancy[k, 0] = out.redundancy[k, 1] = np.nan
            continue
        linearise(k, point, i, measured, ground.position_m, images, cameras, ray)
        _shift_covariance(
            ray.offset, 6 * place, local, shared, point, out.covariance_m2, turned, seen
        )
        for axis in range(2):
            variance = _camera_variance(
                ray, axis, 6 * place, n, camera, cameras.column, local, shared
            )
            for j in range(3):
                for m in range(3):
                    variance += ray.by_ground[axis, j] * seen[j, m] * ray.by_ground[axis, m]
            out.redundancy[k, axis] = 1.0 - weight * variance


@kernel
def point_precision(
    first_group: int,
    last_group: int,
    network: Network,
    cofactors: Cofactors,
    out: PointPrecision,
) -> None:
    """Write the results of the points of groups first_group ... last_group - 1.

    Parameters are those of `normals.accumulate`, and `cofactors` of the solution, of
    the same pairs.
    """
    groups, measured, ground, images, cameras = network
    n_common = cofactors.corner.shape[0]
    most = 0
    for group in range(first_group, last_group):
        point = groups.offsets[group]
        most = max(most, groups.first_ray[point + 1] - groups.first_ray[point])
    widest = 6 * most + n_common
    local_store = np.empty(widest**2)
    rows_store, shared_store = np.empty(3 * widest), np.empty(3 * widest)
    ray, normals, side = new_ray(n_common), np.empty((3, 3)), np.empty(3)
    turned, seen = np.empty((3, 6)), np.empty((3, 3))
    for group in range(first_group, last_group):
        point = groups.offsets[group]
        first, n = groups.first_ray[point], groups.first_ray[point + 1] - groups.first_ray[point]
        width = 6 * n + n_common
        local = local_store[: width * width].reshape(width, width)
        rows = rows_store[: 3 * width].reshape(3, width)
        shared = shared_store[: 3 * width].reshape(3, width)
        pairs = groups.pair[groups.pair_offsets[group] : groups.pair_offsets[group + 1]]
        _gather(groups.ray_image[first : first + n], pairs, cofactors, local)
        for each in range(point, groups.offsets[group + 1]):
            _point(
                each, groups, measured, ground, images, cameras, local,
                ray, normals, side, rows, shared, turned, seen, out,
            )  # fmt: skip
