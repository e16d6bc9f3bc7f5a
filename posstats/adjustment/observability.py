"""What an adjustment does not determine, why, and what would: in words."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from posstats.adjustment.defects import defects, weak_parameters
from posstats.adjustment.significance import LEAST_REDUNDANCY, ParameterTest
from posstats.arrays import Bools, Ids
from posstats.errors import UndeterminedError
from posstats.numerics.bundle.parameters import (
    BORESIGHT,
    GNSS_DRIFTS,
    GNSS_SHIFTS,
    IMU_DRIFTS,
    IMU_SHIFTS,
    LEVER_ARM,
)
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem

FEW_IMAGES = 4  # below, a part of the block is named by its images, else by its strips


@dataclass(frozen=True)
class Undetermined:
    """Something that the measurements leave open.

    Attributes
    ----------
    kind
        ``parameter``: known from its prior, or its relation to others, alone; ``image``;
        ``connection``.
    names, scope
        Names of the parameters, or ids of the images or strips; the parameters' scope.
    reason, remedy
        Why, and what would determine it: half sentences.
    """

    kind: str
    names: tuple[str, ...]
    scope: str
    reason: str
    remedy: str


_FAMILIES: tuple[tuple[tuple[str, ...], str, str], ...] = (
    (
        GNSS_SHIFTS,
        "shifting all antenna positions of the scope shifts its images and points as a whole",
        "full control points within the scope, or more of them",
    ),
    (
        GNSS_DRIFTS,
        "a drift of antenna positions stretches, shears or tilts the images and points as a whole",
        "full control points at the beginning and the end of the scope, and beside it",
    ),
    (
        ("boresight_yaw", "imu_kappa_shift"),
        "in images that look down, boresight yaw and a shift of kappa are the same rotation: their"
        " sum is determined, but not how it is shared",
        "nothing for the orientations; to part the two, strongly tilted images",
    ),
    (
        BORESIGHT,
        "on strips flown in one direction a boresight angle turns like a shift of the IMU angles",
        "strips flown in opposite or crossing directions",
    ),
    (
        IMU_SHIFTS,
        "on strips flown in one direction a shift of an IMU angle turns like a boresight angle,"
        " and within a single strip a roll tilts the points as a whole",
        "strips flown in opposite or crossing directions, with side overlap, or control points",
    ),
    (
        IMU_DRIFTS,
        "the images of the scope are too few, or too weakly tied, to show a drift of the angle",
        "side overlap, cross strips or control points",
    ),
    (
        LEVER_ARM,
        "a lever arm shifts all antenna positions like a shift of the GNSS",
        "strips flown in opposite or crossing directions, and control points",
    ),
)
_CAMERA = (
    "the tie points do not show this deformation of the image apart from the other parameters",
    "more tie points over the whole image format, cross strips, or control points",
)


def explanation(name: str) -> tuple[str, str]:
    """Why a parameter of this name may be open, and what would determine it."""
    for names, reason, remedy in _FAMILIES:
        if name in names:
            return reason, remedy
    return _CAMERA


def undetermined(
    problem: BundleProblem,
    result: AdjustedBundle,
    tests: Sequence[ParameterTest],
    image_id: Ids,
) -> tuple[Undetermined, ...]:
    """What the measurements of an adjusted block do not determine.

    A parameter: by its test. An image: where the redundancy of one of its IMU angles is below
    `LEAST_REDUNDANCY`, rays and neighbours say nothing about the angle. A connection: parts of
    the block without a common point.
    """
    return (
        *_known_from_priors(problem, tests),
        *_weak_parameters(problem, tests),
        *_open_images(result, image_id),
        *unconnected(problem, image_id, ~result.rejected),
    )


def _known_from_priors(
    problem: BundleProblem, tests: Sequence[ParameterTest]
) -> Iterator[Undetermined]:
    """Parameters of one kind, one scope after the other, together."""
    groups: dict[tuple[str, str, str], list[str]] = {}
    for parameter, test in zip(problem.parameters, tests, strict=True):
        if parameter.sigma is not None and not test.determined:
            groups.setdefault((*explanation(test.name), test.scope), []).append(test.name)
    for (reason, remedy, scope), names in groups.items():
        yield Undetermined("parameter", tuple(names), scope, reason, remedy)


def _weak_parameters(
    problem: BundleProblem, tests: Sequence[ParameterTest]
) -> Iterator[Undetermined]:
    """Free parameters that move no observation noticeably, those of one scope together."""
    for defect in weak_parameters(problem, tests):
        scopes: dict[str, list[str]] = {}
        for at in defect.parameters:
            scopes.setdefault(tests[at].scope, []).append(tests[at].name)
        for scope, names in scopes.items():
            yield Undetermined("parameter", tuple(names), scope, defect.reason, defect.remedy)


def _open_images(result: AdjustedBundle, image_id: Ids) -> Iterator[Undetermined]:
    loose = (result.redundancy_pos[:, 3:] < LEAST_REDUNDANCY).any(axis=1)
    if loose.any():
        yield Undetermined(
            "image",
            tuple(str(each) for each in image_id[loose]),
            "block",
            "an angle of these images is known from the IMU alone: nothing checks it",
            "tie points spread over these images, in two directions, and side overlap",
        )


def unconnected(
    problem: BundleProblem, image_id: Ids, used: Bools | None = None
) -> Iterator[Undetermined]:
    """Parts of the block that no point ties to the others, all but the largest."""
    n_images, n_points = len(problem.position_m), len(problem.ground_m)
    use = np.ones(len(problem.point), dtype=bool) if used is None else used
    size = n_images + n_points
    rows, columns = problem.image[use], n_images + problem.point[use]
    graph = coo_array((np.ones(len(rows)), (rows, columns)), shape=(size, size))
    _, part = connected_components(graph, directed=False)
    parts, count = np.unique(part[:n_images], return_counts=True)
    for each in np.delete(parts, np.argmax(count)):
        inside = np.flatnonzero(part[:n_images] == each)
        few = len(inside) < FEW_IMAGES
        named = image_id[inside] if few else problem.exposures.strip[inside]
        yield Undetermined(
            "connection",
            tuple(dict.fromkeys(str(name) for name in named)),
            "block",
            f"no point ties these {'images' if few else 'strips, or images of them,'} to the rest"
            " of the block: the POS and control points alone do",
            "overlap, with points measured across it",
        )


def singular_message(error: UndeterminedError, problem: BundleProblem, image_id: Ids) -> str:
    """What singular normal equations leave open, why, and what would determine it."""
    sentences = [each.sentence for each in defects(problem, tuple(image_id), error)]
    apart = unconnected(problem, image_id)
    sentences += [f"{', '.join(each.names)}: {each.reason}." for each in apart]
    return " ".join(sentences)
