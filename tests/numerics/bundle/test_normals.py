"""The reduced normal equations and what follows from them, against matrices written out."""

from itertools import pairwise

import numpy as np
from strip_scene import CAMERA, measurements, scene

from posstats.numerics.bundle.ground_points import move_points, ray_residuals
from posstats.numerics.bundle.normals import Reduced, accumulate
from posstats.numerics.bundle.point_groups import grouped
from posstats.numerics.bundle.point_normals import Ground, Measured, Network
from posstats.numerics.bundle.precision import Cofactors, PointPrecision, point_precision
from posstats.numerics.bundle.rays import Cameras, Images, project_rays

USED = [0, 3, 6, 10]  # camera_c, bauer_s1, brown_k1, brown_p2 of two cameras, c in common


class Written:
    """A small problem with control, two cameras and shared points; dense normal equations."""

    def __init__(self, seed=1):
        rng = np.random.default_rng(seed)
        oriented, ground = scene(seed)
        rays = measurements(oriented, ground)
        seen = rng.uniform(size=len(rays)) < 0.7
        seen &= np.bincount(rays.point[seen], minlength=len(ground))[rays.point] >= 2
        self.point, self.image = rays.point[seen], rays.image[seen]
        shuffled = rng.permutation(len(self.point))
        self.point, self.image = self.point[shuffled], self.image[shuffled]
        self.xy = rays.xy_px[seen][shuffled] + rng.standard_normal((len(self.point), 2))
        self.weight = rng.uniform(0.5, 4.0, len(self.point))
        self.n, self.ground = len(oriented), ground + rng.standard_normal(ground.shape)
        column = np.full((2, 11), -1)
        column[0, USED], column[1, USED] = [0, 1, 2, 3], [0, 4, 5, 6]
        self.cameras = Cameras(
            np.full(2, CAMERA.principal_distance_px), np.full(2, 0.01), 100.0,
            np.zeros((2, 11)), column,
        )  # fmt: skip
        self.n_common = 7
        camera = np.arange(self.n) % 2
        self.images = Images(oriented.ground_from_image, oriented.position_m, camera)
        self.control = np.full(len(ground), -1)
        self.control[[2, 5]] = [1, 0]
        root = rng.standard_normal((2, 3, 3))
        self.control_weight = root @ np.swapaxes(root, 1, 2)
        self.control_m = ground[[5, 2]]
        self.groups = grouped(self.point, self.image, self.n)

    def network(self):
        order = self.groups.ray
        position = self.ground[self.groups.point]
        control = self.control[self.groups.point]
        return Network(
            self.groups.groups,
            Measured(self.xy[order], self.weight[order]),
            Ground(position, control, self.control_m, self.control_weight),
            self.images,
            self.cameras,
        )

    def dense(self):
        """J of images, camera and points; v; W, the control's rows last."""
        xy, by_pose, by_ground, by_camera = project_rays(
            self.ground, self.point, self.image, self.images, self.cameras
        )
        m, n, p, k = len(self.point), self.n, len(self.ground), self.n_common
        design = np.zeros((m, 2, 6 * n + k + 3 * p))
        for r in range(m):
            i, j = self.image[r], self.point[r]
            design[r, :, 6 * i : 6 * i + 6] = by_pose[r]
            design[r, :, 6 * n + k + 3 * j : 6 * n + k + 3 * j + 3] = by_ground[r]
            columns = self.cameras.column[self.images.camera[i]]
            design[r][:, 6 * n + columns[USED]] = by_camera[r][:, USED]
        control = np.zeros((6, design.shape[2]))
        weight = np.zeros((2 * m + 6, 2 * m + 6))
        weight[: 2 * m, : 2 * m] = np.diag(np.repeat(self.weight, 2))
        residual = [(xy - self.xy).ravel()]
        for g, point in enumerate((5, 2)):
            at = 6 * n + k + 3 * point
            control[3 * g : 3 * g + 3, at : at + 3] = np.eye(3)
            rows = slice(2 * m + 3 * g, 2 * m + 3 * g + 3)
            weight[rows, rows] = self.control_weight[g]
            residual.append(self.ground[point] - self.control_m[g])
        design = np.concatenate([design.reshape(2 * m, -1), control])
        return design, np.concatenate(residual), weight


def accumulated(problem, damping=0.0):
    pairs = problem.groups
    n, k = problem.n, problem.n_common
    reduced = Reduced(
        np.zeros((len(pairs.first), 6, 6)), np.zeros((n, 6, k)), np.zeros((k, k)),
        np.zeros((n, 6)), np.zeros(k),
    )  # fmt: skip
    determined = np.zeros(len(pairs.point), dtype=bool)
    sums = np.zeros(3)
    for part in pairs.parts:
        sums += accumulate(*part, problem.network(), damping, determined, reduced)
    assert determined.all()
    return reduced, sums


def written_out(problem, reduced):
    """The reduced matrix (6 n + k)^2 and its gradient."""
    n, k, pairs = problem.n, problem.n_common, problem.groups
    matrix = np.zeros((n, 6, n, 6))
    matrix[pairs.first, :, pairs.second, :] = reduced.blocks
    full = np.zeros((6 * n + k, 6 * n + k))
    full[: 6 * n, : 6 * n] = matrix.reshape(6 * n, 6 * n)
    full[: 6 * n, 6 * n :] = reduced.border.reshape(6 * n, k)
    full[6 * n :, 6 * n :] = reduced.corner
    full = np.triu(full) + np.triu(full, 1).T
    return full, np.concatenate([reduced.images.ravel(), reduced.common])


def close(actual, expected, tolerance=1e-10):
    np.testing.assert_allclose(actual, expected, rtol=0, atol=tolerance * np.abs(expected).max())


def scaled_close(actual, expected, tolerance=1e-10):
    """Elements relative to the roots of their diagonal elements."""
    scale = 1.0 / np.sqrt(np.diagonal(expected))
    close(actual * scale[:, None] * scale, expected * scale[:, None] * scale, tolerance)


def test_groups_hold_every_ray_once_and_points_of_the_same_images():
    problem = Written()
    groups = problem.groups
    np.testing.assert_array_equal(np.sort(groups.ray), np.arange(len(problem.point)))
    offsets, first_ray, ray_image, *_ = groups.groups
    np.testing.assert_array_equal(problem.image[groups.ray], ray_image)
    np.testing.assert_array_equal(
        problem.point[groups.ray], np.repeat(groups.point, np.diff(first_ray))
    )
    sets = [tuple(ray_image[a:b]) for a, b in pairwise(first_ray)]
    per_group = [set(sets[a:b]) for a, b in pairwise(offsets)]
    assert all(len(each) == 1 for each in per_group)
    assert len(set().union(*per_group)) == len(per_group)


def test_the_reduced_equations_are_schurs_complement_of_the_dense_ones():
    problem = Written()
    reduced, sums = accumulated(problem)
    design, residual, weight = problem.dense()
    normals, gradient = design.T @ weight @ design, design.T @ weight @ residual
    u = 6 * problem.n + problem.n_common
    points = np.linalg.inv(normals[u:, u:])
    full, side = written_out(problem, reduced)
    scaled_close(full, normals[:u, :u] - normals[:u, u:] @ points @ normals[u:, :u])
    close(side, gradient[:u] - normals[:u, u:] @ points @ gradient[u:])
    squares = residual[:-6] @ weight[:-6, :-6] @ residual[:-6]
    control = residual[-6:] @ weight[-6:, -6:] @ residual[-6:]
    np.testing.assert_allclose(
        sums, [squares, control, gradient[u:] @ points @ gradient[u:]], rtol=1e-10
    )


def test_the_points_step_is_that_of_the_dense_equations():
    problem = Written()
    design, residual, weight = problem.dense()
    normals, gradient = design.T @ weight @ design, design.T @ weight @ residual
    u, n = 6 * problem.n + problem.n_common, problem.n
    damping = 0.1
    given = 1e-6 * np.random.default_rng(3).standard_normal(u)
    inner = normals[u:, u:] + damping * np.diag(np.diagonal(normals[u:, u:]))
    expected = -np.linalg.solve(inner, gradient[u:] + normals[u:, :u] @ given)
    steps = given[: 6 * n].reshape(n, 6), given[6 * n :]
    moved = np.empty_like(problem.ground)[problem.groups.point]
    for part in problem.groups.parts:
        move_points(*part, problem.network(), *steps, damping, moved)
    change = moved - problem.ground[problem.groups.point]
    close(change, expected.reshape(-1, 3)[problem.groups.point], 1e-8)


def test_covariances_and_redundancies_are_those_of_the_dense_inverse():
    problem = Written()
    n, k, pairs = problem.n, problem.n_common, problem.groups
    design, residual, weight = problem.dense()
    u = 6 * n + k
    prior = np.diag(np.append(np.tile([1e8] * 3 + [1e2] * 3, n), np.full(k, 1e4)))
    normals = design.T @ weight @ design
    normals[:u, :u] += prior
    inverse = np.linalg.inv(normals)
    by_pair = inverse[: 6 * n, : 6 * n].reshape(n, 6, n, 6)
    cofactors = Cofactors(
        by_pair[pairs.first, :, pairs.second, :].copy(),
        inverse[: 6 * n, 6 * n : u].reshape(n, 6, k).copy(),
        inverse[6 * n : u, 6 * n : u].copy(),
    )
    m, p = len(problem.point), len(pairs.point)
    out = PointPrecision(np.empty((p, 3, 3)), np.empty((m, 2)))
    for part in pairs.parts:
        point_precision(*part, problem.network(), cofactors, out)
    for at, point in enumerate(pairs.point):
        block = slice(u + 3 * point, u + 3 * point + 3)
        scaled_close(out.covariance_m2[at], inverse[block, block], 1e-8)
    redundancy = 1.0 - np.einsum("ij,jk,ik->i", design, inverse, design) * np.diagonal(weight)
    close(out.redundancy, redundancy[: 2 * m].reshape(m, 2)[pairs.ray], 1e-8)
    computed = np.empty((m, 2))
    for part in pairs.parts:
        ray_residuals(*part, problem.network(), computed)
    close(computed, residual[: 2 * m].reshape(m, 2)[pairs.ray])


def test_a_point_of_one_ray_is_not_determined():
    problem = Written()
    order = problem.groups
    point = order.point[3]
    rays = np.flatnonzero(problem.point == point)
    problem.weight[rays[1:]] = 0.0
    n, k = problem.n, problem.n_common
    reduced = Reduced(
        np.zeros((len(order.first), 6, 6)), np.zeros((n, 6, k)), np.zeros((k, k)),
        np.zeros((n, 6)), np.zeros(k),
    )  # fmt: skip
    determined = np.zeros(len(order.point), dtype=bool)
    for part in order.parts:
        accumulate(*part, problem.network(), 0.0, determined, reduced)
    np.testing.assert_array_equal(order.point[~determined], [point])
