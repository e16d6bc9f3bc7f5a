"""Image blocks with a border: numpy's dense inverse, singular systems, growth with the size."""

import numpy as np
import pytest

from posstats.errors import UndeterminedError
from posstats.numerics.solvers.arrow import ArrowMatrix, factorised
from posstats.numerics.solvers.levels import breadth_first_levels


def arrow(pairs, n_images, n_common, seed, b=6):
    """A random positive definite matrix with elements at these pairs of images only.

    A sum of squares: one observation touches one pair of images and the common unknowns.
    """
    rng = np.random.default_rng(seed)
    pairs = sorted({(min(pair), max(pair)) for pair in pairs} | {(i, i) for i in range(n_images)})
    size = b * n_images + n_common
    dense = np.zeros((size, size))
    for i, j in pairs:
        columns = np.unique(
            np.r_[b * i : b * i + b, b * j : b * j + b, b * n_images : size].astype(int)
        )
        rows = rng.standard_normal((len(columns) + 2, len(columns)))
        dense[np.ix_(columns, columns)] += rows.T @ rows
    # some pairs are given the other way round
    first, second = np.array([pair[:: rng.choice([1, -1])] for pair in pairs]).T
    blocks = np.array(
        [dense[b * i : b * i + b, b * j : b * j + b] for i, j in zip(first, second, strict=True)]
    )
    images = b * n_images
    border = dense[:images, images:].reshape(n_images, b, n_common)
    return ArrowMatrix(first, second, blocks, border, dense[images:, images:]), dense


def strips(n_strips, n_images):
    """Pairs of a block of strips: two neighbours along, and across to the next strip."""
    index = np.arange(n_strips * n_images).reshape(n_strips, n_images)
    return [
        (index[s, i], index[t, j])
        for s in range(n_strips)
        for i in range(n_images)
        for t, j in ((s, i + 1), (s, i + 2), (s + 1, i), (s + 1, i + 1))
        if t < n_strips and j < n_images
    ]


def random_pairs(n_images, n_pairs, seed):
    return np.random.default_rng(seed).integers(0, n_images, (n_pairs, 2)).tolist()


PATTERNS = {
    "strips": (strips(3, 7), 21, 5),
    "random": (random_pairs(25, 40, 1), 25, 3),
    "without a border": (strips(2, 6), 12, 0),
    "two components": (strips(1, 5) + [(a + 5, b + 5) for a, b in strips(2, 4)], 13, 2),
    "single images": ([(0, 1)], 4, 2),
    "one level": ([], 1, 4),
    "all with all": ([(i, j) for i in range(6) for j in range(i)], 6, 2),
}


@pytest.mark.parametrize("pattern", PATTERNS)
def test_pairs_connect_neighbouring_levels_only(pattern):
    pairs, n, _ = PATTERNS[pattern]
    first, second = np.array([*pairs, (0, 0)]).T
    levels = breadth_first_levels(first, second, n)
    assert np.abs(levels.level[first] - levels.level[second]).max() <= 1
    np.testing.assert_array_equal(np.sort(levels.image), np.arange(n))
    np.testing.assert_array_equal(
        levels.image[levels.offsets[levels.level] + levels.place], np.arange(n)
    )


@pytest.mark.parametrize("pattern", PATTERNS)
def test_solution_and_selected_inverse_are_those_of_the_dense_matrix(pattern):
    pairs, n, k = PATTERNS[pattern]
    matrix, dense = arrow(pairs, n, k, seed=2)
    inverse = np.linalg.inv(dense)
    factor = factorised(matrix, breadth_first_levels(matrix.first, matrix.second, n))
    right = np.random.default_rng(3).standard_normal((len(dense), 2))
    images, common = factor.solve(right[: 6 * n].reshape(n, 6, 2), right[6 * n :])
    solution = np.concatenate([images.reshape(-1, 2), common])
    np.testing.assert_allclose(solution, inverse @ right, rtol=0, atol=1e-10)

    selected = factor.selected_inverse()
    expected = inverse[: 6 * n, : 6 * n].reshape(n, 6, n, 6)
    blocks = selected.blocks(matrix.first, matrix.second)
    np.testing.assert_allclose(
        blocks, expected[matrix.first, :, matrix.second, :], rtol=0, atol=1e-10
    )
    np.testing.assert_allclose(
        selected.border, inverse[: 6 * n, 6 * n :].reshape(n, 6, k), rtol=0, atol=1e-10
    )
    np.testing.assert_allclose(selected.corner, inverse[6 * n :, 6 * n :], rtol=0, atol=1e-10)


def test_a_singular_matrix_names_what_its_null_space_moves():
    _, dense = arrow(strips(2, 6), 12, 4, seed=4)
    open_direction = np.zeros(len(dense))
    open_direction[[6 * 3 + 1, 6 * 9 + 4, 72 + 2]] = [1.0, -0.5, 2.0]
    projected = np.eye(len(dense)) - np.outer(open_direction, open_direction) / (
        open_direction @ open_direction
    )
    first, second = np.triu_indices(12)  # the projection fills the whole matrix
    singular = projected @ dense @ projected
    blocks = singular[:72, :72].reshape(12, 6, 12, 6)[first, :, second, :]
    open_matrix = ArrowMatrix(
        first, second, blocks, singular[:72, 72:].reshape(12, 6, 4), singular[72:, 72:]
    )
    with pytest.raises(UndeterminedError) as caught:
        factorised(open_matrix, breadth_first_levels(first, second, 12))
    assert caught.value.images == (3, 9)
    assert caught.value.common == (2,)


def test_an_image_without_observations_is_named():
    matrix, _ = arrow(strips(1, 5), 5, 1, seed=5)
    matrix.blocks[(matrix.first == 2) | (matrix.second == 2)] = 0.0
    with pytest.raises(UndeterminedError) as caught:
        factorised(matrix, breadth_first_levels(matrix.first, matrix.second, 5))
    assert caught.value.images == (2,)
    assert caught.value.common == ()


def test_stored_numbers_grow_linearly_with_the_length_of_the_strips():
    def stored(n_images):
        pairs = strips(5, n_images)
        matrix, _ = arrow(pairs, 5 * n_images, 2, seed=6, b=2)
        levels = breadth_first_levels(matrix.first, matrix.second, 5 * n_images)
        inverse = factorised(matrix, levels).selected_inverse()
        return sum(a.size for a in (*inverse.within, *inverse.following))

    assert stored(80) < 2.2 * stored(40)
