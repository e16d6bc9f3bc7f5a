"""Prior values of additional parameters that the measurements contradict.

A prior is an observation of 0 like others, and is judged like them: by the estimate over the
standard deviation that the estimate's difference from the prior has. A contradicted prior would
not bias what the measurements determine, but spoil sigma0 and all tests.
"""

from dataclasses import replace

import numpy as np

from posstats.adjustment.significance import parameter_tests
from posstats.bundle import adjust
from posstats.bundle.parameters import BLOCK, CommonParameter
from posstats.bundle.problem import AdjustedBundle, BundleProblem

CONTRADICTED = 4.0
"""Standard deviations beyond which measurements contradict a prior."""
_ROUNDS = 2  # what strips have in common first, then single parameters


def with_fitting_priors(problem: BundleProblem, adjusted: AdjustedBundle) -> BundleProblem:
    """The problem without contradicted priors.

    Where most strips contradict the prior of a shift or drift, they have a part in common: a free
    parameter of the block is added, from which the strips then differ. (Without their priors the
    strips' IMU shifts could not be told from the boresight.) Otherwise the prior goes.
    """
    for _ in range(_ROUNDS):
        contradicted = _contradicted(problem, adjusted)
        if not contradicted:
            break
        problem = _changed(problem, contradicted)
        adjusted = adjust(problem)
    return problem


def _contradicted(problem: BundleProblem, adjusted: AdjustedBundle) -> list[CommonParameter]:
    """Parameters that the measurements determine, at another value than their prior."""
    tests = parameter_tests(problem, adjusted)
    variances = np.diagonal(adjusted.common_covariance)
    return [
        each
        for each, test, variance in zip(problem.parameters, tests, variances, strict=True)
        if each.sigma is not None
        and test.determined
        and (test.value - each.value) ** 2 > CONTRADICTED**2 * (each.sigma**2 - variance)
    ]


def _changed(problem: BundleProblem, contradicted: list[CommonParameter]) -> BundleProblem:
    present = {(each.name, each.scope) for each in problem.parameters}
    common = [
        name
        for name in dict.fromkeys(each.name for each in contradicted if each.scope != BLOCK)
        if (name, BLOCK) not in present and _of_most_strips(name, problem, contradicted)
    ]
    freed = [each for each in contradicted if each.name not in common]
    kept = [replace(e, sigma=None) if e in freed else e for e in problem.parameters]
    added = [CommonParameter(name) for name in common]
    return replace(problem, parameters=(*added, *kept))


def _of_most_strips(name: str, problem: BundleProblem, contradicted: list[CommonParameter]) -> bool:
    """Whether more than half of a parameter's strips contradict its prior."""
    n_strips = sum(each.name == name for each in problem.parameters)
    return 2 * sum(each.name == name for each in contradicted) > n_strips > 1
