"""Check points: oracles are hand-computed cases, known truth and Monte Carlo."""

from dataclasses import replace

import numpy as np
import pytest
from strip_scene import block, scene

from posstats.block.frames import GroundFrame
from posstats.block.model import GroundPoints
from posstats.geometry.ground.check_points import (
    CheckPointResiduals,
    check_point_accuracy,
    check_point_residuals,
)
from posstats.geometry.ground.intersection import intersect


def _residuals(difference_m, status=None):
    difference = np.asarray(difference_m, dtype=float).reshape(-1, 3)
    g = len(difference)
    return CheckPointResiduals(
        orientation="pos",
        point=np.array([f"p{k}" for k in range(g)], dtype=object),
        given_m=np.zeros((g, 3)),
        difference_m=difference,
        sigma_m=np.ones((g, 3)),
        survey_sigma_m=np.full((g, 2), np.nan),
        n_rays=np.full(g, 3),
        rms_px=np.zeros(g),
        status=np.array(status or ["ok"] * g, dtype=object),
    )


HAND = [[3.0, 4.0, -1.0], [0.0, 0.0, 2.0], [0.0, 5.0, 5.0]]


def test_statistics_of_a_hand_computed_case_with_the_translation_kept():
    # horizontal 5, 0, 5; vertical 1, 2, 5
    found = check_point_accuracy(_residuals(HAND), translation_removed=False)
    assert found.n == 3
    assert (found.max_horizontal_m, found.min_horizontal_m) == (5.0, 0.0)
    assert (found.max_vertical_m, found.min_vertical_m) == (5.0, 1.0)
    assert found.rmse_horizontal_m == pytest.approx(np.sqrt(50 / 3), rel=1e-15)
    assert found.rmse_vertical_m == pytest.approx(np.sqrt(30 / 3), rel=1e-15)
    assert found.shift_m == pytest.approx((1.0, 3.0, 2.0))


def test_statistics_of_a_hand_computed_case_with_the_translation_removed():
    # mean (1, 3, 2); left: (2, 1, -3), (-1, -3, 0), (-1, 2, 3); squares 5 + 10 + 5, 9 + 0 + 9
    found = check_point_accuracy(_residuals(HAND), translation_removed=True)
    assert found.rmse_horizontal_m == pytest.approx(np.sqrt(20 / 2), rel=1e-15)
    assert found.rmse_vertical_m == pytest.approx(np.sqrt(18 / 2), rel=1e-15)
    assert found.max_horizontal_m == pytest.approx(np.sqrt(10))
    assert found.min_horizontal_m == pytest.approx(np.sqrt(5))
    assert (found.max_vertical_m, found.min_vertical_m) == (3.0, 0.0)
    assert found.shift_m == pytest.approx((1.0, 3.0, 2.0))


def test_the_divisor_n_minus_1_makes_the_variance_unbiased():
    # known variance 1; 4,000 sets of 4 points: the mean square has a standard error of 0.013
    rng = np.random.default_rng(0)
    squares = [
        check_point_accuracy(_residuals(rng.normal(7.0, 1.0, (4, 3))), True).rmse_vertical_m ** 2
        for _ in range(4000)
    ]
    assert np.mean(squares) == pytest.approx(1.0, abs=0.05)


def test_one_point_has_no_statistics_once_its_translation_is_removed():
    one = _residuals([[3.0, 4.0, -2.0]])
    kept, removed = check_point_accuracy(one, False), check_point_accuracy(one, True)
    assert (kept.rmse_horizontal_m, kept.rmse_vertical_m) == (5.0, 2.0)
    assert removed.n == 1
    assert removed.shift_m == (3.0, 4.0, -2.0)
    assert removed.max_horizontal_m is removed.min_vertical_m is removed.rmse_vertical_m is None


@pytest.mark.parametrize("removed", [True, False])
def test_no_points_have_no_statistics(removed):
    found = check_point_accuracy(_residuals(np.empty((0, 3))), removed)
    assert found.n == 0
    assert found.shift_m is found.max_horizontal_m is found.rmse_vertical_m is None


def test_points_that_cannot_be_intersected_take_no_part():
    status = ["ok", "fewer than two rays", "ok", "ok"]
    difference = [HAND[0], [np.nan] * 3, HAND[1], HAND[2]]
    for removed in (True, False):
        assert check_point_accuracy(_residuals(difference, status), removed) == (
            check_point_accuracy(_residuals(HAND), removed)
        )


def test_perfect_orientations_leave_no_differences():
    oriented, ground = scene(1)
    found = check_point_residuals(block(oriented, ground), oriented, "adjusted")
    assert found.orientation == "adjusted"
    np.testing.assert_allclose(found.difference_m, 0.0, rtol=0, atol=1e-9)
    np.testing.assert_array_equal(found.given_m, ground)


def test_the_difference_is_computed_minus_given():
    # all centres 2 m too far east: so are all points
    oriented, ground = scene(2)
    east = replace(oriented, position_m=oriented.position_m + np.array([2.0, 0.0, 0.0]))
    found = check_point_residuals(block(oriented, ground), east, "pos")
    np.testing.assert_allclose(found.difference_m, [[2.0, 0.0, 0.0]] * len(ground), atol=1e-9)
    accuracy = check_point_accuracy(found, translation_removed=True)
    assert accuracy.rmse_horizontal_m == pytest.approx(0.0, abs=1e-9)
    assert accuracy.shift_m == pytest.approx((2.0, 0.0, 0.0), abs=1e-9)


def test_check_points_seen_once_or_never_are_listed_and_control_points_are_not():
    oriented, ground = scene(3, n_points=4)
    full = block(oriented, ground, is_check=[True, True, False, True])
    rays = full.tie_points
    keep = (rays.point != 1) | (rays.image == 0)
    points = replace(full.ground_points, point=np.array(["p0", "p1", "p2", "new"], dtype=object))
    partly = replace(full, tie_points=rays.subset(keep), ground_points=points)
    found = check_point_residuals(partly, oriented, "pos")
    assert list(found.point) == ["p0", "p1", "new"]
    assert list(found.status) == ["ok", "fewer than two rays", "fewer than two rays"]
    assert list(found.n_rays) == [5, 1, 0]
    assert np.isnan(found.difference_m[1:]).all()
    assert np.isnan(found.sigma_m[1:]).all()
    assert np.isfinite(found.given_m).all()
    assert check_point_accuracy(found, False).n == 1


def test_a_check_point_given_twice_is_compared_twice():
    oriented, ground = scene(4, n_points=2)
    twice = GroundPoints(
        point=np.array(["p1", "p1"], dtype=object),
        position_m=ground[[1, 1]] + [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
        is_check=np.ones(2, dtype=bool),
        sigma_xy_m=np.full(2, np.nan),
        sigma_z_m=np.full(2, np.nan),
    )
    found = check_point_residuals(
        replace(block(oriented, ground), ground_points=twice), oriented, "pos"
    )
    np.testing.assert_allclose(found.difference_m[:, 2], [0.0, -1.0], atol=1e-9)


def test_a_block_without_ground_points_has_no_residuals():
    oriented, ground = scene(5)
    bare = replace(block(oriented, ground), ground_points=None)
    found = check_point_residuals(bare, oriented, "pos")
    assert len(found) == 0
    assert check_point_accuracy(found, True).n == 0


def test_stated_sigmas_cover_the_differences():
    # image, orientation and survey errors drawn as stated: (difference / sigma)^2 has mean 1
    rng = np.random.default_rng(6)
    oriented, ground = scene(6, n_points=10, sigma_m=0.05, sigma_rad=5e-5)
    stated = block(
        oriented, ground, sigma_xy_m=np.full(10, 0.1), sigma_z_m=np.full(10, 0.2), image_px=0.4
    )
    squares = np.zeros((10, 3))
    runs = 800
    for _ in range(runs):
        noise = rng.normal(0.0, 0.4, stated.tie_points.xy_px.shape)
        surveyed = ground + rng.normal(0.0, [0.1, 0.1, 0.2], (10, 3))
        drawn = replace(
            stated,
            tie_points=replace(stated.tie_points, xy_px=stated.tie_points.xy_px + noise),
            ground_points=replace(stated.ground_points, position_m=surveyed),
        )
        wrong = replace(
            oriented,
            position_m=oriented.position_m + rng.normal(0.0, 0.05, (5, 3)),
            angles_rad=oriented.angles_rad + rng.normal(0.0, 5e-5, (5, 3)),
        )
        found = check_point_residuals(drawn, wrong, "pos")
        squares += (found.difference_m / found.sigma_m) ** 2 / runs
    # standard error sqrt(2 / 800) = 0.05
    assert np.abs(squares - 1.0).max() < 0.2


def test_survey_sigmas_that_are_not_stated_add_nothing():
    oriented, ground = scene(7)
    bare = check_point_residuals(block(oriented, ground), oriented, "pos")
    survey = block(oriented, ground, sigma_z_m=np.full(len(ground), 0.3))
    found = check_point_residuals(survey, oriented, "pos")
    np.testing.assert_allclose(found.sigma_m[:, :2], bare.sigma_m[:, :2])
    np.testing.assert_allclose(found.sigma_m[:, 2], np.hypot(bare.sigma_m[:, 2], 0.3))


def _far_from_the_tangent_point():
    """A scene 150 km from the middle of its block in UTM, where the crs axes are turned."""
    frame = GroundFrame.tangent("EPSG:32631", [[250_000.0, 6_700_000.0, 300.0]])
    oriented, ground = scene(8, sigma_rad=1e-4)
    far = np.array([150_000.0, -150_000.0, -3_500.0])
    oriented = replace(oriented, position_m=oriented.position_m + far)
    return frame, oriented, ground + far


def test_differences_are_in_the_axes_of_the_crs():
    # moving the given points by 1 m of grid east and -2 m of height shows as exactly that
    frame, oriented, ground = _far_from_the_tangent_point()
    moved_crs = frame.to_crs(ground) + np.array([1.0, 0.0, -2.0])
    given = block(oriented, ground, frame=frame)
    points = replace(given.ground_points, position_m=frame.to_computing(moved_crs))
    found = check_point_residuals(replace(given, ground_points=points), oriented, "pos")
    np.testing.assert_allclose(found.difference_m, [[-1.0, 0.0, 2.0]] * len(ground), atol=1e-5)
    np.testing.assert_allclose(found.given_m, moved_crs, rtol=0, atol=1e-5)


def test_sigmas_are_in_the_axes_of_the_crs():
    # oracle: the covariance carried through the numerical derivative of the map projection,
    # which differs by the scale of the grid (below 0.001) only
    frame, oriented, ground = _far_from_the_tangent_point()
    far = block(oriented, ground, frame=frame)
    found = check_point_residuals(far, oriented, "pos")
    points = intersect(far.tie_points, oriented, far.cameras)
    steps = np.eye(3)
    jacobian = np.stack(
        [(frame.to_crs(ground + s) - frame.to_crs(ground - s)) / 2.0 for s in steps], axis=-1
    )
    covariance = points.covariance_with_orientation_m2
    expected = np.einsum("gij,gjk,gik->gi", jacobian, covariance, jacobian)
    np.testing.assert_allclose(found.sigma_m**2, expected, rtol=5e-3)
    unturned = np.diagonal(covariance, axis1=1, axis2=2)
    assert np.abs(unturned / expected - 1.0).max() > 0.02
