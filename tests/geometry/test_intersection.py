"""Forward intersection: oracles are known truth, scipy, closed forms and Monte Carlo."""

from dataclasses import replace

import numpy as np
import pytest
from helpers import shared_path
from scipy.optimize import least_squares
from strip_scene import CAMERA, measurements, orientations, projected, scene

from posstats.formats.block_folder import read_block
from posstats.geometry.ground.intersection import intersect
from posstats.numerics.kernels.rotation import angles_from_rotation

CAMERAS = (CAMERA,)


def _noisy(rays, sigma_px, seed=0):
    noise = np.random.default_rng(seed).normal(0.0, sigma_px, rays.xy_px.shape)
    return replace(rays, xy_px=rays.xy_px + noise)


def _stereo_pair(base=600.0, height=1000.0, **sigma):
    """The normal case: vertical images, base along X; the point is below the left image."""
    pair = orientations([[0, 0, height], [base, 0, height]], np.zeros((2, 3)), **sigma)
    return pair, np.zeros((1, 3))


@pytest.mark.parametrize("system", ["omega-phi-kappa", "phi-omega-kappa"])
def test_perfect_rays_give_the_true_points(system):
    oriented, ground = scene(1, system=system)
    found = intersect(measurements(oriented, ground), oriented, CAMERAS)
    np.testing.assert_allclose(found.position_m, ground, rtol=0, atol=1e-9)
    assert found.rms_px.max() < 1e-9
    assert set(found.status) == {"ok"}
    assert set(found.n_rays) == {len(oriented)}


def test_map_coordinates_of_millions_of_metres_lose_no_digits():
    oriented, ground = scene(1)
    shift = np.array([650_000.0, 6_800_000.0, 0.0])
    far = replace(oriented, position_m=oriented.position_m + shift)
    found = intersect(measurements(oriented, ground), far, CAMERAS)
    np.testing.assert_allclose(found.position_m - shift, ground, rtol=0, atol=5e-9)


def test_points_agree_with_scipy_least_squares():
    oriented, ground = scene(2, n_points=6)
    rays = _noisy(measurements(oriented, ground), 5.0)
    found = intersect(rays, oriented, CAMERAS)
    for k in range(len(ground)):
        mine = rays.point == k

        def residual(point, mine=mine):
            images = rays.image[mine]
            xy = projected(oriented, point[None], np.zeros(len(images), int), images)
            return (rays.xy_px[mine] - xy).ravel()

        best = least_squares(residual, ground[k], jac="3-point", xtol=1e-15, ftol=1e-15, gtol=1e-12)
        np.testing.assert_allclose(found.position_m[k], best.x, rtol=0, atol=1e-6)
        assert found.rms_px[k] == pytest.approx(np.sqrt(np.mean(best.fun**2)), rel=1e-9)
        cofactors = np.linalg.inv(best.jac.T @ best.jac)
        np.testing.assert_allclose(found.covariance_m2[k], 0.04 * cofactors, rtol=1e-6)


def test_covariance_of_the_normal_case_is_the_closed_form():
    # x parallax p = x1 - x2 = B c / h: sigma_Z = h^2 / (B c) sqrt(2) sigma;
    # X = h x1 / c with x1 = 0: sigma_X = h / c sigma;
    # Y from the mean of two measurements (y = 0): sigma_Y = h / (c sqrt 2) sigma
    base, height, sigma = 600.0, 1000.0, 0.3
    pair, ground = _stereo_pair(base, height)
    found = intersect(measurements(pair, ground), pair, CAMERAS, sigma_image_px=sigma)
    c = CAMERA.principal_distance_px
    expected = [
        height / c * sigma,
        height / (c * np.sqrt(2)) * sigma,
        height**2 / (base * c) * np.sqrt(2) * sigma,
    ]
    np.testing.assert_allclose(np.sqrt(np.diag(found.covariance_m2[0])), expected, rtol=1e-12)


def test_orientation_variance_of_the_normal_case_is_the_closed_form():
    # x1 = 0 gives X = X1, the mean of the y gives Y = (Y1 + Y2) / 2, and x2 = -c B / h gives
    # Z = Z2 - h (X2 - X1) / B: variance sigma^2 (1 + 2 (h / B)^2)
    base, height, sigma = 600.0, 1000.0, 0.1
    pair, ground = _stereo_pair(base, height, sigma_m=sigma, sigma_rad=0.0)
    found = intersect(measurements(pair, ground), pair, CAMERAS, sigma_image_px=0.0)
    expected = [sigma, sigma / np.sqrt(2), sigma * np.sqrt(1 + 2 * (height / base) ** 2)]
    actual = np.sqrt(np.diag(found.covariance_with_orientation_m2[0]))
    np.testing.assert_allclose(actual, expected, rtol=1e-12)
    np.testing.assert_array_equal(found.covariance_m2, 0.0)


def test_covariances_agree_with_monte_carlo():
    sigma_px = 0.3
    oriented, ground = scene(4, n_images=4, n_points=5, sigma_m=0.06, sigma_rad=1e-4)
    rays = measurements(oriented, ground)
    stated = intersect(rays, oriented, CAMERAS, sigma_image_px=sigma_px)
    rng, runs = np.random.default_rng(5), 4000
    image_only, both = np.empty((runs, 5, 3)), np.empty((runs, 5, 3))
    for run in range(runs):
        noisy = replace(rays, xy_px=rays.xy_px + rng.normal(0, sigma_px, rays.xy_px.shape))
        wrong = replace(
            oriented,
            position_m=oriented.position_m + rng.normal(0, 0.06, (4, 3)),
            angles_rad=oriented.angles_rad + rng.normal(0, 1e-4, (4, 3)),
        )
        image_only[run] = intersect(noisy, oriented, CAMERAS).position_m - ground
        both[run] = intersect(noisy, wrong, CAMERAS).position_m - ground
    for errors, covariance in [
        (image_only, stated.covariance_m2),
        (both, stated.covariance_with_orientation_m2),
    ]:
        # squared Mahalanobis distance: mean 3, and its mean over 4,000 runs has sigma 0.039
        distance = np.einsum("rki,kij,rkj->rk", errors, np.linalg.inv(covariance), errors)
        assert np.abs(distance.mean(axis=0) - 3.0).max() < 0.16


def test_the_order_of_measurements_and_of_points_does_not_matter():
    oriented, ground = scene(6)
    rays = _noisy(measurements(oriented, ground), 0.5)
    order = np.random.default_rng(1).permutation(len(rays))
    shuffled = replace(
        rays, point=rays.point[order], image=rays.image[order], xy_px=rays.xy_px[order]
    )
    expected = intersect(rays, oriented, CAMERAS)
    found = intersect(shuffled, oriented, CAMERAS, [7, 2, 7])
    np.testing.assert_array_equal(found.point, [7, 2, 7])
    np.testing.assert_array_equal(found.position_m, expected.position_m[[7, 2, 7]])
    np.testing.assert_array_equal(found.rms_px, expected.rms_px[[7, 2, 7]])


def test_turning_the_ground_frame_turns_points_and_covariances():
    oriented, ground = scene(7)
    rays = _noisy(measurements(oriented, ground), 0.5)
    azimuth = 2.1
    turn = np.array(
        [
            [np.cos(azimuth), -np.sin(azimuth), 0.0],
            [np.sin(azimuth), np.cos(azimuth), 0.0],
            [0.0, 0.0, 1.0],
        ]
    )
    turned = replace(
        oriented,
        position_m=oriented.position_m @ turn.T,
        angles_rad=angles_from_rotation(turn @ oriented.ground_from_image, oriented.system),
    )
    before, after = intersect(rays, oriented, CAMERAS), intersect(rays, turned, CAMERAS)
    np.testing.assert_allclose(after.position_m, before.position_m @ turn.T, rtol=0, atol=1e-8)
    np.testing.assert_allclose(after.rms_px, before.rms_px, rtol=1e-9)
    np.testing.assert_allclose(
        after.covariance_m2, turn @ before.covariance_m2 @ turn.T, rtol=1e-8, atol=1e-15
    )


def test_a_blunder_shows_in_the_residuals_of_its_point_alone():
    oriented, ground = scene(8)
    rays = _noisy(measurements(oriented, ground), 0.2)
    wrong = rays.xy_px.copy()
    wrong[np.flatnonzero(rays.point == 3)[1]] += [0.0, 80.0]
    before = intersect(rays, oriented, CAMERAS)
    after = intersect(replace(rays, xy_px=wrong), oriented, CAMERAS)
    assert before.rms_px.max() < 0.5
    assert after.rms_px[3] > 10.0
    others = np.arange(len(ground)) != 3
    np.testing.assert_array_equal(after.rms_px[others], before.rms_px[others])


def test_points_without_two_rays_are_listed_with_the_reason():
    oriented, ground = scene(9, n_points=3)
    rays = measurements(oriented, ground)
    keep = (rays.point == 0) | ((rays.point == 1) & (rays.image == 2))
    found = intersect(rays.subset(keep), oriented, CAMERAS)
    assert list(found.status) == ["ok", "fewer than two rays", "fewer than two rays"]
    assert list(found.n_rays) == [5, 1, 0]
    assert np.isnan(found.position_m[1:]).all()
    assert np.isnan(found.covariance_m2[1:]).all()
    assert np.isnan(found.covariance_with_orientation_m2[1:]).all()
    assert np.isnan(found.rms_px[1:]).all()


def test_rays_of_images_without_orientation_are_left_out():
    oriented, ground = scene(10)
    angles = oriented.angles_rad.copy()
    angles[1] = np.nan
    found = intersect(measurements(oriented, ground), oriented.with_angles(angles), CAMERAS)
    assert set(found.n_rays) == {len(oriented) - 1}
    np.testing.assert_allclose(found.position_m, ground, rtol=0, atol=1e-9)


def test_unknown_orientation_accuracy_leaves_the_image_part_of_the_covariance():
    oriented, ground = scene(10, sigma_m=np.nan)
    found = intersect(measurements(oriented, ground), oriented, CAMERAS)
    assert np.isfinite(found.covariance_m2).all()
    assert np.isnan(found.covariance_with_orientation_m2).all()


def test_parallel_rays_do_not_intersect():
    pair, _ = _stereo_pair()
    rays = measurements(pair, np.zeros((1, 3)))
    found = intersect(replace(rays, xy_px=np.full((2, 2), 100.0)), pair, CAMERAS)
    assert list(found.status) == ["parallel rays"]
    nearly = replace(rays, xy_px=np.array([[100.0, 0.0], [99.5, 0.0]]))
    assert list(intersect(nearly, pair, CAMERAS).status) == ["parallel rays"]


def test_a_point_on_the_line_of_two_projection_centres_has_parallel_rays():
    column = orientations([[0, 0, 1000.0], [0, 0, 1200.0]], np.zeros((2, 3)))
    found = intersect(measurements(column, np.zeros((1, 3))), column, CAMERAS)
    assert list(found.status) == ["parallel rays"]


def test_diverging_rays_meet_behind_the_cameras():
    pair, ground = _stereo_pair()
    rays = measurements(pair, ground)
    swapped = replace(rays, xy_px=rays.xy_px[::-1])
    found = intersect(swapped, pair, CAMERAS)
    assert list(found.status) == ["behind the camera"]
    assert np.isnan(found.position_m).all()


def test_no_points_and_no_measurements_give_an_empty_result():
    oriented, ground = scene(11)
    rays = measurements(oriented, ground)
    nothing = intersect(rays, oriented, CAMERAS, [])
    assert len(nothing) == 0
    assert nothing.covariance_m2.shape == (0, 3, 3)
    unmeasured = intersect(rays.subset(np.zeros(len(rays), bool)), oriented, CAMERAS)
    assert set(unmeasured.status) == {"fewer than two rays"}


def test_adjusted_orientations_of_a_real_block_leave_the_measuring_noise():
    # the block's own vertical parallax is 0.21 px; its POS is off by a quarter of a degree
    real = read_block(shared_path("data", "ign-fd1305"))
    found = intersect(real.tie_points, real.adjusted, real.cameras)
    once = np.bincount(real.tie_points.point) < 2
    np.testing.assert_array_equal(found.is_ok, ~once)
    assert np.nanmedian(found.rms_px) < 0.2
    assert np.nanmax(found.rms_px) < 1.0
    from_pos = intersect(real.tie_points, real.orientations, real.cameras)
    assert np.nanmedian(from_pos.rms_px) > 3.0


def test_rays_of_a_coarse_pos_that_diverge_are_said_to():
    # drone, attitude off by degrees, bases of 14 m: some triple rays meet above the camera
    real = read_block(shared_path("data", "seneca"))
    found = intersect(real.tie_points, real.orientations, real.cameras)
    assert set(found.status) == {"ok", "behind the camera"}
    behind = np.count_nonzero(~found.is_ok)
    assert 0 < behind < 0.001 * len(found)
    assert set(intersect(real.tie_points, real.adjusted, real.cameras).status) == {"ok"}


def test_images_of_different_cameras_meet():
    # the wide camera sees every second image: its coordinates and distance are half as large
    oriented, ground = scene(12)
    wide = replace(CAMERA, id="wide", principal_distance_px=0.5 * CAMERA.principal_distance_px)
    camera = np.arange(len(oriented)) % 2
    rays = measurements(oriented, ground)
    scale = np.where(camera[rays.image] == 1, 0.5, 1.0)[:, None]
    mixed = replace(rays, xy_px=rays.xy_px * scale)
    found = intersect(mixed, replace(oriented, camera=camera), (CAMERA, wide))
    np.testing.assert_allclose(found.position_m, ground, rtol=0, atol=1e-9)
    assert found.rms_px.max() < 1e-9
    alike = intersect(rays, oriented, CAMERAS)
    assert np.all(found.covariance_m2[:, 2, 2] > alike.covariance_m2[:, 2, 2])
