r"""Confidence interval of a root mean square error, and the points that would decide a case.

The root mean square error R of differences d (n, k) ~ N(m, S) has R^2 = tr S + m'm, the mean
shift m kept. Its estimate is Q = sum |d|^2 / n. With M = S + m m'

    E Q = tr M = R^2        n Var Q = V = 2 tr(S S) + 4 m'S m = 2 (tr(M M) - (m'm)^2)

so that Q / R^2 is close to chi-square over its degrees of freedom (two moments matched:
F. E. Satterthwaite, Biometrics Bulletin 2 (1946), 110-114)

    df = 2 (tr M)^2 / (V / n)

which is n for one component without shift (exact), nk for k equal ones, and never below n,
since tr(M M) <= (tr M)^2. What has to be estimated for df is estimated without bias, as far as
that goes, from the covariance S^ (divisor f = n - 1) and the mean d^ of the sample:

    tr(S S) = f^2 / ((f - 1)(f + 2)) (tr(S^ S^) - (tr S^)^2 / f)
    m'S m   = d^'S^ d^ - tr(S S) / n
    (tr M)^2 = Q^2 - V / n                  hence      df = 2 n Q^2 / V - 2

each kept within what is possible: tr(S S) between (tr S)^2 / k and (tr S)^2, m'S m not negative,
df not below n. The plain estimates (V of S^ and d^, Q^2 for (tr M)^2) cover too little: 86 % at
n = 5 with a large shift. Of V the share w = 4 m'S m / V scales with the square of a standard
deviation that f differences estimate beside Q; a normal quantile for it gives Student's case its
known loss (88 % at n = 5, shift 10 sigma). So the interval of log Q is widened by

    c = t(f / w) / z        df becomes df / c^2

with t and z the two-sided quantiles of Student's and the normal distribution; without shift
w = 0 and c = 1, with a dominating shift c = t(n - 1) / z. benchmarks/acceptance_coverage.py
measures the coverage, also of the plain estimates; docs/method.md has the table.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from posstats.arrays import Floats
from posstats.statistics import samples

MIN_POINTS = 3
"""Fewer leave tr(S S) without an estimate."""
MAX_POINTS = 100_000
"""Of `n_to_decide`: more check points than anyone surveys."""
MAX_DF = 1e12
"""Degrees of freedom are cut here, where the interval is 3 parts in a million wide."""


@dataclass(frozen=True)
class RmseInterval:
    """Root mean square error with its chi-square interval; None where undefined.

    Attributes
    ----------
    rmse
        sqrt(sum of squares / n), metres; None without points.
    low, high
        Limits rmse * sqrt(df / chi-square quantile), metres.
    df
        Degrees of freedom from which the limits follow.
    n
        Points.
    level
        Confidence level.
    reason
        Why there is no interval: "no_points", "too_few_points" (below 3) or "no_scatter".
    """

    rmse: float | None
    low: float | None
    high: float | None
    df: float | None
    n: int
    level: float
    reason: str | None = None

    @property
    def df_per_point(self) -> float | None:
        """For `n_to_decide`: df / n; the widening of this n included, so rather too small."""
        return None if self.df is None else self.df / self.n


def rmse_interval(difference_m: ArrayLike, level: float = 0.95) -> RmseInterval:
    """Root mean square error of differences and its confidence interval.

    Parameters
    ----------
    difference_m
        (n, k) differences, the k components joined by the error: (dX, dY) for horizontal,
        (dZ,) for vertical. They may be correlated, of unequal spread and shifted.
    level
        Confidence level of the two-sided interval.
    """
    values, level = samples.checked_differences(difference_m), samples.checked_level(level)
    n = len(values)
    if n == 0:
        return RmseInterval(None, None, None, None, n, level, samples.NO_POINTS)
    unit = samples.power_of_two(values)
    square = float(np.sum((values / unit) ** 2)) / n
    rmse = unit * math.sqrt(square)
    reason = samples.TOO_FEW_POINTS if n < MIN_POINTS else samples.NO_SCATTER
    if n < MIN_POINTS or not samples.has_scatter(values).any():
        return RmseInterval(rmse, None, None, None, n, level, reason)
    df = _degrees_of_freedom(values / unit, square, level)
    low, high = _limits(rmse, df, level)
    return RmseInterval(rmse, low, high, df, n, level)


def n_to_decide(rmse: float, limit: float, df_per_point: float, level: float = 0.95) -> int | None:
    """Smallest number of points whose interval of an unchanged RMSE leaves the limit outside.

    With df = n df_per_point both limits rmse sqrt(df / chi-square quantile) close on the RMSE
    as n grows, so that the number is found by bisection. None where it is beyond 100 000 or
    does not exist (the RMSE equals the limit).

    Parameters
    ----------
    rmse, limit
        Metres; the RMSE found, and the limit that it is compared with.
    df_per_point
        `RmseInterval.df_per_point`; 1 for one component without mean shift.
    level
        Confidence level of the interval.
    """
    _check_case(rmse, limit, df_per_point)
    samples.checked_level(level)
    few, many = MIN_POINTS - 1, MAX_POINTS
    if not _decides(rmse, limit, many * df_per_point, level):
        return None
    while many - few > 1:
        middle = (few + many) // 2
        if _decides(rmse, limit, middle * df_per_point, level):
            many = middle
        else:
            few = middle
    return many


def _degrees_of_freedom(values: Floats, square: float, level: float) -> float:
    """Satterthwaite's degrees of freedom, widened: see the module's text.

    Parameters
    ----------
    values
        (n, k) of order 1.
    square
        Q, the sum of squares / n.
    level
        Confidence level.
    """
    n = len(values)
    scatter, shift = _variance_terms(values)
    variance = 2.0 * scatter + 4.0 * shift
    widening = _widening((n - 1) * variance, 4.0 * shift, level)
    # a shift far beyond the scatter: df without bound
    if 2.0 * n * square**2 >= MAX_DF * variance:
        return MAX_DF
    return max(n, 2.0 * n * square**2 / variance - 2.0) / widening**2


def _variance_terms(values: Floats) -> tuple[float, float]:
    """Unbiased estimates of tr(S S) and m'S m, kept within what is possible."""
    n, k = values.shape
    f = n - 1
    mean, covariance = samples.mean_and_covariance(values)
    trace_2 = float(np.trace(covariance)) ** 2
    unbiased = f**2 / ((f - 1) * (f + 2)) * (float(np.sum(covariance**2)) - trace_2 / f)
    # (tr S)^2 = (tr S^)^2 - 2 tr(S S) / f turns 1/k <= tr(S S) / (tr S)^2 <= 1 into
    scatter = min(max(unbiased, trace_2 * f / (f * k + 2)), trace_2 * f / (f + 2))
    return scatter, max(float(mean @ covariance @ mean) - scatter / n, 0.0)


def _widening(total: float, part: float, level: float) -> float:
    """Student's quantile of total / part degrees of freedom over the normal quantile."""
    if part <= 0.0:
        return 1.0
    upper = 0.5 + 0.5 * level
    return float(special.stdtrit(total / part, upper) / special.ndtri(upper))


def _limits(rmse: float, df: float, level: float) -> tuple[float, float]:
    tail = 0.5 - 0.5 * level
    most, least = special.chdtri(df, tail), special.chdtri(df, 1.0 - tail)
    return rmse * math.sqrt(df / float(most)), rmse * math.sqrt(df / float(least))


def _decides(rmse: float, limit: float, df: float, level: float) -> bool:
    low, high = _limits(rmse, df, level)
    return high < limit if rmse < limit else low > limit


def _check_case(rmse: float, limit: float, df_per_point: float) -> None:
    finite = math.isfinite(rmse) and math.isfinite(limit) and math.isfinite(df_per_point)
    if not (finite and rmse >= 0.0 and limit >= 0.0 and df_per_point > 0.0):
        raise samples.SampleError(
            f"RMSE {rmse!r} and limit {limit!r} must be lengths, and {df_per_point!r} degrees of"
            " freedom per point positive"
        )
