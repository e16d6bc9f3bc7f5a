"""Projection and its derivatives: oracles are numpy's collinearity equations and differences."""

import numpy as np
import pytest
from strip_scene import CAMERA, measurements, projected, scene

from posstats.numerics.kernels.collinearity import project, project_derivatives
from posstats.numerics.kernels.rotation import rotation_derivatives

SYSTEMS = ["omega-phi-kappa", "phi-omega-kappa"]


def _arguments(oriented):
    distance = np.full(len(oriented), CAMERA.principal_distance_px)
    return oriented.ground_from_image, oriented.position_m, distance


def _derivatives(oriented, ground, rays):
    rotation, position, distance = _arguments(oriented)
    turned = rotation_derivatives(oriented.angles_rad, oriented.system)
    return project_derivatives(ground, rays.point, rays.image, rotation, turned, position, distance)


@pytest.mark.parametrize("system", SYSTEMS)
def test_projection_agrees_with_the_collinearity_equations(system):
    oriented, ground = scene(1, system=system)
    rays = measurements(oriented, ground)
    xy = project(ground, rays.point, rays.image, *_arguments(oriented))
    np.testing.assert_allclose(xy, rays.xy_px, rtol=0, atol=1e-9)
    np.testing.assert_allclose(_derivatives(oriented, ground, rays)[0], xy, rtol=1e-14)


def test_projection_of_a_vertical_image_is_scaled_ground():
    # closed form: x = c X / h, y = c Y / h
    xy = project(
        np.array([[30.0, -20.0, 100.0]]),
        np.array([0]),
        np.array([0]),
        np.eye(3)[None],
        np.array([[0.0, 0.0, 1100.0]]),
        np.array([5000.0]),
    )
    np.testing.assert_allclose(xy, [[150.0, -100.0]], rtol=1e-14)


@pytest.mark.parametrize("system", SYSTEMS)
def test_derivatives_agree_with_central_differences(system):
    oriented, ground = scene(2, system=system)
    rays = measurements(oriented, ground)
    _, by_angles, by_ground = _derivatives(oriented, ground, rays)
    for axis in range(3):
        turn, move = np.zeros(3), np.zeros(3)
        turn[axis], move[axis] = 1e-6, 1e-3

        def at(angle=0.0, point=0.0):
            turned = oriented.with_angles(oriented.angles_rad + angle)
            return projected(turned, ground + point, rays.point, rays.image)

        by_angle = (at(angle=turn) - at(angle=-turn)) / 2e-6
        by_point = (at(point=move) - at(point=-move)) / 2e-3
        np.testing.assert_allclose(by_angles[:, :, axis], by_angle, rtol=1e-7, atol=1e-4)
        np.testing.assert_allclose(by_ground[:, :, axis], by_point, rtol=1e-7, atol=1e-8)


def test_a_point_behind_the_camera_has_no_image():
    oriented, ground = scene(3)
    ground[0, 2] = 5000.0
    rays = measurements(oriented, ground)
    xy = project(ground, rays.point, rays.image, *_arguments(oriented))
    assert np.isnan(xy[rays.point == 0]).all()
    assert np.isfinite(xy[rays.point > 0]).all()
    for values in _derivatives(oriented, ground, rays):
        assert np.isnan(values[rays.point == 0]).all()
