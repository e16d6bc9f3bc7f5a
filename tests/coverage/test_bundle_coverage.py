"""Are the adjustment's intervals worth what they say? A fast part of benchmarks/bundle_coverage.py.

The squared length of a whitened error of q unknowns of one block is chi-square of q degrees of
freedom, and blocks are independent: the sum over the blocks has exact limits.
"""

import runpy

import numpy as np
import pytest
from helpers import ROOT
from scipy import stats

from posstats.numerics.kernels.rotation import wrapped

BENCHMARK = ROOT / "benchmarks" / "bundle_coverage.py"
N_BLOCKS = 16
SURE = 0.001
"""Probability of failing on each side, were the covariances right."""


@pytest.fixture(scope="module")
def benchmark():
    return runpy.run_path(str(BENCHMARK))


@pytest.fixture(scope="module")
def adjusted(benchmark):
    """What was observed of each block with drifts of the strips, and its adjustment."""
    setting = benchmark["SETTINGS"][0]
    return [benchmark["adjusted"](setting, 5000 + at) for at in range(N_BLOCKS)]


def square(error, covariance):
    return float(error @ np.linalg.solve(covariance, error))


def orientation(observed, result):
    """Of an image in the corner of the block, where it is held least."""
    true, found = observed.block.adjusted, result.orientations
    error = [
        wrapped(found.angles_rad - true.angles_rad)[0],
        (found.position_m - true.position_m)[0],
    ]
    return np.concatenate(error), result.scale**2 * result.adjusted.orientation_covariance[0]


def parameters(observed, result):
    """All boresight angles, shifts and drifts together: their correlations count."""
    error = [t.value - observed.value[t.name, t.scope] for t in result.parameters]
    return np.array(error), result.scale**2 * result.adjusted.common_covariance


def tie_point(observed, result):
    tie = np.flatnonzero(np.char.startswith(observed.block.tie_points.point_id.astype(str), "T"))
    at = tie[len(tie) // 2]
    error = result.adjusted.ground_m[at] - observed.ground_m[at]
    return error, result.scale**2 * result.adjusted.ground_covariance_m2[at]


def check_point(observed, result):
    """The first: the benchmark's simulation numbers check points before all others."""
    error = result.check_point_position_m[0] - observed.ground_m[0]
    return error, result.check_point_covariance_m2[0]


@pytest.mark.parametrize("unknowns", [orientation, parameters, tie_point, check_point])
def test_errors_are_as_large_as_their_covariances_say(adjusted, unknowns):
    """Standard deviations wrong by a half are outside of the limits, for each of the four."""
    whitened = [unknowns(observed, result) for observed, result in adjusted]
    total = sum(square(*each) for each in whitened)
    dof = sum(len(error) for error, _ in whitened)
    low, high = stats.chi2.ppf([SURE, 1.0 - SURE], dof)
    assert low < total < high
    assert high < 1.5**2 * dof
    assert low > dof / 1.5**2


def test_sigma0_is_that_of_right_weights_and_good_rays_stay(adjusted):
    """Rays taken out are the largest residuals, without which sigma0 is too small."""
    results = [result for _, result in adjusted]
    assert sum(result.rejected.sum() for result in results) <= 1
    dof = sum(result.adjusted.dof for result in results)
    square_sum = sum(result.adjusted.square_sum for result in results)
    low, high = stats.chi2.ppf([SURE, 1.0 - SURE], dof)
    assert low < square_sum < high


def test_95_percent_intervals_hold_the_truth_in_93_to_97_percent(benchmark, adjusted):
    """As far as so few blocks can tell: four standard errors beyond."""
    table = benchmark["averaged"]([benchmark["shares"](*each) for each in adjusted])
    for name in benchmark["TOTALS"]:
        share, error = table[name][0]
        assert 0.93 - 4.0 * error < share < 0.97 + 4.0 * error, name


@pytest.mark.parametrize(("number", "right"), [(3, False), (4, True)])
def test_wrong_weights_are_noticed_and_estimated_ones_are_right(benchmark, number, right):
    """Intervals of the weights as stated (too large and too small by 2), and as estimated."""
    setting = benchmark["SETTINGS"][number]
    blocks = [benchmark["adjusted"](setting, 6000 + at) for at in range(4)]
    table = benchmark["averaged"]([benchmark["shares"](*each) for each in blocks])
    share, error = table["orientations"][1]
    assert (abs(share - 0.95) < 4.0 * error) == right
