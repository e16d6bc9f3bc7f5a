"""Strips, times and terrain of simulated flights are those of their scenario.

Oracle: the scenario itself (closed forms, error models) and sampling bounds of the noise.
"""

import numpy as np
import pytest
from simulated_blocks import (
    intersected,
    scenario_with,
)

from posstats.block.image_pairs import cross_strip_pairs
from posstats.synthetic import simulate


def test_overlaps_follow_from_the_footprints():
    scenario = scenario_with(flight={"tilt_rad": 0, "n_strips": 3, "headings_deg": [0, 180]})
    position = simulate(scenario).adjusted.position_m.reshape(3, 5, 3)
    along, across = 800.0, 1000.0  # px = m at 1500 m and 1500 px
    steps = np.diff(position, axis=1)
    np.testing.assert_allclose(1 - np.abs(steps[..., 1]) / along, 0.6, atol=1e-12)
    np.testing.assert_allclose(steps[..., [0, 2]], 0.0, atol=1e-9)
    np.testing.assert_array_equal(np.sign(steps[:, 0, 1]), [1, -1, 1])
    np.testing.assert_allclose(1 - np.diff(position[:, 0, 0]) / across, 0.3, atol=1e-12)


def test_times_follow_from_speed_and_turns():
    flight = {"speed_m_per_s": 40, "turn_s": 250, "start_time_s": 1e9, "images_per_strip": [3, 2]}
    block = simulate(scenario_with(flight=flight))
    np.testing.assert_allclose(block.orientations.time_s - 1e9, [0, 8, 16, 266, 274], atol=1e-6)
    assert list(block.orientations.strip) == ["1", "1", "1", "2", "2"]
    assert list(block.orientations.image) == ["1-1", "1-2", "1-3", "2-1", "2-2"]


@pytest.mark.parametrize("heading", [0.0, 30.0, 90.0, 200.0, -45.0])
def test_the_image_top_points_along_the_flight(heading):
    block = simulate(scenario_with(flight={"headings_deg": heading, "tilt_rad": 0}))
    forward = np.array([np.sin(np.radians(heading)), np.cos(np.radians(heading)), 0.0])
    up = block.adjusted.ground_from_image[:, :, 1]
    np.testing.assert_allclose(up, np.broadcast_to(forward, up.shape), atol=1e-14)
    step = np.diff(block.adjusted.position_m[:5], axis=0)
    np.testing.assert_allclose(step, np.broadcast_to(320.0 * forward, step.shape), atol=1e-9)


def test_cross_strips_cross_in_the_middle():
    flight = {"n_strips": 3, "headings_deg": [0, 180, 90], "tilt_rad": 0}
    position = simulate(scenario_with(flight=flight)).adjusted.position_m.reshape(3, 5, 3)
    np.testing.assert_allclose(position[:2].mean(axis=(0, 1))[:2], 0.0, atol=1e-9)
    np.testing.assert_allclose(position[2, :, 1], 0.0, atol=1e-9)
    np.testing.assert_allclose(np.diff(position[2, :, 0]), 320.0, atol=1e-9)


def test_a_gap_between_strips_leaves_them_alone():
    assert len(cross_strip_pairs(simulate(scenario_with(flight={"side_overlap": -0.2})))) == 0
    assert len(cross_strip_pairs(simulate(scenario_with(flight={"side_overlap": 0.3})))) > 4


def test_tilts_and_jitter_have_their_standard_deviation():
    flight = {"images_per_strip": 200, "tilt_rad": 0.02, "position_jitter_m": 8}
    sparse = {"tie_points": {"per_model": 8}}
    block = simulate(scenario_with(flight=flight | {"headings_deg": 0}, **sparse))
    still = simulate(
        scenario_with(flight=flight | {"headings_deg": 0, "position_jitter_m": 0}, **sparse)
    )
    # 1,200 draws: the SD is known to 2 %; five of its standard errors are 10 %.
    assert np.std(block.adjusted.angles_rad) == pytest.approx(0.02, rel=0.1)
    assert np.std(block.adjusted.position_m - still.adjusted.position_m) == pytest.approx(
        8, rel=0.1
    )


def test_the_terrain_has_the_standard_deviation_of_a_sine_of_its_amplitude():
    terrain = {"relief_m": 60, "wavelength_m": 500, "mean_height_m": 200}
    block = simulate(scenario_with(terrain=terrain, flight={"images_per_strip": 40}))
    height = intersected(block)[:, 2]
    # 24 waves over some ten wavelengths: near, not at, the expectation.
    assert height.std() == pytest.approx(60 / np.sqrt(2), rel=0.15)
    assert height.mean() == pytest.approx(200, abs=10)
