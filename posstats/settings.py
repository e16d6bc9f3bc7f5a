"""What a user chooses for an analysis or an adjustment, checked; no NumPy."""

from dataclasses import dataclass
from math import radians
from pathlib import Path
from typing import get_args

from posstats.contract.choices import (
    DEFAULT_DRIFT,
    DEFAULT_ERRORS,
    DEFAULT_FRAME,
    DEFAULT_ROBUST,
    DEFAULT_RULES,
    DEFAULT_SCOPE,
    DEFAULT_SELF_CALIBRATION,
    AngleErrorSource,
    ControlChoice,
    DriftScope,
    FrameChoice,
    NamedControl,
    Scope,
    SelfCalibration,
)
from posstats.errors import PosstatsError


@dataclass(frozen=True)
class Settings:
    """What a user chooses for an analysis; each value as on the command line.

    Attributes
    ----------
    rules
        ``paper``, ``strict`` or the path of a TOML file.
    scope
        Correct by one function of time for the block, or by one for every strip.
    errors
        Where angle errors come from: coplanarity of the tie points' rays, a bundle adjustment with
        control points, or the block's adjusted orientation.
    frame
        Frame of the regression; ``auto`` takes the one with less parallax out of sample.
    robust
        Resist blunders in the tie points.
    """

    rules: str | Path = DEFAULT_RULES
    scope: Scope = DEFAULT_SCOPE
    errors: AngleErrorSource = DEFAULT_ERRORS
    frame: FrameChoice = DEFAULT_FRAME
    robust: bool = DEFAULT_ROBUST

    def __post_init__(self) -> None:
        _check(self, scope=Scope, errors=AngleErrorSource, frame=FrameChoice)


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
    shift_rad: float | None = radians(0.05)
    drift_rad_per_s: float | None = radians(0.005) / 100.0
    boresight_rad: float | None = radians(1.0)
    lever_arm_m: float | None = 1.0


@dataclass(frozen=True)
class AdjustmentSettings:
    """What a user chooses for an adjustment; each value as on the command line.

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
    drift: DriftScope = DEFAULT_DRIFT
    self_calibration: SelfCalibration = DEFAULT_SELF_CALIBRATION
    camera: bool = False
    lever_arm: bool = False
    estimate_weights: bool = False
    drop_insignificant: bool = False
    robust: bool = DEFAULT_ROBUST
    priors: DriftPriors = DriftPriors()
    bauer_radius_mm: float = 100.0

    def __post_init__(self) -> None:
        _check(self, drift=DriftScope, self_calibration=SelfCalibration)
        if not isinstance(self.control, tuple):
            _check(self, control=NamedControl)


def _check(settings: object, **allowed: object) -> None:
    """Raise a PosstatsError for a setting that is none of the values of its Literal type."""
    for name, choices in allowed.items():
        value = getattr(settings, name)
        if value not in get_args(choices):
            expected = ", ".join(get_args(choices))
            raise PosstatsError(f"setting {name} is {value!r}: choose one of {expected}")
