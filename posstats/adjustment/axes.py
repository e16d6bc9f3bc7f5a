"""Images whose image coordinates have axes exchanged or reversed, found before any adjustment.

Start orientations are near enough for the coplanarity of rays: with the right axes the parallax
of an image against its neighbours is that of the errors of POS, with wrong ones it is as large as
the image.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from posstats.arrays import Bools, Floats, Ints
from posstats.numerics.bundle.problem import BundleProblem

_LEAST_PAIRS = 6
_BETTER = 0.1  # the parallax of other axes over that of the measured ones
_NOT_WORSE = 2.0
_VARIANTS = np.array(
    [m * [[s], [t]] for m in (np.eye(2), np.eye(2)[::-1]) for s in (1, -1) for t in (1, -1)]
)


def images_with_wrong_axes(problem: BundleProblem) -> Ints:
    """Images that one of the seven other choices of axes fits ten times better.

    The parallax is the median over the pairs of an image's rays with the other rays of their
    points; an image needs six pairs. An axis reversed along the base makes no parallax, so pairs
    with bases along x and along y of the image are judged apart. A wrong image spoils the pairs of
    its neighbours too, so that those found are judged again without the pairs they form. Not seen
    are axes that are wrong in all images, and one reversed along the line of flight where no other
    strip overlaps.
    """
    pairs = _pairs_of_images(problem)
    found = [image for image, each in pairs.items() if each.fit_other_axes]
    apart = {image: pairs[image].without(found) for image in found}
    wrong = [k for k in found if len(apart[k].other) < _LEAST_PAIRS or apart[k].fit_other_axes]
    return np.array(wrong, dtype=np.intp)


@dataclass(frozen=True, eq=False)
class _ImagePairs:
    """The q pairs of rays of one image.

    Attributes
    ----------
    other
        (q,) the other ray's image.
    parallax
        (8, q) of the choices of axes of the one image.
    along_x
        (q,) whether the base lies along its x.
    """

    other: Ints
    parallax: Floats
    along_x: Bools

    def without(self, images: Sequence[int]) -> "_ImagePairs":
        """The pairs with images that are none of these."""
        kept = ~np.isin(self.other, images)
        return _ImagePairs(self.other[kept], self.parallax[:, kept], self.along_x[kept])

    @property
    def fit_other_axes(self) -> bool:
        """Whether one of the other choices is ten times better than the axes as measured.

        It must be so for one kind of pairs and not worse for the other: a single wrong neighbour
        could be all of one kind. Where one kind is rare, all pairs are judged together.
        """
        if len(self.other) < _LEAST_PAIRS:
            return False
        kinds = [rows for rows in (self.along_x, ~self.along_x) if rows.sum() >= _LEAST_PAIRS]
        if len(kinds) < 2:
            kinds = [np.ones(len(self.other), dtype=bool)]
        median = np.array([np.median(self.parallax[:, rows], axis=1) for rows in kinds])
        better = (median < _BETTER * median[:, :1]).any(axis=0)
        bearable = (median <= _NOT_WORSE * median[:, :1]).all(axis=0)
        return bool((better & bearable).any())


def _pairs_of_images(problem: BundleProblem) -> dict[int, _ImagePairs]:
    """The pairs of every image that has some."""
    first, second = _pairs(problem.point)
    first, second = np.append(first, second), np.append(second, first)
    order = np.argsort(problem.image[first], kind="stable")
    first, second = first[order], second[order]
    parallax = np.array([_parallax(problem, first, second, axes) for axes in _VARIANTS])
    along_x = _base_along_x(problem, first, second)
    numbers, starts = np.unique(problem.image[first], return_index=True)
    rows = np.split(np.arange(len(first)), starts[1:])
    return {
        int(number): _ImagePairs(problem.image[second[own]], parallax[:, own], along_x[own])
        for number, own in zip(numbers, rows, strict=True)
    }


def _base_along_x(problem: BundleProblem, first: Ints, second: Ints) -> Bools:
    """(q,) whether the base lies rather along x than along y of the first ray's image."""
    one, other = problem.image[first], problem.image[second]
    base = problem.position_m[other] - problem.position_m[one]
    in_image = np.einsum("qji,qj->qi", problem.ground_from_image[one], base)
    along: Bools = np.abs(in_image[:, 0]) > np.abs(in_image[:, 1])
    return along


def _pairs(point: Ints) -> tuple[Ints, Ints]:
    """Pairs of rays of the same point, next and next but one in the order of the rays."""
    order = np.argsort(point, kind="stable")
    pairs = []
    for step in (1, 2):
        same = point[order[step:]] == point[order[:-step]]
        pairs.append((order[:-step][same], order[step:][same]))
    return np.concatenate([p[0] for p in pairs]), np.concatenate([p[1] for p in pairs])


def _parallax(problem: BundleProblem, first: Ints, second: Ints, axes: Floats) -> Floats:
    """(q,) sine of the angle of the second rays to the planes of the first and the base."""
    one = _directions(problem, problem.xy_px[first] @ axes.T, first)
    other = _directions(problem, problem.xy_px[second], second)
    centre = problem.position_m
    normal = np.cross(centre[problem.image[second]] - centre[problem.image[first]], one)
    length = np.linalg.norm(normal, axis=1) * np.linalg.norm(other, axis=1)
    product = np.abs(np.einsum("qi,qi->q", normal, other))
    sine: Floats = np.divide(product, length, out=np.zeros_like(product), where=length > 0.0)
    return sine


def _directions(problem: BundleProblem, xy_px: Floats, ray: Ints) -> Floats:
    """(q, 3) in the ground frame."""
    image = problem.image[ray]
    distance = problem.distance_px[problem.exposures.camera[image]]
    vectors = np.column_stack([xy_px, -distance])
    turned: Floats = np.einsum("qij,qj->qi", problem.ground_from_image[image], vectors)
    return turned
