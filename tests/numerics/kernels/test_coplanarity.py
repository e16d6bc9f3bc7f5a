"""Derivatives of the y-parallax: central differences; its value: closed form and invariance."""

import numpy as np
import pytest
from stereo_scene import true_models, with_angle_errors, with_image_noise

from posstats.numerics.kernels.coplanarity import base_frames, y_parallax, y_parallax_derivatives
from posstats.numerics.kernels.rotation import rotation_derivatives, rotation_from_angles

SYSTEMS = ("omega-phi-kappa", "phi-omega-kappa")


def arguments(models, angles=None, base=None):
    """Arguments of y_parallax in a frame per model that stays when angles and base change."""
    frame = base_frames(models.base_m)
    angles = models.orientations.angles_rad if angles is None else angles
    rotation = rotation_from_angles(angles, models.orientations.system)
    base = np.einsum("pij,pj->pi", frame, models.base_m) if base is None else base
    return (
        models.left_vectors,
        models.right_vectors,
        models.pairs.offsets,
        frame @ rotation[models.pairs.left],
        frame @ rotation[models.pairs.right],
        base,
    )


def derivatives(models):
    frame = base_frames(models.base_m)[:, None]
    by_angle = rotation_derivatives(models.orientations.angles_rad, models.orientations.system)
    left, right, _, r1, r2, base = arguments(models)
    d1, d2 = frame @ by_angle[models.pairs.left], frame @ by_angle[models.pairs.right]
    vectors, left_ray = np.concatenate([left, right]), np.arange(len(left))
    pair = models.pairs.pair_of_point
    return y_parallax_derivatives(
        vectors, left_ray, left_ray + len(left), pair, r1, r2, d1, d2, base
    )


def erring_models(system):
    models = true_models(system=system, tilt_rad=0.1, cameras=(0, 1))
    return with_image_noise(with_angle_errors(models, 0.05), 5.0)


def test_perfect_points_have_no_parallax():
    for system in SYSTEMS:
        models = true_models(system=system, tilt_rad=0.1, cameras=(0, 1))
        assert np.abs(models.y_parallax_px()).max() < 1e-8


def test_the_parallax_is_that_of_the_textbook_formula():
    models = erring_models(SYSTEMS[0])
    left, right, _, r1, r2, base = arguments(models)
    pair = models.pairs.pair_of_point
    a = np.einsum("nij,nj->ni", r1[pair], left).T
    b = np.einsum("nij,nj->ni", r2[pair], right).T
    bx, by, bz = base[pair].T
    n1 = (bx * b[2] - bz * b[0]) / (a[0] * b[2] - b[0] * a[2])
    n2 = (bx * a[2] - bz * a[0]) / (a[0] * b[2] - b[0] * a[2])
    expected = (n1 * a[1] - n2 * b[1] - by) / n2
    np.testing.assert_allclose(models.y_parallax_px(), expected, rtol=1e-9, atol=1e-8)


@pytest.mark.parametrize("system", SYSTEMS)
def test_derivatives_by_angles_are_central_differences(system):
    models = erring_models(system)
    q, by_left, by_right, _, _ = derivatives(models)
    np.testing.assert_allclose(q, models.y_parallax_px(), rtol=0.0, atol=1e-9)
    step = 1e-6
    for images, analytic in ((models.pairs.left, by_left), (models.pairs.right, by_right)):
        for angle in range(3):
            shift = np.zeros_like(models.orientations.angles_rad)
            shift[images, angle] = step
            plus, minus = (
                y_parallax(*arguments(models, models.orientations.angles_rad + sign * shift))
                for sign in (1, -1)
            )
            numeric = (plus - minus) / (2.0 * step)
            np.testing.assert_allclose(analytic[:, angle], numeric, rtol=1e-6, atol=1e-3)


def test_derivatives_by_the_base_are_central_differences():
    models = erring_models(SYSTEMS[0])
    by_base = derivatives(models)[3]
    base = arguments(models)[-1]
    for axis in range(3):
        shift = 1e-3 * np.eye(3)[axis]
        plus, minus = (y_parallax(*arguments(models, base=base + sign * shift)) for sign in (1, -1))
        np.testing.assert_allclose(by_base[:, axis], (plus - minus) / 2e-3, rtol=1e-6, atol=1e-6)


def test_derivatives_by_image_coordinates_are_central_differences():
    models = erring_models(SYSTEMS[0])
    by_image = derivatives(models)[4]
    for column in range(4):
        shift = 0.01 * np.eye(3)[column % 2]
        values = []
        for sign in (1, -1):
            left, right, *rest = arguments(models)
            if column < 2:
                left = left + sign * shift
            else:
                right = right + sign * shift
            values.append(y_parallax(left, right, *rest))
        numeric = (values[0] - values[1]) / 0.02
        np.testing.assert_allclose(by_image[:, column], numeric, rtol=0.0, atol=1e-8)


def test_a_zero_base_gives_no_number_and_no_exception():
    models = true_models(n_models=1)
    left, right, offsets, r1, r2, base = arguments(models)
    assert not np.isfinite(y_parallax(left, right, offsets, r1, r2, 0.0 * base)).any()
