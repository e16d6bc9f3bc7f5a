"""What the measurements of a block leave open: common rotations and single images."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from posstats.arrays import Bools, Floats, Ids

UNDETERMINED_SHARE = 0.1  # of the prior standard deviation
ROTATIONS = ("about_base_axis", "about_axis_across", "about_vertical")


@dataclass(frozen=True)
class Observability:
    """What a scope of the block (``block`` or a strip's id) does not determine.

    Attributes
    ----------
    rotations
        Common rotations that the measurements leave open, of `ROTATIONS`.
    images
        Ids of the images whose angles are not determined.
    """

    scope: str
    rotations: tuple[str, ...]
    images: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class EstimatedAngles:
    """Uncertainty of the angles of n images, seen as rotations about the ground axes.

    Attributes
    ----------
    image, strip
        (n,) ids.
    position_m
        (n, 3).
    rotation_covariance_rad2
        (n, 3, n, 3) of small rotations about the ground axes.
    prior_sigma_rad
        (n,) prior standard deviation of an angle.
    determined
        (n,) whether an image's angles are determined.
    tied
        (n,) whether an image takes part at all.
    """

    image: Ids
    strip: Ids
    position_m: Floats
    rotation_covariance_rad2: Floats
    prior_sigma_rad: Floats
    determined: Bools
    tied: Bools


def observability(angles: EstimatedAngles) -> tuple[Observability, ...]:
    """What the block as a whole, then every strip in order of flight, leaves undetermined.

    A common rotation of a scope is the mean of the rotations of its images, each weighted by the
    inverse of its own covariance, so that a single loose image does not spoil it. It is open
    where its standard deviation, from the covariance of the adjustment, exceeds a tenth of the
    prior one.
    """
    everywhere = np.ones(len(angles.image), dtype=bool)
    scopes = [("block", everywhere)]
    scopes += [(strip, angles.strip == strip) for strip in dict.fromkeys(angles.strip)]
    return tuple(
        Observability(
            scope=scope,
            rotations=tuple(_open_rotations(angles, inside & angles.tied)),
            images=tuple(angles.image[inside & ~angles.determined]),
        )
        for scope, inside in scopes
    )


def _open_rotations(angles: EstimatedAngles, inside: Bools) -> Iterator[str]:
    images = np.flatnonzero(inside)
    if len(images) < 2:
        return
    covariance = _mean_covariance(angles.rotation_covariance_rad2[images][:, :, images])
    limit = UNDETERMINED_SHARE * float(angles.prior_sigma_rad[images].min())
    along = _flight_axis(angles.position_m[images], angles.strip[images])
    for variance, axis in zip(*_principal_axes(covariance), strict=True):
        if variance > limit**2:
            yield _axis_name(axis, along)


def _mean_covariance(covariance: Floats) -> Floats:
    """Covariance (3, 3) of the weighted mean of n vectors whose covariance is (n, 3, n, 3).

    The weights are the inverse covariances of the single vectors. The best linear mean would
    not do: correlated vectors get negative weights, and a rotation that the images share but
    for a small part would pass as determined.
    """
    weight = np.linalg.inv(np.einsum("iaib->iab", covariance))
    scatter = np.einsum("iab,ibjc,jcd->ad", weight, covariance, weight, optimize=True)
    inverse = np.linalg.inv(weight.sum(axis=0))
    mean: Floats = inverse @ scatter @ inverse
    return mean


def _principal_axes(covariance: Floats) -> tuple[Floats, Floats]:
    """Variances (3,) and unit vectors (3, 3), row by row."""
    variances, axes = np.linalg.eigh(0.5 * (covariance + covariance.T))
    return variances, axes.T


def _flight_axis(position_m: Floats, strip: Ids) -> Floats:
    """Unit vector (3,) closest to the bases between consecutive images of a strip.

    Where no strip has two images, to the way from image to image.
    """
    base = np.diff(position_m, axis=0)
    same = strip[1:] == strip[:-1]
    _, _, axes = np.linalg.svd(base[same] if same.any() else base, full_matrices=False)
    axis: Floats = axes[0]
    return axis


def _axis_name(axis: Floats, along: Floats) -> str:
    """Name a rotation by the nearest of base axis, horizontal axis across it and vertical."""
    across = np.cross([0.0, 0.0, 1.0], along)
    nearness = [abs(axis @ along), abs(axis @ across), abs(axis[2])]
    return ROTATIONS[int(np.argmax(nearness))]
