"""Do 95 % intervals of the drift cover 95 %? A fast part of benchmarks/interval_coverage.py."""

import runpy

import numpy as np
import pytest
from helpers import ROOT
from scipy import stats

from posstats.statistics.drift import fit_drift

BENCHMARK = ROOT / "benchmarks" / "interval_coverage.py"
N_TRIALS = 400


@pytest.fixture(scope="module")
def benchmark():
    return runpy.run_path(str(BENCHMARK))


@pytest.mark.parametrize("number", [0, 1, 2])
def test_gls_intervals_of_the_block_cover_the_drift(benchmark, number):
    """Bounds: binomial limits (0.1 % each side) of a true coverage of 93 to 97 %."""
    setting = benchmark["SETTINGS"][number]
    hits = ols_hits = 0
    for errors in benchmark["modelled_errors"](setting, 12, N_TRIALS, seed=20 + number):
        time, error = errors.time_s, errors.error_rad[:, 0]
        gls = fit_drift(time, error, errors.covariance_rad2[:, 0, :, 0], strip=errors.strip)
        low, high = gls.conf_int()
        ols_low, ols_high = fit_drift(time, error).conf_int()
        hits += low <= 0.0 <= high
        ols_hits += ols_low <= 0.0 <= ols_high
    assert stats.binom.ppf(0.001, N_TRIALS, 0.93) <= hits
    assert hits <= stats.binom.ppf(0.999, N_TRIALS, 0.97)
    assert ols_hits < stats.binom.ppf(0.001, N_TRIALS, 0.93)


@pytest.mark.parametrize("number", [0, 1])
def test_gls_intervals_of_a_strip_cover_the_drift(benchmark, number):
    setting = benchmark["SETTINGS"][number]
    hits = 0
    for errors in benchmark["modelled_errors"](setting, 12, N_TRIALS, seed=30 + number):
        first = np.arange(12)
        covariance = errors.covariance_rad2[:12, 1, :12, 1]
        low, high = fit_drift(
            errors.time_s[first], errors.error_rad[first, 1], covariance
        ).conf_int()
        hits += low <= benchmark["DRIFTS_RAD_PER_S"][1] <= high
    assert stats.binom.ppf(0.001, N_TRIALS, 0.93) <= hits
    assert hits <= stats.binom.ppf(0.999, N_TRIALS, 0.97)
