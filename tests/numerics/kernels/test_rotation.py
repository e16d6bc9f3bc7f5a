"""Rotations against scipy, against turns that can be followed by hand, and against differences."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from posstats.numerics.kernels.rotation import (
    angles_from_rotation,
    axis_rotation,
    rotation_derivatives,
    rotation_from_angles,
    rotation_from_vector,
    skew,
    vector_from_rotation,
    wrapped,
)

SYSTEMS = ("omega-phi-kappa", "phi-omega-kappa")
ANGLES = np.random.default_rng(1).uniform(-0.7, 0.7, (20, 3))


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_a_quarter_turn_takes_the_next_axis_onto_the_one_after(axis):
    turned = axis_rotation(axis, np.array(np.pi / 2)) @ np.eye(3)[(axis + 1) % 3]
    np.testing.assert_allclose(turned, np.eye(3)[(axis + 2) % 3], atol=1e-15)


def test_rotations_are_those_of_scipy():
    omega_first = rotation_from_angles(ANGLES, "omega-phi-kappa")
    np.testing.assert_allclose(omega_first, Rotation.from_euler("XYZ", ANGLES).as_matrix(),
                               atol=1e-14)  # fmt: skip
    phi_first = rotation_from_angles(ANGLES, "phi-omega-kappa")
    turned = ANGLES[:, [1, 0, 2]] * [-1.0, 1.0, 1.0]
    np.testing.assert_allclose(phi_first, Rotation.from_euler("YXZ", turned).as_matrix(),
                               atol=1e-14)  # fmt: skip


def test_signs_of_the_angles_of_a_nadir_photograph():
    """Positive omega tips the image's up towards the sky, kappa turns it counter-clockwise;
    positive phi of omega-phi-kappa lowers the image's right, that of phi-omega-kappa lifts it.
    """
    small = 0.01
    up, right = np.array([0.0, 1.0, 0.0]), np.array([1.0, 0.0, 0.0])
    for system, sign in zip(SYSTEMS, (-1.0, 1.0), strict=True):
        assert (rotation_from_angles([small, 0.0, 0.0], system) @ up)[2] > 0.0
        assert sign * (rotation_from_angles([0.0, small, 0.0], system) @ right)[2] > 0.0
        assert (rotation_from_angles([0.0, 0.0, small], system) @ right)[1] > 0.0


@pytest.mark.parametrize("system", SYSTEMS)
def test_angles_come_back_and_derivatives_are_differences(system):
    rotation = rotation_from_angles(ANGLES, system)
    np.testing.assert_allclose(angles_from_rotation(rotation, system), ANGLES, atol=1e-13)
    derivatives = rotation_derivatives(ANGLES, system)
    for k, step in enumerate(1e-6 * np.eye(3)):
        difference = rotation_from_angles(ANGLES + step, system) - rotation_from_angles(
            ANGLES - step, system
        )
        np.testing.assert_allclose(derivatives[:, k], difference / 2e-6, atol=1e-9)


def test_rotation_vectors_are_those_of_scipy_and_come_back():
    rotation = rotation_from_vector(ANGLES)
    np.testing.assert_allclose(rotation, Rotation.from_rotvec(ANGLES).as_matrix(), atol=1e-14)
    np.testing.assert_allclose(vector_from_rotation(rotation), ANGLES, atol=1e-13)


def test_skew_is_the_cross_product():
    a, b = ANGLES[:10], ANGLES[10:]
    np.testing.assert_allclose((skew(a) @ b[:, :, None])[:, :, 0], np.cross(a, b), atol=1e-16)


def test_angles_are_reduced_to_half_a_turn_on_both_sides():
    turns = np.radians([190.0, -190.0, 540.0, 10.0])
    np.testing.assert_allclose(np.degrees(wrapped(turns)), [-170.0, 170.0, -180.0, 10.0])
