"""Which images see the same points: stereo models and pairs across strips."""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np

from posstats.arrays import Bools, Floats, Ids, Ints
from posstats.block.camera import Camera
from posstats.block.model import Block, Orientations, TiePoints
from posstats.numerics.kernels.coplanarity import base_frames, y_parallax

MIN_MODEL_POINTS = 6


@dataclass(frozen=True, eq=False)
class ImagePairs:
    """p pairs of images with N common points, pair after pair.

    Attributes
    ----------
    left, right
        (p,) index of the images in the block's orientations; left is the earlier exposure.
    offsets
        (p + 1,) first point pair of each image pair, and N.
    left_ray, right_ray
        (N,) row of the block's tie points.
    """

    left: Ints
    right: Ints
    offsets: Ints
    left_ray: Ints
    right_ray: Ints

    def __len__(self) -> int:
        return len(self.left)

    @property
    def n_points(self) -> Ints:
        """(p,) number of common points."""
        return np.diff(self.offsets)

    @property
    def pair_of_point(self) -> Ints:
        """(N,) number of the image pair of every point pair."""
        return np.repeat(np.arange(len(self)), self.n_points)

    def subset(self, which: Bools | Ints) -> "ImagePairs":
        """The pairs `which` (mask or order), with their points."""
        chosen = np.arange(len(self))[which]
        counts = self.n_points[chosen]
        offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.intp)
        points = np.repeat(self.offsets[chosen] - offsets[:-1], counts) + np.arange(offsets[-1])
        return ImagePairs(
            left=self.left[chosen],
            right=self.right[chosen],
            offsets=offsets,
            left_ray=self.left_ray[points],
            right_ray=self.right_ray[points],
        )

    def joined(self, other: "ImagePairs") -> "ImagePairs":
        """These pairs, then the others."""
        return ImagePairs(
            left=np.concatenate([self.left, other.left]),
            right=np.concatenate([self.right, other.right]),
            offsets=np.concatenate([self.offsets, self.offsets[-1] + other.offsets[1:]]),
            left_ray=np.concatenate([self.left_ray, other.left_ray]),
            right_ray=np.concatenate([self.right_ray, other.right_ray]),
        )


@dataclass(frozen=True, eq=False)
class StereoModels:
    """The stereo models of a block: two consecutive exposures of a strip with common points.

    Attributes
    ----------
    pairs
        Left and right image and common points of every model, in order of flight.
    orientations
        The orientations that the models are formed from.
    left_vectors, right_vectors
        (N, 3) image vectors (x, y, -c), px, ideal.
    pixel_size_mm
        (p,) pixel size of the right image (where the parallax is measured), NaN if unknown.
    """

    pairs: ImagePairs
    orientations: Orientations
    left_vectors: Floats
    right_vectors: Floats
    pixel_size_mm: Floats

    def __len__(self) -> int:
        return len(self.pairs)

    @property
    def strip(self) -> Ids:
        """(p,) strip of every model."""
        return self.orientations.strip[self.pairs.left]

    @property
    def base_m(self) -> Floats:
        """(p, 3) right minus left projection centre, ground frame."""
        position = self.orientations.position_m
        return position[self.pairs.right] - position[self.pairs.left]

    def with_orientations(self, orientations: Orientations) -> Self:
        """The same models formed from other orientations of the same images."""
        return replace(self, orientations=orientations)

    def y_parallax_px(self) -> Floats:
        """(N,) vertical parallax of every point pair, px at image scale."""
        base = self.base_m
        base_from_ground = base_frames(base)
        rotation = self.orientations.ground_from_image
        return y_parallax(
            self.left_vectors,
            self.right_vectors,
            self.pairs.offsets,
            base_from_ground @ rotation[self.pairs.left],
            base_from_ground @ rotation[self.pairs.right],
            np.einsum("...ij,...j->...i", base_from_ground, base),
        )


def stereo_models(block: Block) -> StereoModels:
    """The stereo models of a block, check points left out, in order of strip and time.

    Consecutive exposures without a common point form no model; models of fewer than
    `MIN_MODEL_POINTS` points are kept (results list them without a value).

    Examples
    --------
    >>> import posstats
    >>> len(posstats.stereo_models(posstats.read_block("block")))
    28
    """
    rays = _tie_rays(block)
    left, right = _consecutive_images(block.orientations)
    pairs = common_points(block.tie_points, rays, left, right)
    return form_models(block, pairs)


def form_models(block: Block, pairs: ImagePairs) -> StereoModels:
    """Models of given image pairs (of one strip or across strips)."""
    vectors = image_vectors(block.tie_points, block.orientations, block.cameras)
    pixel_size = np.array(
        [np.nan if c.pixel_size_mm is None else c.pixel_size_mm for c in block.cameras]
    )
    return StereoModels(
        pairs=pairs,
        orientations=block.orientations,
        left_vectors=vectors[pairs.left_ray],
        right_vectors=vectors[pairs.right_ray],
        pixel_size_mm=pixel_size[block.orientations.camera[pairs.right]],
    )


def image_vectors(
    tie_points: TiePoints, orientations: Orientations, cameras: tuple[Camera, ...]
) -> Floats:
    """(m, 3) image vectors (x, y, -c), px, of all measurements."""
    distance = np.array([camera.principal_distance_px for camera in cameras])
    depth = -distance[orientations.camera[tie_points.image]]
    return np.column_stack([tie_points.xy_px, depth])


def cross_strip_pairs(block: Block, min_points: int = MIN_MODEL_POINTS) -> ImagePairs:
    """Pairs of images of different strips that share at least `min_points` tie points."""
    rays = _tie_rays(block)
    i, j, point_ray_i, point_ray_j = _all_ray_pairs(block.tie_points, rays)
    strip = block.orientations.strip
    across = strip[i] != strip[j]
    code = i[across] * len(strip) + j[across]
    pairs = _grouped(code, point_ray_i[across], point_ray_j[across], len(strip))
    return pairs.subset(pairs.n_points >= min_points)


def common_points(tie_points: TiePoints, rays: Ints, left: Ints, right: Ints) -> ImagePairs:
    """Common points of the given image pairs; pairs without any are left out.

    Parameters
    ----------
    rays
        Rows of the tie points to use, sorted by point.
    left, right
        (p,) images of the wanted pairs.
    """
    n_images = int(max(tie_points.image.max(initial=0), right.max(initial=0))) + 1
    i, j, ray_i, ray_j = _all_ray_pairs(tie_points, rays)
    wanted = np.minimum(left, right) * n_images + np.maximum(left, right)
    code = i * n_images + j
    use = np.isin(code, wanted)
    found = _grouped(code[use], ray_i[use], ray_j[use], n_images)
    order = {int(c): k for k, c in enumerate(wanted)}
    rank = np.array([order[int(c)] for c in found.left * n_images + found.right], dtype=np.intp)
    return found.subset(np.argsort(rank))


def _tie_rays(block: Block) -> Ints:
    """Rows of the tie points that are not measurements of check points."""
    return np.flatnonzero(~block.check_points[block.tie_points.point])


def _consecutive_images(orientations: Orientations) -> tuple[Ints, Ints]:
    left, right = [], []
    for strip in orientations.strips:
        images = np.flatnonzero(orientations.strip == strip)
        left.append(images[:-1])
        right.append(images[1:])
    return np.concatenate(left), np.concatenate(right)


def _all_ray_pairs(tie_points: TiePoints, rays: Ints) -> tuple[Ints, Ints, Ints, Ints]:
    """All pairs of rays of one point: images i < j and the two rows of the tie points."""
    point = tie_points.point[rays]
    first, second = [], []
    shift = 1
    while True:
        same = np.flatnonzero(point[:-shift] == point[shift:])
        if len(same) == 0:
            break
        first.append(rays[same])
        second.append(rays[same + shift])
        shift += 1
    ray_i = np.concatenate(first) if first else np.empty(0, dtype=np.intp)
    ray_j = np.concatenate(second) if second else np.empty(0, dtype=np.intp)
    return tie_points.image[ray_i], tie_points.image[ray_j], ray_i, ray_j


def _grouped(code: Ints, ray_i: Ints, ray_j: Ints, n_images: int) -> ImagePairs:
    order = np.lexsort((ray_i, code))
    codes, counts = np.unique(code, return_counts=True)
    return ImagePairs(
        left=(codes // n_images).astype(np.intp),
        right=(codes % n_images).astype(np.intp),
        offsets=np.concatenate([[0], np.cumsum(counts)]).astype(np.intp),
        left_ray=ray_i[order],
        right_ray=ray_j[order],
    )
