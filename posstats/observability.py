"""What the measurements of a block leave open: common rotations and single images."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Bools = NDArray[np.bool_]
_Ids = NDArray[np.object_]

UNDETERMINED_SHARE = 0.1  # of the prior standard deviation


@dataclass(frozen=True)
class Observability:
    """What a scope of the block (``block`` or a strip's id) does not determine.

    Attributes
    ----------
    unobservable
        Common rotations that the measurements leave open, in words.
    images
        Ids of the images whose angles are not determined.
    """

    scope: str
    unobservable: tuple[str, ...]
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

    image: _Ids
    strip: _Ids
    position_m: _Floats
    rotation_covariance_rad2: _Floats
    prior_sigma_rad: _Floats
    determined: _Bools
    tied: _Bools


def observability(angles: EstimatedAngles) -> tuple[Observability, ...]:
    """What the block as a whole, then every strip in order of flight, leaves undetermined.

    A common rotation of a scope is the best weighted mean of the rotations of its images (single
    undetermined images do not spoil it); it is open where its standard deviation, from the
    covariance of the adjustment, exceeds a tenth of the prior one.
    """
    everywhere = np.ones(len(angles.image), dtype=bool)
    scopes = [("block", everywhere)]
    scopes += [(strip, angles.strip == strip) for strip in dict.fromkeys(angles.strip)]
    return tuple(
        Observability(
            scope=scope,
            unobservable=tuple(_open_rotations(angles, inside & angles.tied)),
            images=tuple(angles.image[inside & ~angles.determined]),
        )
        for scope, inside in scopes
    )


def _open_rotations(angles: EstimatedAngles, inside: _Bools) -> Iterator[str]:
    images = np.flatnonzero(inside)
    if len(images) == 0:
        return
    covariance = angles.rotation_covariance_rad2[images][:, :, images]
    each = np.tile(np.eye(3), (len(images), 1))
    information = each.T @ np.linalg.solve(covariance.reshape(len(each), len(each)), each)
    variances, axes = np.linalg.eigh(np.linalg.inv(information))
    limit = UNDETERMINED_SHARE * float(angles.prior_sigma_rad[images].min())
    along = _flight_axis(angles.position_m[images])
    for variance, axis in zip(variances, axes.T, strict=True):
        if variance > limit**2:
            yield _axis_name(axis, along)


def _flight_axis(position_m: _Floats) -> _Floats:
    """Unit vector (3,) along which the projection centres spread most."""
    _, _, axes = np.linalg.svd(position_m - position_m.mean(axis=0), full_matrices=False)
    axis: _Floats = axes[0]
    return axis


def _axis_name(axis: _Floats, along: _Floats) -> str:
    """Name a rotation by the nearest of base axis, across axis and vertical."""
    across = np.cross([0.0, 0.0, 1.0], along)
    names = {
        "rotation about the base axis": abs(axis @ along),
        "rotation about the horizontal axis across the base": abs(axis @ across),
        "rotation about the vertical": abs(axis[2]),
    }
    return max(names, key=lambda name: names[name])
