"""Regression of angle errors on time: is there a drift, how large, and how certain."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeVar, get_args

import numpy as np

from posstats.arrays import Bools, Floats, Ids
from posstats.block.model import BLOCK_SCOPE
from posstats.contract.choices import FitKind
from posstats.contract.notice import Notice
from posstats.numerics.kernels.rotation import ANGLE_NAMES, CAMERA_ANGLE_NAMES
from posstats.statistics.drift import (
    ConstantFit,
    DriftFit,
    FitError,
    ImpossibleFitError,
    fit_constant,
    fit_drift,
)

if TYPE_CHECKING:
    from posstats.analysis.angle_errors import AngleErrors

__all__ = [
    "BLOCK_SCOPE", "AngleRegression", "ConstantFit", "DriftFit", "FitError", "fit_drift", "regress",
]  # fmt: skip

_Fit = TypeVar("_Fit")


@dataclass(frozen=True, eq=False)
class AngleRegression:
    """Lines and constants of one angle over one scope.

    Attributes
    ----------
    angle, frame
        omega, phi, kappa in frame "ground"; pitch, roll, yaw in frame "camera".
    scope
        "block" or the strip's id.
    n, n_strips
        Used images, and strips they come from.
    ols, gls, ols_constant, gls_constant
        None where the fit is impossible.
    covariance_known
        False where the errors came without covariance: GLS then has white noise (and at block
        scope the strip effect) only.
    notice
        Why there is no line, or None.
    """

    angle: str
    frame: str
    scope: str
    n: int
    n_strips: int
    ols: DriftFit | None
    gls: DriftFit | None
    ols_constant: ConstantFit | None
    gls_constant: ConstantFit | None
    covariance_known: bool
    notice: Notice | None = None


@dataclass(frozen=True, eq=False)
class AngleSample:
    """What one regression is made from: n images of one angle.

    `covariance_rad2` (n, n) is zero where nothing is known; `strip` (n,) is None for a scope
    without strip effect.
    """

    time_s: Floats
    error_rad: Floats
    covariance_rad2: Floats
    strip: Ids | None

    def line(self, fit: FitKind) -> DriftFit:
        """Straight line; FitError if there is none."""
        if fit == "ols":
            return fit_drift(self.time_s, self.error_rad)
        return fit_drift(self.time_s, self.error_rad, self.covariance_rad2, strip=self.strip)

    def constant(self, fit: FitKind) -> ConstantFit:
        """Constant; FitError if there is none."""
        if fit == "ols":
            return fit_constant(self.error_rad)
        return fit_constant(self.error_rad, self.covariance_rad2, strip=self.strip)


def regress(errors: "AngleErrors") -> tuple[AngleRegression, ...]:
    """Regress every angle on time, over the block and over every strip.

    Only images with `used` count. The block's GLS has a strip effect. A fit that cannot be made
    is None, with a notice that says why.
    """
    return tuple(_regressions(errors))


def _regressions(errors: "AngleErrors") -> Iterator[AngleRegression]:
    names = ANGLE_NAMES if errors.frame == "ground" else CAMERA_ANGLE_NAMES
    scopes = [BLOCK_SCOPE, *dict.fromkeys(errors.strip)]
    for axis, angle in enumerate(names):
        for scope in scopes:
            inside = np.full(len(errors.strip), True)
            if scope != BLOCK_SCOPE:
                inside = errors.strip == scope
            yield _regression(errors, axis, errors.used & inside, angle, scope)


def _regression(
    errors: "AngleErrors", axis: int, chosen: Bools, angle: str, scope: str
) -> AngleRegression:
    sample = angle_sample(errors, axis, chosen, scope)
    lines, why_not = _fits_or_notice(sample.line)
    constants, _ = _fits_or_notice(sample.constant)
    return AngleRegression(
        angle=angle,
        frame=errors.frame,
        scope=scope,
        n=len(sample.time_s),
        n_strips=len(set(errors.strip[chosen])),
        ols=lines.get("ols"),
        gls=lines.get("gls"),
        ols_constant=constants.get("ols"),
        gls_constant=constants.get("gls"),
        covariance_known=errors.covariance_rad2 is not None,
        notice=why_not,
    )


def _fits_or_notice(
    fit: Callable[[FitKind], _Fit],
) -> tuple[dict[FitKind, _Fit], Notice | None]:
    """Both kinds of a fit; those that cannot be made are left out, and the last reason given."""
    made: dict[FitKind, _Fit] = {}
    why_not = None
    for kind in get_args(FitKind):
        try:
            made[kind] = fit(kind)
        except ImpossibleFitError as problem:
            why_not = Notice(code=problem.code, values=problem.values)
    return made, why_not


def angle_sample(errors: "AngleErrors", axis: int, chosen: Bools, scope: str) -> AngleSample:
    """Data of one angle (0, 1, 2) of the `chosen` (n,) images, for a fit over `scope`."""
    known = errors.covariance_rad2
    n = int(np.count_nonzero(chosen))
    return AngleSample(
        time_s=errors.time_s[chosen],
        error_rad=errors.error_rad[chosen, axis],
        covariance_rad2=(
            np.zeros((n, n)) if known is None else known[:, axis, :, axis][np.ix_(chosen, chosen)]
        ),
        strip=errors.strip[chosen] if scope == BLOCK_SCOPE else None,
    )
