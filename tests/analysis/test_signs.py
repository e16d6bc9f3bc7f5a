"""Errors are POS minus truth, corrections take them off: oracles are errors put in by hand."""

from dataclasses import replace

import numpy as np
import pytest
from small_blocks import Layout, true_block

from posstats.analysis.angle_errors import adjusted_errors, in_camera_frame
from posstats.block.turned import corrected
from posstats.numerics.kernels.rotation import rotation_from_angles, rotation_from_vector

ERROR_RAD = np.array([0.004, -0.002, 0.007])


@pytest.fixture(scope="module")
def truth():
    return true_block(Layout(n_points=20, tilt_rad=0.05)).orientations


def block_of(pos, truth):
    return replace(true_block(Layout(n_points=20)), orientations=pos, adjusted=truth)


def test_angle_errors_are_pos_minus_adjusted(truth):
    pos = replace(truth, angles_rad=truth.angles_rad + ERROR_RAD)
    found = adjusted_errors(block_of(pos, truth))
    np.testing.assert_allclose(found.error_rad, np.tile(ERROR_RAD, (len(pos), 1)), atol=1e-14)


def test_correcting_by_the_errors_gives_the_truth_in_both_frames(truth):
    pos = replace(truth, angles_rad=truth.angles_rad + ERROR_RAD)
    ground = adjusted_errors(block_of(pos, truth))
    for errors in (ground, in_camera_frame(ground, pos)):
        found = corrected(pos, errors.error_rad, errors.frame)
        turned = found.ground_from_image - truth.ground_from_image
        np.testing.assert_allclose(turned, 0.0, atol=1e-12)


def test_camera_errors_are_turns_of_the_true_camera_about_its_own_axes(truth):
    """R_pos = R_true exp([e]x), in this order: the boresight of a camera in its own axes."""
    turned = truth.ground_from_image @ rotation_from_vector(ERROR_RAD)
    pos = corrected(truth, np.tile(-ERROR_RAD, (len(truth), 1)), "camera")
    np.testing.assert_allclose(rotation_from_angles(pos.angles_rad, pos.system), turned, atol=1e-12)
    found = in_camera_frame(adjusted_errors(block_of(pos, truth)), pos)
    np.testing.assert_allclose(found.error_rad, np.tile(ERROR_RAD, (len(pos), 1)), atol=1e-10)
