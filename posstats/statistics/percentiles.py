r"""Percentiles of absolute errors: CE90, CE95 (of hypot(dX, dY)), LE90, LE95 (of abs(dZ)).

The sample percentile is definition 8 of R. J. Hyndman, Y. Fan, Sample quantiles in statistical
packages, The American Statistician 50 (1996), 361-365: with the sorted values x_(1..n),

    h = (n + 1/3) p + 1/3,  j = floor(h)        x_(j) + (h - j) (x_(j+1) - x_(j))

and x_(n) where h >= n; it is median-unbiased for nearly any distribution, and recommended there.

Its interval is the percentile interval of the bootstrap. A resample of n values needs but two of
its order statistics: the i-th smallest of n indices drawn from 1..n is ceil(n U_(i)), where U_(i),
the i-th smallest of n uniform numbers, follows Beta(i, n + 1 - i), and given it
U_(i+1) = U_(i) + (1 - U_(i)) Beta(1, n - i). So the bootstrap costs two numbers a resample,
whatever n, and is the distribution that resampling has, not an approximation of it.

An upper limit exists only if the largest value is likely to lie beyond the percentile at all:
P(all n values below the p-quantile) = p^n, for any continuous distribution, must not be more than
the limit may fail, (1 - level) / 2. That takes 36 points for 90 % errors and 72 for 95 % ones in
an interval of 95 % (29 and 59 for a one-sided limit of 95 %). Below, there is no upper limit.
The percentile interval ends at observed values and covers too little where few of them lie
beyond the percentile: the upper limit of a 95 % error fails in 10 % of samples of 72, instead of
2.5 %. So its limits are moved outward to those of the order statistics, which hold for any
continuous distribution; benchmarks/acceptance_coverage.py measures the result.
"""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy import optimize, special

from posstats.arrays import Floats, Ints
from posstats.statistics import samples

N_RESAMPLES = 20_000


@dataclass(frozen=True)
class Percentile:
    """A percentile of absolute errors with its bootstrap interval; None where undefined.

    Attributes
    ----------
    value
        Sample percentile, metres.
    low, high
        Limits of the interval, metres. `high` is None where n < `n_for_high`: the percentile
        may lie beyond all that was observed.
    share
        0.90 or 0.95.
    n
        Points.
    n_for_high
        Fewest points that give an upper limit.
    level
        Confidence level.
    reason
        Why there is no interval ("no_points", "too_few_points": below 2) or no upper limit
        ("too_few_points").
    """

    value: float | None
    low: float | None
    high: float | None
    share: float
    n: int
    n_for_high: int
    level: float
    reason: str | None = None


def sample_percentile(absolute_error_m: ArrayLike, share: float) -> float | None:
    """Percentile of absolute errors (n,), Hyndman and Fan's definition 8; None for n = 0."""
    ordered = _ordered(absolute_error_m)
    share = samples.checked_level(share)
    return float(_between(ordered, *_place(len(ordered), share))) if len(ordered) else None


def percentile_error(
    absolute_error_m: ArrayLike, share: float, seed: int, level: float = 0.95
) -> Percentile:
    """Percentile of absolute errors with its interval.

    Parameters
    ----------
    absolute_error_m
        (n,) absolute errors: hypot(dX, dY) for CE, abs(dZ) for LE.
    share
        0.90 or 0.95 (any share of the errors between 0 and 1).
    seed
        Of the resampling: the same seed gives the same limits.
    level
        Confidence level of the two-sided interval.
    """
    ordered = _ordered(absolute_error_m)
    share, level = samples.checked_level(share), samples.checked_level(level)
    n, enough = len(ordered), n_for_upper_limit(share, level)
    if n < 2:
        value = float(ordered[0]) if n else None
        reason = samples.TOO_FEW_POINTS if n else samples.NO_POINTS
        return Percentile(value, None, None, share, n, enough, level, reason)
    value = float(_between(ordered, *_place(n, share)))
    resampled = _resampled(ordered, share, np.random.default_rng(seed))
    below, above = np.quantile(resampled, (0.5 - 0.5 * level, 0.5 + 0.5 * level))
    lowest, highest = _order_statistics_interval(ordered, share, level)
    low = min(float(below), lowest)
    if highest is None:
        return Percentile(value, low, None, share, n, enough, level, samples.TOO_FEW_POINTS)
    return Percentile(value, low, max(float(above), highest), share, n, enough, level)


def n_for_upper_limit(share: float, level: float = 0.95) -> int:
    """Fewest points with share^n <= (1 - level) / 2: fewer give a percentile no upper limit."""
    tail = 0.5 - 0.5 * samples.checked_level(level)
    n = max(1, math.floor(math.log(tail) / math.log(samples.checked_level(share))))
    return n if share**n <= tail else n + 1


def le_normal(sigma_m: float, share: float) -> float:
    """Half length that holds a share of normal errors of mean zero: z((1 + share) / 2) sigma."""
    _check_sigma(sigma_m)
    return sigma_m * float(special.ndtri(0.5 + 0.5 * samples.checked_level(share)))


def ce_normal(sigma_x_m: float, sigma_y_m: float, rho: float, share: float) -> float:
    r"""Radius of the circle that holds a share of normal errors of mean zero, in the plane.

    With a^2 >= b^2 the eigenvalues of the covariance, an error is (a s cos u, b s sin u), s
    Rayleigh distributed and u uniform, so that

        P(outside) = 2 / pi * integral from 0 to pi/2 of exp(-r^2 / (2 (a^2 cos^2 u + b^2 sin^2 u)))

    exact for any a, b (b = 0 is J. W. Craig's integral of the normal distribution, IEEE MILCOM
    1991). The radius lies between those of one component (b = 0) and of a circle (b = a).

    Parameters
    ----------
    sigma_x_m, sigma_y_m, rho
        Standard deviations, metres, and correlation.
    share
        Share of the errors inside.
    """
    for sigma_m in (sigma_x_m, sigma_y_m):
        _check_sigma(sigma_m)
    if not -1.0 <= rho <= 1.0:
        raise samples.SampleError(f"a correlation lies between -1 and 1, not {rho!r}")
    least = le_normal(1.0, share)
    largest, ratio = _axes(sigma_x_m, sigma_y_m, rho)
    most = math.sqrt(-2.0 * math.log1p(-share))

    def excess(radius: float) -> float:
        return _outside(radius, ratio) - (1.0 - share)

    if excess(least) <= 0.0 or excess(most) >= 0.0:  # one component, or a circle, to rounding
        return largest * (least if ratio < 0.5 else most)
    return largest * float(optimize.brentq(excess, least, most, xtol=1e-14, rtol=1e-13))


def _axes(sigma_x_m: float, sigma_y_m: float, rho: float) -> tuple[float, float]:
    """Larger semi-axis of the standard ellipse, and (smaller / larger)^2."""
    unit = max(sigma_x_m, sigma_y_m)
    if unit == 0.0:
        return 0.0, 1.0
    x, y = (sigma_x_m / unit) ** 2, (sigma_y_m / unit) ** 2
    half = 0.5 * (x + y)
    larger = half + math.hypot(0.5 * (x - y), rho * math.sqrt(x * y))
    ratio = min(1.0, x * y * (1.0 - rho) * (1.0 + rho) / larger**2)
    return unit * math.sqrt(larger), ratio


_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(96)
_COS_SQUARED = np.cos(0.25 * np.pi * (_NODES + 1.0)) ** 2


def _outside(radius: float, ratio: float) -> float:
    """P(outside the radius) for the axes 1 and sqrt(ratio): Gauss-Legendre, 96 nodes."""
    variance = _COS_SQUARED + ratio * (1.0 - _COS_SQUARED)
    return float(0.5 * _WEIGHTS @ np.exp(-0.5 * radius**2 / variance))


def _check_sigma(sigma_m: float) -> None:
    if not 0.0 <= sigma_m <= samples.LARGEST_DIFFERENCE_M:
        raise samples.SampleError(f"a standard deviation is a length, not {sigma_m!r}")


def _ordered(absolute_error_m: ArrayLike) -> Floats:
    values = samples.checked_differences(absolute_error_m)
    if values.shape[1] != 1 or (values < 0.0).any():
        raise samples.SampleError("absolute errors are one list of lengths, none negative")
    return np.sort(values[:, 0])


def _place(n: int, share: float) -> tuple[int, int, float]:
    """j, the next index and h - j of the definition; indices 1..n."""
    h = min(max((n + 1.0 / 3.0) * share + 1.0 / 3.0, 1.0), float(n))
    j = math.floor(h)
    return j, min(j + 1, n), h - j


def _between(ordered: Floats, index: int | Ints, following: int | Ints, part: float) -> Floats:
    """x_(index) + part (x_(following) - x_(index)); indices 1..n."""
    first = ordered[np.asarray(index) - 1]
    return np.asarray(first + part * (ordered[np.asarray(following) - 1] - first))


def _resampled(ordered: Floats, share: float, rng: np.random.Generator) -> Floats:
    """(N_RESAMPLES,) sample percentiles of resamples: see the module's text."""
    n = len(ordered)
    j, following, part = _place(n, share)
    first = rng.beta(j, n + 1 - j, N_RESAMPLES)
    second = first
    if following > j:
        second = first + (1.0 - first) * rng.beta(1.0, n - j, N_RESAMPLES)
    index, next_index = (
        np.clip(np.ceil(n * each), 1, n).astype(np.intp) for each in (first, second)
    )
    return _between(ordered, index, next_index, part)


def _order_statistics_interval(
    ordered: Floats, share: float, level: float
) -> tuple[float, float | None]:
    """Limits for any continuous distribution; no lower one: 0, no upper one: None.

    The number of values below the percentile is binomial, so that x_(i) lies above it with
    P(Bin(n, share) < i) and below it with P(Bin(n, share) >= i); i is the last, the first with
    at most (1 - level) / 2.
    """
    n, tail = len(ordered), 0.5 - 0.5 * level
    fewer = special.bdtr(np.arange(n), n, share)  # P(Bin <= 0 .. n - 1), so < 1 .. n
    lower = int(np.searchsorted(fewer, tail, side="right"))
    reached = np.flatnonzero(special.bdtrc(np.arange(n), n, share) <= tail)  # P(Bin >= 1 .. n)
    low = float(ordered[lower - 1]) if lower else 0.0
    return low, float(ordered[reached[0]]) if len(reached) else None
