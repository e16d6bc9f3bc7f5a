"""Normal equations of a bundle adjustment, reduced by the ground points; compiled.

With N, n and K of `point_normals` and N = L L', a point's part of the normal equations of all
other unknowns is

    sum w A'A - T'T,    sum w A'v - T't        T = L^-1 K,  t = L^-1 n

(Schur's complement; Brown's reduced normal equations). One pass over the rays makes derivatives
and sums: nothing of the size of the number of rays is stored.
"""

from typing import NamedTuple

import numpy as np

from posstats.arrays import Bools, Floats, Ints
from posstats.numerics.bundle.point_groups import PointGroups
from posstats.numerics.bundle.point_normals import (
    Ground,
    Measured,
    Network,
    add_control,
    add_to_point,
    factorise_point,
    linearise,
    solve_lower,
)
from posstats.numerics.bundle.rays import Cameras, Images, Ray, new_ray
from posstats.numerics.kernels.algebra import add_products
from posstats.numerics.kernels.compiled import inner_kernel, kernel

_BATCH = 16  # points whose T are collected before they are multiplied


class Reduced(NamedTuple):
    """Reduced normal equations of n images and k camera unknowns, added to by the kernel.

    Attributes
    ----------
    blocks
        (P, 6, 6) of the pairs of images; upper triangles of an image with itself.
    border
        (n, 6, k).
    corner
        (k, k), upper triangle.
    images, common
        (n, 6), (k,): gradient J'Wv.
    """

    blocks: Floats
    border: Floats
    corner: Floats
    images: Floats
    common: Floats


@inner_kernel
def _add_direct(
    ray: Ray,
    weight: float,
    place: int,
    n_images: int,
    camera: int,
    column: Ints,
    rows: Floats,
    local: Floats,
) -> float:
    """Add w A'A and w A'v of a ray to a group's matrix (upper triangle); w v'v is returned.

    `rows` is what `add_to_point` wrote: A'A = [d]x' [Q [d]x, -Q] in the rotation's rows.
    """
    v, b, d, at, last = ray.residual, ray.by_ground, ray.offset, 6 * place, local.shape[0] - 1
    for j in range(6):
        x, y, z = rows[0, at + j], rows[1, at + j], rows[2, at + j]
        local[at, at + j] += y * d[2] - z * d[1]
        if j > 0:
            local[at + 1, at + j] += z * d[0] - x * d[2]
        if j > 1:
            local[at + 2, at + j] += x * d[1] - y * d[0]
        for i in range(3, j + 1):
            local[at + i, at + j] -= rows[i - 3, at + j]
    v0, v1 = weight * v[0], weight * v[1]
    _add_turned(v0 * b[0, 0] + v1 * b[1, 0], v0 * b[0, 1] + v1 * b[1, 1],
                v0 * b[0, 2] + v1 * b[1, 2], d, at, last, local)  # fmt: skip
    for k in range(ray.by_camera.shape[1]):
        if column[camera, k] >= 0:
            row = 6 * n_images + column[camera, k]
            c0, c1 = weight * ray.by_camera[0, k], weight * ray.by_camera[1, k]
            _add_turned(c0 * b[0, 0] + c1 * b[1, 0], c0 * b[0, 1] + c1 * b[1, 1],
                        c0 * b[0, 2] + c1 * b[1, 2], d, at, row, local)  # fmt: skip
            local[row, last] += c0 * v[0] + c1 * v[1]
            for j in range(ray.by_camera.shape[1]):
                if column[camera, j] >= column[camera, k]:
                    other = 6 * n_images + column[camera, j]
                    local[row, other] += c0 * ray.by_camera[0, j] + c1 * ray.by_camera[1, j]
    return float(v0 * v[0] + v1 * v[1])


@inner_kernel
def _add_turned(
    x: float, y: float, z: float, d: Floats, row: int, column: int, local: Floats
) -> None:
    """Add [[d]x, -1]' (x, y, z) to six rows of a column."""
    local[row, column] += y * d[2] - z * d[1]
    local[row + 1, column] += z * d[0] - x * d[2]
    local[row + 2, column] += x * d[1] - y * d[0]
    local[row + 3, column] -= x
    local[row + 4, column] -= y
    local[row + 5, column] -= z


@inner_kernel
def _add_point(
    point: int,
    groups: PointGroups,
    measured: Measured,
    ground: Ground,
    images: Images,
    cameras: Cameras,
    damping: float,
    ray: Ray,
    normals: Floats,
    side: Floats,
    rows: Floats,
    local: Floats,
) -> tuple[bool, float, float]:
    """Add a point to its group's matrix, all but T'T; write [T t] to rows (3, width).

    Returns whether it is determined, and its weighted square sums of image and control.
    """
    first, n = groups.first_ray[point], groups.first_ray[point + 1] - groups.first_ray[point]
    normals[:], side[:], rows[:] = 0.0, 0.0, 0.0
    column, square_sum = cameras.column, 0.0
    for place in range(n):
        k, i = first + place, groups.ray_image[first + place]
        weight, camera = measured.weight[k], images.camera[i]
        if weight == 0.0:
            continue
        if not linearise(k, point, i, measured, ground.position_m, images, cameras, ray):
            return False, np.inf, 0.0
        add_to_point(ray, weight, place, n, camera, column, normals, side, rows)
        square_sum += _add_direct(ray, weight, place, n, camera, column, rows, local)
    control = add_control(point, ground, normals, side)
    if normals[0, 0] == 0.0:  # all of its rays are taken out
        return True, 0.0, 0.0
    for i in range(3):
        normals[i, i] *= 1.0 + damping
        rows[i, rows.shape[1] - 1] = side[i]
    determined = factorise_point(normals)
    if determined:
        solve_lower(normals, rows)
    return determined, square_sum, control


@inner_kernel
def _scatter(local: Floats, members: Ints, pairs: Ints, n_common: int, out: Reduced) -> None:
    """Add a group's matrix (upper triangle) to the block's."""
    n, last, at = len(members), local.shape[0] - 1, 0
    for i in range(n):
        for j in range(i, n):
            block = out.blocks[pairs[at]]
            at += 1
            for a in range(6):
                for b in range(a if i == j else 0, 6):
                    block[a, b] += local[6 * i + a, 6 * j + b]
        for a in range(6):
            out.images[members[i], a] += local[6 * i + a, last]
            for b in range(n_common):
                out.border[members[i], a, b] += local[6 * i + a, 6 * n + b]
    for a in range(n_common):
        out.common[a] += local[6 * n + a, last]
        for b in range(a, n_common):
            out.corner[a, b] += local[6 * n + a, 6 * n + b]


@kernel
def accumulate(
    first_group: int,
    last_group: int,
    network: Network,
    damping: float,
    determined: Bools,
    out: Reduced,
) -> tuple[float, float, float]:
    """Add the points of groups first_group ... last_group - 1 to the reduced normal equations.

    Parameters
    ----------
    network
        All rays and points; `cameras.column` counts the columns of `out.border`.
    damping
        Levenberg's, relative to the diagonal of every point's N.
    determined
        (p,) written: whether N is regular. Where it is not, the sums are of no use.
    out
        Added to.

    Returns
    -------
    Weighted square sums v'Wv of image coordinates and of control, and n'N^-1 n of the points:
    what their steps alone would take away. Infinite where a point is behind a camera.
    """
    groups, measured, ground, images, cameras = network
    n_common = out.common.shape[0]
    most = 0
    for group in range(first_group, last_group):
        point = groups.offsets[group]
        most = max(most, groups.first_ray[point + 1] - groups.first_ray[point])
    widest = 6 * most + n_common + 6
    local_store, rows_store = np.empty(widest**2), np.empty(3 * _BATCH * widest)
    ray, normals, side = new_ray(n_common), np.empty((3, 3)), np.empty(3)
    image_sum = control_sum = gain = 0.0
    for group in range(first_group, last_group):
        point = groups.offsets[group]
        first, n = groups.first_ray[point], groups.first_ray[point + 1] - groups.first_ray[point]
        width = 6 * ((6 * n + n_common) // 6 + 1)
        local = local_store[: width * width].reshape(width, width)
        rows = rows_store[: 3 * _BATCH * width].reshape(3 * _BATCH, width)
        local[:] = 0.0
        filled = 0
        for each in range(point, groups.offsets[group + 1]):
            determined[each], image_part, control_part = _add_point(
                each, groups, measured, ground, images, cameras, damping,
                ray, normals, side, rows[filled : filled + 3], local,
            )  # fmt: skip
            image_sum += image_part
            control_sum += control_part
            filled += 3
            if filled == len(rows) or each + 1 == groups.offsets[group + 1]:
                for i in range(filled):
                    gain += rows[i, width - 1] ** 2
                add_products(rows, filled, width, local, -1.0)
                filled = 0
        pairs = groups.pair[groups.pair_offsets[group] : groups.pair_offsets[group + 1]]
        _scatter(local, groups.ray_image[first : first + n], pairs, n_common, out)
    return image_sum, control_sum, gain
