"""What a user chooses for an adjustment, and the additional parameters that follow from it."""

from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from posstats.adjustment.control import NAMED_CHOICES, ControlChoice
from posstats.block.model import Block
from posstats.errors import PosstatsError
from posstats.numerics.bundle.parameters import (
    BLOCK,
    BORESIGHT,
    GNSS_DRIFTS,
    GNSS_SHIFTS,
    IMU_DRIFTS,
    IMU_SHIFTS,
    LEVER_ARM,
    CommonParameter,
    drift_parameters,
)

DriftScope = Literal["none", "block", "strip"]
SelfCalibration = Literal["none", "bauer", "brown"]

_DEFORMATION: dict[SelfCalibration, tuple[str, ...]] = {
    "none": (),
    "bauer": ("bauer_s1", "bauer_s2", "bauer_s3"),
    "brown": ("brown_k1", "brown_k2", "brown_k3", "brown_p1", "brown_p2"),
}
INTERIOR = ("camera_c", "camera_x0", "camera_y0")


@dataclass(frozen=True)
class DriftPriors:
    """Standard deviations of POS parameters as observations of the value 0; None: free.

    Attributes
    ----------
    shift_m, drift_m_per_s
        Of the GNSS.
    shift_rad, drift_rad_per_s
        Of the IMU.
    boresight_rad
        The first source paper expects less than three degrees.
    lever_arm_m
        Of what the lever arm differs from the stated one.
    """

    shift_m: float | None = 0.3
    drift_m_per_s: float | None = 0.1 / 100.0
    shift_rad: float | None = float(np.radians(0.05))
    drift_rad_per_s: float | None = float(np.radians(0.005)) / 100.0
    boresight_rad: float | None = float(np.radians(1.0))
    lever_arm_m: float | None = 1.0


@dataclass(frozen=True)
class AdjustmentSettings:
    """What a user chooses; each value as on the command line.

    Attributes
    ----------
    control
        ``roles`` of the ground points; ``none``, ``centre``, ``corners``, ``all``, or ids, which
        choose among all ground points: the others are check points.
    drift
        Shifts and drifts of GNSS and IMU, and the boresight: none, or of the block or each strip.
    self_calibration
        Image deformation: none, three parameters after Bauer, or five after Brown.
    camera
        Principal distance and principal point of every camera are unknown.
    lever_arm
        The lever arm is unknown.
    estimate_weights
        Estimate the variances of the groups of observations.
    drop_insignificant
        Drop free parameters, boresight and lever arm, where they are not significant, one by one.
    robust
        Reject blunders among the rays before data snooping.
    priors
        Of the POS parameters.
    bauer_radius_mm
        r0 of equation 6 of the second source paper.
    """

    control: ControlChoice = "roles"
    drift: DriftScope = "block"
    self_calibration: SelfCalibration = "none"
    camera: bool = False
    lever_arm: bool = False
    estimate_weights: bool = False
    drop_insignificant: bool = False
    robust: bool = True
    priors: DriftPriors = DriftPriors()
    bauer_radius_mm: float = 100.0

    def __post_init__(self) -> None:
        allowed: dict[str, tuple[str, ...]] = {
            "drift": get_args(DriftScope),
            "self_calibration": get_args(SelfCalibration),
        }
        if not isinstance(self.control, tuple):
            allowed["control"] = NAMED_CHOICES
        for name, choices in allowed.items():
            value = getattr(self, name)
            if value not in choices:
                raise PosstatsError(
                    f"setting {name} is {value!r}: choose one of {', '.join(choices)}"
                )


def additional_parameters(
    block: Block, settings: AdjustmentSettings
) -> tuple[CommonParameter, ...]:
    """The additional unknowns of a block.

    Raises
    ------
    PosstatsError
        If Bauer's parameters, which count in mm, are wanted of a camera without pixel size.
    """
    arm = LEVER_ARM if settings.lever_arm else ()
    return (
        *_pos_parameters(block, settings),
        *drift_parameters(arm, (BLOCK,), settings.priors.lever_arm_m),
        *_image_parameters(block, settings),
    )


def _pos_parameters(block: Block, settings: AdjustmentSettings) -> tuple[CommonParameter, ...]:
    """Boresight, and equations 7 and 8 for every scope; drifts where there is a time to drift."""
    if settings.drift == "none":
        return ()
    pos, priors = block.orientations, settings.priors
    scopes = pos.strips if settings.drift == "strip" else (BLOCK,)
    inside = {scope: (pos.strip == scope) | (scope == BLOCK) for scope in scopes}
    lasting = [scope for scope in scopes if np.ptp(pos.time_s[inside[scope]]) > 0.0]
    return (
        *drift_parameters(BORESIGHT, (BLOCK,), priors.boresight_rad),
        *drift_parameters(GNSS_SHIFTS, scopes, priors.shift_m),
        *drift_parameters(GNSS_DRIFTS, lasting, priors.drift_m_per_s),
        *drift_parameters(IMU_SHIFTS, scopes, priors.shift_rad),
        *drift_parameters(IMU_DRIFTS, lasting, priors.drift_rad_per_s),
    )


def _image_parameters(block: Block, settings: AdjustmentSettings) -> tuple[CommonParameter, ...]:
    """Free parameters of every camera: interior orientation and deformation."""
    model = settings.self_calibration
    if model == "bauer" and any(camera.pixel_size_mm is None for camera in block.cameras):
        raise PosstatsError(
            "self-calibration after Bauer counts in mm: it needs the pixel size of the camera"
            " (camera.pixel_size_mm)"
        )
    several = len(block.cameras) > 1
    scopes = [camera.id for camera in block.cameras] if several else [BLOCK]
    interior = INTERIOR if settings.camera else ()
    return drift_parameters((*interior, *_DEFORMATION[model]), scopes)
