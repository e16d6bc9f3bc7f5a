"""What an adjustment does not determine, why, and what would: as codes and values."""

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from posstats.adjustment.defects import Defect, defects, weak_parameters
from posstats.adjustment.significance import LEAST_REDUNDANCY, ParameterTest
from posstats.arrays import Bools, Ids
from posstats.contract.adjustment import OpenKind, Undetermined
from posstats.contract.notice import Notice
from posstats.errors import PosstatsError, UndeterminedError
from posstats.numerics.bundle.parameters import (
    BLOCK,
    BORESIGHT,
    GNSS_DRIFTS,
    GNSS_SHIFTS,
    IMU_DRIFTS,
    IMU_SHIFTS,
    LEVER_ARM,
)
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem

FEW_IMAGES = 4  # below, a part of the block is named by its images, else by its strips


FAMILIES: dict[str, tuple[str, ...]] = {
    "gnss_shifts_by_prior": GNSS_SHIFTS,
    "gnss_drifts_by_prior": GNSS_DRIFTS,
    "yaw_or_kappa": ("boresight_yaw", "imu_kappa_shift"),
    "boresight_by_prior": BORESIGHT,
    "imu_shifts_by_prior": IMU_SHIFTS,
    "imu_drifts_by_prior": IMU_DRIFTS,
    "lever_arm_by_prior": LEVER_ARM,
}
OF_CAMERA = "camera_by_prior"


class UndeterminedBlockError(PosstatsError):
    """A block that its measurements do not determine.

    Parameters
    ----------
    defects
        What is open, why, and what would help.
    parts
        Parts of the block that no point ties to the rest.
    """

    def __init__(self, defects: Sequence[Defect], parts: Sequence[Undetermined]) -> None:
        self.defects = tuple(defects)
        self.parts = tuple(parts)
        reasons = [each.reason for each in defects] + [each.reason_notice for each in parts]
        codes = dict.fromkeys(each.code for each in reasons)
        super().__init__(f"the block is not determined: {', '.join(codes)}")


def family_of(name: str) -> str:
    """The reason for which a parameter of this name may be known from its prior alone."""
    return next((code for code, names in FAMILIES.items() if name in names), OF_CAMERA)


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
    groups: dict[tuple[str, str], list[str]] = {}
    for parameter, test in zip(problem.parameters, tests, strict=True):
        if parameter.sigma is not None and not test.determined:
            groups.setdefault((family_of(test.name), test.scope), []).append(test.name)
    for (family, scope), names in groups.items():
        yield _open("parameter", names, scope, *_explained(family))


def _weak_parameters(
    problem: BundleProblem, tests: Sequence[ParameterTest]
) -> Iterator[Undetermined]:
    """Free parameters that move no observation noticeably, those of one scope together."""
    for defect in weak_parameters(problem, tests):
        scopes: dict[str, list[str]] = {}
        for parameter in defect.parameters:
            scopes.setdefault(parameter.scope, []).append(parameter.name)
        for scope, names in scopes.items():
            yield _open("parameter", names, scope, defect.reason, defect.remedy)


def _open_images(result: AdjustedBundle, image_id: Ids) -> Iterator[Undetermined]:
    loose = (result.redundancy_pos[:, 3:] < LEAST_REDUNDANCY).any(axis=1)
    if loose.any():
        yield _open("image", map(str, image_id[loose]), BLOCK, *_explained("images_by_imu"))


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
        names = dict.fromkeys(str(name) for name in named)
        code = "part_of_images" if few else "part_of_strips"
        yield _open("connection", names, BLOCK, *_explained(code))


def _explained(code: str) -> tuple[Notice, Notice]:
    """Reason and remedy of a code."""
    return Notice(code=f"open_{code}"), Notice(code=f"helps_{code}")


def _open(
    kind: OpenKind, names: Iterable[str], scope: str, reason: Notice, remedy: Notice
) -> Undetermined:
    return Undetermined(
        kind=kind, names=tuple(names), scope=scope, reason_notice=reason, remedy_notice=remedy
    )


def singular_block(
    error: UndeterminedError, problem: BundleProblem, image_id: Ids
) -> UndeterminedBlockError:
    """What singular normal equations leave open, why, and what would determine it."""
    found = defects(problem, tuple(image_id), error)
    return UndeterminedBlockError(found, tuple(unconnected(problem, image_id)))
