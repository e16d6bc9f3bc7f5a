"""Errors of simulated orientations and measurements are those of their scenario.

Oracle: the scenario itself (closed forms, error models) and sampling bounds of the noise.
"""

import numpy as np
import pytest
from simulated_blocks import (
    SYSTEMS,
    angle_errors,
    scenario_with,
    true_models,
)

from posstats.numerics.kernels.rotation import rotation_from_angles, vector_from_rotation
from posstats.synthetic import simulate


@pytest.mark.parametrize("system", SYSTEMS)
def test_ground_errors_are_constant_plus_drift_from_the_first_exposure(system):
    errors = {
        "omega": {"constant_rad": 0.018, "drift_rad_per_s": 4.68e-7},
        "phi": {"constant_rad": -0.002},
        "kappa": {"drift_rad_per_s": -1e-6},
    }
    scenario = scenario_with(
        block={"angles": system}, flight={"start_time_s": 3.5e5}, errors=errors
    )
    block = simulate(scenario)
    since = block.orientations.time_s - 3.5e5
    stated = np.column_stack([0.018 + 4.68e-7 * since, np.full_like(since, -0.002), -1e-6 * since])
    np.testing.assert_allclose(angle_errors(block), stated, atol=2e-15)
    assert np.abs(true_models(block).y_parallax_px()).max() < 1e-9


@pytest.mark.parametrize("system", SYSTEMS)
def test_a_boresight_is_constant_in_the_camera_and_flips_in_the_ground_frame(system):
    boresight = np.array([0.018, -0.004, 0.002])
    errors = {
        name: {"constant_rad": value}
        for name, value in zip(("pitch", "roll", "yaw"), boresight, strict=True)
    }
    flight = {"headings_deg": [0, 180], "tilt_rad": 0}
    block = simulate(scenario_with(block={"angles": system}, flight=flight, errors=errors))
    turn = (
        np.swapaxes(block.adjusted.ground_from_image, -1, -2) @ block.orientations.ground_from_image
    )
    np.testing.assert_allclose(
        vector_from_rotation(turn), np.broadcast_to(boresight, (10, 3)), atol=1e-14
    )
    forth, back = angle_errors(block)[:5], angle_errors(block)[5:]
    np.testing.assert_allclose(back[:, :2], -forth[:, :2], atol=1e-4)
    assert forth[0, 0] == pytest.approx(0.018, abs=1e-4)


def test_camera_errors_turn_the_erroneous_angles():
    errors = {"omega": {"constant_rad": 0.01}, "yaw": {"constant_rad": 0.02}}
    block = simulate(scenario_with(errors=errors))
    angles = block.adjusted.angles_rad + np.array([0.01, 0.0, 0.0])
    expected = rotation_from_angles(angles, "omega-phi-kappa") @ rotation_from_angles(
        [0.0, 0.0, 0.02], "omega-phi-kappa"
    )
    np.testing.assert_allclose(block.orientations.ground_from_image, expected, atol=1e-14)


def test_noise_has_its_standard_deviation():
    angle = {"noise_rad": 1e-5}
    errors = {
        "image_px": 0.3,
        "position": {"noise_m": 0.05},
        "omega": angle,
        "phi": {"noise_rad": 2e-5},
        "kappa": {"noise_rad": 5e-5},
    }
    flight = {"images_per_strip": 200}
    noisy = simulate(scenario_with(errors=errors, flight=flight, tie_points={"per_model": 20}))
    perfect = simulate(scenario_with(flight=flight, tie_points={"per_model": 20}))
    # 400 draws an angle: SD known to 3.5 %, bounds of four standard errors.
    np.testing.assert_allclose(angle_errors(noisy).std(axis=0), [1e-5, 2e-5, 5e-5], rtol=0.14)
    assert (np.abs(angle_errors(noisy).mean(axis=0)) < 4 * np.array([1, 2, 5]) * 5e-7).all()
    position = noisy.orientations.position_m - noisy.adjusted.position_m
    assert position.std() == pytest.approx(0.05, rel=0.1)
    image = noisy.tie_points.xy_px - perfect.tie_points.xy_px
    assert image.std() == pytest.approx(0.3, rel=4 / np.sqrt(2 * image.size))


def test_strip_constants_and_gnss_shifts_stay_through_a_strip():
    errors = {
        "omega": {"strip_rad": 1e-3},
        "position": {"strip_shift_m": 0.2, "strip_drift_m_per_s": 0.01},
    }
    block = simulate(scenario_with(errors=errors, flight={"n_strips": 60, "images_per_strip": 3}))
    omega = angle_errors(block)[:, 0].reshape(60, 3)
    np.testing.assert_allclose(omega, np.repeat(omega[:, :1], 3, axis=1), atol=2e-15)
    assert omega[:, 0].std() == pytest.approx(1e-3, rel=4 / np.sqrt(120))
    position = (block.orientations.position_m - block.adjusted.position_m).reshape(60, 3, 3)
    time = block.orientations.time_s.reshape(60, 3)
    rate = (position[:, 1] - position[:, 0]) / (time[:, 1] - time[:, 0])[:, None]
    np.testing.assert_allclose(
        position[:, 2] - position[:, 0], rate * (time[:, 2] - time[:, 0])[:, None], atol=1e-8
    )
    assert position[:, 0].std() == pytest.approx(0.2, rel=4 / np.sqrt(360))
    assert rate.std() == pytest.approx(0.01, rel=4 / np.sqrt(360))


def test_angle_drifts_start_anew_with_every_strip():
    errors = {"phi": {"strip_drift_rad_per_s": 1e-5}}
    block = simulate(scenario_with(errors=errors, flight={"n_strips": 60, "images_per_strip": 3}))
    phi = angle_errors(block)[:, 1].reshape(60, 3)
    time = block.orientations.time_s.reshape(60, 3)
    np.testing.assert_allclose(phi[:, 0], 0.0, atol=2e-15)
    rate = phi[:, 1] / (time[:, 1] - time[:, 0])
    np.testing.assert_allclose(phi[:, 2], rate * (time[:, 2] - time[:, 0]), atol=1e-13)
    assert rate.std() == pytest.approx(1e-5, rel=4 / np.sqrt(120))


def test_drifts_of_angles_leave_the_other_errors_as_they_were():
    errors = {"phi": {"strip_rad": 1e-3, "noise_rad": 1e-4}, "position": {"noise_m": 0.1}}
    plain = simulate(scenario_with(errors=errors))
    errors["phi"] = errors["phi"] | {"strip_drift_rad_per_s": 1e-5}
    drifting = simulate(scenario_with(errors=errors))
    first = [0, len(plain.orientations) // 2]
    np.testing.assert_array_equal(
        drifting.orientations.angles_rad[first], plain.orientations.angles_rad[first]
    )
    np.testing.assert_array_equal(drifting.orientations.position_m, plain.orientations.position_m)


def test_the_lever_arm_turns_with_the_image():
    arm = np.array([0.3, -0.2, 1.5])
    block = simulate(scenario_with(errors={"position": {"lever_arm_m": arm.tolist()}}))
    offset = block.orientations.position_m - block.adjusted.position_m
    in_image = np.einsum("nij,ni->nj", block.adjusted.ground_from_image, offset)
    np.testing.assert_allclose(in_image, np.tile(arm, (len(offset), 1)), atol=1e-9)


def test_blunders_have_their_share_and_length_and_spare_the_check_points():
    settings = {"tie_points": {"per_model": 1000}, "check_points": {"n": 9}}
    errors = {"blunder_share": 0.1, "blunder_px": 30}
    block = simulate(scenario_with(errors=errors, **settings))
    perfect = simulate(scenario_with(**settings))
    length = np.hypot(*(block.tie_points.xy_px - perfect.tie_points.xy_px).T)
    blundered = length > 1e-6
    np.testing.assert_allclose(length[blundered], 30.0, atol=1e-9)
    is_check = block.check_points[block.tie_points.point]
    assert not blundered[is_check].any()
    n = (~is_check).sum()
    assert blundered.sum() / n == pytest.approx(0.1, abs=4 * np.sqrt(0.09 / n))
