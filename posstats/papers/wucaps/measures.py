"""What a set of orientations is worth: check points, truth, parallax of the models."""

from dataclasses import dataclass

import numpy as np

from posstats.arrays import Floats
from posstats.block.image_pairs import StereoModels
from posstats.block.model import Block, Orientations
from posstats.errors import PosstatsError
from posstats.geometry.ground.check_points import (
    CheckPointResiduals,
    check_point_accuracy,
    check_point_residuals,
)
from posstats.geometry.stereo.parallax import block_statistics, model_rms_px
from posstats.numerics.kernels.rotation import wrapped


@dataclass(frozen=True)
class Measures:
    """Accuracy of one set of orientations of a block of known truth.

    Attributes
    ----------
    horizontal_m, vertical_m
        RMSE of the check points, against their survey.
    predicted_horizontal_m, predicted_vertical_m
        What the standard deviations say that these should be.
    position_horizontal_m, position_vertical_m
        RMSE of the projection centres against truth.
    omega_rad, phi_rad, kappa_rad
        RMSE of the angles against truth.
    parallax_mm
        Mean RMS y-parallax of the stereo models, at image scale.
    """

    horizontal_m: float
    vertical_m: float
    predicted_horizontal_m: float
    predicted_vertical_m: float
    position_horizontal_m: float
    position_vertical_m: float
    omega_rad: float
    phi_rad: float
    kappa_rad: float
    parallax_mm: float


def measured(
    block: Block,
    models: StereoModels,
    orientations: Orientations,
    check_points: CheckPointResiduals | None = None,
) -> Measures:
    """Measure orientations of a simulated block.

    Parameters
    ----------
    block
        With truth and check points.
    models
        Its stereo models, of any orientation.
    orientations
        To be measured.
    check_points
        Their residuals; intersected from the orientations if None.

    Raises
    ------
    PosstatsError
        If the truth, or a check point, is missing.
    """
    truth = block.adjusted
    if check_points is None:
        check_points = check_point_residuals(block, orientations, "direct")
    accuracy = check_point_accuracy(check_points, translation_removed=False)
    horizontal, vertical = accuracy.rmse_horizontal_m, accuracy.rmse_vertical_m
    if truth is None or horizontal is None or vertical is None:
        raise PosstatsError("accuracy needs check points and known truth")
    predicted_m = _rms(check_points.sigma_m[check_points.is_ok])
    position_m = _rms(orientations.position_m - truth.position_m)
    angle_rad = _rms(wrapped(orientations.angles_rad - truth.angles_rad))
    parallax = model_rms_px(models.with_orientations(orientations))
    return Measures(
        horizontal_m=horizontal,
        vertical_m=vertical,
        predicted_horizontal_m=float(np.hypot(*predicted_m[:2])),
        predicted_vertical_m=float(predicted_m[2]),
        position_horizontal_m=float(np.hypot(*position_m[:2])),
        position_vertical_m=float(position_m[2]),
        omega_rad=float(angle_rad[0]),
        phi_rad=float(angle_rad[1]),
        kappa_rad=float(angle_rad[2]),
        parallax_mm=block_statistics(models, parallax).mean_mm,
    )


def _rms(values: Floats) -> Floats:
    """(3,) root mean squares of the columns (n, 3)."""
    rms: Floats = np.sqrt(np.mean(values**2, axis=0))
    return rms
