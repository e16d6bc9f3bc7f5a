"""fit_drift: oracles are NIST, statsmodels, the source paper's table, closed forms, invariance."""

import csv
import itertools
import re

import numpy as np
import pandas as pd
import pytest
import statsmodels.api as sm
from helpers import shared_path
from scipy import stats

from posstats.errors import PosstatsError
from posstats.statistics.drift import FitError, fit_constant, fit_drift, time_clusters


def noisy_line(n=60, slope=4.68e-7, sigma=1e-5, seed=1):
    rng = np.random.default_rng(seed)
    time = np.arange(n) * 15.125
    return time, 0.018 + slope * time + sigma * rng.standard_normal(n)


def correlated_covariance(n, sigma=1e-5):
    lag = np.abs(np.arange(n)[:, None] - np.arange(n))
    return sigma**2 * np.exp(-lag / 4.0)


def norris():
    text = shared_path("oracles", "nist", "Norris.dat").read_text()
    data = np.array([line.split() for line in text.splitlines()[60:96]], dtype=float)

    def numbers(label):
        return [float(v) for v in re.search(rf"^ *{label} +(.*)$", text, re.M)[1].split()]

    return data[:, 1], data[:, 0], numbers


def assert_digits(value, certified, digits=12):
    assert abs(value / certified - 1.0) < 0.5 * 10.0 ** (1 - digits)


def test_norris_to_twelve_digits():
    x, y, certified = norris()
    fit = fit_drift(x, y)
    intercept, intercept_se = fit.intercept_at(0.0)
    (b0, s0), (b1, s1) = certified("B0"), certified("B1")
    _, regression_ss, regression_ms, f_statistic = certified("Regression")
    df, residual_ss, residual_ms = certified("Residual")
    assert_digits(intercept, b0)
    assert_digits(intercept_se, s0)
    assert_digits(fit.slope, b1)
    assert_digits(fit.slope_se, s1)
    assert_digits(fit.sigma, certified("Standard Deviation")[0])
    assert_digits(fit.rsquared, certified("R-Squared")[0])
    assert_digits(fit.f_statistic, f_statistic)
    assert_digits(np.sum(fit.residuals**2), residual_ss)
    assert_digits(fit.sigma**2, residual_ms)
    assert_digits(fit.f_statistic * fit.sigma**2, regression_ms)
    assert_digits(np.sum((y - fit.residuals - y.mean()) ** 2), regression_ss)
    assert (fit.df_model, fit.df_resid, fit.n) == (1, df, 36)


@pytest.mark.parametrize("origin", [3.5e5, 1.2e9, 1.46e9, 1.7e9])
@pytest.mark.parametrize("gls", [False, True])
def test_time_origin_changes_nothing(origin, gls):
    time, error = noisy_line()
    covariance = correlated_covariance(60) if gls else None
    here, there = fit_drift(time, error, covariance), fit_drift(time + origin, error, covariance)
    for name in ("slope", "slope_se", "rsquared", "f_statistic", "f_pvalue", "df_resid"):
        assert getattr(there, name) == pytest.approx(getattr(here, name), rel=1e-10)
    assert there.conf_int() == pytest.approx(here.conf_int(), rel=1e-10)
    assert there.intercept_at(origin) == pytest.approx(here.intercept_at(0.0), rel=1e-10)


def test_published_p_values_follow_from_f_with_58_degrees_of_freedom():
    table = shared_path("paper", "table3.csv")
    with table.open() as file:
        rows = list(csv.DictReader(file))
    assert [row["angle"] for row in rows] == ["phi", "omega", "kappa"]
    for row in rows:
        # Data of n = 60 whose F is the published one: a line plus an orthogonal residual.
        time = np.arange(60.0)
        line = (time - 29.5) / np.linalg.norm(time - 29.5)
        wave = np.cos(np.pi * np.arange(60))
        wave -= wave.mean() + line * (line @ wave)
        published = float(row["f_statistic"])
        error = np.sqrt(published) * line + np.sqrt(58.0) * wave / np.linalg.norm(wave)
        fit = fit_drift(time, error)
        assert fit.f_statistic == pytest.approx(published, rel=1e-12)
        assert fit.f_pvalue == pytest.approx(float(row["p_value"]), abs=1.1e-4)
        assert fit.rsquared == pytest.approx(float(row["r_squared"]), abs=6e-4)


def test_gls_without_white_noise_is_that_of_statsmodels():
    time, _ = noisy_line()
    covariance = correlated_covariance(60)
    # Half the scatter that the covariance says: REML has no room for white noise.
    error = 0.5 * np.linalg.cholesky(covariance) @ np.random.default_rng(2).standard_normal(60)
    fit = fit_drift(time, error, covariance)
    peer = sm.GLS(error * 1e5, sm.add_constant(time / 900.0), sigma=covariance * 1e10).fit()
    assert fit.white_noise_sigma == 0.0
    assert fit.slope == pytest.approx(peer.params[1] * 1e-5 / 900.0, rel=1e-9)
    se = np.sqrt(peer.normalized_cov_params[1, 1]) * 1e-5 / 900.0
    assert fit.slope_se == pytest.approx(se, rel=1e-9)
    assert fit.conf_int(0.9)[1] == pytest.approx(fit.slope + stats.norm.ppf(0.95) * se, rel=1e-5)


def test_gls_with_nothing_known_is_ols():
    time, error = noisy_line()
    ols, gls = fit_drift(time, error), fit_drift(time, error, np.zeros((60, 60)))
    for name in ("slope", "slope_se", "rsquared", "f_statistic", "df_resid", "sigma"):
        assert getattr(gls, name) == pytest.approx(getattr(ols, name), rel=1e-8)
    assert gls.white_noise_sigma == pytest.approx(ols.sigma, rel=1e-8)


def test_covariance_is_absolute():
    time, error = noisy_line(sigma=1e-9)
    fit = fit_drift(time, error, 1e-10 * np.eye(60))
    expected = 1e-5 / np.sqrt(np.sum((time - time.mean()) ** 2))
    assert fit.slope_se == pytest.approx(expected, rel=1e-9)


def test_white_noise_is_added_to_the_covariance():
    time, error = noisy_line(n=400, sigma=3e-5)
    fit = fit_drift(time, error, correlated_covariance(400, sigma=1e-6))
    assert fit.white_noise_sigma == pytest.approx(3e-5, rel=0.1)


def test_sizes_of_strip_effect_and_white_noise_are_found():
    rng = np.random.default_rng(5)
    strip = np.repeat(list("abcdefghijkl"), 20)
    time = np.arange(240.0) * 10.0
    error = 1e-4 * np.repeat(rng.standard_normal(12), 20) + 1e-5 * rng.standard_normal(240)
    plain = fit_drift(time, error, np.zeros((240, 240)))
    strips = fit_drift(time, error, np.zeros((240, 240)), strip=strip)
    assert strips.strip_effect_sigma == pytest.approx(1e-4, rel=0.5)
    assert strips.white_noise_sigma == pytest.approx(1e-5, rel=0.1)
    assert plain.strip_effect_sigma is None


def test_order_of_images_changes_nothing():
    time, error = noisy_line()
    covariance = correlated_covariance(60)
    strip = np.repeat(list("abcde"), 12)
    order = np.random.default_rng(3).permutation(60)
    here = fit_drift(time, error, covariance, strip=strip)
    there = fit_drift(
        time[order], error[order], covariance[np.ix_(order, order)], strip=strip[order]
    )
    assert there.slope == pytest.approx(here.slope, rel=1e-9)
    assert there.slope_se == pytest.approx(here.slope_se, rel=1e-6)
    np.testing.assert_allclose(there.residuals, here.residuals[order], atol=1e-14)


def test_intercept_and_its_covariance_anywhere():
    time, error = noisy_line()
    fit = fit_drift(time, error)
    peer = sm.OLS(error, sm.add_constant(time)).fit()
    assert fit.intercept_at(0.0) == pytest.approx((peer.params[0], peer.bse[0]), rel=1e-9)
    np.testing.assert_allclose(fit.coefficient_covariance(0.0), peer.cov_params(), rtol=1e-8)
    value, se = fit.predict(time)
    np.testing.assert_allclose(value + fit.residuals, error, rtol=1e-14)
    np.testing.assert_allclose(se, peer.get_prediction().se_mean, rtol=1e-9)


@pytest.mark.parametrize("known", [None, 0.0, 1e-10])
@pytest.mark.parametrize("value", [0.0, 1.0, -0.1, 0.018])
def test_constant_response_has_no_drift(known, value):
    covariance = None if known is None else known * np.eye(5)
    fit = fit_drift(np.arange(5.0), np.full(5, value), covariance)
    assert (fit.rsquared, fit.f_statistic, fit.f_pvalue) == (0.0, 0.0, 1.0)
    assert all(np.isfinite([*fit.conf_int(), *fit.intercept_at(2.0), fit.sigma, fit.df_resid]))
    assert fit.intercept_at(9.0)[0] == pytest.approx(value)


@pytest.mark.parametrize(
    ("covariance", "strip"),
    [(None, None), (np.zeros((4, 4)), None), (np.zeros((4, 4)), ["a", "a", "b", "b"])],
)
def test_exact_line_has_unbounded_f(covariance, strip):
    fit = fit_drift([0, 1, 2, 4], [0.1, 0.3, 0.5, 0.9], covariance, strip=strip)
    assert (fit.rsquared, fit.f_statistic, fit.f_pvalue) == (1.0, None, 0.0)
    assert fit.slope == pytest.approx(0.2)
    assert all(np.isfinite(fit.conf_int()))


def test_exact_line_with_known_covariance_keeps_its_uncertainty():
    fit = fit_drift([0, 1, 2, 4], [0.0, 1.0, 2.0, 4.0], 0.01 * np.eye(4))
    assert fit.f_statistic == pytest.approx(1.0 / fit.slope_se**2)
    assert fit.slope_se == pytest.approx(0.1 / np.sqrt(8.75))


@pytest.mark.parametrize("scale", [1e-100, 1e-30, 1e30, 1e100])
def test_size_of_the_errors_does_not_matter(scale):
    time, error = noisy_line()
    fit, scaled = fit_drift(time, error), fit_drift(time, scale * error)
    assert scaled.slope == pytest.approx(scale * fit.slope, rel=1e-10)
    assert scaled.f_statistic == pytest.approx(fit.f_statistic, rel=1e-9)


@pytest.mark.parametrize("kind", [list, tuple, pd.Series, np.float32])
def test_kinds_of_input(kind):
    time, error = [0.0, 1.0, 2.0, 3.0], [0.0, 1.5, 1.75, 3.0]
    convert = kind if kind is not np.float32 else np.array
    fit = fit_drift(convert(time), convert(error))
    assert fit.slope == pytest.approx(fit_drift(np.array(time), np.array(error)).slope)


def test_float32_input():
    time = np.arange(4, dtype=np.float32)
    error = np.array([0.0, 1.5, 1.75, 3.0], dtype=np.float32)
    assert fit_drift(time, error).slope == pytest.approx(0.925, rel=1e-12)


THREE = [0.0, 1.0, 2.0]


@pytest.mark.parametrize(
    ("time", "error", "covariance", "strip", "words"),
    [
        ([], [], None, None, "0 images are too"),
        ([0.0, 1.0], [0.0, 1.0], None, None, "2 images are too"),
        ([5.0, 5.0, 5.0], [0.0, 1.0, 2.0], None, None, "times are equal"),
        ([0.0, np.nan, 2.0], THREE, None, None, "finite"),
        (THREE, [0.0, np.inf, 2.0], None, None, "finite"),
        (THREE, [0.0, 1.0], None, None, "equal length"),
        ([THREE], [THREE], None, None, "equal length"),
        (0.0, 0.0, None, None, "equal length"),
        (["a", "b", "c"], THREE, None, None, "numbers"),
        (THREE, [None, {}, 1.0], None, None, "numbers"),
        (THREE, [0.0, 3.0, 1.0], np.eye(2), None, "must be 3 x 3"),
        (THREE, [0.0, 3.0, 1.0], np.ones(3), None, "must be 3 x 3"),
        (THREE, [0.0, 3.0, 1.0], [[1, 2, 0], [0, 1, 0], [0, 0, 1]], None, "not symmetric"),
        (THREE, [0.0, 3.0, 1.0], -np.eye(3), None, "positive semidefinite"),
        (THREE, [0.0, 3.0, 1.0], [[1, 2, 0], [2, 1, 0], [0, 0, 1]], None, "positive semi"),
        (THREE, [0.0, 3.0, 1.0], np.full((3, 3), np.nan), None, "must be finite"),
        (THREE, [0.0, 3.0, 1.0], "none", None, "numbers"),
        (THREE, [0.0, 3.0, 1.0], None, ["a", "b", "b"], "needs a covariance"),
        (THREE, [0.0, 3.0, 1.0], np.eye(3), ["a"], "strip ids"),
    ],
)
def test_impossible_fits_say_why(time, error, covariance, strip, words):
    with pytest.raises(FitError, match=words) as caught:
        fit_drift(time, error, covariance, strip=strip)
    assert isinstance(caught.value, PosstatsError)
    assert isinstance(caught.value, ValueError)


@pytest.mark.parametrize("level", [0.0, 1.0, 95.0, np.nan])
def test_confidence_level_out_of_range(level):
    with pytest.raises(FitError, match="between 0 and 1"):
        fit_drift(THREE, [0.0, 3.0, 1.0]).conf_int(level)


def test_rounding_of_the_covariance_is_forgiven():
    time, error = noisy_line()
    covariance = correlated_covariance(60)
    rounded = covariance.astype(np.float32) + 1e-16 * np.triu(np.ones((60, 60)))
    fit, exact = fit_drift(time, error, rounded), fit_drift(time, error, covariance)
    assert fit.slope == pytest.approx(exact.slope, rel=1e-3)
    assert fit.slope_se == pytest.approx(exact.slope_se, rel=1e-3)


def test_singular_covariance_leaves_the_strips_free():
    # Rank one: a common constant, known to nothing; the rest is white noise.
    time, error = noisy_line()
    free = fit_drift(time, error, np.full((60, 60), 1e-2))
    assert free.slope == pytest.approx(fit_drift(time, error).slope, rel=1e-6)
    assert free.slope_se == pytest.approx(fit_drift(time, error).slope_se, rel=1e-6)
    assert free.intercept_at(450.0)[1] == pytest.approx(0.1, rel=1e-3)


def strips(n_strips, per_strip, turn=300.0, interval=10.0):
    return np.concatenate(
        [
            k * (per_strip * interval + turn) + interval * np.arange(per_strip)
            for k in range(n_strips)
        ]
    )


@pytest.mark.parametrize(
    ("time", "clusters"),
    [
        (strips(5, 60), 5),
        (strips(1, 60), 1),
        (strips(5, 60)[::-1], 5),
        (np.delete(strips(1, 60), [20, 21]), 1),
        (np.repeat(strips(3, 20), 2), 3),
        ([7.0, 7.0], 1),
    ],
)
def test_time_clusters(time, clusters):
    assert time_clusters(time) == clusters


def test_constant_of_white_noise_is_the_mean_with_its_t_test():
    _, error = noisy_line(slope=0.0)
    fit = fit_constant(error)
    peer = stats.ttest_1samp(error, 0.0)
    assert fit.value == pytest.approx(error.mean())
    assert fit.value / fit.se == pytest.approx(peer.statistic)
    assert fit.df_resid == pytest.approx(59)
    assert fit_constant(1e-5 - fit.value + error).value == pytest.approx(1e-5)


def test_constant_of_equal_errors():
    assert fit_constant([2.0, 2.0, 2.0]).p_value == 0.0
    assert fit_constant([0.0, 0.0, 0.0]).p_value == 1.0


def test_slope_between_strips_has_s_minus_2_degrees_of_freedom():
    """Exposures of a strip at one time: all that is known of the slope are S strip means."""
    strip = np.repeat(np.arange(6), 30)
    rng = np.random.default_rng(8)
    error = 1e-3 * rng.standard_normal(6)[strip] + 1e-7 * rng.standard_normal(180)
    fit = fit_drift(strip * 1000.0, error, 1e-14 * np.eye(180), strip=strip)
    means = fit_drift(np.arange(6) * 1000.0, error.reshape(6, 30).mean(axis=1))
    assert fit.df_resid == pytest.approx(4.0, rel=1e-3)
    assert fit.slope == pytest.approx(means.slope, rel=1e-6)
    assert fit.slope_se == pytest.approx(means.slope_se, rel=1e-3)


def test_slope_within_strips_does_not_rest_on_strip_means():
    strip = np.repeat(np.arange(6), 30)
    time = strip * 1000.0 + np.tile(np.arange(30.0), 6)
    rng = np.random.default_rng(8)
    error = 1e-3 * rng.standard_normal(6)[strip] + 1e-7 * rng.standard_normal(180)
    fit = fit_drift(time, error, 1e-14 * np.eye(180), strip=strip)
    within = np.tile(np.arange(30.0) - 14.5, 6)
    assert fit.slope == pytest.approx(within @ error / (within @ within), abs=0.2 * fit.slope_se)
    assert fit.df_resid > 100


def test_reml_of_balanced_strips_is_the_analysis_of_variance():
    rng = np.random.default_rng(4)
    n_strips, m = 8, 15
    error = np.repeat(3.0 * rng.standard_normal(n_strips), m) + rng.standard_normal(n_strips * m)
    strip = np.repeat(np.arange(n_strips), m)
    fit = fit_constant(error, np.zeros((n_strips * m,) * 2), strip=strip)
    groups = error.reshape(n_strips, m)
    between = m * groups.mean(axis=1).var(ddof=1)
    assert fit.se**2 == pytest.approx(between / (n_strips * m), rel=1e-4)
    assert fit.df_resid == pytest.approx(n_strips - 1, rel=1e-4)


def test_higher_levels_give_wider_intervals():
    fit = fit_drift([0.0, 1.0, 2.0, 3.0], [0.0, 1.0, 0.5, 2.0])
    levels = [fit.conf_int(level) for level in (0.5, 0.9, 0.99)]
    for (low, high), (lower, higher) in itertools.pairwise(levels):
        assert lower < low < high < higher
