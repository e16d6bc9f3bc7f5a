"""What POS observes of the images: antenna positions and attitudes, with exact derivatives.

With R the rotation ground_from_image, S the projection centre and R_B the boresight rotation,

    X_A = S + R (u, v, w) + shift + drift (t - t0)              equations 3 and 7,
    angles(R R_B) + shift + drift (t - t0)                      equations 5 and 8

of the second source paper; R_B = Rx(pitch) Ry(roll) Rz(yaw). Rotation vectors are in the ground
frame, R <- exp([w]x) R.
"""

from dataclasses import dataclass

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.numerics.bundle.parameters import ParameterEffects
from posstats.numerics.kernels.rotation import (
    AngleSystem,
    angles_from_rotation,
    rotation_derivatives,
    rotation_from_angles,
    skew,
    wrapped,
)

_ROLL_PITCH_YAW = np.array([1, 0, 2])  # as phi, omega, kappa of Rx(omega) Ry(phi) Rz(kappa)


@dataclass(frozen=True, eq=False)
class PosObservations:
    """What POS measured of n images; an infinite standard deviation: not measured.

    Attributes
    ----------
    antenna_m, sigma_antenna_m
        (n, 3) antenna positions, ground frame.
    angles_rad, sigma_angles_rad
        (n, 3) omega, phi, kappa of the IMU.
    system
        Of the angles.
    """

    antenna_m: Floats
    sigma_antenna_m: Floats
    angles_rad: Floats
    sigma_angles_rad: Floats
    system: AngleSystem

    @property
    def weight(self) -> Floats:
        """(n, 6) of the antenna positions, then the angles."""
        return np.concatenate([self.sigma_antenna_m, self.sigma_angles_rad], axis=1) ** -2.0


@dataclass(frozen=True, eq=False)
class LinearisedPos:
    """Six observations of each of n images: antenna position, then angles.

    Attributes
    ----------
    residual
        (n, 6) computed minus measured.
    by_pose
        (n, 6, 6) by rotation vector and projection centre.
    by_common
        (n, 6, k) by the additional parameters.
    """

    residual: Floats
    by_pose: Floats
    by_common: Floats


def linearised_pos(
    observed: PosObservations,
    ground_from_image: Floats,
    position_m: Floats,
    effects: ParameterEffects,
    common: Floats,
) -> LinearisedPos:
    """Residuals and derivatives of the POS observations.

    Parameters
    ----------
    observed
        Of n images.
    ground_from_image, position_m
        (n, 3, 3), (n, 3).
    effects, common
        What the additional parameters (k,) act on, and their values.
    """
    antenna, antenna_by_pose, by_lever = antenna_positions(
        ground_from_image, position_m, _values(effects.lever_arm, common)
    )
    angles, angles_by_pose, by_boresight = imu_angles(
        ground_from_image, _values(effects.boresight, common), observed.system
    )
    position_residual = antenna + effects.gnss @ common - observed.antenna_m
    angle_residual = wrapped(angles + effects.imu @ common - observed.angles_rad)
    by_common = np.concatenate([effects.gnss, effects.imu], axis=1)
    for rows, index, by in ((slice(0, 3), effects.lever_arm, by_lever),
                            (slice(3, 6), effects.boresight, by_boresight)):  # fmt: skip
        unknown = index >= 0
        by_common[:, rows, index[unknown]] = by[:, :, unknown]
    return LinearisedPos(
        np.concatenate([position_residual, angle_residual], axis=1),
        np.concatenate([antenna_by_pose, angles_by_pose], axis=1),
        by_common,
    )


def _values(index: Ints, common: Floats) -> Floats:
    """(3,) values of parameters, 0 of those that are not unknown."""
    return np.where(index >= 0, np.append(common, 0.0)[index], 0.0)


def antenna_positions(
    ground_from_image: Floats, position_m: Floats, lever_arm_m: Floats
) -> tuple[Floats, Floats, Floats]:
    """Antenna positions (n, 3) and derivatives (n, 3, 6), (n, 3, 3) by pose and lever arm."""
    arm = ground_from_image @ lever_arm_m
    identity = np.broadcast_to(np.eye(3), (len(arm), 3, 3))
    return position_m + arm, np.concatenate([-skew(arm), identity], axis=2), ground_from_image


def imu_angles(
    ground_from_image: Floats, boresight_rad: Floats, system: AngleSystem
) -> tuple[Floats, Floats, Floats]:
    """Angles (n, 3) of R R_B and derivatives (n, 3, 6), (n, 3, 3) by pose and boresight.

    `boresight_rad` (3,) is roll, pitch, yaw.
    """
    about_axes = boresight_rad[_ROLL_PITCH_YAW]
    image_from_imu = rotation_from_angles(about_axes, "omega-phi-kappa")
    turns = _turns(rotation_derivatives(about_axes, "omega-phi-kappa"), image_from_imu)
    angles = angles_from_rotation(ground_from_image @ image_from_imu, system)
    by_vector = angles_by_rotation_vector(angles, system)
    by_boresight = (by_vector @ ground_from_image @ turns)[:, :, _ROLL_PITCH_YAW]
    return angles, np.concatenate([by_vector, np.zeros_like(by_vector)], axis=2), by_boresight


def angles_by_rotation_vector(angles_rad: Floats, system: AngleSystem) -> Floats:
    """Derivatives (n, 3, 3) of angles (n, 3) by a rotation vector in the ground frame."""
    rotation = rotation_from_angles(angles_rad, system)
    derivatives = rotation_derivatives(angles_rad, system)
    return np.asarray(np.linalg.inv(_turns(derivatives, rotation[..., None, :, :])), dtype=float)


def _turns(derivatives: Floats, rotation: Floats) -> Floats:
    """Rotation vectors (..., 3, 3), in columns, of the derivatives (..., 3, 3, 3) by angles."""
    generator = derivatives @ np.swapaxes(rotation, -1, -2)
    vectors = np.stack([generator[..., 2, 1], generator[..., 0, 2], generator[..., 1, 0]], axis=-1)
    return np.swapaxes(vectors, -1, -2)
