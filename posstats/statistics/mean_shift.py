"""Is the mean difference at check points zero? Hotelling's T2 for all components, t for each.

Null hypothesis: the differences are independent draws of one normal distribution of mean zero,
whatever its covariance. A small p says that the block is shifted.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from posstats.arrays import Floats
from posstats.statistics import samples

LEAST_EIGENVALUE = 1e-10
"""Of a correlation matrix: components are collinear below. Rounding of the covariance leaves
1e-15, differences rounded to the millimetre far more than this."""


@dataclass(frozen=True)
class MeanShiftTest:
    """Hotelling's test of mean = 0; None where it cannot be made, for the reason.

    Attributes
    ----------
    t2
        n d' S^-1 d with the mean d and the covariance S (divisor n - 1) of the differences.
    f
        (n - k) / (k (n - 1)) T2, distributed as F(k, n - k) under the null hypothesis.
    df1, df2
        k, n - k.
    p
        P(F(df1, df2) > f).
    reason
        "no_points", "too_few_points" (n <= k), "no_scatter" (of a component) or "collinear".
    """

    t2: float | None
    f: float | None
    df1: int
    df2: int
    p: float | None
    reason: str | None = None


@dataclass(frozen=True)
class ComponentShift:
    """Student's test of mean = 0 for one component; None where it cannot be made.

    Attributes
    ----------
    mean, se
        Mean difference and its standard error s / sqrt(n), metres.
    t, df, p
        mean / se, n - 1, and P(abs(t(df)) > abs(t)).
    reason
        "no_points", "too_few_points" (below 2) or "no_scatter".
    """

    mean: float | None
    se: float | None
    t: float | None
    df: int
    p: float | None
    reason: str | None = None


def mean_shift(difference_m: ArrayLike) -> MeanShiftTest:
    """Hotelling's T2 that the mean of differences (n, k) is zero in all components.

    H. Hotelling, The generalization of Student's ratio, Annals of Mathematical Statistics 2
    (1931), 360-378.
    """
    values = samples.checked_differences(difference_m)
    n, k = values.shape
    reason = _obstacle(values)
    if reason is not None:
        return MeanShiftTest(None, None, k, n - k, None, reason)
    t2 = _t2(values / np.abs(values).max(axis=0))  # the same in any unit of each component
    if t2 is None:
        return MeanShiftTest(None, None, k, n - k, None, samples.COLLINEAR)
    f = (n - k) / (k * (n - 1)) * t2
    return MeanShiftTest(t2, f, k, n - k, float(special.fdtrc(k, n - k, f)))


def component_shifts(difference_m: ArrayLike) -> tuple[ComponentShift, ...]:
    """Student's test of mean zero for each component of differences (n, k)."""
    return tuple(_component(column) for column in samples.checked_differences(difference_m).T)


def _obstacle(values: Floats) -> str | None:
    n, k = values.shape
    if n <= k:
        return samples.TOO_FEW_POINTS if n else samples.NO_POINTS
    return None if samples.has_scatter(values).all() else samples.NO_SCATTER


def _t2(values: Floats) -> float | None:
    """T2 through the correlation matrix; None where that is singular."""
    mean, covariance = samples.mean_and_covariance(values)
    sigma = np.sqrt(np.diag(covariance))
    eigenvalue, axis = np.linalg.eigh(covariance / np.outer(sigma, sigma))
    if eigenvalue[0] < LEAST_EIGENVALUE:
        return None
    return float(len(values) * np.sum((axis.T @ (mean / sigma)) ** 2 / eigenvalue))


def _component(column: Floats) -> ComponentShift:
    n = len(column)
    if n == 0:
        return ComponentShift(None, None, None, -1, None, samples.NO_POINTS)
    unit = samples.power_of_two(column)
    mean = float(np.mean(column / unit))
    if n == 1:
        return ComponentShift(unit * mean, None, None, 0, None, samples.TOO_FEW_POINTS)
    if not samples.has_scatter(column[:, None])[0]:
        return ComponentShift(unit * mean, 0.0, None, n - 1, None, samples.NO_SCATTER)
    se = float(np.std(column / unit, ddof=1)) / math.sqrt(n)
    t = mean / se
    p = 2.0 * float(special.stdtr(n - 1, -abs(t)))
    return ComponentShift(unit * mean, unit * se, t, n - 1, p)
