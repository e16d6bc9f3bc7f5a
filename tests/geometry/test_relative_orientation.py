"""Relative orientation: simulated truth, PoseLib, scipy and invariances."""

from dataclasses import replace

import numpy as np
import poselib
import pytest
from stereo_scene import (
    METHODS,
    PRINCIPAL_DISTANCE_PX,
    SYSTEMS,
    least_of_scipy,
    noisy_models,
    relative_rotation,
    true_models,
    with_angle_errors,
    with_vectors,
)

from posstats.geometry.stereo.relative_orientation import (
    orient,
)
from posstats.numerics.kernels.rotation import (
    angles_from_rotation,
    rotation_from_angles,
    vector_from_rotation,
    wrapped,
)


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("method", ["independent", "dependent"])
@pytest.mark.parametrize("robust", [False, True])
def test_perfect_models_are_recovered_from_erring_angles(system, method, robust):
    truth = true_models(system=system, cameras=(0, 1))
    result = orient(with_angle_errors(truth, 0.05), method, robust=robust)
    assert list(result.status) == ["ok"] * len(truth)
    assert result.y_parallax_rms_px.max() < 1e-8
    assert not result.n_rejected.any()
    rotation = truth.orientations.ground_from_image
    expected = np.swapaxes(rotation[truth.pairs.left], 1, 2) @ rotation[truth.pairs.right]
    turned = vector_from_rotation(np.swapaxes(relative_rotation(result), 1, 2) @ expected)
    assert np.abs(turned).max() < 1e-11
    base_in_left = np.einsum("pji,pj->pi", result.ground_from_left, result.base_m)
    expected = np.einsum("pji,pj->pi", rotation[truth.pairs.left], truth.base_m)
    direction = [v / np.linalg.norm(v, axis=1)[:, None] for v in (base_in_left, expected)]
    np.testing.assert_allclose(*direction, atol=1e-11)


def test_errors_of_fifteen_degrees_are_overcome():
    result = orient(with_angle_errors(true_models(20), np.radians([5.0, 5.0, 15.0])))
    assert result.converged.all()
    assert result.y_parallax_rms_px.max() < 1e-8


def test_the_least_rms_is_that_of_scipy():
    models = noisy_models(n_models=3)
    result = orient(models)
    for k in range(len(models)):
        rms_px = least_of_scipy(models, k)[1]
        assert result.y_parallax_rms_px[k] == pytest.approx(rms_px, rel=1e-9)


@pytest.mark.parametrize("robust", [False, True])
@pytest.mark.parametrize("method", ["independent", "dependent", "omega"])
def test_a_known_independent_solution_saves_work_and_changes_nothing(method, robust):
    models = noisy_models(n_models=3)
    known = orient(models, robust=robust)
    fresh = orient(models, method, robust=robust)
    reused = orient(models, method, independent=known)
    np.testing.assert_array_equal(reused.y_parallax_rms_px, fresh.y_parallax_rms_px)
    np.testing.assert_array_equal(reused.weights, fresh.weights)


@pytest.mark.parametrize("robust", [False, True])
def test_independent_and_dependent_leave_equal_residuals(robust):
    models = noisy_models(cameras=(0, 1))
    independent, dependent = (orient(models, m, robust=robust) for m in METHODS[:2])
    np.testing.assert_allclose(
        independent.y_parallax_rms_px, dependent.y_parallax_rms_px, rtol=1e-5
    )
    np.testing.assert_array_equal(independent.weights, dependent.weights)
    np.testing.assert_allclose(
        independent.ground_from_left, dependent.ground_from_left, rtol=0.0, atol=1e-12
    )


def test_poselib_finds_the_same_relative_orientation():
    models = noisy_models(n_models=8, n_points=200)
    result = orient(models)
    down = np.diag([1.0, -1.0, -1.0])
    rotation = models.orientations.ground_from_image @ down
    camera = {
        "model": "SIMPLE_PINHOLE",
        "width": 1,
        "height": 1,
        "params": [PRINCIPAL_DISTANCE_PX[0], 0.0, 0.0],
    }
    options = {"max_iterations": 100, "loss_type": "TRIVIAL", "step_tol": 1e-12}
    for k, (left, right) in enumerate(zip(models.pairs.left, models.pairs.right, strict=True)):
        points = slice(*models.pairs.offsets[k : k + 2])
        start = poselib.CameraPose()
        start.R = rotation[right].T @ rotation[left]
        start.t = -rotation[right].T @ models.base_m[k] / np.linalg.norm(models.base_m[k])
        pose, _ = poselib.refine_relative_pose(
            models.left_vectors[points, :2] * [1.0, -1.0],
            models.right_vectors[points, :2] * [1.0, -1.0],
            start,
            camera,
            camera,
            options,
        )
        left_from_right = (down @ pose.R @ down).T
        difference = vector_from_rotation(left_from_right.T @ relative_rotation(result)[k])
        # Sampson errors weigh the points by up to a per cent otherwise
        assert np.abs(difference).max() < 2e-6
        base = -left_from_right @ down @ pose.t / np.linalg.norm(pose.t)
        ours = result.ground_from_left[k].T @ result.base_m[k]
        np.testing.assert_allclose(ours / np.linalg.norm(ours), base, atol=2e-6)


def turned_about_z(models, angle_rad):
    """The ground frame turned by an azimuth (omega-phi-kappa becomes other angles)."""
    turn = rotation_from_angles([0.0, 0.0, angle_rad], "omega-phi-kappa")
    o = models.orientations
    angles = angles_from_rotation(turn @ o.ground_from_image, o.system)
    return models.with_orientations(
        replace(o, position_m=o.position_m @ turn.T, angles_rad=angles)
    ), turn


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("method", ["independent", "dependent", "angles"])
def test_azimuth_of_the_ground_frame_changes_nothing(system, method):
    models = noisy_models(system=system)
    other, turn = turned_about_z(models, 2.3)
    first, second = orient(models, method), orient(other, method)
    np.testing.assert_allclose(first.y_parallax_rms_px, second.y_parallax_rms_px, rtol=1e-9)
    np.testing.assert_allclose(turn @ first.ground_from_right, second.ground_from_right, atol=1e-9)


def test_order_of_models_and_points_changes_nothing():
    models = noisy_models(n_models=4, n_points=30)
    result = orient(models, robust=True)
    rng = np.random.default_rng(5)
    order = np.concatenate([30 * k + rng.permutation(30) for k in (2, 0, 3, 1)])
    pairs = replace(
        models.pairs,
        left=models.pairs.left[[2, 0, 3, 1]],
        right=models.pairs.right[[2, 0, 3, 1]],
    )
    other = replace(
        with_vectors(models, models.left_vectors[order], models.right_vectors[order]), pairs=pairs
    )
    again = orient(other, robust=True)
    np.testing.assert_allclose(
        again.y_parallax_rms_px, result.y_parallax_rms_px[[2, 0, 3, 1]], rtol=1e-9
    )
    np.testing.assert_allclose(again.weights, result.weights[order], atol=1e-6)


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("angle", [0, 1, 2])
def test_held_ground_angles_stay_at_pos(system, angle):
    models = noisy_models(system=system)
    result = orient(models, ("omega", "phi", "kappa")[angle])
    assert result.converged.all()
    angles = angles_from_rotation(result.ground_from_right, system)
    change = wrapped(angles - models.orientations.angles_rad[models.pairs.right])
    assert np.abs(change[:, angle]).max() < 1e-12
    assert np.abs(np.delete(change, angle, axis=1)).min() > 1e-6
    held = orient(models, "angles")
    rotation = models.orientations.ground_from_image[models.pairs.right]
    np.testing.assert_allclose(held.ground_from_right, rotation, atol=1e-12)


def test_millimetres_need_a_pixel_size():
    result = orient(noisy_models(cameras=(0, 0, 0, 1)))
    expected = result.y_parallax_rms_px * np.where(np.arange(6) % 2, np.nan, 0.012)
    np.testing.assert_allclose(result.y_parallax_rms_mm, expected)
