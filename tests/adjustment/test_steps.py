"""The chain of a block's adjustment: what it finds."""

import json
from dataclasses import replace

import numpy as np
import pytest
from helpers import shared_path
from small_scenario import GOOD_POINTS, OMEGA_CONSTANT_RAD, OMEGA_DRIFT_RAD_PER_S, small_block

from posstats import read_block
from posstats.adjustment import Adjustment, AdjustmentSettings, adjust_block
from posstats.adjustment.results import adjustment_results
from posstats.contract.adjustment import AdjustmentResults
from posstats.contract.files import from_json, to_json
from posstats.contract.notice import Notice
from posstats.errors import PosstatsError
from posstats.formats.block_folder import write_block
from posstats.geometry.ground.intersection import intersect
from posstats.numerics.kernels.rotation import wrapped


def parameter(adjustment: Adjustment, name: str, scope: str = "block"):
    return next(p for p in adjustment.parameters if (p.name, p.scope) == (name, scope))


def test_the_simulated_errors_of_the_pos_are_found(corners):
    for name, true in (
        ("imu_omega_shift", OMEGA_CONSTANT_RAD),
        ("imu_omega_drift", OMEGA_DRIFT_RAD_PER_S),
    ):
        found = parameter(corners, name)
        assert found.significant
        assert abs(found.value - true) < 4.0 * found.sigma
        assert found.sigma < 0.1 * true
    assert corners.overall.p > 0.001


def test_adjusted_orientations_are_nearer_the_truth_as_far_as_their_sigmas_say(corners, block):
    adjusted, truth = corners.orientations, block.adjusted
    turned = wrapped(adjusted.angles_rad - truth.angles_rad) / adjusted.sigma_angles_rad
    moved = (adjusted.position_m - truth.position_m) / adjusted.sigma_position_m
    assert np.sqrt(np.mean(turned**2)) < 3.0
    assert np.sqrt(np.mean(moved**2)) < 3.0


def test_check_points_fit_within_their_predicted_accuracy(corners):
    residuals = corners.check_points
    assert residuals.orientation == "bundle"
    assert sorted(residuals.point) == ["C2", "C4", "C5", "C6", "C8"]
    assert np.sqrt(np.mean((residuals.difference_m / residuals.sigma_m) ** 2)) < 2.0
    pos = corners.pos_check_points
    assert np.abs(residuals.difference_m).max() < 0.05 * np.abs(pos.difference_m).max()


def test_rays_to_check_points_take_no_part(block, corners):
    ties = block.tie_points
    checks = np.isin(ties.point_id[ties.point], ["C2", "C5"])
    moved = replace(block, tie_points=replace(ties, xy_px=ties.xy_px + 50.0 * checks[:, None]))
    again = adjust_block(moved, AdjustmentSettings(control="corners"))
    np.testing.assert_array_equal(again.orientations.angles_rad, corners.orientations.angles_rad)
    assert np.abs(again.check_points.difference_m - corners.check_points.difference_m).max() > 1.0


def test_covariance_of_a_check_point_by_perturbing_all_that_it_depends_on(corners):
    block, adjusted = corners.block, corners.adjusted
    point = int(np.flatnonzero(block.tie_points.point_id == "C5")[0])
    rays = np.flatnonzero(block.tie_points.point == point)
    images = block.tie_points.image[rays]

    def position(ties, orientations):
        return intersect(ties, orientations, block.cameras, [point]).position_m[0]

    by_image, by_pose = [], []
    for ray in rays:
        for axis in range(2):
            ends = []
            for step in (0.5, -0.5):
                xy = block.tie_points.xy_px.copy()
                xy[ray, axis] += step
                ties = replace(block.tie_points, xy_px=xy)
                ends.append(position(ties, corners.orientations))
            by_image.append(ends[0] - ends[1])
    for image in images:
        for element, h in enumerate([1e-5] * 3 + [0.1] * 3):
            ends = []
            for step in (h, -h):
                pose = corners.orientations
                values = np.concatenate([pose.angles_rad, pose.position_m], axis=1)
                values[image, element] += step
                turned = replace(pose, angles_rad=values[:, :3], position_m=values[:, 3:])
                ends.append(position(block.tie_points, turned))
            by_pose.append((ends[0] - ends[1]) / (2.0 * h))
    joint = _covariance_of_elements(corners, images)
    by_image, by_pose = np.array(by_image).T, np.array(by_pose).T
    expected = block.accuracy.image_px**2 * by_image @ by_image.T + by_pose @ joint @ by_pose.T
    row = list(corners.check_points.point).index("C5")
    found = corners.check_point_covariance_m2[row] / corners.scale**2
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert np.abs((found - expected) / scale).max() < 1e-3
    assert len(adjusted.position_m) == 32


def _covariance_of_elements(adjustment: Adjustment, images) -> np.ndarray:
    """Joint covariance of omega, phi, kappa, X, Y, Z of images of neighbouring levels."""
    from posstats.numerics.bundle.pos_observations import angles_by_rotation_vector

    n, adjusted = len(images), adjustment.adjusted
    by_pose = np.tile(np.eye(6), (n, 1, 1))
    system = adjustment.orientations.system
    by_pose[:, :3, :3] = angles_by_rotation_vector(adjusted.angles_rad[images], system)
    joint = np.empty((n, 6, n, 6))
    for i in range(n):
        for j in range(n):
            block = adjusted.inverse.blocks(images[[i]], images[[j]])[0]
            joint[i, :, j, :] = by_pose[i] @ block @ by_pose[j].T
    return joint.reshape(6 * n, 6 * n)


def test_strips_share_what_contradicts_their_priors(block):
    strips = adjust_block(block, AdjustmentSettings(control="corners", drift="strip"))
    shift = parameter(strips, "imu_omega_shift")
    assert shift.significant
    assert abs(shift.value - OMEGA_CONSTANT_RAD) < 4.0 * shift.sigma + OMEGA_DRIFT_RAD_PER_S * 2000
    assert strips.overall.p > 0.001


def test_weights_come_out_as_simulated():
    wrong = small_block(check_points=GOOD_POINTS)
    wrong = replace(wrong, accuracy=replace(wrong.accuracy, image_px=0.1))
    found = adjust_block(wrong, AdjustmentSettings(control="all", estimate_weights=True))
    assert found.weights.factor["image"] == pytest.approx(4.0, rel=0.1)
    assert found.overall.sigma0 == pytest.approx(1.0, abs=0.05)


def test_a_block_without_additional_parameters_is_adjusted(block):
    right = replace(block, orientations=block.adjusted)
    stated = block.orientations
    right = replace(
        right,
        orientations=replace(
            block.adjusted,
            sigma_position_m=stated.sigma_position_m,
            sigma_angles_rad=stated.sigma_angles_rad,
        ),
    )
    plain = adjust_block(right, AdjustmentSettings(control="all", drift="none"))
    assert plain.parameters == ()
    assert adjustment_results(plain).correlations == ()


def test_a_systematic_error_without_parameters_is_called_by_its_name(tiny):
    results = adjustment_results(adjust_block(tiny, AdjustmentSettings("all", drift="none")))
    assert Notice(code="systematic_imu", values={"n": 15, "n_images": 15}) in results.notices


def test_insignificant_parameters_are_dropped_on_request(block):
    settings = AdjustmentSettings(
        control="corners", self_calibration="brown", drop_insignificant=True
    )
    dropped = adjust_block(block, settings)
    assert {each.parameter.name for each in dropped.dropped} >= {"brown_k2", "brown_k3"}
    left = {p.name for p in dropped.parameters}
    assert not left & {each.parameter.name for each in dropped.dropped}


def test_bauer_needs_a_pixel_size(block):
    cameras = tuple(replace(camera, pixel_size_mm=None) for camera in block.cameras)
    with pytest.raises(PosstatsError, match="pixel size"):
        adjust_block(replace(block, cameras=cameras), AdjustmentSettings(self_calibration="bauer"))


def test_an_unknown_setting_is_refused():
    with pytest.raises(PosstatsError, match="none, block, strip"):
        AdjustmentSettings(drift="image")


def test_results_are_the_schema_in_plain_values(corners):
    text = to_json(adjustment_results(corners, created="2020-01-01"))
    assert to_json(from_json(text, AdjustmentResults, "adjustment.json")) == text
    values = json.loads(text)
    assert values["schema"] == "posstats-adjustment/1"
    assert values["converged"] is True
    assert {row["group"] for row in values["groups"]} >= {"image", "gnss", "imu", "control"}
    assert set(values) >= {
        "n_iterations", "sigma0", "dof", "chi2_p", "parameters", "correlations",
        "observability", "blunders", "check_points",
    }  # fmt: skip
    assert set(values["parameters"][0]) >= {
        "name", "scope", "value", "sigma", "t", "p", "significant", "unit",
    }  # fmt: skip
    redundancy = sum(row["redundancy"] for row in values["groups"])
    assert redundancy == pytest.approx(values["dof"], rel=1e-6)
    assert {row["orientation"] for row in values["check_points"]} == {"bundle", "pos"}
    assert [row["point"] for row in values["control_points"]] == ["C1", "C3", "C7", "C9"]


def test_written_blocks_give_the_same_adjustment(block, corners, tmp_path):
    write_block(block, tmp_path)
    again = adjust_block(read_block(tmp_path), AdjustmentSettings(control="corners"))
    first, second = parameter(corners, "imu_omega_drift"), parameter(again, "imu_omega_drift")
    assert second.value == pytest.approx(first.value, abs=1e-3 * first.sigma)


@pytest.fixture(scope="module")
def marseille() -> Adjustment:
    return adjust_block(read_block(shared_path("data", "ign-fd1305")))


def test_the_injected_errors_of_the_real_block_are_found(marseille):
    injected = json.loads(shared_path("data", "ign-fd1305", "injected.json").read_text())
    shift = parameter(marseille, "imu_omega_shift").value
    drift = parameter(marseille, "imu_omega_drift").value
    assert np.degrees(shift) == pytest.approx(injected["intercept_deg_at_t0"][0], abs=0.005)
    assert drift == pytest.approx(injected["slope_rad_per_s"][0], abs=3e-8)


def test_image_residuals_of_the_real_block_are_as_long_as_known(marseille):
    residual = marseille.adjusted.residual_px[~marseille.adjusted.rejected]
    length_px = np.hypot(*residual.T)
    assert np.sqrt(np.mean(length_px**2)) == pytest.approx(0.2, abs=0.05)


def test_an_unknown_camera_is_found_and_told_in_the_terms_of_the_block(block):
    # the block states a principal distance 20 px too short, a principal point 6 px right, 4 px up
    true = block.cameras[0]
    column, row = true.principal_point_px
    stated = replace(
        true,
        principal_distance_px=true.principal_distance_px - 20.0,
        principal_point_px=(column + 6.0, row - 4.0),
    )
    ties = block.tie_points
    wrong = replace(
        block, cameras=(stated,), tie_points=replace(ties, xy_px=ties.xy_px - [6.0, 4.0])
    )
    adjustment = adjust_block(wrong, AdjustmentSettings(control="all", camera=True))
    results = adjustment_results(adjustment)
    (camera,) = results.cameras
    sigma = {name: parameter(adjustment, name).sigma for name in ("camera_c", "camera_x0")}
    assert sigma["camera_c"] < 3.0
    assert sigma["camera_x0"] < 1.0
    assert abs(camera.principal_distance_px - true.principal_distance_px) < (
        4.0 * sigma["camera_c"]
    )
    found = np.array(camera.principal_point_px) - true.principal_point_px
    assert (np.abs(found) < 4.0 * sigma["camera_x0"]).all()
    assert results.settings.camera
