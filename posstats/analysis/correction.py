"""Correction of the POS: recorded angles minus the fitted errors."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from posstats.analysis.regression import BLOCK_SCOPE, AngleRegression, ConstantFit, DriftFit
from posstats.analysis.rules import Decision, chosen_fits
from posstats.block.model import Orientations
from posstats.numerics.kernels.rotation import (
    ANGLE_NAMES,
    CAMERA_ANGLE_NAMES,
    angles_from_rotation,
    rotation_from_vector,
)

_Floats = NDArray[np.float64]
_Ids = NDArray[np.object_]

FULL_TURN = 2.0 * np.pi


def predicted_errors(
    regressions: Sequence[AngleRegression],
    decisions: Sequence[Decision],
    time_s: _Floats,
    strip: _Ids,
) -> _Floats:
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


def fitted_values(fit: DriftFit | ConstantFit | None, time_s: _Floats) -> _Floats:
    """Line or constant at times (m,), rad; NaN where there is no fit."""
    if isinstance(fit, DriftFit):
        return fit.predict(time_s)[0]
    return np.full(len(time_s), np.nan if fit is None else fit.value)


def corrected(orientations: Orientations, predicted_rad: _Floats, frame: str) -> Orientations:
    """Orientations without the predicted errors.

    Parameters
    ----------
    predicted_rad
        (n, 3) errors. Frame "ground": POS minus true omega, phi, kappa. Frame "camera": rotation
        vector e about image x, y, z with R_pos = R_true exp([e]x).
    frame
        "ground" or "camera".

    Notes
    -----
    An image whose predicted errors are zero keeps its angles to the last digit.
    """
    recorded = orientations.angles_rad
    if frame == "ground":
        angles = recorded - predicted_rad
    else:
        rotation = orientations.ground_from_image @ rotation_from_vector(-predicted_rad)
        angles = angles_from_rotation(rotation, orientations.system)
    touched = np.any(predicted_rad != 0.0, axis=1)[:, None]
    return orientations.with_angles(np.where(touched, _in_turn_of(angles, recorded), recorded))


def _in_turn_of(angles_rad: _Floats, recorded_rad: _Floats) -> _Floats:
    """Angles in the turn that the recorded ones use: 0 to 360 degrees, else -180 to 180."""
    start = np.where(
        (np.nanmin(recorded_rad, 0) >= 0) & (np.nanmax(recorded_rad, 0) > np.pi), 0.0, -np.pi
    )
    outside = (angles_rad < start) | (angles_rad >= start + FULL_TURN)
    return np.where(outside, (angles_rad - start) % FULL_TURN + start, angles_rad)
