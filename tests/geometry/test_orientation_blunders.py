"""Blunders among the points of a model are found, and normal noise is kept."""

from dataclasses import replace

import numpy as np
import pytest
from stereo_scene import (
    noisy_models,
    with_vectors,
)

from posstats.geometry.stereo.relative_orientation import (
    orient,
)


def with_blunders(models, n_blunders, seed=4):
    """In every model, right points moved by 20 to 400 px in y: none is below any limit."""
    rng = np.random.default_rng(seed)
    shape = len(models), len(models.left_vectors) // len(models)
    bad = (np.argsort(rng.random(shape), axis=1) < n_blunders).ravel()
    right = models.right_vectors.copy()
    right[bad, 0] += rng.uniform(-400.0, 400.0, bad.sum())
    right[bad, 1] += rng.choice([-1.0, 1.0], bad.sum()) * rng.uniform(20.0, 400.0, bad.sum())
    return with_vectors(models, models.left_vectors, right), bad


def without_points(models, gone):
    n_points = np.bincount(models.pairs.pair_of_point[~gone], minlength=len(models))
    pairs = replace(
        models.pairs,
        offsets=np.concatenate([[0], np.cumsum(n_points)]),
        left_ray=models.pairs.left_ray[~gone],
        right_ray=models.pairs.right_ray[~gone],
    )
    return replace(
        models,
        pairs=pairs,
        left_vectors=models.left_vectors[~gone],
        right_vectors=models.right_vectors[~gone],
    )


@pytest.mark.parametrize(
    ("n_points", "n_blunders"), [(20, 4), (20, 6), (30, 6), (30, 9), (150, 30), (150, 60)]
)
def test_blunders_are_rejected_and_do_not_bend_the_solution(n_points, n_blunders):
    # Oracle: plain least squares of the points that are no blunders.
    models, bad = with_blunders(noisy_models(n_models=60, n_points=n_points), n_blunders)
    kept = orient(without_points(models, bad))
    result = orient(models, robust=True)
    assert result.converged.all()
    assert (result.weights[bad] == 0.0).all()
    assert (result.weights[~bad] == 0.0).mean() < 0.005
    np.testing.assert_array_equal(
        result.n_rejected, np.bincount(models.pairs.pair_of_point, result.weights == 0.0)
    )
    same = result.n_rejected == n_blunders
    assert same.mean() > 0.95
    # Least squares leaves the least, (n - u) sigma^2 on average; weights of 95 % efficiency
    # leave on average (1 / 0.95 - 1) u sigma^2 more.
    excess = (result.y_parallax_rms_px / kept.y_parallax_rms_px)[same] ** 2 - 1.0
    assert excess.min() > -1e-9
    assert excess.mean() < (1.0 / 0.95 - 1.0) * 5.0 / (n_points - n_blunders - 5.0)


def test_one_blunder_among_twelve_points_is_found():
    models, bad = with_blunders(noisy_models(n_models=300, n_points=12), 1)
    result = orient(models, robust=True)
    assert (result.weights[bad] == 0.0).mean() > 0.99


@pytest.mark.parametrize("n_points", [6, 8, 12, 30, 200])
def test_normal_noise_is_kept_and_the_rms_unbiased(n_points):
    models = noisy_models(n_models=200, n_points=n_points)
    plain, robust = orient(models), orient(models, robust=True)
    both = plain.converged & robust.converged
    assert both.mean() > 0.9
    rejected = robust.n_rejected[both].sum() / (n_points * both.sum())
    assert rejected < 0.01
    mean_square = [np.mean(r.y_parallax_rms_px[both] ** 2) for r in (plain, robust)]
    # expected: 0.2 px in both images, q = y1 - y2, five elements estimated
    expected = 2 * 0.2**2 * (1 - 5 / n_points)
    assert mean_square[0] == pytest.approx(expected, rel=0.25)
    assert mean_square[1] == pytest.approx(mean_square[0], rel=0.1)
