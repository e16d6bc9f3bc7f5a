"""The rays of a bundle adjustment in the order in which their normal equations add up fastest.

Points seen by the same images share the blocks of the normal equations that they enter. They are
put side by side, so that their sum goes to the block's normal equations once.
"""

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from posstats.arrays import Bools, Ints

_N_PARTS = 2  # the same sums on every machine, whatever its number of processors


class PointGroups(NamedTuple):
    """g groups of p points; a group's points are seen by the same images.

    Attributes
    ----------
    offsets
        (g + 1,) the points of a group.
    first_ray
        (p + 1,) the rays of a point.
    ray_image
        (m,) images, ascending within a point.
    pair_offsets
        (g + 1,) the elements of `pair` of a group.
    pair
        Indices of the image pairs (i <= j, row by row) of every group.
    """

    offsets: Ints
    first_ray: Ints
    ray_image: Ints
    pair_offsets: Ints
    pair: Ints


@dataclass(frozen=True, eq=False)
class GroupedRays:
    """How rays and points are sorted into groups.

    Attributes
    ----------
    point
        (p,) index of the points with rays, group after group.
    ray
        (m,) index of the rays, in the order of these points.
    groups
        In that order.
    first, second
        (P,) image pairs with a common point, first <= second, and every image with itself.
    """

    point: Ints
    ray: Ints
    groups: PointGroups
    first: Ints
    second: Ints

    @property
    def parts(self) -> list[tuple[int, int]]:
        """Groups first ... last - 1, in parts of about equal numbers of rays."""
        first_rays = self.groups.first_ray[self.groups.offsets]
        at = np.searchsorted(first_rays, np.linspace(0, len(self.ray), _N_PARTS + 1)[1:-1])
        bounds = [0, *(int(i) for i in at), len(self.groups.offsets) - 1]
        return [(a, b) for a, b in pairwise(bounds) if a < b]


def grouped(point: Ints, image: Ints, n_images: int) -> GroupedRays:
    """Group rays (m,) of points and images; no point is twice in an image."""
    by_point = np.lexsort((image, point))
    starts = np.flatnonzero(np.diff(point[by_point], prepend=-1))
    n_rays = np.diff(np.append(starts, len(by_point)))
    images = image[by_point]
    key = _keys(images, starts, n_images)
    order = np.lexsort((key, n_rays, images[starts]))
    ray = _ranges(starts[order], n_rays[order])
    first_ray = np.append(0, np.cumsum(n_rays[order]))
    ray_image = images[ray]
    begins = np.flatnonzero(_differs(first_ray, ray_image))
    offsets = np.append(begins, len(order))
    pairs = [_pairs(ray_image[first_ray[p] : first_ray[p + 1]]) for p in begins]
    pair_offsets = np.append(0, np.cumsum([p.shape[1] for p in pairs], dtype=np.intp))
    alone = np.tile(np.arange(n_images), (2, 1))
    first, second = np.concatenate([alone, *pairs], axis=1)
    codes, index = np.unique(first * n_images + second, return_inverse=True)
    groups = PointGroups(offsets, first_ray, ray_image, pair_offsets, index[n_images:])
    return GroupedRays(
        point[by_point[starts[order]]], by_point[ray], groups, codes // n_images, codes % n_images
    )


def _keys(images: Ints, starts: Ints, n_images: int) -> NDArray[np.uint64]:
    """(p,) a number for the images of every point; equal images have equal numbers."""
    code = np.random.default_rng(0).integers(0, 2**63, n_images, dtype=np.uint64)
    return np.asarray(np.add.reduceat(code[images], starts))


def _ranges(first: Ints, length: Ints) -> Ints:
    """first[0], first[0] + 1, ... of the given lengths, one after the other."""
    ends = np.cumsum(length)
    return np.arange(ends[-1]) + np.repeat(first - ends + length, length)


def _differs(first_ray: Ints, ray_image: Ints) -> Bools:
    """(p,) whether a point is seen by other images than the point before."""
    n_rays = np.diff(first_ray)
    differs = np.append(True, n_rays[1:] != n_rays[:-1])
    alike = np.flatnonzero(~differs)
    mine = _ranges(first_ray[alike], n_rays[alike]) if len(alike) else alike
    other = _ranges(first_ray[alike - 1], n_rays[alike - 1]) if len(alike) else alike
    unequal = ray_image[mine] != ray_image[other]
    if len(alike):
        ends = np.append(0, np.cumsum(n_rays[alike]))[:-1]
        differs[alike] = np.logical_or.reduceat(unequal, ends)
    return differs


@lru_cache(maxsize=64)
def _upper(n: int) -> tuple[Ints, Ints]:
    return np.triu_indices(n)


def _pairs(images: Ints) -> Ints:
    """(2, n (n + 1) / 2) images i <= j, row by row."""
    rows, columns = _upper(len(images))
    return np.stack([images[rows], images[columns]])
