"""What is odd about a block, but no reason to refuse it: sentences for the report."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from posstats.arrays import Floats
from posstats.block.image_pairs import MIN_MODEL_POINTS, StereoModels, stereo_models
from posstats.block.model import Block
from posstats.formats.block_toml import BlockSettings

_SHOWN = 5


def block_warnings(block: Block) -> list[str]:
    """Sentences, with counts and the first few ids, on images, strips, models and points."""
    models = stereo_models(block)
    return [
        *_point_warnings(block),
        *_strip_warnings(block),
        *_model_warnings(models),
        *_base_warnings(models),
        *_adjusted_warnings(block),
    ]


def settings_warnings(settings: BlockSettings) -> list[str]:
    """Sentences on what block.toml leaves open."""
    warnings = []
    if settings.orthometric and settings.geoid is None:
        warnings.append(
            "Heights are orthometric and no geoid grid is given: they are taken as ellipsoidal."
        )
    if settings.geoid is not None and not settings.tangent:
        warnings.append('The geoid grid is not used: frame = "grid" takes heights as they are.')
    if settings.assumed_accuracy:
        accuracy = settings.accuracy
        values = {
            "position_m": f"position_m = {accuracy.position_m:g}",
            "angle_deg": f"angle_deg = {np.degrees(accuracy.angle_rad):g}",
            "image_px": f"image_px = {accuracy.image_px:g}",
        }
        assumed = ", ".join(values[key] for key in settings.assumed_accuracy)
        warnings.append(f"The accuracy is not stated in full; assumed: {assumed}.")
    return warnings


def time_warnings(time_in_file_order_s: Floats, images: Sequence[str]) -> list[str]:
    """A sentence on rows that are earlier than the row before; images in file order."""
    back = np.flatnonzero(np.diff(time_in_file_order_s) < 0.0) + 1
    if len(back) == 0:
        return []
    which = [images[int(row)] for row in back]
    return [f"{_count(which, 'row')} of orientations out of time order: {_listed(which)}."]


def _point_warnings(block: Block) -> list[str]:
    ties = block.tie_points
    rays = np.bincount(ties.point, minlength=len(ties.point_id))
    surveyed = set() if block.ground_points is None else set(block.ground_points.point)
    once = [str(point) for point in ties.point_id[rays == 1] if point not in surveyed]
    warnings = []
    if once:
        warnings.append(f"{_count(once, 'tie point')} seen in one image only: {_listed(once)}.")
    if block.ground_points is not None:
        n_rays = dict(zip(ties.point_id, rays, strict=True))
        weak = [str(point) for point in block.ground_points.point if n_rays.get(point, 0) < 2]
        if weak:
            warnings.append(
                f"{_count(weak, 'ground point')} measured in fewer than two images:"
                f" {_listed(weak)}."
            )
    seen = np.bincount(ties.image, minlength=len(block.orientations))
    unseen = [str(image) for image in block.orientations.image[seen == 0]]
    if unseen:
        warnings.append(f"{_count(unseen, 'image')} without tie points: {_listed(unseen)}.")
    return warnings


def _strip_warnings(block: Block) -> list[str]:
    strips, counts = np.unique(block.orientations.strip.astype(str), return_counts=True)
    single = [str(strip) for strip in strips[counts == 1]]
    if not single:
        return []
    return [f"{_count(single, 'strip')} of one image: {_listed(single)}."]


def _model_warnings(models: StereoModels) -> list[str]:
    """Models of fewer than six common points, those of none among them."""
    orientations = models.orientations
    enough = models.pairs.n_points >= MIN_MODEL_POINTS
    formed = set(zip(models.pairs.left[enough], models.pairs.right[enough], strict=True))
    few = []
    for strip in orientations.strips:
        images = np.flatnonzero(orientations.strip == strip)
        few += [
            f"{orientations.image[left]} - {orientations.image[right]}"
            for left, right in pairwise(images)
            if (left, right) not in formed
        ]
    if not few:
        return []
    return [
        f"{_count(few, 'stereo model')} with fewer than {MIN_MODEL_POINTS} common points,"
        f" left out of the statistics: {_listed(few)}."
    ]


def _base_warnings(models: StereoModels) -> list[str]:
    """Models whose base the positions do not determine, as of a camera that hovers."""
    orientations = models.orientations
    left, right = models.pairs.left, models.pairs.right
    sigma = np.hypot(orientations.sigma_position_m[left], orientations.sigma_position_m[right])
    base_m = np.linalg.norm(models.base_m, axis=1)
    short = [
        f"{orientations.image[left[model]]} - {orientations.image[right[model]]}"
        for model in np.flatnonzero(base_m < sigma.max(axis=1, initial=0.0))
    ]
    if not short:
        return []
    return [
        f"{_count(short, 'stereo model')} with a base shorter than the accuracy of their"
        f" positions: {_listed(short)}."
    ]


def _adjusted_warnings(block: Block) -> list[str]:
    if block.adjusted is None:
        return []
    missing = np.isnan(block.adjusted.position_m).any(axis=1)
    images = [str(image) for image in block.orientations.image[missing]]
    if not images:
        return []
    return [f"{_count(images, 'image')} without adjusted orientation: {_listed(images)}."]


def _count(items: Sequence[str], noun: str) -> str:
    return f"{len(items)} {noun}{'' if len(items) == 1 else 's'}"


def _listed(items: Sequence[str]) -> str:
    hidden = len(items) - _SHOWN
    return ", ".join(items[:_SHOWN]) + (f" and {hidden} more" if hidden > 0 else "")
