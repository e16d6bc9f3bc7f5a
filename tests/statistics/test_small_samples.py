"""What a few observations cost: oracles are closed forms written out here."""

import math

import numpy as np
import pytest
from scipy import stats

from posstats.statistics.drift import fit_constant, fit_drift
from posstats.statistics.linear_model import generalised_least_squares
from posstats.statistics.percentiles import percentile_error
from posstats.statistics.rmse import rmse_interval

KNOWN = np.array([1.0, 4.0, 1.0, 9.0, 2.0, 4.0]) * 1e-2
"""Variances of six independent observations, before white noise."""
ERRORS = np.array([1.3, -0.4, 0.9, 2.1, -1.2, 0.2])


def test_standard_error_of_a_mean_pays_for_weights_that_were_estimated():
    """Kenward and Roger (1997) for one mean and one component, with w the weights of six values.

    Var(s2) = 2 / tr(PP), P the projector of REML; se^2 = 1/Sw + 2 Var(s2) (Sw3 - Sw2^2/Sw) / Sw^2.
    """
    fit = generalised_least_squares(ERRORS, np.ones((6, 1)), np.diag(KNOWN), None)
    assert fit.white_noise_variance > 0.1
    weight = 1.0 / (KNOWN + fit.white_noise_variance)
    first, second, third = (float(np.sum(weight**k)) for k in (1, 2, 3))
    spread = 2.0 / (second - 2.0 * third / first + (second / first) ** 2)
    inflation = 2.0 * spread * (third - second**2 / first) / first**2
    assert fit.covariance[0, 0] == pytest.approx(1.0 / first + inflation, rel=1e-9)
    # Satterthwaite: 2 v^2 / Var(v), dv/ds2 = Sw2 / Sw^2
    slope = second / first**2
    assert fit.df[0] == pytest.approx(2.0 / first**2 / (spread * slope**2), rel=1e-9)


def test_standard_error_of_a_slope_pays_for_weights_that_were_estimated():
    """The same for a line through six images, the matrices of the paper written out densely."""
    time = np.arange(6.0)
    known = np.diag(KNOWN * [1, 30, 1, 30, 1, 30])
    fit = generalised_least_squares(ERRORS, np.column_stack([np.ones(6), time]), known, None)
    white = fit.white_noise_variance
    assert white > 0.1
    x = np.column_stack([np.ones(6), time])
    v = np.linalg.inv(known + white * np.eye(6))
    phi = np.linalg.inv(x.T @ v @ x)
    projector = v - v @ x @ phi @ x.T @ v
    spread = 2.0 / np.trace(projector @ projector)
    p, q = -x.T @ v @ v @ x, x.T @ v @ v @ v @ x
    inflated = phi + 2.0 * spread * phi @ (q - p @ phi @ p) @ phi
    np.testing.assert_allclose(fit.covariance, inflated, rtol=1e-8)
    assert inflated[1, 1] > 1.1 * phi[1, 1]  # the case shows the term


def test_a_mean_of_balanced_strips_has_their_number_less_one_and_no_more():
    """Balanced one-way layout: weights do not matter, so t(S - 1) of the strip means is exact."""
    means = np.array([1.0, 4.0, -2.0, 3.0])
    error = (means[:, None] + [-0.1, 0.3, -0.2]).ravel()
    strip = np.repeat(np.arange(4), 3)
    fit = fit_constant(error, np.zeros((12, 12)), strip=strip)
    peer = stats.ttest_1samp(means, 0.0)
    assert fit.value == pytest.approx(1.5)
    assert fit.se == pytest.approx(math.sqrt(means.var(ddof=1) / 4), rel=1e-3)
    assert fit.df_resid == pytest.approx(3.0, rel=1e-3)
    assert fit.p_value == pytest.approx(peer.pvalue, rel=1e-2)


def test_an_ordinary_line_of_four_images_is_that_of_scipy():
    time, error = np.array([0.0, 1.0, 3.0, 7.0]), np.array([0.2, 0.1, 0.9, 1.3])
    fit, peer = fit_drift(time, error), stats.linregress(time, error)
    assert fit.slope == pytest.approx(peer.slope)
    assert fit.slope_se == pytest.approx(peer.stderr)
    assert fit.f_pvalue == pytest.approx(peer.pvalue)
    reach = stats.t.ppf(0.975, 2) * peer.stderr
    assert fit.conf_int() == pytest.approx((peer.slope - reach, peer.slope + reach))
    # away from the reference the line is known less: s^2 (1/n + (t - mean)^2 / Stt)
    at = 10.0
    scatter = np.sum((time - time.mean()) ** 2)
    se = fit.sigma * math.sqrt(0.25 + (at - time.mean()) ** 2 / scatter)
    assert fit.intercept_at(at) == pytest.approx((peer.intercept + at * peer.slope, se))


@pytest.mark.parametrize("n", [8, 12, 15, 30, 80])
def test_limits_of_a_percentile_are_not_inside_those_of_order_statistics(n):
    """x_(i) is above the percentile with P(Bin(n, 0.9) < i); the values are their own ranks."""
    found = percentile_error(np.arange(1.0, n + 1.0), 0.9, seed=1)
    rank = max(i for i in range(1, n + 1) if stats.binom.cdf(i - 1, n, 0.9) <= 0.025)
    assert found.low == rank
    if found.high is not None:
        highest = min(i for i in range(1, n + 1) if stats.binom.sf(i - 1, n, 0.9) <= 0.025)
        assert found.high >= highest


def test_limits_of_an_rmse_are_those_of_the_chi_square_distribution():
    """One component of zero mean: n Q / sigma^2 is chi-square with n degrees of freedom."""
    values = np.array([0.03, -0.03, 0.04, -0.04, 0.02, -0.02])
    found = rmse_interval(values)
    square_sum = float(values @ values)
    assert found.rmse == pytest.approx(math.sqrt(square_sum / 6))
    assert found.df == pytest.approx(6.0)
    low, high = (math.sqrt(square_sum / stats.chi2.ppf(q, 6)) for q in (0.975, 0.025))
    assert (found.low, found.high) == pytest.approx((low, high))
    assert low < found.rmse < high


def test_degrees_of_freedom_of_few_shifted_points_are_those_of_one_component_written_out():
    """s^2 of five values: tr SS = f / (f + 2) s^4, m'Sm = m^2 s^2 - tr SS / n; F = t / z widens."""
    values = np.array([0.9, 1.6, 0.4, 1.2, 1.9])
    n, f = 5, 4
    mean, variance = values.mean(), values.var(ddof=1)
    scatter = f / (f + 2) * variance**2
    shift = mean**2 * variance - scatter / n
    total = 2.0 * scatter + 4.0 * shift
    plain = 2.0 * n * (values @ values / n) ** 2 / total - 2.0
    assert plain > n
    widening = stats.t.ppf(0.975, f * total / (4.0 * shift)) / stats.norm.ppf(0.975)
    found = rmse_interval(values)
    assert found.df == pytest.approx(plain / widening**2, rel=1e-9)
