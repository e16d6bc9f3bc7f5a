"""Which point pairs the block-wide coplanarity adjustment sees, gathered point by point."""

from dataclasses import dataclass

import numpy as np

from posstats.arrays import Bools, Floats, Ints
from posstats.block.image_pairs import ImagePairs, image_vectors
from posstats.block.model import Block, Orientations, TiePoints

SHORTEST_BASE = 3.0  # in standard deviations of the base


@dataclass(frozen=True, eq=False)
class PointPairs:
    """N point pairs of p image pairs, point after point of g points.

    Attributes
    ----------
    left, right
        (p,) images.
    pair
        (N,) number of the image pair of every point pair.
    left_ray, right_ray
        (N,) rays, numbered point after point.
    ray_vectors
        (m, 3) image vectors (x, y, -c) of the rays, px.
    ray_image
        (m,) image of every ray, ascending within a point.
    point_offsets
        (g + 1,) first point pair of each point, and N.
    first_ray, n_rays
        (g,) the rays of each point. Points that the same images see are neighbours, mostly.
    common
        (n, n) number of each pair i <= j of the n images that see a common point, in order of i,
        then j; -1 for the others.
    """

    left: Ints
    right: Ints
    pair: Ints
    left_ray: Ints
    right_ray: Ints
    ray_vectors: Floats
    ray_image: Ints
    point_offsets: Ints
    first_ray: Ints
    n_rays: Ints
    common: Ints

    def n_points_of_images(self, n_images: int) -> Ints:
        """(n_images,) number of points that each image has in common with another one."""
        used = np.zeros(len(self.ray_image), dtype=bool)
        used[self.left_ray] = used[self.right_ray] = True
        return np.bincount(self.ray_image[used], minlength=n_images)


def point_pairs(block: Block, pairs: ImagePairs) -> PointPairs:
    """The common points of pairs of images, gathered point by point."""
    ties = block.tie_points
    n_points = len(ties.point_id)
    point = ties.point[pairs.left_ray]
    counts = np.bincount(point, minlength=n_points)
    n_rays = np.bincount(ties.point, minlength=n_points)
    first_ray = np.cumsum(n_rays) - n_rays
    order = _alike_together(np.flatnonzero(counts), first_ray, n_rays, ties.image)
    rank = np.empty(n_points, dtype=np.intp)
    rank[order] = np.arange(len(order))
    by_point = np.argsort(rank[point], kind="stable")
    return PointPairs(
        left=pairs.left,
        right=pairs.right,
        pair=pairs.pair_of_point[by_point],
        left_ray=pairs.left_ray[by_point],
        right_ray=pairs.right_ray[by_point],
        ray_vectors=image_vectors(ties, block.orientations, block.cameras),
        ray_image=ties.image,
        point_offsets=np.concatenate([[0], np.cumsum(counts[order])]).astype(np.intp),
        first_ray=first_ray[order],
        n_rays=n_rays[order],
        common=_common(ties, len(block.orientations)),
    )


def _common(ties: TiePoints, n_images: int) -> Ints:
    """Number (n, n) the pairs of images of one point, those of an image with itself among them."""
    shared = np.zeros((n_images, n_images), dtype=bool)
    for shift in range(int(np.bincount(ties.point).max(initial=0))):
        last = len(ties) - shift
        same = ties.point[:last] == ties.point[shift:]
        shared[ties.image[:last][same], ties.image[shift:][same]] = True
    return np.where(shared, np.cumsum(shared).reshape(shared.shape) - 1, -1)


def _alike_together(points: Ints, first_ray: Ints, n_rays: Ints, ray_image: Ints) -> Ints:
    """Order the points (by number, first, last and sum of images): the same images in a row."""
    before = np.concatenate([[0], np.cumsum(ray_image)])
    first = first_ray[points]
    end = first + n_rays[points]
    keys = (before[end] - before[first], ray_image[end - 1], ray_image[first], end - first)
    ordered: Ints = points[np.lexsort(keys)]
    return ordered


def long_bases(orientations: Orientations, pairs: ImagePairs) -> Bools:
    """(p,) whether the horizontal base is longer than three of its standard deviations.

    The direction of a shorter base, hence the parallax, is not known even roughly.
    """
    position = orientations.position_m[:, :2]
    sigma = orientations.sigma_position_m[:, :2].max(axis=1)
    base = np.linalg.norm(position[pairs.right] - position[pairs.left], axis=1)
    spread = np.hypot(sigma[pairs.left], sigma[pairs.right])
    long: Bools = base > SHORTEST_BASE * spread
    return long
