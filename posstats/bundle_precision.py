"""Covariances of ground points and redundancy numbers after a bundle adjustment; compiled.

With C the covariance of the other unknowns of a point's rays, and K, N and A, B of
`bundle_normals`, U = N^-1 K gives

    cov X = N^-1 + U C U',       cov (A dx + B dX) = h C h' + B N^-1 B',    h = A - B U,

and the redundancy number of an image coordinate is 1 - w times its diagonal element. C is needed
for pairs of images of one point only: a selected inverse of the normal equations holds it.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from posstats.bundle_groups import PointGroups
from posstats.bundle_normals import (
    Ground,
    Measured,
    Network,
    factorise_point,
    linearise,
    normals_of_point,
    solve_lower,
    solve_upper,
)
from posstats.bundle_rays import Cameras, Images, Ray, new_ray
from posstats.compiled import inner_kernel, kernel

_Floats = NDArray[np.float64]
_Ints = NDArray[np.intp]


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

    blocks: _Floats
    border: _Floats
    corner: _Floats


class PointPrecision(NamedTuple):
    """Results of p points and m rays.

    Attributes
    ----------
    covariance_m2
        (p, 3, 3); NaN of a point that is not determined.
    redundancy
        (m, 2) of the rays' x, y; NaN of a ray that is taken out.
    """

    covariance_m2: _Floats
    redundancy: _Floats


@inner_kernel
def _gather(members: _Ints, pairs: _Ints, cofactors: Cofactors, local: _Floats) -> None:
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
def _by_unknowns(
    ray: Ray,
    axis: int,
    place: int,
    n_images: int,
    camera: int,
    column: _Ints,
    row: _Floats,
    used: _Ints,
) -> int:
    """Write the elements of a row of A that are not 0 and their columns; their number."""
    for i in range(6):
        row[i], used[i] = ray.by_pose[axis, i], 6 * place + i
    count = 6
    for k in range(ray.by_camera.shape[1]):
        if column[camera, k] >= 0:
            row[count], used[count] = ray.by_camera[axis, k], 6 * n_images + column[camera, k]
            count += 1
    return count


@inner_kernel
def _coordinate_variance(
    ray: Ray,
    axis: int,
    count: int,
    row: _Floats,
    used: _Ints,
    local: _Floats,
    shared: _Floats,
    point: int,
    covariance: _Floats,
) -> float:
    """Variance of an adjusted image coordinate; shared: U C (3, 6 n + k), covariance: cov X."""
    variance = 0.0
    for i in range(count):
        across = 0.0
        for j in range(count):
            across += row[j] * local[used[i], used[j]]
        for j in range(3):
            across -= 2.0 * ray.by_ground[axis, j] * shared[j, used[i]]
        variance += row[i] * across
    for i in range(3):
        for j in range(3):
            scale = ray.by_ground[axis, i] * ray.by_ground[axis, j]
            variance += scale * covariance[point, i, j]
    return variance


@inner_kernel
def _propagate(
    lower: _Floats, rows: _Floats, local: _Floats, shared: _Floats, out: _Floats
) -> None:
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
    local: _Floats,
    ray: Ray,
    normals: _Floats,
    side: _Floats,
    rows: _Floats,
    shared: _Floats,
    used: _Ints,
    row: _Floats,
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
        for axis in range(2):
            out.redundancy[k, axis] = np.nan
        if not linearise(k, point, i, measured, ground.position_m, images, cameras, ray):
            continue
        for axis in range(2):
            if measured.weight[k] > 0.0:
                count = _by_unknowns(
                    ray, axis, place, n, images.camera[i], cameras.column, row, used
                )
                variance = _coordinate_variance(
                    ray, axis, count, row, used, local, shared, point, out.covariance_m2
                )
                out.redundancy[k, axis] = 1.0 - measured.weight[k] * variance


@kernel
def point_precision(
    first_group: int,
    last_group: int,
    network: Network,
    cofactors: Cofactors,
    out: PointPrecision,
) -> None:
    """Write the results of the points of groups first_group ... last_group - 1.

    Parameters are those of `bundle_normals.accumulate`, and `cofactors` of the solution, of
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
    used, row = np.empty(6 + n_common, dtype=np.intp), np.empty(6 + n_common)
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
                ray, normals, side, rows, shared, used, row, out,
            )  # fmt: skip
