"""Do 95 % intervals of acceptance hold the truth in 95 % of cases?

A fast part of benchmarks/acceptance_coverage.py. Bounds: binomial limits (0.1 % each side) of a
true coverage of 93 to 97 %.
"""

import runpy

import pytest
from helpers import ROOT
from scipy import stats

BENCHMARK = ROOT / "benchmarks" / "acceptance_coverage.py"
N_TRIALS = 1000


@pytest.fixture(scope="module")
def benchmark():
    return runpy.run_path(str(BENCHMARK))


@pytest.fixture(scope="module")
def cases(benchmark):
    return {case.name: case for case in benchmark["cases"]()}


@pytest.mark.parametrize("n", [5, 10, 30])
@pytest.mark.parametrize(
    "name",
    [
        "V no shift",
        "V shift 3 sigma each",
        "H no shift",
        "H sigma 1:3, shift 1 sigma each",
        "3D sigma 1:3, x shifted",
        "3D correlation 0.8",
    ],
)
def test_intervals_of_the_rmse_hold_the_true_one(benchmark, cases, name, n):
    held, _, _ = benchmark["rmse_coverage"](cases[name], n, N_TRIALS, seed=100 + n)
    assert stats.binom.ppf(0.001, N_TRIALS, 0.93) <= round(held * N_TRIALS)
    assert round(held * N_TRIALS) <= stats.binom.ppf(0.999, N_TRIALS, 0.97)


def test_plain_estimates_of_the_degrees_of_freedom_hold_it_too_seldom(benchmark, cases):
    plain, narrow = benchmark["alternatives"](cases["V shift 3 sigma each"], 5, 20_000, seed=1)
    assert plain < narrow < 0.91


@pytest.mark.parametrize("number", range(4))
@pytest.mark.parametrize("n", [20, 72])
def test_intervals_of_percentiles_hold_the_true_one(benchmark, number, n):
    """They hold for any continuous distribution, so often in more than 95 %."""
    name, draw, truth, share = benchmark["PERCENTILES"][number]
    held, _, _, has_high = benchmark["percentile_coverage"](draw, truth, share, n, 200, seed=n)
    assert has_high == (n >= (36 if name.endswith("90") else 72))
    assert round(held * 200) >= stats.binom.ppf(0.001, 200, 0.95)
