"""A bundle adjustment written out densely in numpy, linearised by differences: an oracle."""

from dataclasses import replace

import numpy as np
from small_blocks import Layout, observed_block, true_block

from posstats.adjustment.block_problem import bundle_problem
from posstats.block.model import GroundPoints
from posstats.numerics.kernels.rotation import angles_from_rotation, rotation_from_vector, wrapped

STEP = np.array([1e-6] * 3 + [1e-2] * 3)


def noisy_problem(
    parameters=(), seed=1, n_control=4, noise=1.0, control_noise=1.0, stated=None, **layout
):
    """Two strips whose observations, POS angles too, err as stated; some points surveyed."""
    truth = true_block(Layout(**({"n_images": 4, "n_points": 60, "jitter_m": 30.0} | layout)))
    rng = np.random.default_rng(seed)
    pos = truth.orientations
    angle_noise = noise * pos.sigma_angles_rad * rng.standard_normal(pos.angles_rad.shape)
    block = observed_block(truth, rng, error_rad=angle_noise, noise=noise)
    ties = truth.tie_points
    often = np.argsort(-np.bincount(ties.point), kind="stable")[:n_control]
    ground = bundle_problem(truth).ground_m[often]
    sigma = np.full((n_control, 2), [0.02, 0.03])
    error = control_noise * rng.standard_normal((n_control, 3)) * sigma[:, [0, 0, 1]]
    surveyed = GroundPoints(
        ties.point_id[often], ground + error, np.zeros(n_control, dtype=bool), *sigma.T
    )
    return bundle_problem(replace(block, ground_points=surveyed), parameters)


class DenseBundle:
    """Residuals (computed minus measured), weight and design of all observations at a solution.

    Rows: image coordinates ray by ray, six POS observations image by image, control, priors.
    Columns: six of every image, three of every point, then additional parameters of which only
    GNSS and IMU shifts of the block are known here.
    """

    def __init__(self, problem, result):
        self.problem, self.result = problem, result
        n, p, k = len(problem.position_m), len(problem.ground_m), len(problem.parameters)
        self.n, self.p = n, p
        steps = np.concatenate([np.tile(STEP, n), np.full(3 * p, 1e-2), np.full(k, 1e-5)])
        zero = np.zeros(len(steps))
        self.residual = self.residuals(zero)
        self.design = np.empty((len(self.residual), len(steps)))
        for at, step in enumerate(steps):
            change = zero.copy()
            change[at] = step
            self.design[:, at] = (self.residuals(change) - self.residuals(-change)) / (2.0 * step)
        self.weight = self._weight()
        normal = self.design.T @ self.weight @ self.design
        scale = 1.0 / np.sqrt(np.diagonal(normal))
        self.cofactor = np.linalg.inv(normal * np.outer(scale, scale)) * np.outer(scale, scale)
        self.of_residuals = np.linalg.inv(self.weight) - self.design @ self.cofactor @ self.design.T

    def residuals(self, change):
        problem, result = self.problem, self.result
        poses = change[: 6 * self.n].reshape(-1, 6)
        rotation = rotation_from_vector(poses[:, :3]) @ result.ground_from_image
        position = result.position_m + poses[:, 3:]
        ground = result.ground_m + change[6 * self.n :][: 3 * self.p].reshape(-1, 3)
        common = result.common + change[6 * self.n + 3 * self.p :]
        shift = np.zeros(6)
        for parameter, value in zip(problem.parameters, common, strict=True):
            axis = parameter.name.split("_")[1]
            shift[{"x": 0, "y": 1, "z": 2, "omega": 3, "phi": 4, "kappa": 5}[axis]] += value
        u = np.einsum(
            "mji,mj->mi", rotation[problem.image], ground[problem.point] - position[problem.image]
        )
        image = -problem.distance_px[0] * u[:, :2] / u[:, 2:] - problem.xy_px
        antenna = position + shift[:3] - problem.pos.antenna_m
        angles = wrapped(
            angles_from_rotation(rotation, problem.pos.system) + shift[3:] - problem.pos.angles_rad
        )
        control = ground[problem.control.point] - problem.control.position_m
        prior = [
            value - p.value
            for p, value in zip(problem.parameters, common, strict=True)
            if p.sigma is not None
        ]
        pos = np.concatenate([antenna, angles], axis=1)
        return np.concatenate([image.ravel(), pos.ravel(), control.ravel(), prior])

    def _weight(self):
        problem = self.problem
        prior = [p.sigma for p in problem.parameters if p.sigma is not None]
        variance = np.concatenate(
            [
                np.repeat(problem.sigma_px**2, 2),
                1.0 / problem.pos.weight.ravel(),
                np.ones(3 * len(problem.control.point)),
                np.square(prior),
            ]
        )
        weight = np.diag(1.0 / variance)
        at = 2 * len(problem.point) + 6 * self.n
        for covariance in problem.control.covariance_m2:
            weight[at : at + 3, at : at + 3] = np.linalg.inv(covariance)
            at += 3
        return weight
