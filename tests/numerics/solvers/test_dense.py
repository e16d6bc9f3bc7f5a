"""Normal equations: closed forms, brute force, Monte Carlo."""

import numpy as np
import pytest

from posstats.errors import GeometryError
from posstats.numerics.solvers.dense import inverted, normals_factor, propagated


def system(seed=0):
    """Design (30, 4), noise mixing D (30, 40), arbitrary weights, prior weights of the unknowns."""
    rng = np.random.default_rng(seed)
    mixing = np.concatenate([np.eye(30), 0.3 * rng.standard_normal((30, 10))], axis=1)
    return rng.standard_normal((30, 4)), mixing, rng.uniform(0.5, 2.0, 30), np.full(4, 2.0)


def propagation_of(design, mixing, weight, prior):
    noise = mixing.T @ (weight[:, None] * design)
    normals = design.T @ (weight[:, None] * design) + np.diag(prior)
    return propagated(normals, noise.T @ noise, prior)


def test_solution_and_inverse_are_those_of_the_upper_triangle():
    design, _, weight, prior = system()
    normals = design.T @ (weight[:, None] * design) + np.diag(prior)
    inverse, factor = inverted(np.triu(normals)), normals_factor(np.triu(normals))
    np.testing.assert_allclose(inverse, np.linalg.inv(normals), rtol=1e-12)
    np.testing.assert_allclose(factor.solve(normals @ np.arange(4.0)), np.arange(4.0), atol=1e-13)


@pytest.mark.parametrize("diagonal", [[1.0, 0.0], [1.0, -1.0], [1.0, np.nan]])
def test_singular_normals_are_an_error(diagonal):
    with pytest.raises(GeometryError, match="singular"):
        normals_factor(np.diag(diagonal))


def test_propagation_and_variance_factor_agree_with_simulation():
    """20,000 draws of noise (sigma 0.7) and prior errors, weights that are not the right ones."""
    design, mixing, weight, prior = system()
    found = propagation_of(design, mixing, weight, prior)
    rng = np.random.default_rng(1)
    draws = 20_000
    noise = 0.7 * rng.standard_normal((draws, 40)) @ mixing.T
    truth = rng.standard_normal((draws, 4)) / np.sqrt(prior)  # prior values are zero
    observed = truth @ design.T + noise
    estimate = (observed * weight) @ design @ found.inverse
    spread = np.cov((estimate - truth).T)
    expected = found.covariance(0.49, np.arange(4))
    np.testing.assert_allclose(spread, expected, atol=0.03 * np.abs(expected).max())
    residual = observed - estimate @ design.T
    mean_square_sum = float(np.mean((residual**2) @ weight))
    noise_trace = float(weight @ np.sum(mixing**2, axis=1))
    assert found.variance_factor(mean_square_sum, noise_trace) == pytest.approx(0.49, rel=0.005)


def test_without_redundancy_there_is_no_variance_factor():
    found = propagation_of(np.eye(4), np.eye(4), np.ones(4), np.zeros(4))
    assert np.isnan(found.variance_factor(0.0, 4.0))


def test_covariance_of_some_unknowns_is_a_part_of_that_of_all():
    found = propagation_of(*system())
    some = np.array([3, 1])
    np.testing.assert_allclose(
        found.covariance(1.5, some), found.covariance(1.5, np.arange(4))[np.ix_(some, some)]
    )
