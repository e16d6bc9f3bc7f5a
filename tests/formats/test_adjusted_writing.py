"""Standard deviations of angles in the conventions of files."""

import numpy as np
import pytest

from posstats.block.frames import GroundFrame
from posstats.formats.convention import Convention
from posstats.numerics.kernels.rotation import rotation_from_angles, rotation_from_vector


@pytest.mark.parametrize("angles", ["omega-phi-kappa", "phi-omega-kappa", "roll-pitch-heading"])
def test_sigmas_of_file_angles_by_turning_the_camera(angles):
    rng = np.random.default_rng(1)
    position = np.array([[650_000.0, 6_600_000.0, 3000.0], [660_000.0, 6_640_000.0, 2500.0]])
    frame = GroundFrame.tangent("EPSG:2154", position)
    convention = Convention(angles, np.radians(0.9), frame, mounting_rad=0.3)
    rotation = rotation_from_angles(
        np.array([[0.05, -0.1, 1.0], [-0.2, 0.1, -2.5]]), "omega-phi-kappa"
    )
    factor = 1e-4 * rng.normal(size=(2, 3, 3))
    covariance = factor @ np.swapaxes(factor, 1, 2)
    by_turn = np.empty((2, 3, 3))
    for axis in range(3):
        step = 1e-6 * np.eye(3)[axis]
        ends = [
            convention.file_angles(position, rotation_from_vector(sign * step) @ rotation)
            for sign in (1.0, -1.0)
        ]
        by_turn[:, :, axis] = (ends[0] - ends[1]) / 2e-6
    expected = np.sqrt(np.diagonal(by_turn @ covariance @ np.swapaxes(by_turn, 1, 2), 0, 1, 2))
    found = convention.file_angle_sigmas(position, rotation, covariance)
    np.testing.assert_allclose(found, expected, rtol=1e-6)
