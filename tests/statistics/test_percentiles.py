"""Percentiles of absolute errors: tables of the normal case, brute resampling, limits."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import integrate, stats

from posstats.statistics import percentiles
from posstats.statistics.percentiles import (
    ce_normal,
    le_normal,
    n_for_upper_limit,
    percentile_error,
    sample_percentile,
)
from posstats.statistics.samples import SampleError

sizes = st.lists(st.floats(0.0, 1e6), min_size=2, max_size=30)


@pytest.mark.parametrize(("share", "factor"), [(0.90, 1.6449), (0.95, 1.9600)])
def test_linear_errors_have_the_factors_of_the_tables(share, factor):
    assert round(le_normal(1.0, share), 4) == factor
    assert le_normal(0.25, share) == 0.25 * le_normal(1.0, share)


@pytest.mark.parametrize(("share", "factor"), [(0.90, 2.1460), (0.95, 2.4477)])
def test_circular_errors_have_the_factors_of_the_tables(share, factor):
    assert round(ce_normal(1.0, 1.0, 0.0, share), 4) == factor


@pytest.mark.parametrize("rho", [-0.99, -0.8, 0.0, 0.4, 0.8])
@pytest.mark.parametrize(("sigma_y", "share"), [(1.0, 0.90), (3.0, 0.95), (0.2, 0.95)])
def test_the_circle_holds_its_share_of_the_density(sigma_y, rho, share):
    """Another integral of it: over x, of the conditional distribution of y."""
    radius = ce_normal(1.0, sigma_y, rho, share)
    spread = sigma_y * np.sqrt(1.0 - rho**2)

    def density(x):
        half, centre = np.sqrt(max(radius**2 - x**2, 0.0)), rho * sigma_y * x
        inside = stats.norm.cdf(np.array([half, -half]), centre, spread)
        return stats.norm.pdf(x) * (inside[0] - inside[1])

    held = integrate.quad(density, -radius, radius, epsabs=1e-11, limit=400)[0]
    assert held == pytest.approx(share, abs=1e-8)


@pytest.mark.parametrize(
    "case", [(1.0, 0.0, 0.0), (0.0, 1.0, 0.5), (0.6, 0.8, 1.0), (0.6, 0.8, -1.0)]
)
def test_errors_along_one_line_have_the_linear_factor(case):
    assert ce_normal(*case, 0.95) == pytest.approx(le_normal(1.0, 0.95), rel=1e-12)


@given(st.floats(0.0, 1.0), st.floats(-1.0, 1.0), st.floats(0.01, 0.99))
def test_the_circle_lies_between_the_line_and_the_round_case(sigma_y, rho, share):
    radius = ce_normal(1.0, sigma_y, rho, share)
    assert le_normal(1.0, share) * (1 - 1e-12) <= radius
    larger = np.sqrt(np.linalg.eigvalsh([[1.0, rho * sigma_y], [rho * sigma_y, sigma_y**2]])[1])
    assert radius <= larger * np.sqrt(-2.0 * np.log1p(-share)) * (1 + 1e-12)
    assert ce_normal(sigma_y * 1e3, 1e3, rho, share) == pytest.approx(1e3 * radius, rel=1e-9)


def test_no_error_has_no_circle():
    assert ce_normal(0.0, 0.0, 0.0, 0.9) == 0.0


@pytest.mark.parametrize("case", [(-1.0, 1.0, 0.0), (np.nan, 1.0, 0.0), (1.0, 1.0, 1.1)])
def test_no_standard_deviations_are_refused(case):
    with pytest.raises(SampleError):
        ce_normal(*case, 0.9)


@pytest.mark.parametrize("share", [0.90, 0.95])
def test_percentiles_of_normal_errors_are_the_closed_form_within_two_percent(share):
    rng = np.random.default_rng(7)
    linear = percentile_error(np.abs(0.1 * rng.standard_normal(10_000)), share, seed=1)
    x, y = rng.multivariate_normal([0, 0], [[1.0, 0.8], [0.8, 4.0]], 10_000).T
    circular = percentile_error(np.hypot(x, y), share, seed=1)
    for found, truth in (
        (linear, le_normal(0.1, share)),
        (circular, ce_normal(1.0, 2.0, 0.4, share)),
    ):
        assert found.value == pytest.approx(truth, rel=0.02)
        assert found.low < truth < found.high
        assert found.high - found.low < 0.06 * truth


@given(sizes, st.floats(0.05, 0.99))
def test_the_sample_percentile_is_numpys_median_unbiased_quantile(values, share):
    expected = np.quantile(values, share, method="median_unbiased")
    assert sample_percentile(values, share) == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize(("n", "share"), [(12, 0.90), (40, 0.95), (200, 0.90)])
def test_the_order_statistics_drawn_are_those_of_resampling(n, share):
    """Quantiles of 20 000 percentiles, and of as many resamples of all n values."""
    values = np.sort(np.random.default_rng(n).rayleigh(size=n))
    drawn = percentiles._resampled(values, share, np.random.default_rng(1))
    resamples = np.random.default_rng(2).choice(values, (20_000, n))
    brute = np.quantile(resamples, share, axis=1, method="median_unbiased")
    assert stats.ks_2samp(drawn.round(9), brute.round(9)).pvalue > 0.001


def test_the_bootstrap_alone_would_fail_too_often_above():
    """Nominally in 2.5 % of samples."""
    rng = np.random.default_rng(4)
    truth, n_trials = ce_normal(1.0, 1.0, 0.0, 0.95), 300
    fails = 0
    for _ in range(n_trials):
        values = np.sort(rng.rayleigh(size=72))
        fails += np.quantile(percentiles._resampled(values, 0.95, rng), 0.975) < truth
    assert fails > stats.binom.ppf(0.999, n_trials, 0.025)


def test_the_same_seed_gives_the_same_limits():
    values = np.random.default_rng(3).rayleigh(size=80)
    assert percentile_error(values, 0.9, seed=5) == percentile_error(values[::-1], 0.9, seed=5)
    assert percentile_error(values, 0.9, seed=5) != percentile_error(values, 0.9, seed=6)


@pytest.mark.parametrize(
    ("share", "level", "n"),
    [(0.90, 0.95, 36), (0.95, 0.95, 72), (0.90, 0.90, 29), (0.95, 0.90, 59)],
)
def test_an_upper_limit_takes_the_points_of_the_binomial_table(share, level, n):
    """Two-sided 90 % is one-sided 95 %: the known 29 and 59."""
    assert n_for_upper_limit(share, level) == n
    values = np.random.default_rng(n).rayleigh(size=n)
    assert percentile_error(values, share, 1, level).high == values.max()
    fewer = percentile_error(values[1:], share, 1, level)
    assert (fewer.high, fewer.reason, fewer.n_for_high) == (None, "too_few_points", n)
    assert 0.0 < fewer.low < fewer.value


@given(sizes)
def test_limits_are_observed_values_about_the_percentile(values):
    found = percentile_error(values, 0.9, seed=1)
    assert min(values) <= found.low <= found.value <= max(values)


@pytest.mark.parametrize(
    ("values", "value", "low", "reason"),
    [
        ([], None, None, "no_points"),
        ([0.3], 0.3, None, "too_few_points"),
        ([0.3, 0.3], 0.3, 0.3, "too_few_points"),
        ([0.0] * 20, 0.0, 0.0, "too_few_points"),
        ([0.2] * 100, 0.2, 0.2, None),
        ([1e100] * 100, 1e100, 1e100, None),
    ],
)
def test_small_and_constant_samples_say_what_they_can(values, value, low, reason):
    found = percentile_error(values, 0.95, seed=1)
    assert (found.value, found.low, found.reason) == (value, low, reason)
    assert found.high == (value if reason is None else None)
    assert sample_percentile(values, 0.95) == value


@pytest.mark.parametrize("values", [[-0.1, 0.2], [[0.1, 0.2]], [np.nan, 0.1]])
def test_values_that_are_no_absolute_errors_are_refused(values):
    with pytest.raises(SampleError):
        percentile_error(values, 0.95, seed=1)
