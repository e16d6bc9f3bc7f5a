"""The normal equations of one ground point of a bundle adjustment; compiled.

A ray of weight w has the residual v = computed - measured and the derivatives A by the unknowns
of its image and the camera, B by its point. The sums over the rays of one point are

    N = sum w B'B + P,    n = sum w B'v + P (X - X0),    K = sum w B'A     (P, X0: its control).
"""

from typing import NamedTuple

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.numerics.bundle.point_groups import PointGroups
from posstats.numerics.bundle.rays import Cameras, Images, Ray, observe
from posstats.numerics.kernels.compiled import inner_kernel

# Smallest pivot, of a point's normal equations scaled to a unit diagonal, that determines it.
_SINGULAR_PIVOT = 1e-12


class Measured(NamedTuple):
    """m rays in the order of the groups.

    Attributes
    ----------
    xy_px
        (m, 2).
    weight
        (m,) 1/px2; 0 takes a ray out.
    """

    xy_px: Floats
    weight: Floats


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

    position_m: Floats
    control: Ints
    control_m: Floats
    weight: Floats


class Network(NamedTuple):
    """Rays, points, images and cameras at one state of the unknowns."""

    groups: PointGroups
    measured: Measured
    ground: Ground
    images: Images
    cameras: Cameras


@inner_kernel
def linearise(
    ray: int,
    point: int,
    image: int,
    measured: Measured,
    position_m: Floats,
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


@inner_kernel
def add_to_point(
    ray: Ray,
    weight: float,
    place: int,
    n_images: int,
    camera: int,
    column: Ints,
    normals: Floats,
    side: Floats,
    rows: Floats,
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


@inner_kernel
def add_control(point: int, ground: Ground, normals: Floats, side: Floats) -> float:
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


@inner_kernel
def factorise_point(normals: Floats) -> bool:
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


@inner_kernel
def solve_lower(lower: Floats, rows: Floats) -> None:
    """L^-1 rows (3, k), in place."""
    for j in range(rows.shape[1]):
        x = rows[0, j] / lower[0, 0]
        y = (rows[1, j] - lower[1, 0] * x) / lower[1, 1]
        rows[0, j], rows[1, j] = x, y
        rows[2, j] = (rows[2, j] - lower[2, 0] * x - lower[2, 1] * y) / lower[2, 2]


@inner_kernel
def solve_upper(lower: Floats, rows: Floats) -> None:
    """L'^-1 rows (3, k), in place."""
    for j in range(rows.shape[1]):
        z = rows[2, j] / lower[2, 2]
        y = (rows[1, j] - lower[2, 1] * z) / lower[1, 1]
        rows[2, j], rows[1, j] = z, y
        rows[0, j] = (rows[0, j] - lower[1, 0] * y - lower[2, 0] * z) / lower[0, 0]


@inner_kernel
def normals_of_point(
    point: int,
    groups: PointGroups,
    measured: Measured,
    ground: Ground,
    images: Images,
    cameras: Cameras,
    ray: Ray,
    normals: Floats,
    side: Floats,
    rows: Floats,
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
