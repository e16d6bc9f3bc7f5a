"""Image rays with additional parameters: the package's camera, and differences."""

import numpy as np
import pytest
from strip_scene import CAMERA, measurements, scene

from posstats.block.camera import Camera, Distortion
from posstats.numerics.bundle.rays import CAMERA_PARAMETERS, Cameras, Images, project_rays
from posstats.numerics.kernels.rotation import rotation_from_vector

C = CAMERA.principal_distance_px
VALUES = np.array([3.0, -2.0, 1.5, 2e-8, 3e-5, -2e-5, 0.02, -0.01, 0.004, 1e-3, -2e-3])


def cameras(values):
    columns = np.full((1, len(CAMERA_PARAMETERS)), -1)
    return Cameras(np.array([C]), np.array([0.01]), 100.0, values[None], columns)


def images(oriented, turn=0.0, move=0.0):
    rotation = rotation_from_vector(np.broadcast_to(turn, (len(oriented), 3)))
    return Images(
        rotation @ oriented.ground_from_image, oriented.position_m + move, oriented.camera
    )


def test_brown_parameters_are_those_of_the_camera_model():
    oriented, ground = scene(1)
    rays = measurements(oriented, ground)
    values = VALUES * [0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 1]
    xy, *_ = project_rays(ground, rays.point, rays.image, images(oriented), cameras(values))
    k1, k2, k3, p1, p2 = VALUES[6:]
    distorted = Camera(
        "c", "c", 1.0, 1.0, C, (0.0, 0.0), None, Distortion("brown", k1, k2, k3, p1, p2)
    )
    measured = distorted.measured_from_ideal(rays.xy_px) * [1.0, -1.0]
    np.testing.assert_allclose(xy, measured, rtol=0, atol=1e-9)


def test_bauer_parameters_are_those_of_equation_6():
    oriented, ground = scene(1)
    rays = measurements(oriented, ground)
    values = VALUES * [0, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0]
    xy, *_ = project_rays(ground, rays.point, rays.image, images(oriented), cameras(values))
    _, x0, y0, s1, s2, s3, *_ = VALUES
    x, y = 0.01 * rays.xy_px.T
    ring = x**2 + y**2 - 100.0**2
    shift_mm = np.stack([s1 * x * ring - s3 * x, s1 * y * ring + s2 * x + s3 * y], axis=1)
    np.testing.assert_allclose(xy, rays.xy_px + shift_mm / 0.01 + [x0, y0], rtol=0, atol=1e-9)


@pytest.mark.parametrize("values", [0.0 * VALUES, VALUES], ids=["ideal", "deformed"])
def test_derivatives_agree_with_central_differences(values):
    oriented, ground = scene(2)
    rays = measurements(oriented, ground)

    def at(ground=ground, turn=0.0, move=0.0, values=values):
        return project_rays(
            ground, rays.point, rays.image, images(oriented, turn, move), cameras(values)
        )

    _, by_pose, by_ground, by_camera = at()
    for axis in range(3):
        unit = np.eye(3)[axis]
        turned = (at(turn=1e-6 * unit)[0] - at(turn=-1e-6 * unit)[0]) / 2e-6
        moved = (at(move=1e-3 * unit)[0] - at(move=-1e-3 * unit)[0]) / 2e-3
        shifted = (at(ground + 1e-3 * unit)[0] - at(ground - 1e-3 * unit)[0]) / 2e-3
        np.testing.assert_allclose(by_pose[:, :, axis], turned, rtol=1e-7, atol=2e-4)
        np.testing.assert_allclose(by_pose[:, :, 3 + axis], moved, rtol=1e-7, atol=1e-8)
        np.testing.assert_allclose(by_ground[:, :, axis], shifted, rtol=1e-7, atol=1e-8)
    steps = [1e-1, 1e-1, 1e-1, 1e-9, 1e-5, 1e-5, 1e-4, 1e-4, 1e-4, 1e-4, 1e-4]
    for column, step in enumerate(steps):
        change = step * np.eye(11)[column]
        difference = (at(values=values + change)[0] - at(values=values - change)[0]) / (2.0 * step)
        scale = np.abs(difference).max()
        np.testing.assert_allclose(
            by_camera[:, :, column], difference, rtol=1e-7, atol=1e-7 * scale
        )


def test_a_point_behind_the_camera_has_no_image():
    oriented, ground = scene(3)
    ground[0, 2] = 5000.0
    rays = measurements(oriented, ground)
    for values in project_rays(ground, rays.point, rays.image, images(oriented), cameras(VALUES)):
        assert np.isnan(values[rays.point == 0]).all()
        assert np.isfinite(values[rays.point > 0]).all()
