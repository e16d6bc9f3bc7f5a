"""Tests of mean shift, normality and the largest residual: other software, size, invariance."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import stats
from statsmodels.stats.multivariate import test_mvmean as mvmean

from posstats.statistics.mean_shift import component_shifts, mean_shift
from posstats.statistics.normality import normality
from posstats.statistics.outliers import largest_residuals
from posstats.statistics.samples import SampleError

N_TRIALS = 4000


def size(p_values):
    """Share of p below 5 %, and the binomial limits (0.1 % each side) of a true 5 %."""
    low, high = stats.binom.ppf([0.001, 0.999], len(p_values), 0.05) / len(p_values)
    return low <= np.mean(np.array(p_values) < 0.05) <= high


@pytest.mark.parametrize(("n", "k"), [(4, 3), (8, 2), (30, 3), (3, 2)])
def test_hotellings_test_is_that_of_statsmodels(n, k):
    rng = np.random.default_rng(n)
    values = rng.standard_normal((n, k)) @ rng.standard_normal((k, k)) + 0.3
    found, expected = mean_shift(values), mvmean(values)
    assert found.t2 == pytest.approx(expected.t2, rel=1e-9)
    assert found.f == pytest.approx(expected.statistic, rel=1e-9)
    assert (found.df1, found.df2) == expected.df
    assert found.p == pytest.approx(expected.pvalue, rel=1e-9)


def test_students_test_is_that_of_scipy_and_hotellings_of_one_component():
    values = np.random.default_rng(4).normal(0.02, 0.1, (15, 3))
    for column, found in zip(values.T, component_shifts(values), strict=True):
        expected = stats.ttest_1samp(column, 0.0)
        assert found.t == pytest.approx(expected.statistic)
        assert found.p == pytest.approx(expected.pvalue)
        assert found.df == expected.df
        assert (found.mean, found.se) == (
            pytest.approx(column.mean()),
            pytest.approx(stats.sem(column)),
        )
        assert mean_shift(column).p == pytest.approx(found.p)


@given(st.integers(0, 2**32 - 1), st.floats(-1e3, 1e3))
def test_hotellings_test_is_the_same_in_any_units_and_axes(seed, angle):
    rng = np.random.default_rng(seed)
    values = rng.standard_normal((9, 2)) + 0.5
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    assert mean_shift(values @ turn * [1e-60, 1e80]).p == pytest.approx(
        mean_shift(values).p, rel=1e-6
    )


def test_hotellings_test_rejects_five_percent_of_blocks_without_shift():
    rng = np.random.default_rng(8)
    mix = np.array([[1.0, 0.8, 0.0], [0.0, 3.0, 0.5], [0.0, 0.0, 1.0]])
    assert size([mean_shift(rng.standard_normal((10, 3)) @ mix).p for _ in range(N_TRIALS)])


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        (np.empty((0, 3)), "no_points"),
        (np.eye(3), "too_few_points"),
        ([1.0], "too_few_points"),
        (np.zeros((5, 2)), "no_scatter"),
        ([[0.1, 1.0], [0.1, 2.0], [0.1, 4.0]], "no_scatter"),
        (np.outer(np.arange(5.0), [1.0, -2.0]), "collinear"),
        (np.outer([1.0, 5.0, 2.0, 4.0], [1e90, 1e-90]), "collinear"),
    ],
)
def test_a_shift_that_cannot_be_tested_says_why(values, reason):
    found = mean_shift(values)
    assert (found.t2, found.f, found.p, found.reason) == (None, None, None, reason)


@pytest.mark.parametrize(
    ("values", "mean", "reason"),
    [([], None, "no_points"), ([0.2], 0.2, "too_few_points"), ([0.2] * 3, 0.2, "no_scatter")],
)
def test_a_component_that_cannot_be_tested_says_why(values, mean, reason):
    (found,) = component_shifts(values)
    assert found.mean == (None if mean is None else pytest.approx(mean))
    assert (found.t, found.p, found.reason) == (None, None, reason)


def test_normality_is_scipys_for_each_component():
    values = np.random.default_rng(5).standard_normal((40, 2)) ** [1, 3]
    for column, found in zip(values.T, normality(values), strict=True):
        expected = stats.shapiro(column)
        assert (found.w, found.p) == (
            pytest.approx(expected.statistic),
            pytest.approx(expected.pvalue),
        )
    assert normality(values)[0].p > 0.05 > normality(values)[1].p


def test_normality_far_from_zero_is_that_near_it():
    values = np.round(np.random.default_rng(6).standard_normal(30), 3)
    for other in (values + 1e6, values * 1e90, values * 1e-300):
        assert normality(other)[0].w == pytest.approx(normality(values)[0].w, rel=1e-6)


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        ([], "no_points"),
        ([1.0, 2.0], "too_few_points"),
        ([0.1] * 9, "no_scatter"),
        (np.arange(5001.0), "too_many_points"),
    ],
)
def test_normality_that_cannot_be_tested_says_why(values, reason):
    (found,) = normality(values)
    assert (found.w, found.p, found.n, found.reason) == (None, None, len(values), reason)


@pytest.mark.parametrize("n", [5, 10, 30, 100])
def test_the_largest_residual_of_good_points_is_rejected_in_five_percent(n):
    rng = np.random.default_rng(n)
    assert size([largest_residuals(rng.standard_normal(n))[0].p for _ in range(N_TRIALS)])


@pytest.mark.parametrize(
    ("n", "critical"), [(3, 1.1543), (5, 1.7150), (10, 2.2900), (30, 2.9085), (100, 3.3841)]
)
def test_the_largest_residual_has_the_critical_values_of_grubbs_tables(n, critical):
    """Two-sided, 5 %; the tables' own formula, from Student's distribution."""
    t = stats.t.isf(0.05 / (2 * n), n - 2)
    assert (n - 1) / np.sqrt(n) * np.sqrt(t**2 / (n - 2 + t**2)) == pytest.approx(
        critical, abs=5e-5
    )
    found = [
        largest_residuals(sample)[0] for sample in np.random.default_rng(n).normal(size=(200, n))
    ]
    apart = [each for each in found if abs(each.g - critical) > 1e-4]  # four printed digits
    assert all((each.p < 0.05) == (each.g > critical) for each in apart)


def test_a_blunder_is_found_with_its_point_and_sign():
    values = np.random.default_rng(9).normal(0.0, 0.05, (20, 3))
    values[13, 2] -= 0.5
    found = largest_residuals(values)
    assert found[2].point == 13
    assert found[2].residual == pytest.approx(values[13, 2] - values[:, 2].mean())
    assert found[2].p_holm == pytest.approx(3 * found[2].p)
    assert found[2].p_holm < 1e-4 < found[0].p <= found[0].p_holm


@given(
    hnp.arrays(
        float, st.tuples(st.integers(3, 9), st.integers(1, 3)), elements=st.integers(-50, 50)
    )
)
def test_p_values_of_residuals_are_probabilities_and_holm_keeps_their_order(values):
    found = [each for each in largest_residuals(values) if each.reason is None]
    for each in found:
        assert 0.0 <= each.p <= each.p_holm <= 1.0
        assert np.sqrt((each.n - 1) / each.n) * (1 - 1e-9) <= each.g
        assert each.g <= (each.n - 1) / np.sqrt(each.n) * (1 + 1e-9)
    adjusted = [each.p_holm for each in sorted(found, key=lambda each: each.p)]
    assert adjusted == sorted(adjusted)


@pytest.mark.parametrize(
    ("values", "point", "reason"),
    [
        ([], None, "no_points"),
        ([0.3], 0, "too_few_points"),
        ([0.1, 0.3], 0, "too_few_points"),
        ([0.0] * 4, 0, "no_scatter"),
    ],
)
def test_a_residual_that_cannot_be_tested_says_why(values, point, reason):
    (found,) = largest_residuals(values)
    assert (found.point, found.g, found.p, found.p_holm, found.reason) == (
        point,
        None,
        None,
        None,
        reason,
    )


def test_one_point_off_an_otherwise_constant_sample_is_certain():
    (found,) = largest_residuals([0.0, 0.0, 0.0, 0.0, 7.0])
    assert (found.point, found.p) == (4, pytest.approx(0.0, abs=1e-12))


@pytest.mark.parametrize("test", [mean_shift, component_shifts, normality, largest_residuals])
def test_differences_that_are_not_finite_are_refused(test):
    with pytest.raises(SampleError, match="finite"):
        test([0.1, np.nan, 0.3])
