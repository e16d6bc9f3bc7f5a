"""Normal equations of a bundle adjustment, reduced by the ground points; compiled.

A ray of weight w has the residual v = computed - measured and the derivatives A by the unknowns
of its image and the camera, B by its point. With the sums over the rays of one point

    N = sum w B'B + P,    n = sum w B'v + P (X - X0),    K = sum w B'A     (P, X0: its control)

and N = L L', the point's part of the normal equations of all other unknowns is

    sum w A'A - T'T,    sum w A'v - T't        T = L^-1 K,  t = L^-1 n,

and its own step is -N^-1 (n + K s) for a step s of the others (Schur's complement; Brown's
reduced normal equations). One pass over the rays makes derivatives and sums: nothing of the size
of the number of rays is stored.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from posstats.bundle_groups import PointGroups
from posstats.bundle_rays import Cameras, Images, Ray, new_ray, observe
from posstats.compiled import inlined_kernel, kernel
from posstats.kernel_algebra import add_products

_Floats = NDArray[np.float64]
_Ints = NDArray[np.intp]

# Smallest pivot, of a point's normal equations scaled to a unit diagonal, that determines it.
_SINGULAR_PIVOT = 1e-12
_INTERSECTION_STEPS = 3
_BATCH = 16  # points whose T are collected before they are multiplied


class Measured(NamedTuple):
    """m rays in the order of the groups.

    Attributes
    ----------
    xy_px
        (m, 2).
    weight
        (m,) 1/px2; 0 takes a ray out.
    """

    xy_px: _Floats
    weight: _Floats


class Ground(NamedTuple):
    """p points in the order of the groups; g of them are observed (control).

    Attributes
    ----------
    position_m
        (p, 3) where they are assumed.
    control
        (p,) index into the following, -1: none.
    control_m
        (g, 3).
    weight
        (g, 3, 3) 1/m2, inverse covariances.
    """

    position_m: _Floats
    control: _Ints
    control_m: _Floats
    weight: _Floats


class Network(NamedTuple):
    """Rays, points, images and cameras at one state of the unknowns."""

    groups: PointGroups
    measured: Measured
    ground: Ground
    images: Images
    cameras: Cameras


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

    blocks: _Floats
    border: _Floats
    corner: _Floats
    images: _Floats
    common: _Floats


@inlined_kernel
def linearise(
    ray: int,
    point: int,
    image: int,
    measured: Measured,
    position_m: _Floats,
    images: Images,
    cameras: Cameras,
    out: Ray,
) -> bool:
    """Write a ray's residual and derivatives; false if its point is behind the camera."""
    if not observe(position_m, point, image, images, cameras, out):
        return False
    out.residual[0] -= measured.xy_px[ray, 0]
    out.residual[1] -= measured.xy_px[ray, 1]
    return True


@inlined_kernel
def add_to_point(
    ray: Ray,
    weight: float,
    place: int,
    n_images: int,
    camera: int,
    column: _Ints,
    normals: _Floats,
    side: _Floats,
    rows: _Floats,
) -> None:
    """Add a ray to N and n, and write its part of K (3, 6 n_images + k).

    The ray is that of the point's image number `place`. With Q = w B'B and its offset d, its
    columns of K are [Q [d]x, -Q].
    """
    b, d, at = ray.by_ground, ray.offset, 6 * place
    for i in range(3):
        x, y = weight * b[0, i], weight * b[1, i]
        q0, q1, q2 = (
            x * b[0, 0] + y * b[1, 0], x * b[0, 1] + y * b[1, 1], x * b[0, 2] + y * b[1, 2]
        )  # fmt: skip
        side[i] += x * ray.residual[0] + y * ray.residual[1]
        normals[i, 0] += q0
        normals[i, 1] += q1
        normals[i, 2] += q2
        rows[i, at] = q1 * d[2] - q2 * d[1]
        rows[i, at + 1] = q2 * d[0] - q0 * d[2]
        rows[i, at + 2] = q0 * d[1] - q1 * d[0]
        rows[i, at + 3], rows[i, at + 4], rows[i, at + 5] = -q0, -q1, -q2
        for k in range(ray.by_camera.shape[1]):
            if column[camera, k] >= 0:
                common = 6 * n_images + column[camera, k]
                rows[i, common] += x * ray.by_camera[0, k] + y * ray.by_camera[1, k]


@inlined_kernel
def add_control(point: int, ground: Ground, normals: _Floats, side: _Floats) -> float:
    """Add a point's control to N and n; its weighted square sum is returned."""
    control, square_sum = ground.control[point], 0.0
    if control < 0:
        return 0.0
    for i in range(3):
        row = 0.0
        for j in range(3):
            weight = ground.weight[control, i, j]
            normals[i, j] += weight
            row += weight * (ground.position_m[point, j] - ground.control_m[control, j])
        side[i] += row
        square_sum += row * (ground.position_m[point, i] - ground.control_m[control, i])
    return square_sum


@inlined_kernel
def factorise_point(normals: _Floats) -> bool:
    """Lower Cholesky factor (3, 3) in place; false if the point is not determined."""
    a, b, c = normals[0, 0], normals[1, 1], normals[2, 2]
    if not (a > 0.0 and b > 0.0 and c > 0.0):
        return False
    normals[0, 0] = np.sqrt(a)
    normals[1, 0] /= normals[0, 0]
    normals[2, 0] /= normals[0, 0]
    second = b - normals[1, 0] ** 2
    if not second > _SINGULAR_PIVOT * b:
        return False
    normals[1, 1] = np.sqrt(second)
    normals[2, 1] = (normals[2, 1] - normals[2, 0] * normals[1, 0]) / normals[1, 1]
    third = c - normals[2, 0] ** 2 - normals[2, 1] ** 2
    if not third > _SINGULAR_PIVOT * c:
        return False
    normals[2, 2] = np.sqrt(third)
    return True


@inlined_kernel
def solve_lower(lower: _Floats, rows: _Floats) -> None:
    """L^-1 rows (3, k), in place."""
    for j in range(rows.shape[1]):
        x = rows[0, j] / lower[0, 0]
        y = (rows[1, j] - lower[1, 0] * x) / lower[1, 1]
        rows[0, j], rows[1, j] = x, y
        rows[2, j] = (rows[2, j] - lower[2, 0] * x - lower[2, 1] * y) / lower[2, 2]


@inlined_kernel
def solve_upper(lower: _Floats, rows: _Floats) -> None:
    """L'^-1 rows (3, k), in place."""
    for j in range(rows.shape[1]):
        z = rows[2, j] / lower[2, 2]
        y = (rows[1, j] - lower[2, 1] * z) / lower[1, 1]
        rows[2, j], rows[1, j] = z, y
        rows[0, j] = (rows[0, j] - lower[1, 0] * y - lower[2, 0] * z) / lower[0, 0]


@inlined_kernel
def _add_direct(
    ray: Ray,
    weight: float,
    place: int,
    n_images: int,
    camera: int,
    column: _Ints,
    rows: _Floats,
    local: _Floats,
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


@inlined_kernel
def _add_turned(
    x: float, y: float, z: float, d: _Floats, row: int, column: int, local: _Floats
) -> None:
    """Add [[d]x, -1]' (x, y, z) to six rows of a column."""
    local[row, column] += y * d[2] - z * d[1]
    local[row + 1, column] += z * d[0] - x * d[2]
    local[row + 2, column] += x * d[1] - y * d[0]
    local[row + 3, column] -= x
    local[row + 4, column] -= y
    local[row + 5, column] -= z


@inlined_kernel
def _add_point(
    point: int,
    groups: PointGroups,
    measured: Measured,
    ground: Ground,
    images: Images,
    cameras: Cameras,
    damping: float,
    ray: Ray,
    normals: _Floats,
    side: _Floats,
    rows: _Floats,
    local: _Floats,
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


@inlined_kernel
def _scatter(local: _Floats, members: _Ints, pairs: _Ints, n_common: int, out: Reduced) -> None:
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
    determined: NDArray[np.bool_],
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


@inlined_kernel
def normals_of_point(
    point: int,
    groups: PointGroups,
    measured: Measured,
    ground: Ground,
    images: Images,
    cameras: Cameras,
    ray: Ray,
    normals: _Floats,
    side: _Floats,
    rows: _Floats,
) -> None:
    """Write N, n and K (3, 6 n + k) of a point."""
    first, n = groups.first_ray[point], groups.first_ray[point + 1] - groups.first_ray[point]
    normals[:], side[:], rows[:] = 0.0, 0.0, 0.0
    for place in range(n):
        k, i = first + place, groups.ray_image[first + place]
        weight, camera = measured.weight[k], images.camera[i]
        if weight > 0.0 and linearise(
            k, point, i, measured, ground.position_m, images, cameras, ray
        ):
            add_to_point(ray, weight, place, n, camera, cameras.column, normals, side, rows)
    add_control(point, ground, normals, side)


@kernel
def move_points(
    first_group: int,
    last_group: int,
    network: Network,
    image_step: _Floats,
    common_step: _Floats,
    damping: float,
    new_position_m: _Floats,
) -> None:
    """Move the points of some groups as a step of the other unknowns asks for.

    Parameters are those of `accumulate`, and

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


@inlined_kernel
def _square_sum(
    point: int,
    groups: PointGroups,
    measured: Measured,
    ground: Ground,
    images: Images,
    cameras: Cameras,
    ray: Ray,
    normals: _Floats,
    side: _Floats,
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

    Parameters are those of `accumulate`; the ground positions are the start, and overwritten.
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
def ray_residuals(
    first_group: int, last_group: int, network: Network, residual_px: _Floats
) -> None:
    """Write the residuals (m, 2) of the rays of some groups, NaN behind a camera.

    Parameters are those of `accumulate`; a residual is computed minus measured.
    """
    groups, measured, ground, images, cameras = network
    ray = new_ray(0)
    for point in range(groups.offsets[first_group], groups.offsets[last_group]):
        for k in range(groups.first_ray[point], groups.first_ray[point + 1]):
            image = groups.ray_image[k]
            seen = linearise(k, point, image, measured, ground.position_m, images, cameras, ray)
            for axis in range(2):
                residual_px[k, axis] = ray.residual[axis] if seen else np.nan
