"""Dropping of additional parameters: what was put into the block stays, what was not goes."""

from dataclasses import replace

import numpy as np
import pytest
from dense_bundle import noisy_problem

from posstats.adjustment.parameter_choice import select_parameters
from posstats.adjustment.significance import parameter_tests
from posstats.errors import UndeterminedError
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.parameters import (
    GNSS_DRIFTS,
    GNSS_SHIFTS,
    IMU_DRIFTS,
    IMU_SHIFTS,
    CommonParameter,
    drift_parameters,
)

FREE = drift_parameters((*GNSS_SHIFTS, *GNSS_DRIFTS, *IMU_SHIFTS, *IMU_DRIFTS), ("block",))
EXTRA = tuple(CommonParameter(name) for name in ("camera_x0", "bauer_s2", "brown_k1"))


def drifting(parameters, seed=1):
    """The omega of the IMU drifts by 5e-6 rad/s, antenna positions are off by 5 m in X."""
    problem = noisy_problem(parameters, seed=seed, n_control=6)
    since = problem.exposures.time_s - problem.exposures.time_s.min()
    angles, antenna = problem.pos.angles_rad.copy(), problem.pos.antenna_m.copy()
    angles[:, 0] += 5e-6 * since
    antenna[:, 0] += 5.0
    return replace(problem, pos=replace(problem.pos, angles_rad=angles, antenna_m=antenna))


def test_effects_in_the_block_stay_and_others_go():
    # 12 blocks, 12 parameters without effect: 144 tests to 0.05, 7 +- 2.6 significant by chance
    put_in = {"gnss_x_shift", "imu_omega_shift", "imu_omega_drift"}
    by_chance = 0
    for seed in range(12):
        found = select_parameters(drifting((*FREE, *EXTRA), seed))
        left = [parameter.name for parameter in found.problem.parameters]
        assert put_in <= set(left)
        assert len(found.dropped) + len(left) == len(FREE) + len(EXTRA)
        for test in parameter_tests(found.problem, found.result):
            with_drift = test.name.replace("shift", "drift") in left and "shift" in test.name
            assert test.significant or with_drift
            by_chance += test.name not in put_in and not with_drift
    assert 1 <= by_chance <= 18


def test_every_step_drops_the_largest_p_of_an_adjustment_of_its_own():
    problem = drifting((*FREE, *EXTRA))
    for step in select_parameters(problem).dropped:
        tests = {test.name: test for test in parameter_tests(problem, adjust(problem))}
        assert step.test == tests[step.parameter.name]
        assert step.test.p >= 0.05
        with_drift = {name.replace("drift", "shift") for name in tests if "drift" in name}
        assert step.test.p == max(test.p for name, test in tests.items() if name not in with_drift)
        left = tuple(p for p in problem.parameters if p != step.parameter)
        problem = replace(problem, parameters=left)


def test_weighted_observations_stay():
    priors = tuple(replace(parameter, sigma=0.01) for parameter in FREE)
    measured = CommonParameter("lever_arm_w", sigma=0.05, value=0.02)
    assumed = CommonParameter("brown_k1", sigma=1e-3)
    found = select_parameters(noisy_problem((*priors, measured, assumed)))
    assert found.problem.parameters == (*priors, measured)
    (dropped,) = found.dropped
    assert dropped.parameter == assumed
    assert dropped.reason == "not significant"


def test_two_names_of_one_unknown_lose_the_last():
    parameters = (CommonParameter("imu_kappa_shift"), CommonParameter("boresight_yaw"))
    problem = noisy_problem(parameters)
    angles = problem.pos.angles_rad + np.array([0.0, 0.0, 0.01])
    found = select_parameters(replace(problem, pos=replace(problem.pos, angles_rad=angles)))
    assert [(each.parameter, each.reason) for each in found.dropped] == [
        (parameters[1], "singular")
    ]
    np.testing.assert_allclose(found.result.common, [0.01], atol=3e-4)


def test_a_block_without_datum_is_refused():
    with pytest.raises(UndeterminedError):
        select_parameters(undefined())


def undefined():
    problem = noisy_problem(n_control=0)
    nothing = np.full((8, 3), np.inf)
    pos = replace(problem.pos, sigma_antenna_m=nothing, sigma_angles_rad=nothing)
    return replace(problem, pos=pos)


def test_parameters_that_only_tilts_tell_apart_are_dropped_as_not_determined():
    parameters = (CommonParameter("gnss_z_shift"), CommonParameter("lever_arm_w"))
    found = select_parameters(noisy_problem(parameters))
    assert found.dropped[0].reason == "not determined"
