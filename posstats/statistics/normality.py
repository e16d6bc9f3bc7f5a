"""Are the differences of a component normal? Shapiro and Wilk's test.

Null hypothesis: the differences are independent draws of one normal distribution, whatever its
mean and standard deviation. A small p says that statements which rest on normal errors (the
intervals of the RMSE, factors such as 1.96 RMSE) are to be read with care.
"""

from dataclasses import dataclass

from numpy.typing import ArrayLike
from scipy import stats

from posstats.arrays import Floats
from posstats.statistics import samples

MIN_POINTS = 3
MAX_POINTS = 5000
"""Royston's approximation of the p-value holds up to here."""


@dataclass(frozen=True)
class NormalityTest:
    """Shapiro-Wilk W of one component and its p-value; None where the test cannot be made.

    Attributes
    ----------
    w
        1 for a sample like the normal distribution's expected order statistics.
    p
        P(W < w) under the null hypothesis.
    n
        Points.
    reason
        "no_points", "too_few_points" (below 3), "too_many_points" (above 5000), "no_scatter".
    """

    w: float | None
    p: float | None
    n: int
    reason: str | None = None


def normality(difference_m: ArrayLike) -> tuple[NormalityTest, ...]:
    """Shapiro-Wilk test of each component of differences (n, k).

    S. S. Shapiro, M. B. Wilk, Biometrika 52 (1965), 591-611; p-value of P. Royston, Applied
    Statistics 44 (1995), 547-551, as in scipy.stats.shapiro.
    """
    return tuple(_component(column) for column in samples.checked_differences(difference_m).T)


def _component(column: Floats) -> NormalityTest:
    n = len(column)
    reason = _obstacle(column)
    if reason is not None:
        return NormalityTest(None, None, n, reason)
    # W is the same for any origin and unit; far from zero, or huge, its sums lose digits
    deviation = column - column[0]
    result = stats.shapiro(deviation / samples.power_of_two(deviation))
    return NormalityTest(min(float(result.statistic), 1.0), float(result.pvalue), n)


def _obstacle(column: Floats) -> str | None:
    n = len(column)
    if n < MIN_POINTS:
        return samples.TOO_FEW_POINTS if n else samples.NO_POINTS
    if n > MAX_POINTS:
        return samples.TOO_MANY_POINTS
    return None if samples.has_scatter(column[:, None])[0] else samples.NO_SCATTER
