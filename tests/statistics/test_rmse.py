"""RMSE intervals: Satterthwaite's closed forms, limits, invariance, degenerate samples."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy import stats

from posstats.errors import PosstatsError
from posstats.statistics.rmse import MAX_POINTS, n_to_decide, rmse_interval
from posstats.statistics.samples import SampleError

lengths = st.floats(-1e3, 1e3).map(lambda value: round(value, 4))
differences = hnp.arrays(float, st.tuples(st.integers(3, 12), st.integers(1, 3)), elements=lengths)


def standardised(n, k, seed=1):
    """(n, k) values of mean exactly 0 and covariance exactly the unit matrix."""
    values = np.random.default_rng(seed).standard_normal((n, k))
    values -= values.mean(axis=0)
    return values @ np.linalg.inv(np.linalg.cholesky(values.T @ values / (n - 1))).T


def test_one_component_without_shift_has_n_degrees_of_freedom():
    """The textbook interval of a standard deviation of known mean."""
    found = rmse_interval(standardised(20, 1))
    low, high = np.sqrt(20 / stats.chi2.ppf([0.975, 0.025], 20))
    np.testing.assert_allclose(found.rmse, np.sqrt(19 / 20))
    assert found.df == pytest.approx(20, abs=1)
    assert found.low == pytest.approx(found.rmse * low, rel=0.03)
    assert found.high == pytest.approx(found.rmse * high, rel=0.03)


@pytest.mark.parametrize(
    ("shift", "covariance", "per_point"),
    [
        ([0.0], [1.0], 1.0),
        ([1.0], [1.0], 2 * 2**2 / (2 + 4)),
        ([0.0, 0.0], [1.0, 1.0], 2.0),
        ([0.0, 0.0], [1.0, 9.0], 2 * 10**2 / (2 * 82)),
        ([0.0, 0.0, 0.0], [1.0, 1.0, 1.0], 3.0),
        ([3.0, 0.0, 0.0], [1.0, 1.0, 4.0], 2 * 15**2 / (2 * 18 + 4 * 9)),
    ],
)
def test_degrees_of_freedom_of_many_points_are_satterthwaites(shift, covariance, per_point):
    values = np.array(shift) + standardised(20_000, len(shift)) * np.sqrt(covariance)
    found = rmse_interval(values)
    assert found.df_per_point == pytest.approx(per_point, rel=2e-3)
    assert found.rmse == pytest.approx(np.sqrt(np.sum(covariance) + np.sum(np.square(shift))), 1e-4)


def test_limits_follow_from_the_degrees_of_freedom_and_widen_with_the_level():
    values = np.random.default_rng(2).normal(0.05, 0.1, (15, 2))
    found, wide = rmse_interval(values), rmse_interval(values, level=0.99)
    quantile = stats.chi2.ppf([0.975, 0.025], found.df)
    np.testing.assert_allclose([found.low, found.high], found.rmse * np.sqrt(found.df / quantile))
    assert wide.low < found.low < found.rmse < found.high < wide.high


def test_a_large_shift_gives_students_interval_of_the_mean():
    """The RMSE of d = b + e, e much smaller than b, is the mean but for e^2 / 2b."""
    values = 1e4 + standardised(6, 1)
    found = rmse_interval(values)
    reach = stats.t.ppf(0.975, 5) / np.sqrt(6)
    assert found.high - found.low == pytest.approx(2 * reach, rel=1e-3)


@given(differences, st.integers(-300, 300))
def test_the_interval_turns_and_scales_with_the_differences(values, exponent):
    found = rmse_interval(values)
    unit = 2.0**exponent
    scaled = rmse_interval(values * unit)
    turned = rmse_interval(-values[::-1, ::-1])
    assert scaled.reason == turned.reason == found.reason
    assert scaled.rmse == pytest.approx(found.rmse * unit, rel=1e-12)
    if found.reason is None:
        assert 0.0 < found.low < found.rmse < found.high
        assert scaled.low == pytest.approx(found.low * unit, rel=1e-9)
        assert turned.high == pytest.approx(found.high, rel=1e-6)


@pytest.mark.parametrize(
    ("values", "rmse", "reason"),
    [
        ([], None, "no_points"),
        (np.empty((0, 3)), None, "no_points"),
        ([[3.0, 4.0]], 5.0, "too_few_points"),
        ([1.0, -1.0], 1.0, "too_few_points"),
        ([0.0, 0.0, 0.0], 0.0, "no_scatter"),
        ([0.1] * 7, 0.1, "no_scatter"),
        ([[1e90, -1e90]] * 4, np.sqrt(2) * 1e90, "no_scatter"),
    ],
)
def test_a_sample_without_interval_says_why(values, rmse, reason):
    found = rmse_interval(values)
    assert found.reason == reason
    assert found.rmse == (None if rmse is None else pytest.approx(rmse))
    assert (found.low, found.high, found.df, found.df_per_point) == (None,) * 4


@pytest.mark.parametrize(
    "values",
    [
        np.outer(np.arange(5.0), [1.0, 2.0, 3.0]),  # collinear
        [1e100, -1e100, 3e99],
        [1e-310, 2e-310, -1e-310],
        [1e6, 1e6 + 1e-8, 1e6 - 1e-8],  # a shift 1e14 times the scatter
        [0.0, 0.0, 0.0, 1.0],
        [[0.0, 1.0], [0.0, 2.0], [0.0, 1.5]],  # one component without scatter
    ],
)
def test_unusual_samples_have_a_finite_interval(values):
    found = rmse_interval(values)
    assert 0.0 < found.low < found.rmse < found.high < np.inf


@pytest.mark.parametrize(
    "values", [[1.0, np.nan], [np.inf, 1.0], [1e101], ["a"], 1.0, np.ones((2, 2, 2)), [[], []]]
)
def test_values_that_are_no_differences_are_refused(values):
    with pytest.raises(SampleError) as refused:
        rmse_interval(values)
    assert isinstance(refused.value, PosstatsError)
    assert isinstance(refused.value, ValueError)


@pytest.mark.parametrize("level", [0.0, 1.0, np.nan, 95])
def test_a_level_that_is_no_share_is_refused(level):
    with pytest.raises(SampleError, match="between 0 and 1"):
        rmse_interval([1.0, 2.0, 3.0], level)


@pytest.mark.parametrize("per_point", [0.9, 1.0, 2.0, 3.0])
@pytest.mark.parametrize("rmse", [0.05, 0.09, 0.11, 0.2])
def test_the_number_that_decides_is_the_first_one_found_by_trying_all(rmse, per_point):
    n = np.arange(3, 2000)
    quantile = stats.chi2.ppf([[0.975], [0.025]], n * per_point)
    low, high = rmse * np.sqrt(n * per_point / quantile)
    outside = (high < 0.1) | (low > 0.1)
    assert n_to_decide(rmse, 0.1, per_point) == n[np.argmax(outside)]


def test_no_number_decides_where_the_rmse_is_the_limit():
    assert n_to_decide(0.1, 0.1, 2.0) is None
    assert n_to_decide(0.1, 0.1001, 2.0) is None
    assert MAX_POINTS / 2 < n_to_decide(0.1, 0.1005, 1.0) < MAX_POINTS


@given(differences, st.floats(0.0, 2e3))
def test_more_points_than_measured_are_asked_for_just_where_the_interval_holds_the_limit(
    values, limit
):
    found = rmse_interval(values)
    if found.reason is None and not np.isclose(limit, [found.low, found.high]).any():
        needed = n_to_decide(found.rmse, limit, found.df_per_point)
        assert (needed is None or needed > len(values)) == (found.low < limit < found.high)


@pytest.mark.parametrize("case", [(-1.0, 1.0, 1.0), (1.0, np.inf, 1.0), (1.0, 2.0, 0.0)])
def test_a_case_without_meaning_is_refused(case):
    with pytest.raises(SampleError, match="must be lengths"):
        n_to_decide(*case)
