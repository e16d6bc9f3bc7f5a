"""Differences at check points as checked arrays: the entrance of the acceptance statistics.

Everything here is arrays of metres. A test that a sample cannot carry is no error: its result
has a reason, one of the codes below. Values that are no differences (NaN, text, a wrong shape)
are errors.
"""

import numpy as np
from numpy.typing import ArrayLike

from posstats.arrays import Bools, Floats
from posstats.errors import PosstatsError

NO_POINTS = "no_points"
TOO_FEW_POINTS = "too_few_points"
TOO_MANY_POINTS = "too_many_points"
NO_SCATTER = "no_scatter"
"""All differences of a component are equal, to rounding."""
COLLINEAR = "collinear"
"""The components' covariance is singular to rounding."""

LARGEST_DIFFERENCE_M = 1e100
ROUNDING = 8.0 * float(np.finfo(float).eps)
"""Scatter up to this share of the largest value is rounding."""


class SampleError(PosstatsError, ValueError):
    """Values that are no sample of differences, or a question outside its range."""


def checked_differences(difference_m: ArrayLike) -> Floats:
    """(n, k) finite differences; a list (n,) is one component.

    Raises
    ------
    SampleError
        (a PosstatsError and a ValueError) for another shape, for values that are not numbers,
        not finite, or beyond 1e100 m.
    """
    try:
        values = np.asarray(difference_m, dtype=float)
    except (TypeError, ValueError) as problem:
        raise SampleError(f"differences must be numbers: {problem}") from problem
    if values.ndim == 1:
        values = values[:, None]
    if values.ndim != 2 or values.shape[1] == 0:
        raise SampleError(f"differences are (points, components), not of shape {values.shape}")
    if not (np.abs(values) <= LARGEST_DIFFERENCE_M).all():
        raise SampleError("differences must be finite lengths: leave points without one out")
    return values


def checked_level(level: float) -> float:
    """A confidence level or share; a SampleError unless it lies between 0 and 1."""
    if not 0.0 < level < 1.0:
        raise SampleError(f"a level or share lies between 0 and 1, not {level!r}")
    return float(level)


def power_of_two(values: Floats) -> float:
    """The power of two next above the largest of values: to divide by it costs no digits."""
    size = float(np.abs(values).max(initial=0.0))
    return float(np.ldexp(1.0, int(np.frexp(size)[1])))


def has_scatter(values: Floats) -> Bools:
    """(k,) whether the values (n, k) of a component differ by more than rounding; n >= 1."""
    spread = values.max(axis=0) - values.min(axis=0)
    scatter: Bools = spread > ROUNDING * np.abs(values).max(axis=0)
    return scatter


def mean_and_covariance(values: Floats) -> tuple[Floats, Floats]:
    """Mean (k,) and covariance (k, k), divisor n - 1, of values (n, k); n >= 2."""
    mean = values.mean(axis=0)
    deviation = values - mean
    return mean, deviation.T @ deviation / (len(values) - 1)
