"""Rows of results.json against the fits and errors that they are made from."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest
from small_blocks import Layout, true_block

from posstats.analysis.angle_errors import adjusted_errors
from posstats.analysis.regression import AngleRegression
from posstats.analysis.rows import angle_error_rows, angle_error_summary_rows, regression_row
from posstats.statistics.drift import fit_constant, fit_drift

TIME = np.array([0.0, 12.0, 31.0, 45.0, 90.0, 140.0]) + 57_000.0
ERROR = np.array([1.3, -0.4, 0.9, 2.1, 1.2, 4.2]) * 1e-4
KNOWN = np.diag([1.0, 9.0, 1.0, 4.0, 1.0, 25.0]) * 1e-10


@pytest.mark.parametrize("prefix", ["", "gls_"])
def test_a_regression_row_is_its_fit_at_the_time_of_origin(prefix):
    ols, gls = fit_drift(TIME, ERROR), fit_drift(TIME, ERROR, KNOWN)
    constant = fit_constant(ERROR, KNOWN)
    row = vars(
        regression_row(
            AngleRegression("omega", "ground", "block", 6, 2, ols, gls, None, constant, True)
        )
    )
    fit = gls if prefix else ols
    origin = row["time_origin_s"]
    at, se = fit.intercept_at(origin)
    assert (row[f"{prefix}intercept_rad"], row[f"{prefix}slope_rad_per_s"]) == (at, fit.slope)
    assert row["gls_intercept_se" if prefix else "intercept_se_rad"] == se
    assert row[f"{prefix}slope_se"] == fit.slope_se
    low, high = row[f"{prefix}slope_ci95"]
    assert (low, high) == fit.conf_int()
    assert low < fit.slope < high
    covariance = fit.coefficient_covariance(origin)
    assert row[f"{prefix}cov_intercept_slope"] == covariance[0, 1]
    assert row["gls_df_resid" if prefix else "df_resid"] == fit.df_resid
    assert row[f"{prefix}p_value"] == fit.f_pvalue
    assert (row["r_squared"], row["f_statistic"]) == (ols.rsquared, ols.f_statistic)
    assert row["sigma_rad"] == ols.sigma
    assert row["white_noise_sigma_rad"] == gls.white_noise_sigma
    assert (row["constant_rad"], row["constant_se_rad"]) == (constant.value, constant.se)
    assert (row["n"], row["n_strips"]) == (6, 2)


@pytest.fixture(scope="module")
def frame():
    """Errors of which no two columns, means or signs are alike, and one image without."""
    truth = true_block(Layout(n_points=20))
    n = len(truth.orientations)
    rng = np.random.default_rng(3)
    error = rng.normal([0.003, -0.002, 0.001], [1e-4, 3e-4, 9e-4], (n, 3))
    pos = replace(truth.orientations, angles_rad=truth.orientations.angles_rad + error)
    errors = adjusted_errors(replace(truth, orientations=pos, adjusted=truth.orientations))
    sigma = rng.uniform(1e-5, 9e-5, (n, 3))
    covariance = np.diag(sigma.ravel() ** 2).reshape(n, 3, n, 3)
    used = np.arange(n) != 4
    return SimpleNamespace(
        frame="ground", errors=replace(errors, covariance_rad2=covariance, used=used)
    ), (error, sigma, used)


def test_summaries_are_of_the_used_errors_with_their_mean_in_the_rms(frame):
    made, (error, sigma, used) = frame
    for axis, row in enumerate(angle_error_summary_rows(made)):
        column = error[used, axis]
        assert row.angle == ("omega", "phi", "kappa")[axis]
        assert row.n == used.sum()
        assert row.mean_rad == pytest.approx(column.mean())
        assert row.rms_rad == pytest.approx(np.sqrt(np.mean(column**2)))
        assert row.max_abs_rad == pytest.approx(np.abs(column).max())
        assert row.median_sigma_rad == pytest.approx(np.median(sigma[used, axis]))


def test_errors_of_images_stand_beside_their_own_standard_deviations(frame):
    made, (error, sigma, used) = frame
    for k, row in enumerate(angle_error_rows([made])):
        assert row.used == used[k]
        for axis, angle in enumerate(("omega", "phi", "kappa")):
            assert getattr(row, f"{angle}_rad") == pytest.approx(error[k, axis], abs=1e-13)
            assert getattr(row, f"sigma_{angle}_rad") == pytest.approx(sigma[k, axis])
