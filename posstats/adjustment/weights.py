"""Variance components of the groups of observations of a bundle adjustment.

The factor of a group is v'Pv over its redundancy; its expectation is 1 if all stated weights are
right, and its relative sampling error at least sqrt(2 / redundancy). Weights are estimated by
rescaling and adjusting again (Foerstner's form of the iterated estimation): at the solution every
factor is 1.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem

GROUPS = ("image", "gnss", "imu", "control")
LEAST_REDUNDANCY = 10.0
"""Of a group whose weight is estimated: below, the factor errs by 45 % and more."""
LEAST_FACTOR = 1e-6
"""Residuals a thousand times smaller than stated are those of perfect data: no weight follows."""
MOST_ROUNDS = 20
SETTLED = 0.01


@dataclass(frozen=True, eq=False)
class EstimatedWeights:
    """Outcome of the estimation.

    Attributes
    ----------
    problem, result
        With the estimated weights, and their adjustment.
    factor
        By group: estimated over stated variance; 1 of the groups that keep their weight.
    kept
        Groups that have observations and keep their weight: of too little redundancy to
        estimate it, or without residuals.
    converged
        Every factor of the other groups is within `SETTLED` of 1.
    """

    problem: BundleProblem
    result: AdjustedBundle
    factor: Mapping[str, float]
    kept: tuple[str, ...]
    converged: bool


def variance_factors(result: AdjustedBundle) -> dict[str, float]:
    """Factor of every group; NaN without redundancy."""
    return {
        name: result.groups[name].square_sum / result.groups[name].redundancy
        if result.groups[name].redundancy > 0.0
        else float("nan")
        for name in GROUPS
    }


def rescaled(problem: BundleProblem, factor: Mapping[str, float]) -> BundleProblem:
    """The problem with the stated variances of every group times its factor."""
    pos, control = problem.pos, problem.control
    return replace(
        problem,
        sigma_px=problem.sigma_px * np.sqrt(factor["image"]),
        pos=replace(
            pos,
            sigma_antenna_m=pos.sigma_antenna_m * np.sqrt(factor["gnss"]),
            sigma_angles_rad=pos.sigma_angles_rad * np.sqrt(factor["imu"]),
        ),
        control=replace(control, covariance_m2=control.covariance_m2 * factor["control"]),
    )


def estimate_weights(problem: BundleProblem) -> EstimatedWeights:
    """Estimate the variances of the groups; priors of parameters keep theirs.

    Raises
    ------
    ConvergenceError, GeometryError, UndeterminedError
        As `adjust`.
    """
    total = dict.fromkeys(GROUPS, 1.0)
    result = adjust(problem)
    for n_rounds in range(MOST_ROUNDS + 1):
        factor = _estimable(result)
        converged = all(abs(value - 1.0) <= SETTLED for value in factor.values())
        if converged or n_rounds == MOST_ROUNDS:
            break
        change = {name: factor.get(name, 1.0) for name in GROUPS}
        total = {name: total[name] * change[name] for name in GROUPS}
        problem = rescaled(problem, change)
        result = adjust(problem)
    kept = tuple(n for n in GROUPS if n not in factor and result.groups[n].n > 0)
    return EstimatedWeights(problem, result, total, kept, converged)


def _estimable(result: AdjustedBundle) -> dict[str, float]:
    """Factors of the groups whose weight can be estimated."""
    return {
        name: value
        for name, value in variance_factors(result).items()
        if result.groups[name].redundancy >= LEAST_REDUNDANCY and value > LEAST_FACTOR
    }
