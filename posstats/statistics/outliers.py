r"""Does the largest residual at check points belong to the others? Grubbs' two-sided test.

Null hypothesis: the differences of a component are independent draws of one normal distribution,
whatever its mean and standard deviation. The statistic is

    G = max abs(d_i - mean) / s        s with divisor n - 1

(F. E. Grubbs, Annals of Mathematical Statistics 21 (1950), 27-58). Each scaled residual r alone
has a known distribution: with t^2 = n (n - 2) r^2 / ((n - 1)^2 - n r^2), t is Student's with n - 2
degrees of freedom (W. R. Thompson, same journal 6 (1935), 214-219). So, with p1 = P(abs(t) > t(G)),

    p = n p1.

This is exact where no two residuals can be as large as G together, 2 G^2 > n - 1 (two squares
stay below the sum of all, (n - 1) s^2): at 5 % for up to 13 points. Elsewhere it is Bonferroni's
bound, above the exact value by the expected number of pairs beyond G at most, which is below
p^2 / 2: the size of the test at 5 % lies between 4.87 % and 5 %.

Where all but one difference are equal, as rounding to the millimetre makes two of three, G is the
largest there is and p = 0: the null hypothesis knows no equal values.

The components of a point may be correlated; over k components the p-values are adjusted by Holm's
method, which holds for any dependence.
"""

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike
from scipy import special

from posstats.arrays import Floats
from posstats.statistics import samples
from posstats.statistics.holm import holm

MIN_POINTS = 3


@dataclass(frozen=True)
class LargestResidual:
    """The largest residual of one component and its test; None where undefined.

    Attributes
    ----------
    point
        Index of the point (the first of equal ones); None without points.
    residual
        Difference minus mean difference there, signed, metres.
    g
        Its absolute value in standard deviations.
    p
        P(G > g) under the null hypothesis, this component alone.
    p_holm
        The same with all components of the call as one family.
    n
        Points.
    reason
        "no_points", "too_few_points" (below 3) or "no_scatter".
    """

    point: int | None
    residual: float | None
    g: float | None
    p: float | None
    p_holm: float | None
    n: int
    reason: str | None = None


def largest_residuals(difference_m: ArrayLike) -> tuple[LargestResidual, ...]:
    """Grubbs' test of the largest residual of each component of differences (n, k)."""
    found = [_component(column) for column in samples.checked_differences(difference_m).T]
    family = holm([each.p for each in found])
    return tuple(replace(each, p_holm=p) for each, p in zip(found, family, strict=True))


def _component(column: Floats) -> LargestResidual:
    n = len(column)
    if n == 0:
        return LargestResidual(None, None, None, None, None, n, samples.NO_POINTS)
    unit = samples.power_of_two(column)
    deviation = column / unit - np.mean(column / unit)
    point = int(np.argmax(np.abs(deviation)))
    largest = float(deviation[point])
    found = LargestResidual(point, unit * largest, None, None, None, n)
    if n < MIN_POINTS:
        return replace(found, reason=samples.TOO_FEW_POINTS)
    if not samples.has_scatter(column[:, None])[0]:
        return replace(found, reason=samples.NO_SCATTER)
    g = abs(largest) / float(np.std(column / unit, ddof=1))
    return replace(found, g=g, p=_p_value(g, n))


def _p_value(g: float, n: int) -> float:
    """Of n residuals: n P(abs(t) > t(g)), at most 1."""
    rest = (n - 1) ** 2 - n * g**2
    if rest <= 0.0:  # all other differences are equal: no larger g exists
        return 0.0
    t = g * math.sqrt(n * (n - 2) / rest)
    return min(1.0, 2.0 * n * float(special.stdtr(n - 2, -t)))
