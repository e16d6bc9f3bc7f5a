"""Normal equations of y-parallaxes with the covariance that pairs of one point share; compiled.

A point seen in n images makes up to n(n-1)/2 pairs but has 2n - 3 degrees of freedom: its q
share the noise of its n image points, cov q = sigma^2 D D' with D = dq/d(image coordinates).
Each point's weight matrix is therefore

    W = (D D' + L)^-1,   L = diag(d (1/w - 1 + RIDGE)),   d = diag(D D'),

where w is the robust weight of each pair (w = 0 takes the pair out exactly). D D' is singular at
the solution, so a small independent noise (RIDGE) keeps W regular; the covariance of the
unknowns is right for this W all the same (`numerics.solvers.dense.Propagation`).

By Woodbury's identity nothing of the size of the number of pairs is inverted: with
E = D'L^-1 D, H = D'L^-1 J and g = D'L^-1 q (2n rows each) and the Cholesky factor C C' = I + E,

    G = D'WJ = (I + E)^-1 H,                 J'WJ = J'L^-1 J - (C^-1 H)'(C^-1 H),
    J'Wq = J'L^-1 q - (C^-1 H)'(C^-1 g),     q'Wq = q'L^-1 q - |C^-1 g|^2,
    D'Wq = (I + E)^-1 g,                     tr(W D D') = tr((I + E)^-1 E) = 2n - |C^-1|^2.

Points seen by the same images share their matrices, which enter those of the block only once.
"""

from typing import NamedTuple

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.numerics.kernels.algebra import Six, add_products, six
from posstats.numerics.kernels.compiled import inner_kernel, kernel

RIDGE = 0.05


class Observed(NamedTuple):
    """N y-parallaxes and their derivatives, px, px/rad, px/m, px/px.

    Attributes
    ----------
    q
        (N,).
    by_left_angles, by_right_angles, by_base
        (N, 3), the base in the ground frame.
    by_image
        (N, 4) by x, y of the left and of the right image point: the rows of D.
    variance
        (N,) per unit variance of an image coordinate: d = diag(D D').
    """

    q: Floats
    by_left_angles: Floats
    by_right_angles: Floats
    by_base: Floats
    by_image: Floats
    variance: Floats


class PointRays(NamedTuple):
    """The pairs and the rays of g points, as in `point_pairs.PointPairs`."""

    left_ray: Ints
    right_ray: Ints
    point_offsets: Ints
    first_ray: Ints
    n_rays: Ints
    ray_image: Ints


def matrix_of_parts(parts: Floats, common: Ints) -> Floats:
    """The matrix (6 n, 6 n), right in its upper triangle, of its parts (c, 6, 6).

    Images without a common point make zeros, most of the matrix: it is put together last.
    """
    matrix = np.zeros((len(common), 6, len(common), 6))
    first, second = np.nonzero(common >= 0)
    matrix[first, :, second, :] = parts
    return matrix.reshape(6 * len(common), -1)


def precision(variance: Floats, robust_weight: Floats) -> Floats:
    """(N,) diagonal of L^-1 from d = diag(D D') (N,) and the robust weights (N,) in [0, 1]."""
    result: Floats = robust_weight / (variance * (1.0 - robust_weight * (1.0 - RIDGE)))
    return result


@inner_kernel
def _add_six(row: Floats, first: int, factor: float, values: Six) -> None:
    """Add a multiple of six numbers to a row, from `first` on."""
    row[first] += factor * values[0]
    row[first + 1] += factor * values[1]
    row[first + 2] += factor * values[2]
    row[first + 3] += factor * values[3]
    row[first + 4] += factor * values[4]
    row[first + 5] += factor * values[5]


@inner_kernel
def _add_pair(
    left: int,
    right: int,
    weight: float,
    q: float,
    row: Floats,
    by_image: Floats,
    normals: Floats,
    right_side: Floats,
    noise: Floats,
    shared: Floats,
) -> None:
    """Add one pair to J'L^-1 J, J'L^-1 q, I + E and [H g].

    `left` < `right` are the places of its rays in the point; `row` (12,) is its row of J,
    `by_image` (4,) that of D. Of `normals` only the upper triangle becomes complete.
    """
    last = shared.shape[1] - 1
    a, b = six(row, 0), six(row, 6)
    for i in range(6):
        scaled_left, scaled_right = weight * row[i], weight * row[6 + i]
        _add_six(normals[6 * left + i], 6 * left, scaled_left, a)
        _add_six(normals[6 * left + i], 6 * right, scaled_left, b)
        _add_six(normals[6 * right + i], 6 * right, scaled_right, b)
        right_side[6 * left + i] += scaled_left * q
        right_side[6 * right + i] += scaled_right * q
    for i in range(4):
        at = 2 * left + i if i < 2 else 2 * right + i - 2
        scaled = weight * by_image[i]
        _add_six(shared[at], 6 * left, scaled, a)
        _add_six(shared[at], 6 * right, scaled, b)
        shared[at, last] += scaled * q
        for j in range(2):
            noise[at, 2 * left + j] += scaled * by_image[j]
            noise[at, 2 * right + j] += scaled * by_image[2 + j]


@inner_kernel
def _add_point(
    point: int,
    points: PointRays,
    observed: Observed,
    pair_precision: Floats,
    row: Floats,
    normals: Floats,
    right_side: Floats,
    noise: Floats,
    shared: Floats,
) -> float:
    """Add a point to J'L^-1 J and J'L^-1 q, write its I + E and [H g]; q'L^-1 q is returned."""
    noise[:], shared[:] = 0.0, 0.0
    for i in range(noise.shape[0]):
        noise[i, i] = 1.0
    first = points.first_ray[point]
    square_sum = 0.0
    for k in range(points.point_offsets[point], points.point_offsets[point + 1]):
        for i in range(3):
            row[i], row[6 + i] = observed.by_left_angles[k, i], observed.by_right_angles[k, i]
            row[3 + i], row[9 + i] = -observed.by_base[k, i], observed.by_base[k, i]
        _add_pair(
            points.left_ray[k] - first, points.right_ray[k] - first, pair_precision[k],
            observed.q[k], row, observed.by_image[k], normals, right_side, noise, shared,
        )  # fmt: skip
        square_sum += pair_precision[k] * observed.q[k] * observed.q[k]
    return square_sum


@inner_kernel
def _square(store: Floats, n: int) -> Floats:
    """A contiguous (n, n) matrix on top of a store: the compiler vectorises only such."""
    return store[: n * n].reshape(n, n)


@inner_kernel
def _factorise(matrix: Floats, n: int) -> None:
    """Lower Cholesky factor of the leading (n, n) part, in place."""
    for j in range(n):
        for k in range(j):
            matrix[j, j] -= matrix[j, k] * matrix[j, k]
        matrix[j, j] = np.sqrt(matrix[j, j])
        for i in range(j + 1, n):
            for k in range(j):
                matrix[i, j] -= matrix[i, k] * matrix[j, k]
            matrix[i, j] /= matrix[j, j]


@inner_kernel
def _solve_lower(factor: Floats, n: int, rows: Floats, width: int) -> None:
    """C^-1 rows, in place; rows (n, width) leading part."""
    for i in range(n):
        for k in range(i):
            f = factor[i, k]
            for j in range(width):
                rows[i, j] -= f * rows[k, j]
        f = 1.0 / factor[i, i]
        for j in range(width):
            rows[i, j] *= f


@inner_kernel
def _solve_upper(factor: Floats, n: int, rows: Floats, width: int) -> None:
    """C'^-1 rows, in place; rows (n, width) leading part."""
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            f = factor[k, i]
            for j in range(width):
                rows[i, j] -= f * rows[k, j]
        f = 1.0 / factor[i, i]
        for j in range(width):
            rows[i, j] *= f


@inner_kernel
def _back_substitute(factor: Floats, n: int, column: Floats, image_noise: Floats) -> None:
    """C'^-1 column (n,) into image_noise (n / 2, 2)."""
    for i in range(n - 1, -1, -1):
        value = column[i]
        for k in range(i + 1, n):
            value -= factor[k, i] * image_noise[k // 2, k % 2]
        image_noise[i // 2, i % 2] = value / factor[i, i]


@inner_kernel
def _inverse_square_sum(factor: Floats, n: int, work: Floats) -> float:
    """|C^-1|^2, the trace of (C C')^-1; work (n,)."""
    total = 0.0
    for column in range(n):
        for i in range(column, n):
            value = 1.0 if i == column else 0.0
            for k in range(column, i):
                value -= factor[i, k] * work[k]
            work[i] = value / factor[i, i]
            total += work[i] * work[i]
    return total


@inner_kernel
def _subtract_projected(shared: Floats, right_side: Floats) -> float:
    """Take (C^-1 H)'(C^-1 g) from the right side; |C^-1 g|^2 is returned."""
    width = right_side.shape[0]
    square_sum = 0.0
    for r in range(shared.shape[0]):
        projected = shared[r, width]
        square_sum += projected * projected
        for i in range(width):
            right_side[i] -= shared[r, i] * projected
    return square_sum


@inner_kernel
def _seen_by(images: Ints, point: int, points: PointRays) -> bool:
    """Whether there is such a point, and exactly these images see it."""
    if point == points.first_ray.shape[0]:
        return False
    first, n = points.first_ray[point], points.n_rays[point]
    return np.array_equal(points.ray_image[first : first + n], images)


@inner_kernel
def _scatter(local: Floats, images: Ints, common: Ints, parts: Floats) -> None:
    """Add the upper triangle of a point's (6 n, 6 n) matrix to the block's."""
    for i in range(images.shape[0]):
        for j in range(i, images.shape[0]):
            part = parts[common[images[i], images[j]]]
            for a in range(6):
                for b in range(6):
                    part[a, b] += local[6 * i + a, 6 * j + b]


@kernel
def accumulate_normals(
    observed: Observed,
    pair_precision: Floats,
    points: PointRays,
    common: Ints,
    normals: Floats,
    right_side: Floats,
    noise_normals: Floats,
    image_noise: Floats,
) -> tuple[float, float]:
    """Add the point pairs of a block to its normal equations, point by point.

    Parameters
    ----------
    observed, pair_precision
        Of all pairs; the second (N,) from `precision`.
    points
        The points to add; those of the same images are best neighbours.
    common
        (n, n) numbers of the pairs of images, as in `point_pairs.PointPairs`.
    normals, right_side
        (c, 6, 6), (6 n,): J'WJ, as for `matrix_of_parts`, and J'Wq are added; per image three
        angles, then three coordinates.
    noise_normals
        (c, 6, 6): M = G'G is added, or (0, 6, 6): not wanted.
    image_noise
        (m, 2): D'Wq, the part of every ray's image coordinates that makes the parallaxes (its
        negative is the least-squares residual), is written, px.

    Returns
    -------
    q'Wq, and tr(W D D') (0 where `noise_normals` is not wanted).
    """
    with_noise = noise_normals.shape[0] > 0
    most = points.n_rays.max()
    local_store, local_noise_store = np.empty((6 * most) ** 2), np.empty((6 * most) ** 2)
    noise_store, shared_store = np.empty((2 * most) ** 2), np.empty(2 * most * (6 * most + 1))
    right_store, row, work = np.empty(6 * most), np.empty(12), np.empty(2 * most)
    square_sum = noise_trace = 0.0
    point = 0
    while point < points.first_ray.shape[0]:
        first, n = points.first_ray[point], points.n_rays[point]
        images = points.ray_image[first : first + n]
        local, local_noise = _square(local_store, 6 * n), _square(local_noise_store, 6 * n)
        right, noise = right_store[: 6 * n], _square(noise_store, 2 * n)
        shared = shared_store[: 2 * n * (6 * n + 1)].reshape(2 * n, 6 * n + 1)
        local[:], local_noise[:], right[:] = 0.0, 0.0, 0.0
        while _seen_by(images, point, points):
            square_sum += _add_point(
                point, points, observed, pair_precision, row, local, right, noise, shared
            )
            _factorise(noise, 2 * n)
            _solve_lower(noise, 2 * n, shared, 6 * n + 1)
            add_products(shared, 2 * n, 6 * n, local, -1.0)
            square_sum -= _subtract_projected(shared, right)
            first = points.first_ray[point]
            _back_substitute(noise, 2 * n, shared[:, 6 * n], image_noise[first : first + n])
            if with_noise:
                noise_trace += 2 * n - _inverse_square_sum(noise, 2 * n, work)
                _solve_upper(noise, 2 * n, shared, 6 * n)
                add_products(shared, 2 * n, 6 * n, local_noise, 1.0)
            point += 1
        _scatter(local, images, common, normals)
        if with_noise:
            _scatter(local_noise, images, common, noise_normals)
        for i in range(6 * n):
            right_side[6 * images[i // 6] + i % 6] += right[i]
    return square_sum, noise_trace
