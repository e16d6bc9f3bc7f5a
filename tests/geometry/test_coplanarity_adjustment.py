"""The adjustment on arrays: brute-force matrices, numerical derivatives, scipy, refusals."""

from dataclasses import replace

import numpy as np
import pytest
from small_blocks import Layout, observed_block, true_block

from posstats.block.image_pairs import cross_strip_pairs, stereo_models
from posstats.errors import ConvergenceError, GeometryError
from posstats.geometry.coplanarity import adjustment as coplanarity_adjustment
from posstats.geometry.coplanarity.adjustment import Priors, adjust_coplanarity
from posstats.geometry.coplanarity.linearised import linearised
from posstats.geometry.coplanarity.normals import (
    RIDGE,
    PointRays,
    accumulate_normals,
    matrix_of_parts,
    precision,
)
from posstats.geometry.coplanarity.point_pairs import point_pairs
from posstats.numerics.kernels.coplanarity import base_frames

LAYOUT = Layout(n_images=4, n_points=120)


def problem(seed=1, angle_error=2e-3):
    block = observed_block(true_block(LAYOUT), np.random.default_rng(seed), angle_error)
    pairs = point_pairs(block, stereo_models(block).pairs.joined(cross_strip_pairs(block)))
    pos = block.orientations
    priors = Priors(
        pos.angles_rad,
        pos.position_m,
        np.full((len(pos), 3), 0.02),
        pos.sigma_position_m,
        pos.system,
        block.accuracy.image_px,
    )
    frames = base_frames(priors.position_m[pairs.right] - priors.position_m[pairs.left])
    return pairs, priors, frames


def dense(pairs, observed, n_images):
    """J (N, 6 n) and D (N, 2 m) written out."""
    n_pairs = len(observed.q)
    design = np.zeros((n_pairs, n_images, 6))
    by_image = np.zeros((n_pairs, len(pairs.ray_image), 2))
    rows = np.arange(n_pairs)
    left, right = pairs.left[pairs.pair], pairs.right[pairs.pair]
    design[rows, left, :3] = observed.by_left_angles
    design[rows, right, :3] = observed.by_right_angles
    design[rows, left, 3:] = -observed.by_base
    design[rows, right, 3:] = observed.by_base
    by_image[rows, pairs.left_ray] = observed.by_image[:, :2]
    by_image[rows, pairs.right_ray] = observed.by_image[:, 2:]
    return design.reshape(n_pairs, -1), by_image.reshape(n_pairs, -1)


def test_normals_are_those_of_matrices_written_out():
    """J'WJ, J'Wq, G'G, D'Wq, q'Wq and tr(W D D') with W inverted in full, a third down-weighted."""
    pairs, priors, frames = problem()
    unknowns = priors.values.reshape(-1, 6)
    observed = linearised(
        pairs, unknowns, np.zeros((len(pairs.ray_image), 2)), frames, priors.system
    )
    robust = np.random.default_rng(2).choice([1.0, 1.0, 0.3, 0.0], len(observed.q))
    size = unknowns.size
    shape = (pairs.common.max() + 1, 6, 6)
    normals, right_side, noise = np.zeros(shape), np.zeros(size), np.zeros(shape)
    image_noise = np.zeros((len(pairs.ray_image), 2))
    points = PointRays(
        pairs.left_ray, pairs.right_ray, pairs.point_offsets, pairs.first_ray, pairs.n_rays,
        pairs.ray_image,
    )  # fmt: skip
    square_sum, noise_trace = accumulate_normals(
        observed, precision(observed.variance, robust), points, pairs.common, normals, right_side,
        noise, image_noise,
    )  # fmt: skip

    design, by_image = dense(pairs, observed, len(unknowns))
    kept = robust > 0.0
    design, by_image, q = design[kept], by_image[kept], observed.q[kept]
    shared = by_image @ by_image.T
    own = np.diagonal(shared) * (1.0 / robust[kept] - 1.0 + RIDGE)
    weight = np.linalg.inv(shared + np.diag(own))
    noise_design = by_image.T @ weight @ design

    def close(found, expected):
        np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())

    def upper(parts):
        return np.triu(matrix_of_parts(parts, pairs.common))

    close(upper(normals), np.triu(design.T @ weight @ design))
    close(right_side, design.T @ weight @ q)
    close(upper(noise), np.triu(noise_design.T @ noise_design))
    close(image_noise.ravel(), by_image.T @ weight @ q)
    assert square_sum == pytest.approx(q @ weight @ q, rel=1e-9)
    assert noise_trace == pytest.approx(np.trace(weight @ shared), rel=1e-9)


def test_derivatives_are_exact_off_the_solution():
    """Oracle: central differences by every unknown, q of several px."""
    pairs, priors, frames = problem()
    unknowns = priors.values
    no_noise = np.zeros((len(pairs.ray_image), 2))

    def q_at(values):
        return linearised(pairs, values.reshape(-1, 6), no_noise, frames, priors.system).q

    observed = linearised(pairs, unknowns.reshape(-1, 6), no_noise, frames, priors.system)
    design, _ = dense(pairs, observed, len(priors.angles_rad))
    assert np.abs(observed.q).max() > 1.0
    for column, step in enumerate(np.tile([1e-5] * 3 + [1e-2] * 3, len(priors.angles_rad))):
        change = np.zeros(unknowns.size)
        change[column] = step
        numerical = (q_at(unknowns + change) - q_at(unknowns - change)) / (2.0 * step)
        scale = np.abs(design[:, column]).max()
        np.testing.assert_allclose(design[:, column], numerical, atol=1e-6 * scale)


def test_the_solution_is_stationary():
    """The gradient of the whole least-squares problem, by image noise, angles and positions.

    Oracle: the Gauss-Helmert conditions. With W = (D D' + L)^-1, x and the noise e minimise
    e'e + (q - De)'L^-1 (q - De) + s^2 (x - x0)'P (x - x0), solved here by an outside optimiser.
    """
    from scipy.optimize import least_squares

    pairs, priors, frames = problem(angle_error=5e-4)
    found = adjust_coplanarity(pairs, priors, robust=False)
    solution = np.concatenate([found.angles_rad, found.position_m], axis=1)
    n_rays = len(pairs.ray_image)
    at_solution = linearised(pairs, solution, np.zeros((n_rays, 2)), frames, priors.system)
    ridge = 1.0 / np.sqrt(RIDGE * at_solution.variance)
    scale = float(np.sqrt(np.mean(at_solution.q**2 / at_solution.variance)))
    sigma = 1.0 / np.sqrt(priors.weights)

    def residuals(values):
        noise = values[solution.size :].reshape(n_rays, 2)
        unknowns = (priors.values + sigma * values[: solution.size]).reshape(-1, 6)
        observed = linearised(pairs, unknowns, noise, frames, priors.system)
        shift = np.concatenate([noise[pairs.left_ray], noise[pairs.right_ray]], axis=1)
        q = observed.q - np.einsum("ij,ij->i", observed.by_image, shift)
        return np.concatenate([ridge * q / scale, values[solution.size :] / scale,
                               values[: solution.size]])  # fmt: skip

    def jacobian(values):
        noise = values[solution.size :].reshape(n_rays, 2)
        unknowns = (priors.values + sigma * values[: solution.size]).reshape(-1, 6)
        observed = linearised(pairs, unknowns, noise, frames, priors.system)
        design, by_image = dense(pairs, observed, len(solution))
        upper = (ridge / scale)[:, None] * np.concatenate([design * sigma, -by_image], axis=1)
        prior = np.concatenate([np.eye(solution.size), np.zeros((solution.size, 2 * n_rays))], 1)
        own = np.concatenate([np.zeros((2 * n_rays, solution.size)), np.eye(2 * n_rays) / scale], 1)
        return np.concatenate([upper, own, prior])

    start = np.zeros(solution.size + 2 * n_rays)
    best = least_squares(residuals, start, jacobian, xtol=1e-15, ftol=1e-15, gtol=1e-12)
    estimate = (priors.values + sigma * best.x[: solution.size]).reshape(-1, 6)
    standard_error = np.sqrt(np.diagonal(found.covariance_rad2.reshape(24, 24))).reshape(-1, 3)
    assert np.abs((estimate[:, :3] - found.angles_rad) / standard_error).max() < 0.02


def test_covariance_is_symmetric_to_the_last_bit_positive_definite_and_smaller_than_the_prior():
    pairs, priors, _ = problem()
    covariance = adjust_coplanarity(pairs, priors).covariance_rad2.reshape(24, 24)
    np.testing.assert_array_equal(covariance, covariance.T)
    assert np.linalg.eigvalsh(covariance).min() > 0.0
    assert np.sqrt(np.diagonal(covariance)).max() < 0.02


def test_progress_is_told():
    pairs, priors, _ = problem()
    told = []
    result = adjust_coplanarity(
        pairs, priors, progress=lambda done, total: told.append((done, total))
    )
    assert [done for done, _ in told] == list(range(1, result.n_iterations + 1))


def test_hopeless_angles_are_an_error_in_words():
    """Angles of another system, off by radians, do not give a silent answer."""
    pairs, priors, _ = problem()
    wrong = replace(priors, angles_rad=np.random.default_rng(3).uniform(-3, 3, (8, 3)))
    with pytest.raises((ConvergenceError, GeometryError), match=r"coplanarity|normal equations"):
        adjust_coplanarity(pairs, wrong)


def test_too_large_a_block_is_refused_before_memory_runs_out(monkeypatch):
    pairs, priors, _ = problem()
    monkeypatch.setattr(coplanarity_adjustment, "MAX_IMAGES", 7)
    with pytest.raises(GeometryError, match="at most 7 images"):
        adjust_coplanarity(pairs, priors)
