"""Models that cannot be oriented are reported and harm no other."""

from dataclasses import replace

import numpy as np
import pytest
from small_scenario import small_block
from stereo_scene import (
    METHODS,
    models_of,
    noisy_models,
    true_models,
    with_image_noise,
    with_vectors,
)

from posstats.block.image_pairs import stereo_models
from posstats.geometry.stereo.relative_orientation import (
    orient,
)
from posstats.numerics.kernels.rotation import (
    rotation_from_angles,
    vector_from_rotation,
)


def degenerate_cases():
    good = noisy_models(n_models=8, n_points=12)
    o = good.orientations
    position, angles = o.position_m.copy(), o.angles_rad.copy()
    position[3] = position[2]  # model 1: zero base
    position[5] = position[4] + [0.0, 0.0, 100.0]  # model 2: vertical base
    angles[6, 1] = np.nan  # model 3: no orientation
    left, right = good.left_vectors.copy(), good.right_vectors.copy()
    for vectors in (left, right):
        vectors[48:60] = vectors[48]  # model 4: one point
        line = np.linspace(0.0, 1.0, 12)[:, None]
        vectors[60:72] = vectors[60] + line * (vectors[71] - vectors[60])  # model 5: a line
        vectors[72:84] = vectors[72:76].repeat(3, axis=0)  # model 6: four points
    models = with_vectors(good, left, right)
    models = models.with_orientations(replace(o, position_m=position, angles_rad=angles))
    offsets = models.pairs.offsets.copy()
    offsets[-1] -= 7  # model 7: five points
    models = replace(
        models,
        pairs=replace(models.pairs, offsets=offsets),
        left_vectors=left[:-7],
        right_vectors=right[:-7],
    )
    return good, models


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("robust", [False, True])
def test_degenerate_models_are_reported_and_harm_no_other(method, robust):
    good, models = degenerate_cases()
    result = orient(models, method, robust=robust)
    assert list(result.status[[0, 1, 2, 3, 7]]) == [
        "ok",
        "degenerate: zero base",
        "degenerate: base without horizontal extent",
        "no orientation",
        "fewer than 6 points",
    ]
    assert all(s.startswith("degenerate: the points") for s in result.status[4:7])
    assert list(result.converged) == [True] + [False] * 7
    for values in (
        result.y_parallax_rms_px,
        result.ground_from_left,
        result.ground_from_right,
        result.base_m,
    ):
        assert np.isnan(values[1:]).all()
        assert np.isfinite(values[0]).all()
    assert np.isnan(result.weights[12:]).all()
    alone = orient(good, method, robust=robust)
    assert result.y_parallax_rms_px[0] == pytest.approx(alone.y_parallax_rms_px[0], rel=1e-9)


def test_points_on_a_line_are_degenerate_with_noise_too():
    truth = true_models(n_models=10, n_points=30)
    ground = np.zeros((10, 30, 3))
    o = truth.orientations
    start = o.position_m[0::2] + 0.5 * truth.base_m - [0.0, 0.0, 3000.0]
    ground = start[:, None] + np.linspace(-400.0, 400.0, 30)[:, None] * [0.6, 0.8, 0.0]
    result = orient(with_image_noise(models_of(o, ground), 0.2))
    assert not result.converged.any()


def test_no_models_give_an_empty_result():
    models = true_models(1)
    pairs = replace(
        models.pairs,
        left=models.pairs.left[:0],
        right=models.pairs.right[:0],
        offsets=np.zeros(1, dtype=np.intp),
    )
    empty = replace(
        models,
        pairs=pairs,
        left_vectors=models.left_vectors[:0],
        right_vectors=models.right_vectors[:0],
        pixel_size_mm=models.pixel_size_mm[:0],
    )
    for method in METHODS:
        assert len(orient(empty, method, robust=True).status) == 0


def test_a_solution_that_turns_the_images_too_far_is_no_solution():
    # Kappa of all images off by 59 degrees: solved by turning back; noise and tilts decide
    # whether that is more than 60 degrees, and the status says which.
    block = small_block()
    models = stereo_models(block)
    angles = block.adjusted.angles_rad + np.array([0.0, 0.0, np.radians(59.0)])
    result = orient(models.with_orientations(block.adjusted.with_angles(angles)))
    start = rotation_from_angles(angles, block.adjusted.system)
    solved = result.converged
    for images, turned in (
        (models.pairs.left, result.ground_from_left),
        (models.pairs.right, result.ground_from_right),
    ):
        change = np.swapaxes(start[images], 1, 2) @ turned
        assert np.linalg.norm(vector_from_rotation(change[solved]), axis=1).max() < np.radians(60.0)
    too_far = result.status == "degenerate: the images turn by more than 60 degrees"
    assert too_far.any()
    assert np.isnan(result.y_parallax_rms_px[too_far]).all()
