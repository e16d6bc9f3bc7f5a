"""What a bundle block adjustment adjusts, and what comes out: frozen arrays, no files, no words."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

import numpy as np

from posstats.arrays import Bools, Floats, Ints
from posstats.numerics.bundle.parameters import CommonParameter, Exposures
from posstats.numerics.bundle.pos_observations import PosObservations, angles_by_rotation_vector
from posstats.numerics.kernels.rotation import AngleSystem, angles_from_rotation
from posstats.numerics.solvers.arrow import SelectedInverse


@dataclass(frozen=True, eq=False)
class Control:
    """Surveyed positions of g of the points.

    Attributes
    ----------
    point
        (g,) indices, each once.
    position_m
        (g, 3).
    covariance_m2
        (g, 3, 3).
    """

    point: Ints
    position_m: Floats
    covariance_m2: Floats

    def subset(self, rows: Ints | slice) -> Self:
        """The points of these rows."""
        return replace(self, **{name: values[rows] for name, values in vars(self).items()})


@dataclass(frozen=True, eq=False)
class BundleProblem:
    """n images, m rays to p points, c cameras; start values and observations.

    Attributes
    ----------
    exposures
        Times, strips and cameras of the images.
    ground_from_image, position_m
        (n, 3, 3), (n, 3) start values.
    distance_px, mm_per_px
        (c,) stated principal distance and pixel size of the cameras.
    point, image
        (m,) indices; no point is twice in an image.
    xy_px
        (m, 2) measured image coordinates: x right, y up.
    sigma_px
        (m,) standard deviation of each of the two.
    ground_m
        (p, 3) start values of points.
    pos
        What POS observed.
    control
        Surveyed points.
    parameters
        Additional unknowns.
    bauer_radius_mm
        r0 of equation 6 of the second source paper.
    """

    exposures: Exposures
    ground_from_image: Floats
    position_m: Floats
    distance_px: Floats
    mm_per_px: Floats
    point: Ints
    image: Ints
    xy_px: Floats
    sigma_px: Floats
    ground_m: Floats
    pos: PosObservations
    control: Control
    parameters: tuple[CommonParameter, ...] = ()
    bauer_radius_mm: float = 100.0


@dataclass(frozen=True)
class ObservationGroup:
    """Observations of one kind.

    Attributes
    ----------
    n
        Number of observations with weight.
    square_sum
        v'Pv.
    redundancy
        Their part of the degrees of freedom; the variance factor is square_sum over it.
    """

    n: int
    square_sum: float
    redundancy: float


@dataclass(frozen=True, eq=False)
class AdjustedBundle:
    """Result of an adjustment; all covariances are those of the stated weights (sigma0 = 1).

    Attributes
    ----------
    ground_from_image, position_m
        (n, 3, 3), (n, 3).
    ground_m
        (p, 3), NaN where not determined.
    common
        (k,) additional parameters.
    inverse
        Of the reduced normal equations: covariance of rotation vector (ground frame) and
        projection centre of every image, and of pairs of images with a common point (`blocks`);
        with the additional parameters (`border`), and of these (`corner`).
    ground_covariance_m2
        (p, 3, 3), NaN where not determined.
    residual_px, redundancy_px
        (m, 2) of the rays: computed minus measured, and redundancy numbers; NaN where taken out.
    residual_pos, redundancy_pos
        (n, 6) of antenna positions, m, and angles, rad; redundancy NaN where not observed.
    residual_control_m, redundancy_control
        (g, 3).
    rejected
        (m,) rays taken out as blunders, or because their point is not determined.
    groups
        ``image``, ``gnss``, ``imu``, ``control``, ``parameters``.
    dof
        Degrees of freedom: observations with weight less unknowns.
    n_iterations
        Number of steps.
    system
        Of the angles.
    """

    ground_from_image: Floats
    position_m: Floats
    ground_m: Floats
    common: Floats
    inverse: SelectedInverse
    ground_covariance_m2: Floats
    residual_px: Floats
    redundancy_px: Floats
    residual_pos: Floats
    redundancy_pos: Floats
    residual_control_m: Floats
    redundancy_control: Floats
    rejected: Bools
    groups: Mapping[str, ObservationGroup]
    dof: int
    n_iterations: int
    system: AngleSystem

    @property
    def square_sum(self) -> float:
        """V'Pv of all observations."""
        return sum(group.square_sum for group in self.groups.values())

    @property
    def sigma0(self) -> float:
        """Standard deviation of unit weight; NaN without redundancy."""
        return float(np.sqrt(self.square_sum / self.dof)) if self.dof > 0 else float("nan")

    @property
    def angles_rad(self) -> Floats:
        """(n, 3) omega, phi, kappa."""
        return angles_from_rotation(self.ground_from_image, self.system)

    @cached_property
    def orientation_covariance(self) -> Floats:
        """(n, 6, 6) of omega, phi, kappa, rad, and of the projection centre, m."""
        image = np.arange(len(self.position_m))
        by_pose = np.broadcast_to(np.eye(6), (len(image), 6, 6)).copy()
        by_pose[:, :3, :3] = angles_by_rotation_vector(self.angles_rad, self.system)
        own = self.inverse.blocks(image, image)
        covariance: Floats = by_pose @ own @ np.swapaxes(by_pose, 1, 2)
        return covariance

    @property
    def common_covariance(self) -> Floats:
        """(k, k) of the additional parameters."""
        return self.inverse.corner
