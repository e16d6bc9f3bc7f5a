"""Vertical parallax of the stereo models: per model, strip and block."""

from dataclasses import dataclass

import numpy as np

from posstats.arrays import Bools, Floats
from posstats.block.image_pairs import MIN_MODEL_POINTS, StereoModels

NOTICEABLE = 0.10
"""Relative change of a mean parallax from which it is worth a word."""


@dataclass(frozen=True)
class StripParallax:
    """RMS y-parallax of the models of one strip, or of the block.

    Attributes
    ----------
    strip
        Id of the strip; None for the whole block.
    n_models
        Number of models that have a value; the statistics are over these, NaN if there is none.
    max_px, min_px, mean_px
        At image scale.
    max_mm, min_mm, mean_mm
        The same in mm; NaN if the pixel size of one of the models is unknown.
    """

    strip: str | None
    n_models: int
    max_px: float
    min_px: float
    mean_px: float
    max_mm: float
    min_mm: float
    mean_mm: float


def model_rms_px(models: StereoModels) -> Floats:
    """(p,) root mean square of the y-parallax of all points of each model, px at image scale.

    NaN for models of fewer than `MIN_MODEL_POINTS` points, without a base or an orientation.
    """
    pair_of_point = models.pairs.pair_of_point
    squares = np.bincount(pair_of_point, models.y_parallax_px() ** 2, minlength=len(models))
    usable = (models.pairs.n_points >= MIN_MODEL_POINTS) & np.isfinite(squares)
    rms = np.full(len(models), np.nan)
    rms[usable] = np.sqrt(squares[usable] / models.pairs.n_points[usable])
    return rms


def strip_statistics(models: StereoModels, rms_px: Floats) -> tuple[StripParallax, ...]:
    """Maximum, minimum and mean over the models of every strip (Table 2 of the first paper).

    Parameters
    ----------
    models
        The stereo models.
    rms_px
        (p,) RMS y-parallax of each, of any orientation; NaN where there is none.

    Returns
    -------
    One entry per strip that has a model, in order of flight.
    """
    return tuple(
        _statistics(models, rms_px, models.strip == strip, strip)
        for strip in dict.fromkeys(models.strip)
    )


def block_statistics(models: StereoModels, rms_px: Floats) -> StripParallax:
    """Maximum, minimum and mean over all models of the block; parameters as for the strips."""
    return _statistics(models, rms_px, np.ones(len(models), dtype=bool), None)


def _statistics(
    models: StereoModels, rms_px: Floats, chosen: Bools, strip: str | None
) -> StripParallax:
    valued = chosen & np.isfinite(rms_px)
    max_px, min_px, mean_px = _max_min_mean(rms_px[valued])
    max_mm, min_mm, mean_mm = _max_min_mean((rms_px * models.pixel_size_mm)[valued])
    return StripParallax(strip, int(valued.sum()), max_px, min_px, mean_px, max_mm, min_mm, mean_mm)


def _max_min_mean(values: Floats) -> tuple[float, float, float]:
    if len(values) == 0:
        return np.nan, np.nan, np.nan
    return float(values.max()), float(values.min()), float(values.mean())
