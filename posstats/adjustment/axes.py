"""Images whose image coordinates have axes exchanged or reversed, found before any adjustment.

Start orientations are near enough for the coplanarity of rays: with the right axes the parallax
of an image against its neighbours is that of the errors of POS, with wrong ones it is as large as
the image.
"""

import numpy as np
from numpy.typing import NDArray

from posstats.bundle.problem import BundleProblem

_Floats = NDArray[np.float64]
_Ints = NDArray[np.intp]

_LEAST_PAIRS = 6
_BETTER = 0.1  # the parallax of other axes over that of the measured ones
_NOT_WORSE = 2.0
_VARIANTS = np.array(
    [m * [[s], [t]] for m in (np.eye(2), np.eye(2)[::-1]) for s in (1, -1) for t in (1, -1)]
)


def images_with_wrong_axes(problem: BundleProblem) -> _Ints:
    """Images that one of the seven other choices of axes fits ten times better.

    The parallax is the median over the pairs of an image's rays with the other rays of their
    points; an image needs six pairs. An axis reversed along the base makes no parallax, so pairs
    with bases along x and along y of the image are judged apart. Not seen are
    axes that are wrong in all images, and one reversed along the line of flight where no other
    strip overlaps.
    """
    first, second = _pairs(problem.point)
    first, second = np.append(first, second), np.append(second, first)
    image = problem.image[first]
    order = np.argsort(image, kind="stable")
    first, second, image = first[order], second[order], image[order]
    numbers, starts = np.unique(image, return_index=True)
    parallax = np.array([_parallax(problem, first, second, axes) for axes in _VARIANTS])
    along_x = _base_along_x(problem, first, second)
    wrong = []
    for number, rows in zip(numbers, np.split(np.arange(len(image)), starts[1:]), strict=True):
        if len(rows) >= _LEAST_PAIRS and _fits_better(parallax[:, rows], along_x[rows]):
            wrong.append(number)
    return np.array(wrong, dtype=np.intp)


def _fits_better(parallax: _Floats, along_x: NDArray[np.bool_]) -> bool:
    """Whether one of the variants, parallax (8, q), is ten times better than the first.

    It must be so for one kind of pairs and not worse for the other: a single wrong neighbour could
    be all of one kind. Where one kind is rare, all pairs are judged together.
    """
    kinds = [rows for rows in (along_x, ~along_x) if rows.sum() >= _LEAST_PAIRS]
    if len(kinds) < 2:
        kinds = [np.ones(len(along_x), dtype=bool)]
    median = np.array([np.median(parallax[:, rows], axis=1) for rows in kinds])
    better = (median < _BETTER * median[:, :1]).any(axis=0)
    bearable = (median <= _NOT_WORSE * median[:, :1]).all(axis=0)
    return bool((better & bearable).any())


def _base_along_x(problem: BundleProblem, first: _Ints, second: _Ints) -> NDArray[np.bool_]:
    """(q,) whether the base lies rather along x than along y of the first ray's image."""
    one, other = problem.image[first], problem.image[second]
    base = problem.position_m[other] - problem.position_m[one]
    in_image = np.einsum("qji,qj->qi", problem.ground_from_image[one], base)
    along: NDArray[np.bool_] = np.abs(in_image[:, 0]) > np.abs(in_image[:, 1])
    return along


def _pairs(point: _Ints) -> tuple[_Ints, _Ints]:
    """Pairs of rays of the same point, next and next but one in the order of the rays."""
    order = np.argsort(point, kind="stable")
    pairs = []
    for step in (1, 2):
        same = point[order[step:]] == point[order[:-step]]
        pairs.append((order[:-step][same], order[step:][same]))
    return np.concatenate([p[0] for p in pairs]), np.concatenate([p[1] for p in pairs])


def _parallax(problem: BundleProblem, first: _Ints, second: _Ints, axes: _Floats) -> _Floats:
    """(q,) sine of the angle of the second rays to the planes of the first and the base."""
    one = _directions(problem, problem.xy_px[first] @ axes.T, first)
    other = _directions(problem, problem.xy_px[second], second)
    centre = problem.position_m
    normal = np.cross(centre[problem.image[second]] - centre[problem.image[first]], one)
    length = np.linalg.norm(normal, axis=1) * np.linalg.norm(other, axis=1)
    product = np.abs(np.einsum("qi,qi->q", normal, other))
    sine: _Floats = np.divide(product, length, out=np.zeros_like(product), where=length > 0.0)
    return sine


def _directions(problem: BundleProblem, xy_px: _Floats, ray: _Ints) -> _Floats:
    """(q, 3) in the ground frame."""
    image = problem.image[ray]
    distance = problem.distance_px[problem.exposures.camera[image]]
    vectors = np.column_stack([xy_px, -distance])
    turned: _Floats = np.einsum("qij,qj->qi", problem.ground_from_image[image], vectors)
    return turned
