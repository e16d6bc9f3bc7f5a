"""Positive definite systems of image blocks with a border of common unknowns.

Images that share no point have no element in common, so the images are partitioned into
breadth-first levels of the graph of pairs: elements connect neighbouring levels only, and the
matrix is block tridiagonal with a border (arrow). With the levels' Cholesky factors L_l,

    L_l L_l' = A_ll - X_(l-1)' X_(l-1),        X_l = L_l^-1 A_l,l+1,
    L_c L_c' = A_cc - sum Y_l' Y_l,            Y_l = L_l^-1 (A_lc - X_(l-1)' Y_(l-1))

(c: the border),

and backwards (Takahashi's equations), with Z the inverse, G = L_l'^-1 [X_l Y_l] and n the
unknowns of level l + 1 and the border,

    Z_ln = -G Z_nn,    Z_ll = (L_l L_l')^-1 - Z_ln G'.

Time and memory are n b^2 and n b for n unknowns in levels of b. Arrays only.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.linalg import blas, lapack

from posstats.arrays import Bools, Floats, Ints
from posstats.errors import UndeterminedError
from posstats.numerics.solvers.levels import Levels

# Smallest pivot, of a matrix scaled to a unit diagonal, that is not rounding alone.
SINGULAR_PIVOT = 1e-12
_RIDGE = 1e-9  # makes a singular matrix regular, to look for its null space
_NULL = 1e-10  # eigenvalues of the scaled matrix below belong to the null space
_NULL_VECTORS = 24
_PARTICIPATION = 1e-6  # squared component, in a null vector, of an unknown that it moves


@dataclass(frozen=True, eq=False)
class ArrowMatrix:
    """A symmetric matrix of n images with b unknowns each and k common unknowns.

    Attributes
    ----------
    first, second
        (P,) the pairs of images with elements, each once; every image with itself is one.
    blocks
        (P, b, b), rows of the first and columns of the second image.
    border
        (n, b, k).
    corner
        (k, k).
    """

    first: Ints
    second: Ints
    blocks: Floats
    border: Floats
    corner: Floats

    def scaled(self, images: Floats, common: Floats) -> "ArrowMatrix":
        """Rows and columns multiplied by (n, b) and (k,) factors."""
        rows, columns = images[self.first][:, :, None], images[self.second][:, None, :]
        return ArrowMatrix(
            self.first,
            self.second,
            self.blocks * rows * columns,
            self.border * images[:, :, None] * common,
            self.corner * common[:, None] * common,
        )

    def diagonal(self) -> tuple[Floats, Floats]:
        """(n, b) and (k,)."""
        own = self.first == self.second
        images = np.zeros(self.border.shape[:2])
        images[self.first[own]] = np.diagonal(self.blocks[own], axis1=1, axis2=2)
        return images, np.diagonal(self.corner).copy()

    def plus_diagonal(self, images: Floats, common: Floats) -> "ArrowMatrix":
        """The matrix with (n, b) and (k,) added to its diagonal."""
        own = self.first == self.second
        blocks = self.blocks.copy()
        blocks[own] += np.eye(blocks.shape[1]) * images[self.first[own]][:, :, None]
        return ArrowMatrix(
            self.first, self.second, blocks, self.border, self.corner + np.diag(common)
        )


@dataclass(frozen=True, eq=False)
class SelectedInverse:
    """The elements of an inverse inside and between neighbouring levels, and of the border.

    Attributes
    ----------
    levels
        Of the matrix.
    within
        Per level (b m, b m), m its number of images.
    following
        Per level (b m, b m'), columns of the next level; without columns for the last.
    border
        (n, b, k), by image.
    corner
        (k, k).
    """

    levels: Levels
    within: tuple[Floats, ...]
    following: tuple[Floats, ...]
    border: Floats
    corner: Floats

    def blocks(self, first: Ints, second: Ints) -> Floats:
        """(P, b, b) blocks of pairs (P,) of images of the same or of neighbouring levels."""
        b = self.border.shape[1]
        result = np.empty((len(first), b, b))
        level, place = self.levels.level, self.levels.place
        swapped = level[first] > level[second]
        upper, lower = np.where(swapped, second, first), np.where(swapped, first, second)
        between = level[upper] != level[lower]
        for index, source in _by_level(level[upper], between, self.within, self.following):
            square = source.reshape(source.shape[0] // b, b, -1, b)
            result[index] = square[place[upper[index]], :, place[lower[index]], :]
        result[swapped] = np.swapaxes(result[swapped], 1, 2)
        return result


def _by_level(
    level: Ints,
    between: Bools,
    within: tuple[Floats, ...],
    following: tuple[Floats, ...],
) -> Iterator[tuple[Ints, Floats]]:
    """Which pairs (indices) are inside, or lead on from, which level's matrix."""
    for kind, sources in ((False, within), (True, following)):
        chosen = np.flatnonzero(between == kind)
        order = chosen[np.argsort(level[chosen], kind="stable")]
        bounds = np.searchsorted(level[order], np.arange(len(sources) + 1))
        for at, source in enumerate(sources):
            if bounds[at] < bounds[at + 1]:
                yield order[bounds[at] : bounds[at + 1]], source


@dataclass(frozen=True, eq=False)
class ArrowFactor:
    """Cholesky factor of an `ArrowMatrix` scaled to a unit diagonal.

    Attributes
    ----------
    levels
        Of the matrix.
    scale_images, scale_common
        (n, b) and (k,): one over the roots of the diagonal.
    lower
        Per level L_l, and last that of the border.
    coupling
        Per level [X_l Y_l], columns of the next level and of the border.
    """

    levels: Levels
    scale_images: Floats
    scale_common: Floats
    lower: tuple[Floats, ...]
    coupling: tuple[Floats, ...]

    def solve(self, images: Floats, common: Floats) -> tuple[Floats, Floats]:
        """The solution (n, b, q), (k, q) for right-hand sides of these shapes, q columns."""
        n, b, q = images.shape
        k = len(common)
        right = (images * self.scale_images[:, :, None])[self.levels.image].reshape(n * b, q)
        parts = np.split(right, b * self.levels.offsets[1:-1])
        border = common * self.scale_common[:, None]
        for at, coupling in enumerate(self.coupling):
            parts[at] = _solved(self.lower[at], parts[at], transposed=False)
            carried = coupling.T @ parts[at]
            if at + 1 < len(parts):
                parts[at + 1] = parts[at + 1] - carried[: len(carried) - k]
            border = border - carried[len(carried) - k :]
        border = _solved(self.lower[-1], border, transposed=False)
        border = _solved(self.lower[-1], border, transposed=True)
        after = np.empty((0, q))
        for at in range(len(parts) - 1, -1, -1):
            carried = self.coupling[at] @ np.concatenate([after, border])
            parts[at] = after = _solved(self.lower[at], parts[at] - carried, transposed=True)
        solution = np.empty((n, b, q))
        solution[self.levels.image] = np.concatenate(parts).reshape(n, b, q)
        return solution * self.scale_images[:, :, None], border * self.scale_common[:, None]

    def selected_inverse(self) -> SelectedInverse:
        """The inverse where the matrix has elements, and more (see `SelectedInverse`)."""
        n, b = self.scale_images.shape
        k = len(self.scale_common)
        scale = self.scale_images[self.levels.image].reshape(-1)
        scales = [*np.split(scale, b * self.levels.offsets[1:-1]), np.empty(0)]
        corner = _inverse_square(self.lower[-1])
        after = corner
        within: list[Floats] = []
        following: list[Floats] = []
        border: list[Floats] = []
        for at in range(len(self.coupling) - 1, -1, -1):
            g = _solved(self.lower[at], self.coupling[at], transposed=True)
            onward = -(g @ after)
            own = _inverse_square(self.lower[at]) - onward @ g.T
            own = 0.5 * (own + own.T)
            split = g.shape[1] - k
            within.append(own * scales[at][:, None] * scales[at])
            following.append(onward[:, :split] * scales[at][:, None] * scales[at + 1])
            border.append(onward[:, split:] * scales[at][:, None] * self.scale_common)
            to_border = onward[:, split:]
            after = np.block([[own, to_border], [to_border.T, corner]])
        by_image = np.empty((n, b, k))
        by_image[self.levels.image] = np.concatenate(border[::-1]).reshape(n, b, k)
        return SelectedInverse(
            self.levels,
            tuple(within[::-1]),
            tuple(following[::-1]),
            by_image,
            corner * self.scale_common[:, None] * self.scale_common,
        )


def factorised(matrix: ArrowMatrix, levels: Levels) -> ArrowFactor:
    """Factorise a matrix whose pairs connect the same or neighbouring levels only.

    Raises
    ------
    UndeterminedError
        If it is singular; names the images and common unknowns that its null space moves.
    """
    images, common = matrix.diagonal()
    with np.errstate(divide="ignore", invalid="ignore"):
        scale_images, scale_common = 1.0 / np.sqrt(images), 1.0 / np.sqrt(common)
    bad_images = ~np.isfinite(scale_images).all(axis=1)
    bad_common = ~np.isfinite(scale_common)
    if bad_images.any() or bad_common.any():
        raise UndeterminedError(np.flatnonzero(bad_images), np.flatnonzero(bad_common))
    scaled = matrix.scaled(scale_images, scale_common)
    parts = _factors(scaled, levels, SINGULAR_PIVOT)
    if parts is None:
        raise _undetermined(scaled, levels)
    return ArrowFactor(levels, scale_images, scale_common, *parts)


def _factors(
    matrix: ArrowMatrix, levels: Levels, smallest_pivot: float
) -> tuple[tuple[Floats, ...], tuple[Floats, ...]] | None:
    """Factors and couplings of `ArrowFactor`; None if a pivot is too small."""
    own, next_level = _dense_levels(matrix, levels)
    k = len(matrix.corner)
    lower: list[Floats] = []
    couplings: list[Floats] = []
    corner = matrix.corner
    before = np.zeros((0, len(own[0]) + k))
    for at, (diagonal, onward) in enumerate(zip(own, next_level, strict=True)):
        size = len(diagonal)
        members = levels.image[levels.offsets[at] : levels.offsets[at + 1]]
        to_border = matrix.border[members].reshape(size, k)
        carried = before[:, :size].T @ before
        right = np.concatenate([onward, to_border - carried[:, size:]], axis=1)
        factor = _cholesky(diagonal - carried[:, :size], smallest_pivot)
        if factor is None:
            return None
        before = _solved(factor, right, transposed=False)
        lower.append(factor)
        couplings.append(before)
        to_border = before[:, right.shape[1] - k :]
        corner = corner - to_border.T @ to_border
    factor = _cholesky(corner, smallest_pivot)
    return None if factor is None else ((*lower, factor), tuple(couplings))


def _dense_levels(matrix: ArrowMatrix, levels: Levels) -> tuple[list[Floats], list[Floats]]:
    """A_ll (both triangles) and A_l,l+1 of every level."""
    b = matrix.blocks.shape[1]
    size = np.append(np.diff(levels.offsets), 0)
    own = tuple(np.zeros((s, b, s, b)) for s in size[:-1])
    onward = tuple(np.zeros((s, b, t, b)) for s, t in pairwise(size))
    level, place = levels.level, levels.place
    swapped = level[matrix.first] > level[matrix.second]
    upper = np.where(swapped, matrix.second, matrix.first)
    lower = np.where(swapped, matrix.first, matrix.second)
    blocks = np.where(swapped[:, None, None], np.swapaxes(matrix.blocks, 1, 2), matrix.blocks)
    between = level[upper] != level[lower]
    for index, target in _by_level(level[upper], between, own, onward):
        target[place[upper[index]], :, place[lower[index]], :] = blocks[index]
    inside = np.flatnonzero(~between & (upper != lower))
    none = np.zeros(len(inside), dtype=bool)
    for index, target in _by_level(level[upper[inside]], none, own, ()):
        pair = inside[index]
        target[place[lower[pair]], :, place[upper[pair]], :] = np.swapaxes(blocks[pair], 1, 2)
    return (
        [a.reshape(b * len(a), -1) for a in own],
        [a.reshape(b * len(a), -1) for a in onward],
    )


def _cholesky(matrix: Floats, smallest_pivot: float) -> Floats | None:
    """Lower factor (Fortran order), None if a pivot is too small or not finite."""
    if len(matrix) == 0:
        return np.zeros((0, 0))
    lower, info = lapack.dpotrf(matrix.T, lower=1)
    pivots = np.diagonal(lower) ** 2
    if info != 0 or not np.all(pivots > smallest_pivot):
        return None
    return np.asarray(lower, dtype=float)


def _solved(lower: Floats, right: Floats, *, transposed: bool) -> Floats:
    """L^-1 right, or L'^-1 right."""
    if right.size == 0:
        return right
    return np.asarray(blas.dtrsm(1.0, lower, right, lower=1, trans_a=int(transposed)))


def _inverse_square(lower: Floats) -> Floats:
    """(L L')^-1, both triangles."""
    if len(lower) == 0:
        return np.zeros((0, 0))
    inverse, _ = lapack.dpotri(lower, lower=1)
    triangle: Floats = np.asarray(inverse, dtype=float)
    triangle += np.tril(triangle, -1).T
    return triangle


def _undetermined(scaled: ArrowMatrix, levels: Levels) -> UndeterminedError:
    """What the null space of a singular matrix of unit diagonal moves, by inverse iteration."""
    n, b, k = scaled.border.shape
    ones_images, ones_common = np.ones((n, b)), np.ones(k)
    ridged = scaled.plus_diagonal(_RIDGE * ones_images, _RIDGE * ones_common)
    parts = _factors(ridged, levels, 0.0)
    if parts is None:  # not even positive: an indefinite or infinite matrix
        return UndeterminedError(np.arange(n), np.arange(k))
    factor = ArrowFactor(levels, ones_images, ones_common, *parts)
    count = min(_NULL_VECTORS, n * b + k)
    vectors = np.random.default_rng(0).standard_normal((n * b + k, count))
    for _ in range(4):
        basis, _ = np.linalg.qr(vectors)
        images, common = factor.solve(basis[: n * b].reshape(n, b, count), basis[n * b :])
        vectors = np.concatenate([images.reshape(n * b, count), common])
    inverse_eigenvalues, rotation = np.linalg.eigh(basis.T @ vectors)
    null = (basis @ rotation)[:, 1.0 / inverse_eigenvalues - _RIDGE < _NULL]
    moved = (null**2).sum(axis=1) > _PARTICIPATION
    return UndeterminedError(
        np.flatnonzero(moved[: n * b].reshape(n, b).any(axis=1)), np.flatnonzero(moved[n * b :])
    )
