"""Check and control points of simulated blocks lie where their scenario puts them.

Oracle: the scenario itself (closed forms, error models) and sampling bounds of the noise.
"""

import numpy as np
import pytest
from simulated_blocks import (
    LAMBERT_93,
    intersected,
    scenario_with,
)

from posstats.synthetic import simulate


@pytest.mark.parametrize("distribution", ["grid", "corners", "side-overlap", "random"])
@pytest.mark.parametrize("n", [1, 2, 4, 7, 15])
def test_surveyed_points_lie_in_the_block_and_are_seen_twice(distribution, n):
    spec = {"n": n, "distribution": distribution}
    block = simulate(scenario_with(check_points=spec, flight={"n_strips": 3}))
    assert len(block.ground_points) == n
    assert block.notices == ()
    plane = block.ground_points.position_m[:, :2]
    assert len(np.unique(plane.round(3), axis=0)) == n
    limit = block.adjusted.position_m[:, :2]
    assert (plane >= limit.min(axis=0) - 1e-9).all()
    assert (plane <= limit.max(axis=0) + 1e-9).all()


def test_corner_points_are_the_middle_the_corners_and_a_grid():
    def plane(n):
        spec = {"n": n, "distribution": "corners"}
        block = simulate(scenario_with(control_points=spec, flight={"n_strips": 3, "tilt_rad": 0}))
        assert not block.ground_points.is_check.any()
        return {tuple(xy) for xy in block.ground_points.position_m[:, :2].round(6)}

    corners = {(x, y) for x in (-700.0, 700.0) for y in (-640.0, 640.0)}
    assert plane(1) == {(0.0, 0.0)}
    assert plane(4) == corners
    assert plane(9) >= corners | {(0.0, 0.0)}


def test_points_in_the_side_overlaps_lie_midway_between_the_strips():
    def across(n):
        spec = {"n": n, "distribution": "side-overlap"}
        block = simulate(scenario_with(check_points=spec, flight={"n_strips": 5, "tilt_rad": 0}))
        assert np.bincount(block.tie_points.point)[block.check_points].min() >= 4
        return block.ground_points.position_m[:, 0]

    # Strips at x = -1400, -700, 0, 700, 1400.
    np.testing.assert_allclose(across(6), [-1050, -1050, -350, -350, 350, 1050], atol=1e-9)
    np.testing.assert_allclose(across(2), [-350, 1050], atol=1e-9)
    assert np.bincount(np.digitize(across(15), [-700, 0, 700])).tolist() == [4, 4, 4, 3]


def test_a_long_cross_strip_does_not_draw_the_surveyed_points_out_of_the_block():
    flight = {"n_strips": None, "images_per_strip": [5, 5, 15], "headings_deg": [0, 180, 90]}
    spec = {"n": 15, "distribution": "corners"}
    block = simulate(scenario_with(flight=flight, check_points=spec))
    assert np.abs(block.ground_points.position_m[:, 0]).max() == pytest.approx(350.0)
    assert block.notices == ()


def test_surveyed_points_have_their_own_image_and_ground_noise():
    settings = {"flight": {"n_strips": 4}, "tie_points": {"per_model": 20}}
    spec = {"n": 400, "image_px": 1.5, "ground_m": 0.3}
    noisy = simulate(scenario_with(check_points=spec, **settings))
    perfect = simulate(scenario_with(check_points={"n": 400}, **settings))
    survey = noisy.ground_points.position_m - perfect.ground_points.position_m
    assert survey.std() == pytest.approx(0.3, rel=4 / np.sqrt(2400))
    image = noisy.tie_points.xy_px - perfect.tie_points.xy_px
    is_check = noisy.check_points[noisy.tie_points.point]
    assert image[is_check].std() == pytest.approx(1.5, rel=4 / np.sqrt(4 * is_check.sum()))
    np.testing.assert_allclose(image[~is_check], 0.0, atol=1e-9)
    assert (noisy.ground_points.sigma_xy_m == 0.3).all()
    assert np.isnan(perfect.ground_points.sigma_z_m).all()


def test_true_ground_points_are_where_the_true_rays_meet():
    block = simulate(
        scenario_with(block=LAMBERT_93, check_points={"n": 9}, terrain={"relief_m": 50})
    )
    ground = intersected(block)
    rows = {point: row for row, point in enumerate(block.tie_points.point_id)}
    found = ground[[rows[point] for point in block.ground_points.point]]
    np.testing.assert_allclose(found, block.ground_points.position_m, atol=1e-7)
