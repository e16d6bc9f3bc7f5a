"""What is odd about a block, but no reason to refuse it."""

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from posstats.arrays import Floats
from posstats.block.image_pairs import MIN_MODEL_POINTS, StereoModels, stereo_models
from posstats.block.model import Block
from posstats.contract.notice import Notice, listing
from posstats.formats.block_toml import BlockSettings


def block_notices(block: Block) -> tuple[Notice, ...]:
    """Notices, with counts and the first few ids, on images, strips, models and points."""
    models = stereo_models(block)
    return (
        *_of_points(block),
        *_of_strips(block),
        *_of_models(models),
        *_of_bases(models),
        *_of_adjusted(block),
    )


def settings_notices(settings: BlockSettings) -> tuple[Notice, ...]:
    """Notices on what block.toml leaves open."""
    notices = []
    if settings.orthometric and settings.geoid is None:
        notices.append(Notice(code="heights_without_geoid"))
    if settings.geoid is not None and not settings.tangent:
        notices.append(Notice(code="geoid_not_used"))
    if settings.assumed_accuracy:
        accuracy = settings.accuracy
        stated = {
            "position_m": accuracy.position_m,
            "angle_deg": np.degrees(accuracy.angle_rad),
            "image_px": accuracy.image_px,
        }
        lines = tuple(f"{key} = {stated[key]:g}" for key in settings.assumed_accuracy)
        notices.append(Notice(code="accuracy_assumed", values={"lines": lines}))
    return tuple(notices)


def time_notices(time_in_file_order_s: Floats, images: Sequence[str]) -> tuple[Notice, ...]:
    """A notice on rows that are earlier than the row before; images in file order."""
    back = np.flatnonzero(np.diff(time_in_file_order_s) < 0.0) + 1
    return listing("rows_out_of_order", [images[int(row)] for row in back])


def _of_points(block: Block) -> tuple[Notice, ...]:
    ties = block.tie_points
    rays = np.bincount(ties.point, minlength=len(ties.point_id))
    surveyed = {} if block.ground_points is None else dict.fromkeys(block.ground_points.point)
    n_rays = dict(zip(ties.point_id, rays, strict=True))
    once = [point for point in ties.point_id[rays == 1] if point not in surveyed]
    few = [point for point in surveyed if n_rays.get(point, 0) < 2]
    seen = np.bincount(ties.image, minlength=len(block.orientations))
    return (
        *listing("tie_points_seen_once", once),
        *listing("ground_points_with_few_rays", few),
        *listing("images_without_tie_points", block.orientations.image[seen == 0]),
    )


def _of_strips(block: Block) -> tuple[Notice, ...]:
    strips, counts = np.unique(block.orientations.strip.astype(str), return_counts=True)
    return listing("strips_of_one_image", strips[counts == 1])


def _of_models(models: StereoModels) -> tuple[Notice, ...]:
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
    return listing("models_with_few_points", few, n_needed=MIN_MODEL_POINTS)


def _of_bases(models: StereoModels) -> tuple[Notice, ...]:
    """Models whose base the positions do not determine, as of a camera that hovers."""
    orientations = models.orientations
    left, right = models.pairs.left, models.pairs.right
    sigma = np.hypot(orientations.sigma_position_m[left], orientations.sigma_position_m[right])
    base_m = np.linalg.norm(models.base_m, axis=1)
    short = [
        f"{orientations.image[left[model]]} - {orientations.image[right[model]]}"
        for model in np.flatnonzero(base_m < sigma.max(axis=1, initial=0.0))
    ]
    return listing("models_with_short_base", short)


def _of_adjusted(block: Block) -> tuple[Notice, ...]:
    if block.adjusted is None:
        return ()
    missing = np.isnan(block.adjusted.position_m).any(axis=1)
    return listing("images_without_adjusted", block.orientations.image[missing])
