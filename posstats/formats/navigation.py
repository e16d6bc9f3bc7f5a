"""Navigation angles (roll, pitch, heading) of a POS and the rotation of the image.

Frames: the body has x forward, y right, z down; the local level frame is north, east, down
(NED). Heading counts clockwise from true north, pitch is positive nose up, roll positive right
wing down:

    enu_from_camera = enu_from_ned Rz(heading) Ry(pitch) Rx(roll) body_from_camera

In a map grid the azimuth of grid north (meridian convergence) is taken off the heading. The image
top points forward, or `mounting_rad` clockwise from forward, seen from above.
"""

import numpy as np
from numpy.typing import ArrayLike

from posstats.arrays import Floats
from posstats.numerics.kernels.rotation import axis_rotation

# North, east, down <-> east, north, up; also body <-> camera with the image top forward.
_SWAP = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])


def rotation_from_navigation(
    angles_rad: ArrayLike, convergence_rad: ArrayLike = 0.0, mounting_rad: float = 0.0
) -> Floats:
    """Rotation grid_from_image (n, 3, 3) of roll, pitch, heading.

    Parameters
    ----------
    angles_rad
        (n, 3) roll, pitch, heading, rad.
    convergence_rad
        (n,) azimuth of grid north, rad; 0 gives the rotation into true east, north, up.
    mounting_rad
        How far the image top is turned clockwise from forward.
    """
    angles = np.asarray(angles_rad, dtype=float)
    heading = angles[..., 2] - np.asarray(convergence_rad, dtype=float)
    ned_from_body = (
        axis_rotation(2, heading)
        @ axis_rotation(1, angles[..., 1])
        @ axis_rotation(0, angles[..., 0])
    )
    return _SWAP @ ned_from_body @ _body_from_camera(mounting_rad)


def navigation_from_rotation(
    grid_from_image: ArrayLike, convergence_rad: ArrayLike = 0.0, mounting_rad: float = 0.0
) -> Floats:
    """Roll, pitch, heading (n, 3), rad, of rotations (n, 3, 3); heading in [0, 2 pi).

    Inverse of `rotation_from_navigation`; pitch is in [-pi/2, pi/2].
    """
    rotation = np.asarray(grid_from_image, dtype=float)
    b = _SWAP @ rotation @ _body_from_camera(mounting_rad).T
    roll = np.arctan2(b[..., 2, 1], b[..., 2, 2])
    pitch = np.arcsin(np.clip(-b[..., 2, 0], -1.0, 1.0))
    heading = (np.arctan2(b[..., 1, 0], b[..., 0, 0]) + convergence_rad) % (2.0 * np.pi)
    return np.stack([roll, pitch, heading], axis=-1)


def navigation_rotation_vectors(angles_rad: ArrayLike, mounting_rad: float = 0.0) -> Floats:
    """Rotation vectors (n, 3, 3), camera axes, of unit changes of roll, pitch, heading (columns).

    A change d of the angles turns the camera by R exp([W d]x), W the returned matrix.
    """
    angles = np.asarray(angles_rad, dtype=float)
    body_from_level = np.swapaxes(
        axis_rotation(1, angles[..., 1]) @ axis_rotation(0, angles[..., 0]), -1, -2
    )
    vectors = np.zeros_like(body_from_level)
    vectors[..., 0, 0] = 1.0
    vectors[..., :, 1] = np.swapaxes(axis_rotation(0, angles[..., 0]), -1, -2)[..., :, 1]
    vectors[..., :, 2] = body_from_level[..., :, 2]
    in_camera: Floats = _body_from_camera(mounting_rad).T @ vectors
    return in_camera


def _body_from_camera(mounting_rad: float) -> Floats:
    rotation: Floats = axis_rotation(2, np.asarray(mounting_rad)) @ _SWAP
    return rotation
