"""Image coordinates of ground points with the camera's additional parameters; compiled.

With u = R^T (X - S), a = -ux / uz and b = -uy / uz the ideal image point is c (a, b). Measured is

    x = c (a g - 2 p1 a b + p2 (3 a^2 + b^2)) + xi (s1 (rho^2 - r0^2) - s3) + x0
    y = c (b g - p1 (a^2 + 3 b^2) + 2 p2 a b) + eta (s1 (rho^2 - r0^2) + s3) + s2 xi + y0,

g = 1 + k1 r^2 + k2 r^4 + k3 r^6, r^2 = a^2 + b^2, (xi, eta) = c (a, b), rho its length in mm:
Brown's model as in `camera.Distortion` (y up here) and Bauer's, equation 6 of the second source
paper, both added to the ideal point of equation 1. c = principal distance + camera_c.

A rotation vector w turns an image in the ground frame, R <- exp([w]x) R; per image three of its
components come first, then three of the projection centre.
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from posstats.compiled import inner_kernel, kernel
from posstats.kernel_algebra import cross

_Floats = NDArray[np.float64]
_Ints = NDArray[np.intp]

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

    ground_from_image: _Floats
    position_m: _Floats
    camera: _Ints


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

    distance_px: _Floats
    mm_per_px: _Floats
    radius_mm: float
    value: _Floats
    column: _Ints


@inner_kernel
def observe(
    ground: _Floats,
    image: int,
    images: Images,
    cameras: Cameras,
    xy: _Floats,
    by_pose: _Floats,
    by_ground: _Floats,
    by_camera: _Floats,
) -> bool:
    """Write the image point (2,) and its derivatives (2, 6), (2, 3), (2, 11).

    False, and nothing is written, if the point is behind the camera.
    """
    r, centre, camera = (
        images.ground_from_image[image],
        images.position_m[image],
        images.camera[image],
    )
    d = (ground[0] - centre[0], ground[1] - centre[1], ground[2] - centre[2])
    uz = r[0, 2] * d[0] + r[1, 2] * d[1] + r[2, 2] * d[2]
    if not uz < 0.0:
        return False
    a = -(r[0, 0] * d[0] + r[1, 0] * d[1] + r[2, 0] * d[2]) / uz
    b = -(r[0, 1] * d[0] + r[1, 1] * d[1] + r[2, 1] * d[2]) / uz
    gradient = _deformed(a, b, camera, cameras, xy, by_camera)
    for axis in range(2):
        ga, gb = gradient[axis]
        for j in range(3):
            by_ground[axis, j] = -(ga * r[j, 0] + gb * r[j, 1] + (ga * a + gb * b) * r[j, 2]) / uz
        turned = cross(by_ground[axis], d)
        for j in range(3):
            by_pose[axis, j] = turned[j]
            by_pose[axis, 3 + j] = -by_ground[axis, j]
    return True


@inner_kernel
def _deformed(
    a: float, b: float, camera: int, cameras: Cameras, xy: _Floats, by_camera: _Floats
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Write the image point and its derivatives by the camera; those of x and y by (a, b)."""
    dc, x0, y0, s1, s2, s3, k1, k2, k3, p1, p2 = cameras.value[camera]
    c, mm = cameras.distance_px[camera] + dc, cameras.mm_per_px[camera]
    r2 = a * a + b * b
    radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3))
    growth = 2.0 * (k1 + r2 * (2.0 * k2 + 3.0 * k3 * r2))
    u = a * radial - 2.0 * p1 * a * b + p2 * (3.0 * a * a + b * b)
    v = b * radial - p1 * (a * a + 3.0 * b * b) + 2.0 * p2 * a * b
    mixed = growth * a * b - 2.0 * p1 * a + 2.0 * p2 * b
    ua = radial + growth * a * a - 2.0 * p1 * b + 6.0 * p2 * a
    vb = radial + growth * b * b - 6.0 * p1 * b + 2.0 * p2 * a

    # The scale-free Bauer terms: lengths in principal distances, s1 in their inverse squares.
    t1 = s1 * (mm * c) ** 2
    ring = t1 * r2 - s1 * cameras.radius_mm**2
    ua += ring - s3 + 2.0 * t1 * a * a
    vb += ring + s3 + 2.0 * t1 * b * b
    across = mixed + 2.0 * t1 * a * b
    xy[0] = c * (u + a * (ring - s3)) + x0
    xy[1] = c * (v + b * (ring + s3) + s2 * a) + y0

    ring_by_s1 = (mm * c) ** 2 * r2 - cameras.radius_mm**2
    _write(by_camera, 0, u + a * (3.0 * t1 * r2 - s1 * cameras.radius_mm**2 - s3),
           v + b * (3.0 * t1 * r2 - s1 * cameras.radius_mm**2 + s3) + s2 * a)  # fmt: skip
    _write(by_camera, 1, 1.0, 0.0)
    _write(by_camera, 2, 0.0, 1.0)
    _write(by_camera, 3, c * a * ring_by_s1, c * b * ring_by_s1)
    _write(by_camera, 4, 0.0, c * a)
    _write(by_camera, 5, -c * a, c * b)
    _write(by_camera, 6, c * a * r2, c * b * r2)
    _write(by_camera, 7, c * a * r2**2, c * b * r2**2)
    _write(by_camera, 8, c * a * r2**3, c * b * r2**3)
    _write(by_camera, 9, -2.0 * c * a * b, -c * (a * a + 3.0 * b * b))
    _write(by_camera, 10, c * (3.0 * a * a + b * b), 2.0 * c * a * b)
    return (c * ua, c * across), (c * (across + s2), c * vb)


@inner_kernel
def _write(by_camera: _Floats, parameter: int, x: float, y: float) -> None:
    by_camera[0, parameter], by_camera[1, parameter] = x, y


@kernel
def project_rays(
    ground_m: _Floats, point: _Ints, image: _Ints, images: Images, cameras: Cameras
) -> tuple[_Floats, _Floats, _Floats, _Floats]:
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
    m = len(point)
    xy, by_pose = np.full((m, 2), np.nan), np.full((m, 2, 6), np.nan)
    by_ground, by_camera = np.full((m, 2, 3), np.nan), np.full((m, 2, 11), np.nan)
    for k in range(m):
        observe(
            ground_m[point[k]], image[k], images, cameras,
            xy[k], by_pose[k], by_ground[k], by_camera[k],
        )  # fmt: skip
    return xy, by_pose, by_ground, by_camera
