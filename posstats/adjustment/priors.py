"""Prior values of additional parameters that the measurements contradict.

A prior is an observation of 0 like others, and is judged like them: by the estimate over the
standard deviation that the estimate's difference from the prior has. A contradicted prior would
not bias what the measurements determine, but spoil sigma0 and all tests. A control point that
contradicts more than any prior does is wrong itself, and no witness against priors.
"""

from dataclasses import replace

import numpy as np

from posstats.adjustment.significance import local_tests, parameter_tests
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.parameters import BLOCK, CommonParameter
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem

CONTRADICTED = 4.0
"""Standard deviations beyond which measurements contradict a prior."""
_ROUNDS = 2  # what strips have in common first, then single parameters


def with_fitting_priors(problem: BundleProblem, adjusted: AdjustedBundle) -> BundleProblem:
    """The problem without contradicted priors.

    Where most strips contradict the prior of a shift or drift, they have a part in common: a free
    parameter of the block is added, from which the strips then differ. (Without their priors the
    strips' IMU shifts could not be told from the boresight.) Otherwise the prior goes.
    """
    judged, adjusted = _without_wrong_control(problem, adjusted)
    for _ in range(_ROUNDS):
        contradicted = list(_contradicted(judged, adjusted))
        if not contradicted:
            break
        judged = _changed(judged, contradicted)
        adjusted = adjust(judged)
    return replace(problem, parameters=judged.parameters)


def _without_wrong_control(
    problem: BundleProblem, adjusted: AdjustedBundle
) -> tuple[BundleProblem, AdjustedBundle]:
    """Without control points, but for the last, that contradict more than any prior does.

    Of a single wrong observation the standardised residual is the largest of all.
    """
    while len(problem.control.point) > 1:
        priors = _contradicted(problem, adjusted).values()
        w = np.nan_to_num(np.abs(local_tests(problem, adjusted)["control"].w).max(axis=1))
        if not priors or w.max() <= max(priors):
            break
        problem = _without_control_point(problem, int(w.argmax()))
        adjusted = adjust(problem)
    return problem, adjusted


def _without_control_point(problem: BundleProblem, row: int) -> BundleProblem:
    rows = np.delete(np.arange(len(problem.control.point)), row)
    return replace(problem, control=problem.control.subset(rows))


def _contradicted(problem: BundleProblem, adjusted: AdjustedBundle) -> dict[CommonParameter, float]:
    """Parameters that the measurements determine, at another value than their prior: with |w|."""
    tests = parameter_tests(problem, adjusted)
    variances = np.diagonal(adjusted.common_covariance)
    return {
        each: abs(test.value - each.value) / float(np.sqrt(each.sigma**2 - variance))
        for each, test, variance in zip(problem.parameters, tests, variances, strict=True)
        if each.sigma is not None
        and test.determined
        and (test.value - each.value) ** 2 > CONTRADICTED**2 * (each.sigma**2 - variance)
    }


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
