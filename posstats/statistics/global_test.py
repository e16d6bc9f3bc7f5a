"""The global test of an adjustment, which asks whether the stated weights are right.

Null hypothesis: the observations have the stated standard deviations and no gross errors, so that
v'Pv follows the chi-square distribution of as many degrees of freedom as there is redundancy.
"""

from dataclasses import dataclass

import numpy as np
from scipy import stats


@dataclass(frozen=True)
class GlobalTest:
    """Whether the stated weights are right.

    Attributes
    ----------
    sigma0
        Standard deviation of unit weight; NaN without redundancy.
    dof
        Degrees of freedom.
    p
        Two-sided, of the chi-square distribution of v'Pv; NaN without redundancy.
    """

    sigma0: float
    dof: int
    p: float


def global_test(square_sum: float, dof: int) -> GlobalTest:
    """Chi-square test of v'Pv against the degrees of freedom."""
    if dof <= 0:
        return GlobalTest(float("nan"), dof, float("nan"))
    tail = min(stats.chi2.cdf(square_sum, dof), stats.chi2.sf(square_sum, dof))
    return GlobalTest(float(np.sqrt(square_sum / dof)), dof, 2.0 * float(tail))
