"""Variance components: weights stated wrong are found, in simulated blocks."""

from dataclasses import replace

import numpy as np
from dense_bundle import DenseBundle, noisy_problem

from posstats.bundle import adjust
from posstats.bundle_weights import GROUPS, estimate_weights, rescaled, variance_factors

STATED_WRONG = {"image": 4.0, "gnss": 0.25, "imu": 1.0, "control": 1.0}


def block(seed):
    """Observations of a balanced block: every group has a redundancy of 40 or more."""
    return noisy_problem(
        seed=seed, n_strips=3, n_images=8, n_points=150, n_control=20, sigma_position_m=0.15
    )


def test_factors_are_those_of_dense_algebra():
    problem = noisy_problem(seed=3)
    result = adjust(problem)
    dense = DenseBundle(problem, result)
    m, n = 2 * len(problem.point), len(problem.position_m)
    redundancy = np.diagonal(dense.of_residuals @ dense.weight)
    square = dense.residual * (dense.weight @ dense.residual)
    pos = np.arange(m, m + 6 * n).reshape(n, 6)
    rows = {
        "image": np.arange(m),
        "gnss": pos[:, :3].ravel(),
        "imu": pos[:, 3:].ravel(),
        "control": np.arange(m + 6 * n, len(square)),
    }
    for group, factor in variance_factors(result).items():
        at = rows[group]
        np.testing.assert_allclose(factor, square[at].sum() / redundancy[at].sum(), rtol=1e-5)


def test_weights_stated_wrong_by_two_and_a_half_come_back():
    """The factor of a group has the relative sampling error sqrt(2 / redundancy).

    It is that of a chi-square with the group's redundancy, somewhat more where groups are
    confused with each other: over ten blocks the squares of the errors in these units have a
    mean of 1, with the sampling error sqrt(2 / 10); 3 is more than four of them away.
    """
    error = {group: [] for group in GROUPS}
    for seed in range(10):
        found = estimate_weights(rescaled(block(seed), STATED_WRONG))
        assert found.converged
        assert found.kept == ()
        for group in GROUPS:
            redundancy = found.result.groups[group].redundancy
            assert redundancy > 25.0
            true_factor = 1.0 / STATED_WRONG[group]
            error[group].append(
                (found.factor[group] / true_factor - 1.0) / np.sqrt(2.0 / redundancy)
            )
    for group, values in error.items():
        assert np.mean(np.square(values)) < 3.0, group
        assert abs(np.mean(values)) < 1.3, group


def test_a_group_of_little_redundancy_keeps_its_weight_and_is_named():
    problem = noisy_problem(seed=4, n_control=2)
    found = estimate_weights(rescaled(problem, STATED_WRONG))
    assert found.kept == ("control",)
    assert found.factor["control"] == 1.0
    np.testing.assert_array_equal(
        found.problem.control.covariance_m2, problem.control.covariance_m2
    )


def test_perfect_observations_give_no_weights():
    problem = noisy_problem(noise=0.0, control_noise=0.0)
    found = estimate_weights(problem)
    assert set(found.factor.values()) == {1.0}
    assert set(found.kept) == set(GROUPS)


def test_estimated_weights_do_not_depend_on_those_stated():
    problem = block(1)
    one, other = (estimate_weights(each) for each in (problem, rescaled(problem, STATED_WRONG)))
    for group in GROUPS:
        # the iteration ends within 1 % of the fixed point; a step there is a tenth of the rest
        np.testing.assert_allclose(
            one.factor[group], other.factor[group] * STATED_WRONG[group], rtol=0.1
        )
    np.testing.assert_allclose(
        one.problem.sigma_px, problem.sigma_px * np.sqrt(one.factor["image"]), rtol=1e-12
    )
    assert replace(one.problem, sigma_px=problem.sigma_px).exposures is problem.exposures
