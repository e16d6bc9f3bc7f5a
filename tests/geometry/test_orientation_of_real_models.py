"""Relative orientation of the real blocks, beside scipy."""

import numpy as np
import pytest
from helpers import shared_path
from stereo_scene import least_of_scipy

from posstats.block.image_pairs import stereo_models
from posstats.formats.block_folder import read_block
from posstats.geometry.stereo.parallax import model_rms_px
from posstats.geometry.stereo.relative_orientation import (
    orient,
)


def test_a_real_block_of_known_orientation_needs_little():
    block = read_block(shared_path("data", "ign-fd1305"))
    models = stereo_models(block).with_orientations(block.adjusted)
    raw = model_rms_px(models)
    assert np.isfinite(raw).sum() == 53
    assert np.nanmean(raw) == pytest.approx(0.214, abs=0.002)
    result = orient(models)
    assert result.converged.sum() == 53
    assert np.nanmax(result.y_parallax_rms_px / raw) <= 1.0


@pytest.mark.parametrize("start", ["pos", "adjusted"])
def test_six_points_in_a_curved_valley_reach_the_least_that_scipy_finds(start):
    # Model 1 turns by 0.8 degrees for 0.1 px of noise: a step of Gauss-Newton from the adjusted
    # orientation multiplies the sum of squares by nine, so this asks for fine damping.
    block = read_block(shared_path("data", "ign-fd1305"))
    models = stereo_models(block)
    if start == "adjusted":
        models = models.with_orientations(block.adjusted)
    change_rad, rms_px = least_of_scipy(models, 1)
    result = orient(models)
    assert result.n_points[1] == 6
    # In the valley scipy stops up to 3e-6 short of the least, by its release; we must not.
    assert rms_px * (1.0 - 1e-5) < result.y_parallax_rms_px[1] < rms_px * (1.0 + 1e-7)
    assert np.abs(change_rad).max() > np.radians(0.5)


def test_a_drone_pos_far_from_truth_is_overcome():
    models = stereo_models(read_block(shared_path("data", "seneca")))
    raw = model_rms_px(models)
    assert np.isfinite(raw).sum() == 63
    assert np.nanmedian(raw) == pytest.approx(279.0, rel=0.03)
    for robust in (False, True):
        result = orient(models, robust=robust)
        assert np.nanmedian(result.y_parallax_rms_px) <= 1.3
        assert result.converged[result.n_points > 8].all()


def test_plain_least_squares_of_a_drone_model_gives_up_on_a_least_sixty_degrees_away():
    # Eight points in a corner of 470 x 85 px: the sum of squares falls along a valley to turns
    # that no camera made; scipy takes some 500 evaluations to get there.
    models = stereo_models(read_block(shared_path("data", "seneca")))
    lost = np.flatnonzero(~orient(models).converged)
    assert list(models.pairs.n_points[lost]) == [8]
    change_rad, rms_px = least_of_scipy(models, lost[0], x_scale="jac", max_nfev=5000)
    assert np.abs(change_rad).max() > np.radians(60.0)
    assert rms_px < 0.31
