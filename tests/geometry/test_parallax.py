"""Statistics of the y-parallax: hand-made values and bad models."""

from dataclasses import replace

import numpy as np
import pytest
from stereo_scene import true_models, with_angle_errors

from posstats.geometry.stereo.parallax import block_statistics, model_rms_px, strip_statistics


def test_the_rms_is_over_all_points_of_a_model():
    models = with_angle_errors(true_models(3, 10), 0.01)
    q = models.y_parallax_px().reshape(3, 10)
    np.testing.assert_allclose(model_rms_px(models), np.sqrt(np.mean(q**2, axis=1)), rtol=1e-12)


def test_models_without_a_value_are_nan():
    models = with_angle_errors(true_models(4, 6), 0.01)
    o = models.orientations
    position, angles = o.position_m.copy(), o.angles_rad.copy()
    position[1] = position[0]
    angles[3] = np.nan
    models = models.with_orientations(replace(o, position_m=position, angles_rad=angles))
    offsets = np.array([0, 6, 12, 17, 23])  # the third has five points
    models = replace(
        models,
        pairs=replace(models.pairs, offsets=offsets),
        left_vectors=models.left_vectors[:-1],
        right_vectors=models.right_vectors[:-1],
    )
    assert list(np.isnan(model_rms_px(models))) == [True, True, True, False]


def test_strips_and_block_are_summed_up_over_models_with_a_value():
    models = true_models(4, 6)
    strip = np.array(["b", "b", "b", "b", "a", "a", "c", "c"], dtype=object)
    models = models.with_orientations(replace(models.orientations, strip=strip))
    rms_px = np.array([1.0, 3.0, 5.0, np.nan])
    b, a, c = strip_statistics(models, rms_px)
    assert (b.strip, b.n_models, b.max_px, b.min_px, b.mean_px) == ("b", 2, 3.0, 1.0, 2.0)
    assert b.mean_mm == pytest.approx(2.0 * 0.012)
    assert (a.strip, a.n_models, a.mean_px) == ("a", 1, 5.0)
    assert (c.strip, c.n_models) == ("c", 0)
    assert np.isnan([c.max_px, c.min_px, c.mean_px, c.mean_mm]).all()
    block = block_statistics(models, rms_px)
    assert (block.strip, block.n_models, block.mean_px) == (None, 3, 3.0)


def test_millimetres_are_unknown_when_one_pixel_size_is():
    models = true_models(2, 6, cameras=(0, 0, 0, 1))
    block = block_statistics(models, np.array([1.0, 2.0]))
    assert block.mean_px == 1.5
    assert np.isnan(block.mean_mm)
