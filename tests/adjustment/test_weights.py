"""Variance components: weights stated wrong are found, in simulated blocks."""

import numpy as np
from dense_bundle import DenseBundle, noisy_problem

from posstats.adjustment.weights import GROUPS, estimate_weights, rescaled, variance_factors
from posstats.numerics.bundle import adjust

STATED_WRONG = {"image": 4.0, "gnss": 0.25, "imu": 1.0, "control": 1.0}


def block(seed, n_control=20):
    """Observations of a block in which every group has a redundancy of 10 or more."""
    return noisy_problem(
        seed=seed, n_strips=3, n_images=8, n_points=150, n_control=n_control, sigma_position_m=0.15
    )


def group_rows(problem):
    """The rows of `DenseBundle` of every group."""
    m, n = 2 * len(problem.point), len(problem.position_m)
    pos = np.arange(m, m + 6 * n).reshape(n, 6)
    control = np.arange(3 * len(problem.control.point))
    return dict(
        zip(
            GROUPS,
            (np.arange(m), pos[:, :3].ravel(), pos[:, 3:].ravel(), m + 6 * n + control),
            strict=True,
        )
    )


def test_factors_are_those_of_dense_algebra():
    problem = noisy_problem(seed=3)
    result = adjust(problem)
    dense = DenseBundle(problem, result)
    redundancy = np.diagonal(dense.of_residuals @ dense.weight)
    square = dense.residual * (dense.weight @ dense.residual)
    factors = variance_factors(result)
    for group, at in group_rows(problem).items():
        expected = square[at].sum() / redundancy[at].sum()
        np.testing.assert_allclose(factors[group], expected, rtol=1e-5)


def sampling_error(problem):
    """(4,) standard deviations of factors at the fixed point, by Helmert's equations.

    2 S^-1 is the covariance of variance components, S_ij = tr(P_i Qv P_j Qv) of the groups'
    weights: more than 2 / redundancy, as residuals of one group contain errors of the others.
    """
    dense = DenseBundle(problem, adjust(problem))
    whitened = np.sqrt(np.diagonal(dense.weight))  # the weights are diagonal here
    square = (whitened[:, None] * dense.of_residuals * whitened) ** 2
    rows = group_rows(problem).values()
    sums = [[square[np.ix_(i, j)].sum() for j in rows] for i in rows]
    return np.sqrt(np.diagonal(2.0 * np.linalg.inv(sums)))


def test_weights_stated_wrong_by_two_and_a_half_come_back():
    """Mean squares of errors, in units of their sampling error, of 20 blocks: chi-square / 20.

    2.5 is exceeded once in 3,000 times; the mean of the errors leaves +-0.9 once in 18,000.
    """
    expected = np.array([1.0 / STATED_WRONG[group] for group in GROUPS])
    errors = []
    for seed in range(20):
        found = estimate_weights(rescaled(block(seed), STATED_WRONG))
        assert found.converged
        assert found.kept == ()
        errors.append(np.array([found.factor[group] for group in GROUPS]) / expected - 1.0)
    in_units = np.array(errors) / sampling_error(block(0))
    assert (np.mean(in_units**2, axis=0) < 2.5).all()
    assert (np.abs(np.mean(in_units, axis=0)) < 0.9).all()


def test_a_group_of_little_redundancy_keeps_its_weight_and_is_named():
    problem = block(4, n_control=2)
    found = estimate_weights(rescaled(problem, STATED_WRONG))
    assert found.kept == ("control",)
    assert found.converged
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
