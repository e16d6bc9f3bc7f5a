"""Robust scale and weights: closed forms on a normal distribution's quantiles."""

import numpy as np
import pytest
from scipy import stats

from posstats.numerics.solvers.robust import (
    HUBER,
    REJECTION,
    huber_weights,
    kept_weights,
    median_scale,
)


def test_the_scale_of_normal_residuals_is_their_standard_deviation():
    n = 100_001
    residuals = 2.5 * stats.norm.ppf((np.arange(n) + 0.5) / n)
    assert median_scale(residuals) == pytest.approx(2.5, rel=1e-4)


def test_the_scale_leaves_out_what_is_unknown_and_has_a_floor():
    assert median_scale(np.array([1.0, np.nan, -1.0])) == 1.4826
    assert median_scale(np.zeros(3)) == 0.01
    assert median_scale(np.zeros(3), 0.5) == 0.5


def test_huber_bounds_the_influence_of_large_residuals():
    size = np.array([0.0, HUBER, 2.0 * HUBER, np.inf])
    np.testing.assert_array_equal(huber_weights(2.0 * size, 2.0), [1.0, 1.0, 0.5, 0.0])


def test_residuals_beyond_the_limit_are_rejected():
    size = np.array([0.0, REJECTION, np.nextafter(REJECTION, 4.0), np.inf])
    np.testing.assert_array_equal(kept_weights(size, 1.0), [1.0, 1.0, 0.0, 0.0])
