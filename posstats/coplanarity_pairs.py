"""Which point pairs the block-wide coplanarity adjustment sees, gathered point by point."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from posstats.block import TiePoints
from posstats.stereo import StereoModels

_Floats = NDArray[np.float64]
_Ints = NDArray[np.intp]

SHORTEST_BASE = 3.0  # in standard deviations of the base


@dataclass(frozen=True, eq=False)
class PointPairs:
    """N point pairs of p image pairs, and how they hang together in g points.

    Attributes
    ----------
    left, right
        (p,) images.
    offsets
        (p + 1,) first point pair of each image pair, and N.
    left_vectors, right_vectors
        (N, 3) image vectors (x, y, -c), px.
    left_ray, right_ray
        (N,) rays, numbered point after point.
    ray_image
        (m,) image of every ray, ascending within a point.
    by_point
        (N,) order of the point pairs that makes those of one point neighbours.
    point_offsets
        (g + 1,) first place of each point in `by_point`, and N.
    first_ray, n_rays
        (g,) the rays of each point.
    """

    left: _Ints
    right: _Ints
    offsets: _Ints
    left_vectors: _Floats
    right_vectors: _Floats
    left_ray: _Ints
    right_ray: _Ints
    ray_image: _Ints
    by_point: _Ints
    point_offsets: _Ints
    first_ray: _Ints
    n_rays: _Ints


def point_pairs(tie_points: TiePoints, models: StereoModels, across: StereoModels) -> PointPairs:
    """Point pairs of the stereo models and of the pairs of images across strips.

    Image pairs whose base is shorter than three of its standard deviations are left out: the
    direction of such a base, hence the parallax, is not known even roughly.
    """
    parts = [(part, _long_enough(part)) for part in (models, across)]
    images = [(part.pairs.left[keep], part.pairs.right[keep]) for part, keep in parts]
    counts = np.concatenate([part.pairs.n_points[keep] for part, keep in parts])
    chosen = [(part, np.repeat(keep, part.pairs.n_points)) for part, keep in parts]
    left_ray = np.concatenate([p.pairs.left_ray[rows] for p, rows in chosen])
    right_ray = np.concatenate([p.pairs.right_ray[rows] for p, rows in chosen])
    point = tie_points.point[left_ray]
    by_point = np.argsort(point, kind="stable")
    points, point_counts = np.unique(point, return_counts=True)
    return PointPairs(
        left=np.concatenate([left for left, _ in images]),
        right=np.concatenate([right for _, right in images]),
        offsets=np.concatenate([[0], np.cumsum(counts)]).astype(np.intp),
        left_vectors=np.concatenate([p.left_vectors[rows] for p, rows in chosen]),
        right_vectors=np.concatenate([p.right_vectors[rows] for p, rows in chosen]),
        left_ray=left_ray,
        right_ray=right_ray,
        ray_image=tie_points.image,
        by_point=by_point,
        point_offsets=np.concatenate([[0], np.cumsum(point_counts)]).astype(np.intp),
        first_ray=np.searchsorted(tie_points.point, points, side="left"),
        n_rays=np.bincount(tie_points.point, minlength=len(tie_points.point_id))[points],
    )


def _long_enough(models: StereoModels) -> NDArray[np.bool_]:
    """(p,) whether the horizontal base exceeds its uncertainty."""
    sigma = models.orientations.sigma_position_m[:, :2].max(axis=1)
    base = np.hypot(models.base_m[:, 0], models.base_m[:, 1])
    spread = np.hypot(sigma[models.pairs.left], sigma[models.pairs.right])
    long_enough: NDArray[np.bool_] = base > SHORTEST_BASE * spread
    return long_enough
