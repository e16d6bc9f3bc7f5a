"""Rotations: the angle systems of aerial photographs, their inverses and derivatives.

Frames: the ground frame is right-handed with Z up; the image frame has x right, y up and z
towards the sky. A rotation `ground_from_image` turns image vectors into ground vectors. Angle
triples are always ordered (omega, phi, kappa), in radians, whatever the system.
"""

from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from posstats.arrays import Floats

AngleSystem = Literal["omega-phi-kappa", "phi-omega-kappa"]
ANGLE_NAMES = ("omega", "phi", "kappa")
CAMERA_ANGLE_NAMES = ("pitch", "roll", "yaw")


def axis_rotation(axis: int, angle_rad: Floats) -> Floats:
    """Rotation (..., 3, 3) by `angle_rad` (...) about coordinate axis 0, 1 or 2, right-handed."""
    i, j = (axis + 1) % 3, (axis + 2) % 3
    cosine, sine = np.cos(angle_rad), np.sin(angle_rad)
    rotation = np.zeros((*np.shape(angle_rad), 3, 3))
    rotation[..., axis, axis] = 1.0
    rotation[..., i, i] = rotation[..., j, j] = cosine
    rotation[..., j, i] = sine
    rotation[..., i, j] = -sine
    return rotation


def _factors(angles_rad: Floats, system: AngleSystem) -> list[tuple[int, int, float, Floats]]:
    """Elementary rotations of a system, left to right: (angle index, axis, sign, matrix)."""
    if system == "omega-phi-kappa":
        order = [(0, 0, 1.0), (1, 1, 1.0), (2, 2, 1.0)]
    else:
        # The papers' phi turns clockwise about +Y (a3 = -sin phi cos omega).
        order = [(1, 1, -1.0), (0, 0, 1.0), (2, 2, 1.0)]
    return [
        (index, axis, sign, axis_rotation(axis, sign * angles_rad[..., index]))
        for index, axis, sign in order
    ]


def rotation_from_angles(angles_rad: ArrayLike, system: AngleSystem) -> Floats:
    """Rotation matrix ground_from_image of an angle triple.

    Parameters
    ----------
    angles_rad
        (..., 3) array of omega, phi, kappa in radians.
    system
        ``omega-phi-kappa``: Rx(omega) Ry(phi) Rz(kappa); ``phi-omega-kappa``:
        Ry(-phi) Rx(omega) Rz(kappa), equation (2) of the second source paper.

    Returns
    -------
    (..., 3, 3) array.
    """
    (_, _, _, first), (_, _, _, second), (_, _, _, third) = _factors(
        np.asarray(angles_rad, dtype=float), system
    )
    return first @ second @ third


def angles_from_rotation(ground_from_image: ArrayLike, system: AngleSystem) -> Floats:
    """Angle triples (..., 3) omega, phi, kappa in radians of rotation matrices (..., 3, 3).

    Inverse of `rotation_from_angles`; phi (omega for ``phi-omega-kappa``) is in [-pi/2, pi/2].
    """
    r = np.asarray(ground_from_image, dtype=float)
    if system == "omega-phi-kappa":
        omega = np.arctan2(-r[..., 1, 2], r[..., 2, 2])
        phi = np.arcsin(np.clip(r[..., 0, 2], -1.0, 1.0))
        kappa = np.arctan2(-r[..., 0, 1], r[..., 0, 0])
    else:
        omega = np.arcsin(np.clip(-r[..., 1, 2], -1.0, 1.0))
        phi = np.arctan2(-r[..., 0, 2], r[..., 2, 2])
        kappa = np.arctan2(r[..., 1, 0], r[..., 1, 1])
    return np.stack([omega, phi, kappa], axis=-1)


def rotation_derivatives(angles_rad: ArrayLike, system: AngleSystem) -> Floats:
    """Derivatives of the rotation matrix with respect to omega, phi and kappa.

    Returns
    -------
    (..., 3, 3, 3) array; the first of the three last axes counts omega, phi, kappa.
    """
    angles = np.asarray(angles_rad, dtype=float)
    factors = _factors(angles, system)
    derivatives = np.empty((*angles.shape[:-1], 3, 3, 3))
    for position, (index, axis, sign, _) in enumerate(factors):
        terms = [matrix for _, _, _, matrix in factors]
        terms[position] = sign * (_axis_generator(axis) @ terms[position])
        derivatives[..., index, :, :] = terms[0] @ terms[1] @ terms[2]
    return derivatives


def _axis_generator(axis: int) -> Floats:
    """d/da of the axis rotation at a = 0 (a skew matrix)."""
    return skew(np.eye(3)[axis])


def skew(vector: ArrayLike) -> Floats:
    """Cross-product matrix (..., 3, 3) of vectors (..., 3): skew(a) b = a x b."""
    v = np.asarray(vector, dtype=float)
    matrix = np.zeros((*v.shape, 3))
    matrix[..., 2, 1], matrix[..., 1, 2] = v[..., 0], -v[..., 0]
    matrix[..., 0, 2], matrix[..., 2, 0] = v[..., 1], -v[..., 1]
    matrix[..., 1, 0], matrix[..., 0, 1] = v[..., 2], -v[..., 2]
    return matrix


def rotation_from_vector(vector_rad: ArrayLike) -> Floats:
    """Rotation exp([e]x) (..., 3, 3) of rotation vectors e (..., 3) in radians (Rodrigues)."""
    e = np.asarray(vector_rad, dtype=float)
    angle = np.linalg.norm(e, axis=-1)[..., None, None]
    generator = skew(e)
    # sinc keeps full precision at angle 0: np.sinc(x) = sin(pi x) / (pi x)
    first = np.sinc(angle / np.pi)
    second = 0.5 * np.sinc(angle / (2.0 * np.pi)) ** 2
    rotation: Floats = np.eye(3) + first * generator + second * (generator @ generator)
    return rotation


def vector_from_rotation(rotation: ArrayLike) -> Floats:
    """Rotation vectors e (..., 3) in radians with exp([e]x) = rotation, |e| < pi."""
    r = np.asarray(rotation, dtype=float)
    axis = 0.5 * np.stack(
        [
            r[..., 2, 1] - r[..., 1, 2],
            r[..., 0, 2] - r[..., 2, 0],
            r[..., 1, 0] - r[..., 0, 1],
        ],
        axis=-1,
    )
    sine = np.linalg.norm(axis, axis=-1)
    cosine = 0.5 * (np.trace(r, axis1=-2, axis2=-1) - 1.0)
    angle = np.arctan2(sine, cosine)
    vector: Floats = axis / np.sinc(angle / np.pi)[..., None]
    return vector


def wrapped(angle_rad: ArrayLike) -> Floats:
    """Angles reduced to [-pi, pi)."""
    reduced: Floats = (np.asarray(angle_rad, dtype=float) + np.pi) % (2.0 * np.pi) - np.pi
    return reduced
