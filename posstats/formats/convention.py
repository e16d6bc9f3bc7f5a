"""The convention of a block's orientation files, and the rotations of the computation.

What the files hold and what is computed with differ by the angle system and unit, the map grid
and the [pos] section:

* angles of the files refer to the local grid axes at the position of the file (for roll, pitch,
  heading: to true north); rotations of the computation turn into the computing frame;
* boresight: the angles of orientations.csv are those of the IMU, R_IMU = R R_B, with R the
  camera's rotation and R_B = Rx(pitch) Ry(roll) Rz(yaw) about the camera's axes (image x, image y,
  towards the sky). So R = R_IMU R_B^T;
* lever arm: the positions of orientations.csv are those of a point offset by the lever arm, in
  camera axes, from the projection centre: X = X_S + R lever. So X_S = X - R lever.
"""

from dataclasses import dataclass

import numpy as np

from posstats.arrays import Floats
from posstats.block.frames import GroundFrame
from posstats.formats.block_toml import RADIANS_PER_UNIT, BlockSettings, FileAngleSystem
from posstats.formats.navigation import (
    navigation_from_rotation,
    navigation_rotation_vectors,
    rotation_from_navigation,
)
from posstats.numerics.kernels.rotation import (
    AngleSystem,
    angles_from_rotation,
    axis_rotation,
    rotation_derivatives,
    rotation_from_angles,
)


@dataclass(frozen=True)
class Convention:
    """How the orientations of a file become rotations of the computing frame, and back.

    Attributes
    ----------
    angles
        Angle system of the files.
    unit_rad
        Radians per unit of the files' angles.
    frame
        The block's ground frame.
    mounting_rad
        How far the image top is turned clockwise from forward (roll-pitch-heading only).
    boresight_rad
        Roll, pitch, yaw of the IMU against the camera; zero for adjusted orientations.
    lever_arm_m
        From the projection centre to the point x, y, z, camera axes; zero for adjusted ones.
    """

    angles: FileAngleSystem
    unit_rad: float
    frame: GroundFrame
    mounting_rad: float = 0.0
    boresight_rad: tuple[float, float, float] = (0.0, 0.0, 0.0)
    lever_arm_m: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @classmethod
    def of_pos(cls, settings: BlockSettings, frame: GroundFrame) -> "Convention":
        """The convention of orientations.csv."""
        return cls(
            settings.angles,
            RADIANS_PER_UNIT[settings.angle_unit],
            frame,
            settings.mounting_rad,
            settings.boresight_rad,
            settings.lever_arm_m,
        )

    @classmethod
    def of_adjusted(cls, settings: BlockSettings, frame: GroundFrame) -> "Convention":
        """The convention of adjusted.csv: orientations of the camera itself."""
        unit = RADIANS_PER_UNIT[settings.angle_unit]
        return cls(settings.angles, unit, frame, settings.mounting_rad)

    @property
    def system(self) -> AngleSystem:
        """Angle system of the computation."""
        return "phi-omega-kappa" if self.angles == "phi-omega-kappa" else "omega-phi-kappa"

    def ground_from_image(self, position_crs: Floats, file_angles: Floats) -> Floats:
        """Camera rotations (n, 3, 3) into the computing frame.

        Parameters
        ----------
        position_crs
            (n, 3) x, y, z of the file.
        file_angles
            (n, 3) angles of the file, in its unit and order.
        """
        angles = file_angles * self.unit_rad
        if self.angles == "roll-pitch-heading":
            convergence = self.frame.convergence_rad(position_crs)
            grid = rotation_from_navigation(angles, convergence, self.mounting_rad)
        else:
            grid = rotation_from_angles(angles, self.angles)
        return self.frame.computing_from_crs_axes(position_crs) @ grid @ self._imu_from_camera.T

    def computing_angles(self, ground_from_image: Floats) -> Floats:
        """Angles (n, 3), rad, of the computation's system."""
        return angles_from_rotation(ground_from_image, self.system)

    def file_angles(self, position_crs: Floats, ground_from_image: Floats) -> Floats:
        """Angles (n, 3) of the file, in its unit, of camera rotations; inverse of the above."""
        axes = self.frame.computing_from_crs_axes(position_crs)
        grid = np.swapaxes(axes, -1, -2) @ ground_from_image @ self._imu_from_camera
        if self.angles == "roll-pitch-heading":
            convergence = self.frame.convergence_rad(position_crs)
            angles = navigation_from_rotation(grid, convergence, self.mounting_rad)
        else:
            angles = angles_from_rotation(grid, self.angles)
        return angles / self.unit_rad

    def projection_centre(self, position_crs: Floats, ground_from_image: Floats) -> Floats:
        """Projection centres (n, 3) in the computing frame: X_S = X - R lever."""
        offset = ground_from_image @ np.array(self.lever_arm_m)
        centre: Floats = self.frame.to_computing(position_crs) - offset
        return centre

    def sigma_angles_rad(self, file_sigmas: Floats, file_angles: Floats) -> Floats:
        """Standard deviations (n, 3) of omega, phi, kappa from those of the file's angles.

        Those of roll, pitch, heading are propagated as uncorrelated; omega, phi, kappa keep
        theirs (boresight and frame turn them by less than a standard deviation is known).
        """
        sigmas = file_sigmas * self.unit_rad
        if self.angles != "roll-pitch-heading":
            return sigmas
        angles = file_angles * self.unit_rad
        rotation = rotation_from_navigation(angles, 0.0, self.mounting_rad)
        opk = angles_from_rotation(rotation, self.system)
        jacobian = np.linalg.solve(
            _rotation_vectors(opk, self.system),
            navigation_rotation_vectors(angles, self.mounting_rad),
        )
        propagated: Floats = np.sqrt((jacobian**2 @ sigmas[..., None] ** 2)[..., 0])
        return propagated

    def file_angle_sigmas(
        self, position_crs: Floats, ground_from_image: Floats, rotation_covariance: Floats
    ) -> Floats:
        """Standard deviations (n, 3) of the file's angles, in its unit.

        Parameters
        ----------
        position_crs, ground_from_image
            (n, 3), (n, 3, 3).
        rotation_covariance
            (n, 3, 3) of rotation vectors in the computing frame, R <- exp([w]x) R.
        """
        angles = self.file_angles(position_crs, ground_from_image) * self.unit_rad
        if self.angles == "roll-pitch-heading":
            vectors = navigation_rotation_vectors(angles, self.mounting_rad)
        else:
            vectors = _rotation_vectors(angles, self.angles)
        turned = np.swapaxes(ground_from_image @ self._imu_from_camera, -1, -2)
        by_rotation = np.linalg.solve(vectors, turned)
        covariance = by_rotation @ rotation_covariance @ np.swapaxes(by_rotation, -1, -2)
        sigmas: Floats = np.sqrt(np.diagonal(covariance, axis1=1, axis2=2)) / self.unit_rad
        return sigmas

    @property
    def _imu_from_camera(self) -> Floats:
        """R_B, the boresight matrix."""
        roll, pitch, yaw = (np.asarray(angle) for angle in self.boresight_rad)
        boresight: Floats = axis_rotation(0, pitch) @ axis_rotation(1, roll) @ axis_rotation(2, yaw)
        return boresight


def _rotation_vectors(angles_rad: Floats, system: AngleSystem) -> Floats:
    """Rotation vectors (n, 3, 3), camera axes, of unit changes of the three angles (columns)."""
    image_from_ground = np.swapaxes(rotation_from_angles(angles_rad, system), -1, -2)
    skew = image_from_ground[..., None, :, :] @ rotation_derivatives(angles_rad, system)
    vectors = np.stack([skew[..., 2, 1], skew[..., 0, 2], skew[..., 1, 0]], axis=-1)
    return np.swapaxes(vectors, -1, -2)
