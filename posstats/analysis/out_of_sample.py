"""What a correction is worth on images that its fit has not seen."""

from collections.abc import Sequence

import numpy as np

from posstats.analysis.angle_errors import AngleErrors
from posstats.analysis.correction import axis_of, fitted_values
from posstats.analysis.regression import (
    BLOCK_SCOPE,
    AngleSample,
    ConstantFit,
    DriftFit,
    FitError,
    angle_sample,
)
from posstats.analysis.rules import Decision, OutOfSampleParallax
from posstats.arrays import Floats, Ints
from posstats.block.image_pairs import StereoModels
from posstats.block.turned import corrected
from posstats.geometry.stereo.parallax import model_rms_px

LEAVE_STRIP_OUT = "leave_strip_out"
LEAVE_HALF_OUT = "leave_half_strip_out"


def out_of_sample_parallax(
    models: StereoModels, errors: AngleErrors, decisions: Sequence[Decision]
) -> OutOfSampleParallax:
    """Parallax if every image were corrected by fits that leave its part of the block out.

    Parameters
    ----------
    models
        Stereo models formed from the POS.
    errors
        Angle errors of all images of the block, in the frame of the decisions.
    decisions
        The corrections to judge: of the block, or of one or more strips. Models of other strips
        do not count.

    Notes
    -----
    The decided forms are fitted again without the images in question; for decisions of the block
    these are the images of one strip, for decisions of a strip (or a block of one strip) the
    first or the second half of it. A model across two halves does not count.
    """
    scopes = {decision.scope for decision in decisions}
    part, method = _parts(errors, by_strip=scopes == {BLOCK_SCOPE})
    predicted = np.zeros((len(errors), 3))
    for decision in decisions:
        if decision.correct:
            predicted[:, axis_of(decision)] += _unseen_prediction(errors, decision, part)
    left, right = models.pairs.left, models.pairs.right
    counts = (part[left] == part[right]) & np.isfinite(predicted[left] + predicted[right]).all(1)
    if BLOCK_SCOPE not in scopes:
        counts &= np.isin(models.strip.astype(str), list(scopes))
    after = corrected(models.orientations, np.nan_to_num(predicted), errors.frame)
    raw_px = model_rms_px(models)
    corrected_px = model_rms_px(models.with_orientations(after))
    counts &= np.isfinite(raw_px) & np.isfinite(corrected_px)
    n_models = int(counts.sum())
    if n_models == 0:
        return OutOfSampleParallax(np.nan, np.nan, 0, method)
    return OutOfSampleParallax(
        float(raw_px[counts].mean()), float(corrected_px[counts].mean()), n_models, method
    )


def _parts(errors: AngleErrors, by_strip: bool) -> tuple[Ints, str]:
    """Part (n,) of every image: its strip, or the half of its strip."""
    strips, number = np.unique(errors.strip.astype(str), return_inverse=True)
    if by_strip and len(strips) > 1:
        return number, LEAVE_STRIP_OUT
    half = np.zeros(len(number), dtype=np.intp)
    for k in range(len(strips)):
        half[number == k] = errors.time_s[number == k] > np.median(errors.time_s[number == k])
    return 2 * number + half, LEAVE_HALF_OUT


def _unseen_prediction(errors: AngleErrors, decision: Decision, part: Ints) -> Floats:
    """Fitted error (n,), each image's from fits without its part; NaN where none can be made."""
    inside = (errors.strip == decision.scope) | (decision.scope == BLOCK_SCOPE)
    predicted = np.zeros(len(errors))
    for left_out in np.unique(part[inside]):
        seen = errors.used & inside & (part != left_out)
        fit = _fit(angle_sample(errors, axis_of(decision), seen, decision.scope), decision)
        test = inside & (part == left_out)
        predicted[test] = fitted_values(fit, errors.time_s[test])
    return predicted


def _fit(sample: AngleSample, decision: Decision) -> DriftFit | ConstantFit | None:
    try:
        if decision.form == "linear":
            return sample.line(decision.fit)
        return sample.constant(decision.fit)
    except FitError:
        return None
