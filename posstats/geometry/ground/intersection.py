"""Forward intersection: ground points from all their image rays, with residuals and covariance."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from posstats.arrays import Bools, Floats, Ids, Ints
from posstats.block.camera import Camera
from posstats.block.image_pairs import image_vectors
from posstats.block.model import Accuracy, Orientations, TiePoints
from posstats.numerics.kernels.collinearity import (
    INTERSECTED,
    intersect_rays,
    intersection_precision,
    project_derivatives,
)
from posstats.numerics.kernels.rotation import rotation_derivatives

# In the order of the status numbers of the kernel.
_STATUS = np.array(
    ["ok", "fewer than two rays", "parallel rays", "behind the camera", "not converged"],
    dtype=object,
)


@dataclass(frozen=True, eq=False)
class IntersectedPoints:
    """k ground points, computing frame; NaN where `status` is not "ok".

    Attributes
    ----------
    point
        (k,) index into the tie points' `point_id`.
    position_m
        (k, 3).
    covariance_m2
        (k, 3, 3) from the noise of the image coordinates alone.
    covariance_with_orientation_m2
        (k, 3, 3) the same plus the stated accuracy of the orientations, which are taken as
        independent between images; NaN where an image has no stated accuracy.
    n_rays
        (k,) rays used, those of images that have an orientation.
    rms_px
        (k,) root mean square of the 2 n_rays residuals of the image coordinates.
    status
        (k,) "ok", "fewer than two rays", "parallel rays", "behind the camera" or
        "not converged".
    """

    point: Ints
    position_m: Floats
    covariance_m2: Floats
    covariance_with_orientation_m2: Floats
    n_rays: Ints
    rms_px: Floats
    status: Ids

    def __len__(self) -> int:
        return len(self.point)

    @property
    def is_ok(self) -> Bools:
        """(k,) true where there is a position."""
        return np.asarray(self.status == "ok", dtype=bool)


def intersect(
    tie_points: TiePoints,
    orientations: Orientations,
    cameras: tuple[Camera, ...],
    points: ArrayLike | None = None,
    *,
    sigma_image_px: float = Accuracy.image_px,
) -> IntersectedPoints:
    """Intersect the rays of points by least squares of the image residuals.

    Parameters
    ----------
    tie_points
        Measurements, in any order.
    orientations
        Orientations of all images; rays of images with NaN in them are left out.
    cameras
        The block's cameras.
    points
        (k,) indices into `tie_points.point_id`, negative for points that no image shows; all
        points if None.
    sigma_image_px
        Standard deviation of an image coordinate, for the covariances.

    Returns
    -------
    IntersectedPoints
        One row for every wanted point, in that order.
    """
    wanted = np.arange(len(tie_points.point_id)) if points is None else np.asarray(points, np.intp)
    rays = _usable_rays(tie_points, orientations, wanted)
    first = np.searchsorted(rays.point, wanted, side="left")
    last = np.searchsorted(rays.point, wanted, side="right")
    vectors = image_vectors(rays, orientations, cameras)
    rotation, centre = orientations.ground_from_image, orientations.position_m
    ground, code = intersect_rays(vectors, rays.image, first, last, rotation, centre)
    good = np.flatnonzero(code == INTERSECTED)
    chosen, offsets = _ranges(first[good], last[good])
    cofactors, from_orientations, rms_px = _precision(
        ground[good], offsets, rays.image[chosen], vectors[chosen], orientations
    )
    from_image = sigma_image_px**2 * cofactors
    from_both = from_image + from_orientations
    return IntersectedPoints(
        point=wanted,
        position_m=ground,
        covariance_m2=_scattered(from_image, good, len(wanted)),
        covariance_with_orientation_m2=_scattered(from_both, good, len(wanted)),
        n_rays=last - first,
        rms_px=_scattered(rms_px, good, len(wanted)),
        status=_STATUS[code],
    )


def _usable_rays(tie_points: TiePoints, orientations: Orientations, wanted: Ints) -> TiePoints:
    """Rays of the wanted points in images that have an orientation, sorted by point, image."""
    elements = np.hstack([orientations.position_m, orientations.angles_rad])
    oriented: Bools = np.all(np.isfinite(elements), axis=1)
    is_wanted = np.zeros(len(tie_points.point_id), dtype=bool)
    is_wanted[wanted[wanted >= 0]] = True
    usable = tie_points.subset(oriented[tie_points.image] & is_wanted[tie_points.point])
    order = np.lexsort((usable.image, usable.point))
    return replace(
        usable, point=usable.point[order], image=usable.image[order], xy_px=usable.xy_px[order]
    )


def _ranges(first: Ints, last: Ints) -> tuple[Ints, Ints]:
    """Concatenation of the ranges first[i] ... last[i] - 1, and the offsets (k + 1,) in it."""
    counts = last - first
    offsets = np.concatenate([[0], np.cumsum(counts)]).astype(np.intp)
    return np.arange(offsets[-1]) + np.repeat(first - offsets[:-1], counts), offsets


def _precision(
    ground: Floats, offsets: Ints, image: Ints, vectors: Floats, orientations: Orientations
) -> tuple[Floats, Floats, Floats]:
    """Of k points: cofactors m2/px2, covariance from the orientations m2, RMS of residuals px."""
    counts = np.diff(offsets)
    point = np.repeat(np.arange(len(ground)), counts)
    distance = np.empty(len(orientations))
    distance[image] = -vectors[:, 2]
    xy, by_angles, by_ground = project_derivatives(
        ground,
        point,
        image,
        orientations.ground_from_image,
        rotation_derivatives(orientations.angles_rad, orientations.system),
        orientations.position_m,
        distance,
    )
    cofactors, from_orientations = intersection_precision(
        by_angles,
        by_ground,
        offsets,
        image,
        orientations.sigma_angles_rad,
        orientations.sigma_position_m,
    )
    squares = np.sum((vectors[:, :2] - xy) ** 2, axis=1)
    rms_px = np.sqrt(np.bincount(point, squares, minlength=len(ground)) / (2 * counts))
    return cofactors, from_orientations, rms_px


def _scattered(values: Floats, rows: Ints, n: int) -> Floats:
    """`values` in the given rows of an array of n rows, NaN elsewhere."""
    out = np.full((n, *values.shape[1:]), np.nan)
    out[rows] = values
    return out
