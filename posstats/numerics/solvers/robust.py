"""Robust weights of standardised residuals, against blunders: Huber's, then rejection.

The limits count in robust standard deviations, from the median absolute residual.
"""

import numpy as np

from posstats.arrays import Floats

HUBER = 1.345  # 95 % efficiency on normal errors
TUKEY = 4.685  # the same
REJECTION = 3.5
NORMAL_MAD = 1.4826  # standard deviation over median absolute deviation, normal distribution
SMALLEST_SCALE = 0.01  # of the stated accuracy: perfect data must not break the weights


def median_scale(standardised: Floats, smallest: float = SMALLEST_SCALE) -> float:
    """Robust standard deviation of residuals of any shape; NaN does not count."""
    return max(NORMAL_MAD * float(np.nanmedian(np.abs(standardised))), smallest)


def huber_weights(size: Floats, scale: float) -> Floats:
    """(k,) 1 up to `HUBER` scales, falling with the residuals' size (k,) beyond."""
    limit = HUBER * scale
    weight: Floats = limit / np.maximum(size, limit)
    return weight


def kept_weights(size: Floats, scale: float) -> Floats:
    """(k,) 1, or 0 where the residuals' size (k,) is beyond `REJECTION` scales."""
    return np.where(size <= REJECTION * scale, 1.0, 0.0)
