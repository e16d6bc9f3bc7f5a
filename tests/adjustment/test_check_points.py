"""Image coordinates freed of an estimated deformation."""

import numpy as np

from posstats.adjustment.check_points import ideal_xy
from posstats.block.camera import Camera, Distortion
from posstats.numerics.bundle.rays import CAMERA_PARAMETERS, Cameras


def cameras(**values: float) -> Cameras:
    value = np.zeros((1, len(CAMERA_PARAMETERS)))
    for name, number in values.items():
        value[0, CAMERA_PARAMETERS.index(name)] = number
    column = np.full((1, len(CAMERA_PARAMETERS)), -1)
    return Cameras(np.array([10_000.0]), np.array([0.01]), 100.0, value, column)


def grid() -> np.ndarray:
    x, y = np.meshgrid(np.linspace(-6000, 6000, 7), np.linspace(-4000, 4000, 5))
    return np.column_stack([x.ravel(), y.ravel()])


def test_brown_is_the_distortion_of_a_camera():
    lens = Distortion("brown", k1=0.01, k2=-0.02, k3=0.003, p1=1e-4, p2=-2e-4)
    camera = Camera("", "", 1, 1, 10_000.0, (0.0, 0.0), distortion=lens)
    ideal = grid()
    measured = camera.measured_from_ideal(ideal) * [1.0, -1.0]
    estimated = cameras(brown_k1=0.01, brown_k2=-0.02, brown_k3=0.003, brown_p1=1e-4, brown_p2=-2e-4)  # fmt: skip  # noqa: E501
    camera_of = np.zeros(len(ideal), dtype=int)
    np.testing.assert_allclose(ideal_xy(measured, camera_of, estimated), ideal, atol=1e-5)


def test_bauer_is_equation_6():
    s1, s2, s3 = 2e-8, 1e-4, -5e-5
    ideal = grid()
    x, y = ideal.T
    ring = s1 * (0.01**2 * (x**2 + y**2) - 100.0**2)
    measured = ideal + np.column_stack([x * ring - s3 * x, y * ring + s2 * x + s3 * y])
    estimated = cameras(bauer_s1=s1, bauer_s2=s2, bauer_s3=s3)
    found = ideal_xy(measured, np.zeros(len(ideal), dtype=int), estimated)
    np.testing.assert_allclose(found, ideal, atol=1e-5)


def test_without_deformation_nothing_changes():
    xy = grid()
    assert ideal_xy(xy, np.zeros(len(xy), dtype=int), cameras()) is xy
