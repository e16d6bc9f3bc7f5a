"""Roll, pitch, heading against real converted POS data and hand-made cases."""

import numpy as np
import pandas as pd
import pytest
from helpers import shared_path
from pyproj import Proj

from posstats.block.frames import GroundFrame
from posstats.formats.navigation import (
    navigation_from_rotation,
    navigation_rotation_vectors,
    rotation_from_navigation,
)
from posstats.numerics.kernels.rotation import angles_from_rotation, vector_from_rotation, wrapped


def test_seneca_pos_converts_to_its_published_omega_phi_kappa() -> None:
    """Oracle: the same POS as metadata (heading, pitch, roll, geographic) and in EPSG:32617.

    The metadata's last digit is 1e-6 degrees, 1.7e-8 rad.
    """
    raw = pd.read_csv(shared_path("data", "seneca", "raw_pos.csv")).set_index("image")
    converted = pd.read_csv(shared_path("data", "seneca", "orientations.csv")).set_index("image")
    raw = raw.loc[converted.index]
    x, y = Proj("EPSG:32617")(raw.longitude_deg.to_numpy(), raw.latitude_deg.to_numpy())
    position = np.column_stack([x, y, raw.height_wgs84_m])
    assert np.allclose(position, converted[["x", "y", "z"]], atol=1e-3)
    angles = np.radians(raw[["roll_deg", "pitch_deg", "heading_deg"]].to_numpy())
    rotation = rotation_from_navigation(angles, GroundFrame("EPSG:32617").convergence_rad(position))
    opk = angles_from_rotation(rotation, "omega-phi-kappa")
    expected = np.radians(converted[["omega", "phi", "kappa"]].to_numpy())
    assert np.abs(wrapped(opk - expected)).max() < 2e-8


@pytest.mark.parametrize(
    ("roll", "pitch", "heading", "image_up", "view"),
    [
        (0, 0, 0, (0, 1, 0), (0, 0, -1)),  # level, flying north
        (0, 0, 90, (1, 0, 0), (0, 0, -1)),  # flying east: image top east
        (0, 10, 0, (0, np.cos(np.pi / 18), np.sin(np.pi / 18)), None),  # nose up
        (10, 0, 0, None, (-np.sin(np.pi / 18), 0, -np.cos(np.pi / 18))),  # right wing down
    ],
)
def test_the_axes_of_simple_attitudes(roll, pitch, heading, image_up, view) -> None:
    rotation = rotation_from_navigation(np.radians([roll, pitch, heading]))
    if image_up is not None:
        assert np.allclose(rotation[:, 1], image_up, atol=1e-15)
    if view is not None:
        assert np.allclose(-rotation[:, 2], view, atol=1e-15)


def test_mounting_turns_the_image_top_clockwise() -> None:
    """A camera mounted 90 degrees clockwise, flying north, has its image top in the east."""
    rotation = rotation_from_navigation(np.zeros(3), 0.0, np.pi / 2)
    assert np.allclose(rotation[:, 1], (1, 0, 0), atol=1e-15)


def test_grid_north_east_of_true_north_makes_the_grid_heading_smaller() -> None:
    rotation = rotation_from_navigation(np.zeros((1, 3)), np.array([0.1]))
    assert np.allclose(rotation[0, :, 1], (-np.sin(0.1), np.cos(0.1), 0.0))


def test_navigation_angles_come_back() -> None:
    rng = np.random.default_rng(3)
    angles = rng.uniform(-1.0, 1.0, (50, 3)) * (3.1, 1.5, 3.1) + (0.0, 0.0, 3.14)
    convergence = rng.uniform(-0.1, 0.1, 50)
    rotation = rotation_from_navigation(angles, convergence, 0.7)
    back = navigation_from_rotation(rotation, convergence, 0.7)
    assert np.abs(wrapped(back - angles)).max() < 1e-13


def test_rotation_vectors_are_the_derivative_of_the_rotation() -> None:
    """Oracle: central differences."""
    angles = np.random.default_rng(4).uniform(-1.0, 1.0, (20, 3))
    vectors = navigation_rotation_vectors(angles, 0.4)
    for axis in range(3):
        step = 1e-5 * np.eye(3)[axis]
        before = rotation_from_navigation(angles - step, 0.0, 0.4)
        after = rotation_from_navigation(angles + step, 0.0, 0.4)
        difference = vector_from_rotation(np.swapaxes(before, -1, -2) @ after) / 2e-5
        assert np.allclose(vectors[:, :, axis], difference, atol=1e-9)
