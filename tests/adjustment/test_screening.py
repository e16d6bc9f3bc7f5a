"""Rays that the robust start takes out: blunders, and no good ones."""

from dataclasses import replace

import numpy as np
from small_blocks import Layout, observed_block, true_block

from posstats.adjustment.block_problem import bundle_problem
from posstats.adjustment.screening import contradicting_rays


def observed_problem(seed):
    truth = true_block(Layout(n_strips=3, n_images=6, base_m=480.0, n_points=500, seed=seed))
    angles = 1e-4 * np.random.default_rng([seed, 1]).standard_normal((18, 3))
    return bundle_problem(observed_block(truth, np.random.default_rng(seed), angles))


def test_blocks_without_blunders_keep_their_rays():
    """Five standard deviations: 0.01 of the 16,000 coordinates, were they independent."""
    problems = [observed_problem(seed) for seed in range(1, 11)]
    assert sum(2 * len(problem.point) for problem in problems) > 16_000
    assert sum(contradicting_rays(problem).sum() for problem in problems) == 0


def test_blunders_go_and_good_rays_of_the_same_points_stay():
    problem = observed_problem(1)
    n_rays = np.bincount(problem.point)[problem.point]
    first = np.append(True, problem.point[1:] != problem.point[:-1])
    wrong = np.flatnonzero(first & (n_rays >= 4))[::5]
    xy = problem.xy_px.copy()
    xy[wrong] += [20.0, 20.0]
    rejected = np.flatnonzero(contradicting_rays(replace(problem, xy_px=xy)))
    assert np.isin(rejected, wrong).all()
    # points that the robust adjustment lost with their blunder are left to data snooping
    assert len(rejected) > 0.8 * len(wrong)
