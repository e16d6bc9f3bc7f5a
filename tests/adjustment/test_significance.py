"""Tests of adjustments against dense algebra, scipy's distributions and simulation."""

from dataclasses import replace

import numpy as np
import pytest
from dense_bundle import DenseBundle, noisy_problem
from scipy import stats

from posstats.adjustment.significance import (
    correlations,
    critical_value,
    largest_effects,
    local_tests,
    noncentrality,
    parameter_tests,
)
from posstats.adjustment.weights import GROUPS, rescaled
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.parameters import GNSS_SHIFTS, IMU_SHIFTS, CommonParameter
from posstats.statistics.global_test import global_test

SHIFTS = (
    *(CommonParameter(name) for name in GNSS_SHIFTS),
    *(CommonParameter(name, sigma=1e-3) for name in IMU_SHIFTS),
)


def correlated(control):
    """The same control with coordinates that are correlated."""
    turn = np.array([[1.0, 0.4, 0.2], [0.0, 1.0, 0.5], [0.0, 0.0, 1.0]])
    return replace(control, covariance_m2=turn @ control.covariance_m2 @ turn.T)


@pytest.fixture(scope="module")
def solved():
    problem = noisy_problem(SHIFTS)
    problem = replace(problem, control=correlated(problem.control))
    result = adjust(problem)
    return problem, result, DenseBundle(problem, result)


def test_local_tests_are_those_of_dense_algebra(solved):
    problem, result, dense = solved
    gradient = dense.weight @ dense.residual
    curvature = np.diagonal(dense.weight @ dense.of_residuals @ dense.weight)
    redundancy = np.diagonal(dense.of_residuals @ dense.weight)
    m, n = 2 * len(problem.point), len(problem.position_m)
    pos = np.arange(m, m + 6 * n).reshape(n, 6)
    rows = {
        "image": np.arange(m).reshape(-1, 2),
        "gnss": pos[:, :3],
        "imu": pos[:, 3:],
        "control": m + 6 * n + np.arange(3 * len(problem.control.point)).reshape(-1, 3),
    }
    tests = local_tests(problem, result)
    for group, at in rows.items():
        checked = redundancy[at] > 0.01
        test = tests[group]
        assert test.n_unchecked == (~checked).sum()
        assert checked.sum() > 10
        for mine, theirs in (
            (test.w, gradient[at] / np.sqrt(curvature[at])),
            (test.detectable, (3.2905267 + 0.8416212) / np.sqrt(curvature[at])),
            (test.blunder, -gradient[at] / curvature[at]),
        ):
            np.testing.assert_array_equal(np.isfinite(mine), checked)
            scale = np.abs(theirs[checked]).max()
            np.testing.assert_allclose(mine[checked], theirs[checked], rtol=1e-4, atol=1e-5 * scale)


def test_parameter_tests_are_those_of_dense_algebra(solved):
    problem, result, dense = solved
    dof = len(dense.residual) - dense.design.shape[1]
    sigma0 = np.sqrt(dense.residual @ dense.weight @ dense.residual / dof)
    prior = np.array([1e6 * (parameter.sigma is not None) for parameter in SHIFTS])
    measured = np.linalg.inv(dense.cofactor)
    measured[-6:, -6:] -= np.diag(prior)
    noise = sigma0**2 * measured
    noise[-6:, -6:] += np.diag(prior)
    sigma = np.sqrt(np.diagonal(dense.cofactor @ noise @ dense.cofactor))[-6:]
    tests = parameter_tests(problem, result)
    for at, test in enumerate(tests):
        t = result.common[at] / sigma[at]
        assert (test.name, test.scope) == (SHIFTS[at].name, "block")
        assert test.unit == ("m" if at < 3 else "rad")
        np.testing.assert_allclose([test.t, test.p], [t, 2 * stats.t.cdf(-abs(t), dof)], rtol=1e-5)
        assert test.significant == (test.p < 0.05)
        assert test.determined
    chi2 = stats.chi2(dof).cdf(sigma0**2 * dof)
    whole = global_test(result.square_sum, result.dof)
    np.testing.assert_allclose(
        [whole.sigma0, whole.dof, whole.p], [sigma0, dof, 2 * min(chi2, 1 - chi2)], rtol=1e-6
    )


def test_strongest_correlation_with_an_orientation_is_that_of_dense_algebra(solved):
    problem, result, dense = solved
    n = len(problem.position_m)
    cofactor = dense.cofactor
    sigma = np.sqrt(np.diagonal(cofactor))
    both = cofactor / np.outer(sigma, sigma)
    found = correlations(result)
    for at in range(3):  # projection centres, which differ by no rotation between angles
        centres = both[: 6 * n, -6 + at].reshape(n, 6)
        assert found.element[at] == 3 + at
        np.testing.assert_allclose(
            found.with_image[at], centres[found.image[at], 3 + at], rtol=1e-4
        )
        assert abs(found.with_image[at]) > np.abs(centres[:, 3:]).max() - 1e-4


def test_a_height_shift_and_a_lever_arm_of_nadir_images_are_one_unknown():
    parameters = tuple(
        CommonParameter(name) for name in ("gnss_z_shift", "gnss_x_shift", "lever_arm_w")
    )
    problem = noisy_problem(parameters)
    result = adjust(problem)
    found = correlations(result)
    assert (found.first.tolist(), found.second.tolist()) == ([0], [2])
    assert found.value[0] < -0.95
    # tilts of 0.01 tell them apart: 0.05 m / (0.014 sqrt(8)) = 1.3 m, 25 times 0.05 m
    tests = parameter_tests(problem, result)
    assert [test.determined for test in tests] == [False, True, False]


def test_a_prior_that_outweighs_the_measurements_leaves_a_parameter_undetermined():
    loose, tight = (
        parameter_tests(problem, adjust(problem))[0]
        for problem in (
            noisy_problem((CommonParameter("gnss_z_shift", sigma=s),)) for s in (1.0, 1e-3)
        )
    )
    assert loose.determined
    assert not tight.determined


@pytest.mark.parametrize("factor", [0.25, 4.0])
def test_a_parameter_known_from_its_prior_alone_has_the_priors_sigma_whatever_sigma0(factor):
    # a shift of 0.1 mm beside GNSS of centimetres: nothing but its prior knows it
    problem = noisy_problem((CommonParameter("gnss_z_shift", sigma=1e-4),))
    result = adjust(rescaled(problem, dict.fromkeys(GROUPS, factor)))
    assert abs(result.sigma0 * np.sqrt(factor) - 1.0) < 0.2
    assert parameter_tests(problem, result)[0].sigma == pytest.approx(1e-4, rel=0.01)


def test_the_sigma_of_a_parameter_is_the_scatter_where_priors_are_right_and_weights_are_not():
    # the prior knows a shift as well as the measurements, stated half as accurate as they are
    sigma_m, rng = 0.02, np.random.default_rng(11)
    error, sigma = [], []
    for seed in range(150):
        shift = sigma_m * rng.standard_normal()
        problem = noisy_problem((CommonParameter("gnss_x_shift", sigma=sigma_m),), seed=seed)
        moved = problem.pos.antenna_m + np.array([shift, 0.0, 0.0])
        problem = replace(problem, pos=replace(problem.pos, antenna_m=moved))
        problem = rescaled(problem, dict.fromkeys(GROUPS, 4.0))
        test = parameter_tests(problem, adjust(problem))[0]
        error.append(test.value - shift)
        sigma.append(test.sigma)
    ratio = np.mean(np.square(error)) / np.mean(np.square(sigma))
    assert abs(ratio - 1.0) < 4.0 * np.sqrt(2.0 / 150)


def test_largest_effects_of_the_camera_are_those_of_differences():
    names = (
        "camera_c", "camera_x0", "camera_y0", "bauer_s1", "bauer_s2", "bauer_s3",
        "brown_k1", "brown_k2", "brown_k3", "brown_p1", "brown_p2",
    )  # fmt: skip
    problem = noisy_problem(tuple(CommonParameter(name) for name in names))
    c, mm = problem.distance_px[0], problem.mm_per_px[0]
    x, y = problem.xy_px.T
    a, b, r2 = x / c, y / c, (x**2 + y**2) / c**2
    ring = mm**2 * (x**2 + y**2) - problem.bauer_radius_mm**2
    zero, one = np.zeros_like(x), np.ones_like(x)
    moved = [
        (a, b), (one, zero), (zero, one), (x * ring, y * ring), (zero, x), (-x, y),
        (x * r2, y * r2), (x * r2**2, y * r2**2), (x * r2**3, y * r2**3),
        (-2 * c * a * b, -c * (r2 + 2 * b**2)), (c * (r2 + 2 * a**2), 2 * c * a * b),
    ]  # fmt: skip
    expected = [np.hypot(*each).max() / problem.sigma_px[0] for each in moved]
    np.testing.assert_allclose(largest_effects(problem), expected, rtol=1e-12)


def test_critical_value_and_noncentrality_are_baardas():
    np.testing.assert_allclose([critical_value(), noncentrality()], [3.29, 4.13], atol=5e-3)


def test_rates_of_rejection_without_blunders_are_those_stated():
    # 60 blocks: p of the chi-square test is uniform, |w| is beyond 1.96 in 5 % of all cases
    p, beyond = [], {"image": [], "gnss": [], "imu": [], "control": []}
    for seed in range(60):
        problem = noisy_problem(seed=seed)
        result = adjust(problem)
        p.append(global_test(result.square_sum, result.dof).p)
        for group, test in local_tests(problem, result).items():
            w = test.w[np.isfinite(test.w)]
            beyond[group].append(np.mean(np.abs(w) > critical_value(0.05)))
    assert stats.kstest(p, "uniform").pvalue > 0.01
    for group, rates in beyond.items():
        error = np.std(rates, ddof=1) / np.sqrt(len(rates))
        assert abs(np.mean(rates) - 0.05) < 3.0 * error, group


def test_parameters_without_effect_are_significant_in_a_twentieth_of_blocks_whatever_the_scale():
    # 6 parameters in 100 blocks: 30 +- 5.3; all stated standard deviations are twice the true ones
    parameters = tuple(CommonParameter(name) for name in (*GNSS_SHIFTS, *IMU_SHIFTS))
    significant = 0
    for seed in range(100):
        problem = rescaled(noisy_problem(parameters, seed=seed), dict.fromkeys(GROUPS, 4.0))
        significant += sum(t.significant for t in parameter_tests(problem, adjust(problem)))
    assert 14 <= significant <= 46


def test_a_blunder_of_the_detectable_size_is_found_with_the_stated_power():
    # 150 blocks, 0.80 +- 0.033
    first = noisy_problem()
    detectable = local_tests(first, adjust(first))["gnss"].detectable[3, 0]
    found = 0
    for seed in range(150):
        problem = noisy_problem(seed=seed)
        antenna = problem.pos.antenna_m.copy()
        antenna[3, 0] += detectable
        problem = replace(problem, pos=replace(problem.pos, antenna_m=antenna))
        w = local_tests(problem, adjust(problem))["gnss"].w[3, 0]
        found += abs(w) > critical_value()
    assert 0.68 < found / 150 < 0.92
