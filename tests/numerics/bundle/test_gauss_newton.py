"""The bundle adjustment: a dense solution by scipy, simulated truth, blunders, what is refused."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation
from small_blocks import CAMERA, Layout, observed_block, true_block

from posstats.adjustment.block_problem import bundle_problem
from posstats.block.model import GroundPoints
from posstats.errors import ConvergenceError, GeometryError, UndeterminedError
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.parameters import (
    BORESIGHT,
    GNSS_DRIFTS,
    GNSS_SHIFTS,
    IMU_DRIFTS,
    IMU_SHIFTS,
    LEVER_ARM,
    CommonParameter,
    drift_parameters,
)
from posstats.numerics.bundle.problem import Control
from posstats.numerics.bundle.system import BundleSystem
from posstats.numerics.kernels.rotation import rotation_from_vector, vector_from_rotation, wrapped

C, MM = CAMERA.principal_distance_px, CAMERA.pixel_size_mm
PARAMETERS = (
    *drift_parameters(GNSS_SHIFTS, ("s0", "s1"), 0.3),
    *drift_parameters(GNSS_DRIFTS, ("s0", "s1"), 1e-3),
    *drift_parameters(IMU_SHIFTS, ("block",), 1e-3),
    *drift_parameters(IMU_DRIFTS, ("block",), 1e-6),
    *(CommonParameter(name, sigma=0.05, value=0.02) for name in LEVER_ARM),
    *(CommonParameter(name, sigma=1e-4) for name in BORESIGHT),
    CommonParameter("camera_c"),
    CommonParameter("camera_x0", sigma=2.0),
    *(CommonParameter(f"bauer_s{i}", sigma=s) for i, s in ((1, 1e-7), (2, 1e-4), (3, 1e-4))),
    *(CommonParameter(f"brown_{n}", sigma=1e-3) for n in ("k1", "p1", "p2")),
)


def small_problem(parameters=(), seed=1, n_points=60, n_control=3, **layout):
    """Two strips; the ground points of `n_control` are surveyed to 2 and 3 cm."""
    truth = true_block(Layout(n_images=4, n_points=n_points, **layout))
    rng = np.random.default_rng(seed)
    block = observed_block(truth, rng, error_rad=1e-3)
    ties = truth.tie_points
    often = np.argsort(-np.bincount(ties.point), kind="stable")[:n_control]
    ground = bundle_problem(truth).ground_m[often]
    sigma = np.full((n_control, 2), [0.02, 0.03])
    noise = rng.standard_normal((n_control, 3)) * sigma[:, [0, 0, 1]]
    surveyed = GroundPoints(
        ties.point_id[often], ground + noise, np.zeros(n_control, dtype=bool), *sigma.T
    )
    return bundle_problem(replace(block, ground_points=surveyed), parameters), truth


class Dense:
    """The same least-squares problem written out in numpy: standardised residuals of all."""

    def __init__(self, problem):
        self.problem, self.n = problem, len(problem.position_m)
        self.k, self.p = len(problem.parameters), len(problem.ground_m)

    def unpacked(self, unknowns):
        poses, common = unknowns[: 6 * self.n].reshape(-1, 6), unknowns[6 * self.n :][: self.k]
        rotation = rotation_from_vector(poses[:, :3]) @ self.problem.ground_from_image
        position = self.problem.position_m + poses[:, 3:]
        value = {(p.name, p.scope): c for p, c in zip(self.problem.parameters, common, strict=True)}
        return rotation, position, value, unknowns[6 * self.n + self.k :].reshape(-1, 3)

    def residuals(self, unknowns):
        problem = self.problem
        rotation, position, value, ground = self.unpacked(unknowns)

        def of(name, scope="block"):
            return value.get((name, scope), 0.0)

        u = np.einsum(
            "mji,mj->mi", rotation[problem.image], ground[problem.point] - position[problem.image]
        )
        a, b = -u[:, 0] / u[:, 2], -u[:, 1] / u[:, 2]
        r2, c = a**2 + b**2, C + of("camera_c")
        p1, p2 = of("brown_p1"), of("brown_p2")
        radial = 1.0 + of("brown_k1") * r2
        x_mm, y_mm = MM * c * a, MM * c * b
        ring = of("bauer_s1") * (x_mm**2 + y_mm**2 - 100.0**2)
        x = c * (a * radial - 2 * p1 * a * b + p2 * (r2 + 2 * a**2)) + of("camera_x0")
        y = c * (b * radial - p1 * (r2 + 2 * b**2) + 2 * p2 * a * b)
        x += (x_mm * ring - of("bauer_s3") * x_mm) / MM
        y += (y_mm * ring + of("bauer_s2") * x_mm + of("bauer_s3") * y_mm) / MM
        image = (np.stack([x, y], axis=1) - problem.xy_px) / problem.sigma_px[:, None]
        pos = self.pos(rotation, position, of)
        control = problem.control
        root = np.sqrt(np.diagonal(control.covariance_m2, axis1=1, axis2=2))
        surveyed = (ground[control.point] - control.position_m) / root
        prior = [
            (value[p.name, p.scope] - p.value) / p.sigma
            for p in problem.parameters
            if p.sigma is not None
        ]
        return np.concatenate([image.ravel(), pos.ravel(), surveyed.ravel(), prior])

    def pos(self, rotation, position, of):
        problem, time_s = self.problem, self.problem.exposures.time_s
        strips, observed = problem.exposures.strip, problem.pos
        lever = np.array([of(name) for name in LEVER_ARM])
        antenna = position + rotation @ lever
        for strip in ("s0", "s1"):
            own = strips == strip
            since = (time_s - time_s[own].min())[own, None]
            antenna[own] += [of(name, strip) for name in GNSS_SHIFTS]
            antenna[own] += since * [of(name, strip) for name in GNSS_DRIFTS]
        roll, pitch, yaw = (of(name) for name in BORESIGHT)
        boresight = Rotation.from_euler("XYZ", [pitch, roll, yaw])
        angles = (Rotation.from_matrix(rotation) * boresight).as_euler("XYZ")
        angles += [of(name) for name in IMU_SHIFTS]
        angles += (time_s - time_s.min())[:, None] * [of(name) for name in IMU_DRIFTS]
        return np.concatenate(
            [
                (antenna - observed.antenna_m) / observed.sigma_antenna_m,
                wrapped(angles - observed.angles_rad) / observed.sigma_angles_rad,
            ],
            axis=1,
        )

    def solved(self, sigma, values=None):
        """Unknowns and scipy's result, whose Jacobian is by unknowns in units of sigma.

        Counted from 1000 sigma, the differences are over 0.01 sigma: no digits are lost.
        """
        if values is None:
            values = [parameter.value for parameter in self.problem.parameters]
        start = np.concatenate([np.zeros(6 * self.n), values, self.problem.ground_m.ravel()])
        result = least_squares(
            lambda s: self.residuals(start + sigma * (s - 1e3)), np.full(len(sigma), 1e3),
            jac="3-point", diff_step=1e-5, xtol=1e-15, ftol=1e-15, gtol=1e-15, max_nfev=20,
        )  # fmt: skip
        return start + sigma * (result.x - 1e3), result


def block_diagonal(blocks):
    return np.sqrt(np.diagonal(blocks, axis1=-2, axis2=-1)).ravel()


def test_solution_and_covariances_are_those_of_a_dense_solver():
    problem, _ = small_problem(PARAMETERS)
    result = adjust(problem)
    n, k = len(problem.position_m), len(PARAMETERS)
    image = np.arange(n)
    sigma = np.concatenate(
        [
            block_diagonal(result.inverse.blocks(image, image)),
            np.sqrt(np.diagonal(result.common_covariance)),
            block_diagonal(result.ground_covariance_m2),
        ]
    )
    dense = Dense(problem)
    rotation, position, value, ground = dense.unpacked(dense.solved(sigma)[0])
    # once more from there, where increments of the rotations are derivatives by the vector
    dense = Dense(
        replace(problem, ground_from_image=rotation, position_m=position, ground_m=ground)
    )
    unknowns, solved = dense.solved(sigma, [*value.values()])
    rotation, position, value, ground = dense.unpacked(unknowns)
    assert abs(2.0 * solved.cost / result.square_sum - 1.0) < 1e-10
    assert result.dof == len(solved.fun) - len(sigma)
    np.testing.assert_allclose(
        sum(group.redundancy for group in result.groups.values()), result.dof, rtol=1e-9
    )

    turn = vector_from_rotation(result.ground_from_image @ np.swapaxes(rotation, 1, 2))
    poses = np.concatenate([turn, result.position_m - position], axis=1).ravel()
    common = result.common - list(value.values())
    difference = np.concatenate([poses, common, (result.ground_m - ground).ravel()])
    np.testing.assert_allclose(difference / sigma, 0.0, rtol=0, atol=1e-6)

    covariance = np.linalg.inv(solved.jac.T @ solved.jac)  # of unknowns in units of sigma
    full = np.empty((6 * n + k, 6 * n + k))
    first, second = np.triu_indices(n)
    blocks = result.inverse.blocks(first, second)
    for i, j, block in zip(first, second, blocks, strict=True):
        full[6 * i : 6 * i + 6, 6 * j : 6 * j + 6] = block
        full[6 * j : 6 * j + 6, 6 * i : 6 * i + 6] = block.T
    full[: 6 * n, 6 * n :] = result.inverse.border.reshape(6 * n, k)
    full[6 * n :, : 6 * n] = full[: 6 * n, 6 * n :].T
    full[6 * n :, 6 * n :] = result.inverse.corner
    u = 6 * n + k
    np.testing.assert_allclose(
        full / sigma[:u, None] / sigma[:u], covariance[:u, :u], rtol=0, atol=1e-6
    )
    for point in range(len(ground)):
        rows = slice(u + 3 * point, u + 3 * point + 3)
        own = result.ground_covariance_m2[point] / sigma[rows, None] / sigma[rows]
        np.testing.assert_allclose(own, covariance[rows, rows], rtol=0, atol=1e-6)


def test_a_start_far_from_the_solution_leads_to_the_same_one():
    problem, _ = small_problem()
    expected = adjust(problem)
    turn = rotation_from_vector(0.3 * np.random.default_rng(2).standard_normal((8, 3)))
    far = replace(
        problem,
        ground_from_image=turn @ problem.ground_from_image,
        ground_m=problem.ground_m + np.array([50.0, -30.0, 100.0]),
    )
    result = adjust(far)
    assert result.n_iterations > expected.n_iterations
    np.testing.assert_allclose(result.square_sum, expected.square_sum, rtol=1e-9)
    np.testing.assert_allclose(result.ground_m, expected.ground_m, rtol=0, atol=1e-6)


def test_estimates_scatter_about_the_truth_as_the_covariances_say():
    """Whitened errors of all orientations, points and drift parameters have unit variance."""
    parameters = drift_parameters(GNSS_SHIFTS, ("s0", "s1"), 0.3)
    whitened = {"orientation": [], "point": [], "common": []}
    for seed in range(40):
        problem, truth = consistent_problem(parameters, seed)
        result = adjust(problem)
        pos = truth.orientations
        orientation = np.concatenate(
            [
                wrapped(result.angles_rad - pos.angles_rad),
                result.position_m - pos.position_m,
            ],
            axis=1,
        )
        roots = np.linalg.cholesky(result.orientation_covariance)
        whitened["orientation"].append(np.linalg.solve(roots, orientation[:, :, None]))
        roots = np.linalg.cholesky(result.ground_covariance_m2)
        error = result.ground_m - bundle_problem(truth).ground_m
        whitened["point"].append(np.linalg.solve(roots, error[:, :, None]))
        root = np.linalg.cholesky(result.common_covariance)
        shift = result.common - true_shifts(seed)
        whitened["common"].append(np.linalg.solve(root, shift))
    for name, values in whitened.items():
        numbers = np.array(values).reshape(40, -1)
        mean_square = (numbers**2).mean(axis=1)
        spread = mean_square.std(ddof=1) / np.sqrt(40)
        assert abs(mean_square.mean() - 1.0) < 4.0 * spread + 0.01, name


def true_shifts(seed):
    return 0.3 * np.random.default_rng(1000 + seed).standard_normal(6)


def consistent_problem(parameters, seed):
    """All observations have errors as stated, antenna positions also `true_shifts` per strip."""
    truth = true_block(Layout(n_images=4, n_points=60))
    rng = np.random.default_rng(seed)
    angles = 1e-4 * rng.standard_normal((8, 3))
    block = observed_block(truth, rng, error_rad=angles)
    pos = block.orientations
    shift = true_shifts(seed).reshape(2, 3)[(pos.strip == "s1").astype(int)]
    block = replace(block, orientations=replace(pos, position_m=pos.position_m + shift))
    problem = bundle_problem(block, parameters)
    ground, sigma = bundle_problem(truth).ground_m[:4], 0.05
    control = Control(
        np.arange(4),
        ground + sigma * rng.standard_normal((4, 3)),
        np.broadcast_to(sigma**2 * np.eye(3), (4, 3, 3)),
    )
    return replace(problem, control=control), truth


def test_blunders_are_found_and_the_rest_is_adjusted_as_without_them():
    problem, _ = small_problem(n_points=400)
    rng = np.random.default_rng(5)
    wrong = rng.choice(len(problem.point), len(problem.point) // 30, replace=False)
    direction = rng.uniform(0.0, 2.0 * np.pi, len(wrong))
    xy = problem.xy_px.copy()
    xy[wrong] += 30.0 * np.column_stack([np.cos(direction), np.sin(direction)])
    rays = np.bincount(problem.point, minlength=len(problem.ground_m))[problem.point]
    result = adjust(replace(problem, xy_px=xy), robust=True)
    found = result.rejected[wrong][rays[wrong] >= 4]
    assert found.mean() > 0.95

    sigma = problem.sigma_px.copy()
    sigma[result.rejected] = np.inf
    expected = adjust(replace(problem, xy_px=xy, sigma_px=sigma))
    np.testing.assert_allclose(result.position_m, expected.position_m, rtol=0, atol=1e-8)
    image = result.groups["image"]
    assert image.n == 2 * (~result.rejected).sum()
    assert 0.8 < image.square_sum / image.redundancy < 1.1


def test_a_perfect_block_is_found_exactly_by_the_robust_solution():
    truth = true_block(Layout(n_images=4, n_points=100))
    result = adjust(bundle_problem(truth), robust=True)
    assert not result.rejected.any()
    np.testing.assert_allclose(result.position_m, truth.orientations.position_m, rtol=0, atol=1e-6)


def test_a_network_without_datum_names_its_images():
    problem, _ = small_problem(n_control=0)
    pos = replace(
        problem.pos,
        sigma_antenna_m=np.full((8, 3), np.inf),
        sigma_angles_rad=np.full((8, 3), np.inf),
    )
    with pytest.raises(UndeterminedError) as caught:
        adjust(replace(problem, pos=pos))
    assert caught.value.images == tuple(range(8))
    assert caught.value.common == ()


def test_parameters_that_nothing_separates_are_named():
    """A shift of all antennas beside a shift of each strip, all free."""
    parameters = (
        *drift_parameters(GNSS_SHIFTS, ("block",)),
        *drift_parameters(("gnss_z_shift",), ("s0", "s1")),
    )
    problem, _ = small_problem(parameters)
    with pytest.raises(UndeterminedError) as caught:
        adjust(problem)
    assert caught.value.common == (2, 3, 4)
    assert caught.value.images == ()


def test_a_point_of_one_ray_is_left_out():
    problem, _ = small_problem()
    point = problem.point[0]
    keep = (problem.point != point) | (np.arange(len(problem.point)) == 0)
    alone = replace(
        problem,
        point=problem.point[keep], image=problem.image[keep],
        xy_px=problem.xy_px[keep], sigma_px=problem.sigma_px[keep],
    )  # fmt: skip
    result = adjust(alone)
    np.testing.assert_array_equal(np.flatnonzero(result.rejected), [0])
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(result.ground_m[:, 0])), [point])
    total = sum(group.redundancy for group in result.groups.values())
    np.testing.assert_allclose(total, result.dof, rtol=1e-9)


def test_points_behind_the_cameras_are_refused():
    problem, _ = small_problem()
    with pytest.raises(GeometryError, match="behind cameras"):
        adjust(replace(problem, ground_m=problem.ground_m + 5000.0 * np.eye(3)[2]))


def test_progress_is_told_and_an_iteration_that_does_not_settle_is_refused(monkeypatch):
    problem, _ = small_problem()
    told = []
    adjust(problem, progress=lambda *step: told.append(step))
    assert [step[0] for step in told] == list(range(1, len(told) + 1))
    monkeypatch.setattr("posstats.numerics.bundle.gauss_newton.MAX_ITERATIONS", 1)
    with pytest.raises(ConvergenceError, match="settle in 1 step"):
        adjust(problem)


def test_points_are_intersected_where_their_rays_say():
    """Against each point alone by scipy: with the images held, no point can do better."""
    problem, _ = small_problem(n_control=0)
    start = replace(problem, ground_m=problem.ground_m + 5.0)
    system = BundleSystem.of(start)
    state = system.intersected(system.start)
    for at, point in enumerate(system.rays.point[:10]):
        rays = problem.point == point
        image, xy = problem.image[rays], problem.xy_px[rays]

        def residuals(ground, image=image, xy=xy):
            line = ground - problem.position_m[image]
            u = np.einsum("mji,mj->mi", problem.ground_from_image[image], line)
            return (-C * u[:, :2] / u[:, 2:] - xy).ravel()

        alone = least_squares(residuals, problem.ground_m[point], xtol=1e-14, gtol=1e-14)
        np.testing.assert_allclose(state.ground_m[at], alone.x, rtol=0, atol=1e-4)
