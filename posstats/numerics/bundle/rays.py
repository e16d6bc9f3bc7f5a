"""Image coordinates of ground points with the camera's additional parameters; compiled.

With u = R^T (X - S), a = -ux / uz and b = -uy / uz the ideal image point is c (a, b). Measured is

    x = c (a g - 2 p1 a b + p2 (3 a^2 + b^2)) + xi (s1 (rho^2 - r0^2) - s3) + x0
    y = c (b g - p1 (a^2 + 3 b^2) + 2 p2 a b) + eta (s1 (rho^2 - r0^2) + s3) + s2 xi + y0,

g = 1 + k1 r^2 + k2 r^4 + k3 r^6, r^2 = a^2 + b^2, (xi, eta) = c (a, b), rho its length in mm:
Brown's model as in `posstats.block.camera.Distortion` (y up here) and Bauer's, equation 6 of the
second source paper, both added to the ideal point of equation 1. c = principal distance +
camera_c.

A rotation vector w turns an image in the ground frame, R <- exp([w]x) R; per image three of its
components come first, then three of the projection centre.
"""

from typing import NamedTuple

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.numerics.kernels.algebra import cross
from posstats.numerics.kernels.compiled import inner_kernel, kernel

CAMERA_PARAMETERS = (
    "camera_c", "camera_x0", "camera_y0",
    "bauer_s1", "bauer_s2", "bauer_s3",
    "brown_k1", "brown_k2", "brown_k3", "brown_p1", "brown_p2",
)  # fmt: skip
"""px, px, px, 1/mm2, 1, 1, then 1: the columns of `Cameras.value`; measured minus stated."""


class Images(NamedTuple):
    """n images.

    Attributes
    ----------
    ground_from_image
        (n, 3, 3).
    position_m
        (n, 3).
    camera
        (n,) index.
    """

    ground_from_image: Floats
    position_m: Floats
    camera: Ints


class Cameras(NamedTuple):
    """c cameras.

    Attributes
    ----------
    distance_px
        (c,) stated principal distance.
    mm_per_px
        (c,) pixel size.
    radius_mm
        Bauer's r0.
    value
        (c, 11) `CAMERA_PARAMETERS`.
    column
        (c, 11) among which unknowns of the adjustment they are; -1: no unknown.
    """

    distance_px: Floats
    mm_per_px: Floats
    radius_mm: float
    value: Floats
    column: Ints


class Ray(NamedTuple):
    """Room for one ray.

    Derivatives by the image's unknowns follow from those by the point, b: they are b x d by the
    rotation vector and -b by the projection centre.

    Attributes
    ----------
    residual
        (2,) px.
    offset
        (3,) d = X - S, m.
    by_ground
        (2, 3) px/m.
    by_camera
        (2, 11) px by `CAMERA_PARAMETERS`, or (2, 0): not wanted.
    """

    residual: Floats
    offset: Floats
    by_ground: Floats
    by_camera: Floats


@inner_kernel
def new_ray(n_common: int) -> Ray:
    """Room for one ray; derivatives by the camera are wanted if there are common unknowns."""
    n_camera = 11 if n_common > 0 else 0
    return Ray(np.empty(2), np.empty(3), np.empty((2, 3)), np.empty((2, n_camera)))


# Elements are addressed one by one below: a view of an array costs more than its numbers.


@inner_kernel
def observe(
    ground_m: Floats, point: int, image: int, images: Images, cameras: Cameras, out: Ray
) -> bool:
    """Write a ray's image point (as residual) and derivatives.

    False, and nothing is written, if the point is behind the camera.
    """
    r, s, camera = images.ground_from_image, images.position_m, images.camera[image]
    dx = ground_m[point, 0] - s[image, 0]
    dy = ground_m[point, 1] - s[image, 1]
    dz = ground_m[point, 2] - s[image, 2]
    uz = r[image, 0, 2] * dx + r[image, 1, 2] * dy + r[image, 2, 2] * dz
    if not uz < 0.0:
        return False
    a = -(r[image, 0, 0] * dx + r[image, 1, 0] * dy + r[image, 2, 0] * dz) / uz
    b = -(r[image, 0, 1] * dx + r[image, 1, 1] * dy + r[image, 2, 1] * dz) / uz
    x, y, xa, xb, ya, yb = _deformed(a, b, camera, cameras)
    out.residual[0], out.residual[1] = x, y
    out.offset[0], out.offset[1], out.offset[2] = dx, dy, dz
    xz, yz = xa * a + xb * b, ya * a + yb * b
    for j in range(3):
        first, second, third = r[image, j, 0], r[image, j, 1], r[image, j, 2]
        out.by_ground[0, j] = -(xa * first + xb * second + xz * third) / uz
        out.by_ground[1, j] = -(ya * first + yb * second + yz * third) / uz
    if out.by_camera.shape[1] > 0:
        _derive_camera(a, b, camera, cameras, out)
    return True


@inner_kernel
def _deformed(
    a: float, b: float, camera: int, cameras: Cameras
) -> tuple[float, float, float, float, float, float]:
    """The image point x, y and its derivatives: x by a, x by b, y by a, y by b."""
    v = cameras.value
    c = cameras.distance_px[camera] + v[camera, 0]
    s1, s2, s3 = v[camera, 3], v[camera, 4], v[camera, 5]
    k1, k2, k3 = v[camera, 6], v[camera, 7], v[camera, 8]
    p1, p2 = v[camera, 9], v[camera, 10]
    r2 = a * a + b * b
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    growth = 2.0 * (k1 + r2 * (2.0 * k2 + 3.0 * k3 * r2))
    bent = s1 * (cameras.mm_per_px[camera] * c) ** 2
    ring = bent * r2 - s1 * cameras.radius_mm**2
    mixed = (growth + 2.0 * bent) * a * b - 2.0 * p1 * a + 2.0 * p2 * b
    x = a * (radial + ring - s3) - 2.0 * p1 * a * b + p2 * (3.0 * a * a + b * b)
    y = b * (radial + ring + s3) - p1 * (a * a + 3.0 * b * b) + 2.0 * p2 * a * b + s2 * a
    xa = radial + ring - s3 + (growth + 2.0 * bent) * a * a - 2.0 * p1 * b + 6.0 * p2 * a
    yb = radial + ring + s3 + (growth + 2.0 * bent) * b * b - 6.0 * p1 * b + 2.0 * p2 * a
    return (
        c * x + v[camera, 1], c * y + v[camera, 2],
        c * xa, c * mixed, c * (mixed + s2), c * yb,
    )  # fmt: skip


@inner_kernel
def _derive_camera(a: float, b: float, camera: int, cameras: Cameras, out: Ray) -> None:
    """Write the derivatives by `CAMERA_PARAMETERS`."""
    x, y, _, _, _, _ = _deformed(a, b, camera, cameras)
    v = cameras.value
    c = cameras.distance_px[camera] + v[camera, 0]
    r2 = a * a + b * b
    length = (cameras.mm_per_px[camera] * c) ** 2 * r2
    by_c = 2.0 * v[camera, 3] * length  # Bauer's rings grow with the image
    ring = c * (length - cameras.radius_mm**2)
    _write(out, 0, (x - v[camera, 1]) / c + a * by_c, (y - v[camera, 2]) / c + b * by_c)
    _write(out, 1, 1.0, 0.0)
    _write(out, 2, 0.0, 1.0)
    _write(out, 3, a * ring, b * ring)
    _write(out, 4, 0.0, c * a)
    _write(out, 5, -c * a, c * b)
    _write(out, 6, c * a * r2, c * b * r2)
    _write(out, 7, c * a * r2**2, c * b * r2**2)
    _write(out, 8, c * a * r2**3, c * b * r2**3)
    _write(out, 9, -2.0 * c * a * b, -c * (a * a + 3.0 * b * b))
    _write(out, 10, c * (3.0 * a * a + b * b), 2.0 * c * a * b)


@inner_kernel
def _write(out: Ray, parameter: int, x: float, y: float) -> None:
    out.by_camera[0, parameter], out.by_camera[1, parameter] = x, y


@kernel
def project_rays(
    ground_m: Floats, point: Ints, image: Ints, images: Images, cameras: Cameras
) -> tuple[Floats, Floats, Floats, Floats]:
    """Image coordinates of rays and all their derivatives, NaN where behind the camera.

    Parameters
    ----------
    ground_m
        (p, 3) ground points.
    point, image
        (m,) which point is projected into which image.
    images, cameras
        See there.

    Returns
    -------
    xy
        (m, 2) px.
    by_pose
        (m, 2, 6) px/rad by the rotation vector, px/m by the projection centre.
    by_ground
        (m, 2, 3) px/m.
    by_camera
        (m, 2, 11) px by `CAMERA_PARAMETERS`.
    """
    m, offset = len(point), np.empty(3)
    xy, by_pose = np.full((m, 2), np.nan), np.full((m, 2, 6), np.nan)
    by_ground, by_camera = np.full((m, 2, 3), np.nan), np.full((m, 2, 11), np.nan)
    for k in range(m):
        row = Ray(xy[k], offset, by_ground[k], by_camera[k])
        if observe(ground_m, point[k], image[k], images, cameras, row):
            for axis in range(2):
                by_pose[k, axis, :3] = cross(by_ground[k, axis], offset)
                by_pose[k, axis, 3:] = -by_ground[k, axis]
    return xy, by_pose, by_ground, by_camera
