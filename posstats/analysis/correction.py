"""Correction of the POS: recorded angles minus the fitted errors."""

from collections.abc import Sequence

import numpy as np

from posstats.analysis.regression import BLOCK_SCOPE, AngleRegression, ConstantFit, DriftFit
from posstats.analysis.rules import Decision, chosen_fits
from posstats.arrays import Floats, Ids
from posstats.numerics.kernels.rotation import ANGLE_NAMES, CAMERA_ANGLE_NAMES


def predicted_errors(
    regressions: Sequence[AngleRegression],
    decisions: Sequence[Decision],
    time_s: Floats,
    strip: Ids,
) -> Floats:
    """Angle errors (n, 3), rad, that the decided corrections say images have.

    Parameters
    ----------
    regressions, decisions
        Of one frame; zero is predicted where nothing is decided.
    time_s, strip
        (n,) of the images, which need not be those of the regressions.
    """
    fits = {(r.angle, r.scope): r for r in regressions}
    predicted = np.zeros((len(time_s), 3))
    for decision in decisions:
        if decision.correct:
            inside = (strip == decision.scope) | (decision.scope == BLOCK_SCOPE)
            line, constant = chosen_fits(fits[decision.angle, decision.scope], decision.fit)
            fit = line if decision.form == "linear" else constant
            predicted[inside, axis_of(decision)] = fitted_values(fit, time_s[inside])
    return predicted


def axis_of(decision: Decision) -> int:
    """Column of the decision's angle."""
    names = ANGLE_NAMES if decision.frame == "ground" else CAMERA_ANGLE_NAMES
    return names.index(decision.angle)


def fitted_values(fit: DriftFit | ConstantFit | None, time_s: Floats) -> Floats:
    """Line or constant at times (m,), rad; NaN where there is no fit."""
    if isinstance(fit, DriftFit):
        return fit.predict(time_s)[0]
    return np.full(len(time_s), np.nan if fit is None else fit.value)
