"""Why a bundle adjustment does not determine an unknown, and what would: as codes and values."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from posstats.adjustment.significance import ParameterTest
from posstats.contract.notice import Notice
from posstats.errors import UndeterminedError
from posstats.numerics.bundle.parameters import (
    BLOCK,
    BORESIGHT,
    GNSS_DRIFTS,
    GNSS_SHIFTS,
    IMU_DRIFTS,
    IMU_SHIFTS,
    LEVER_ARM,
    CommonParameter,
)
from posstats.numerics.bundle.problem import BundleProblem

_GNSS, _IMU = (*GNSS_SHIFTS, *GNSS_DRIFTS), (*IMU_SHIFTS, *IMU_DRIFTS)
_RADIAL = ("camera_c", "bauer_s1", "brown_k1", "brown_k2", "brown_k3")
_POINT = ("camera_x0", "camera_y0", "brown_p1", "brown_p2")
_AFFINE = ("bauer_s2", "bauer_s3")


@dataclass(frozen=True)
class Defect:
    """Unknowns that are open for one reason.

    Attributes
    ----------
    parameters
        Additional parameters that are open.
    images
        Ids of the open images where these alone are open; without parameters and images, the
        orientations of all images are open.
    reason, remedy
        Why, and what would help.
    """

    parameters: tuple[CommonParameter, ...]
    images: tuple[str, ...]
    reason: Notice
    remedy: Notice


@dataclass(frozen=True)
class _Situation:
    """What the reasons depend on."""

    problem: BundleProblem
    parameters: dict[int, CommonParameter]

    def named(self, names: Iterable[str]) -> tuple[int, ...]:
        """Open parameters of these names."""
        inside = set(names)
        return tuple(at for at, each in self.parameters.items() if each.name in inside)

    def of_strip(self, parameter: CommonParameter) -> bool:
        """Whether a shift or drift is that of a strip."""
        return parameter.scope != BLOCK and parameter.name in (*_GNSS, *_IMU)

    @property
    def n_control(self) -> int:
        """How many control points there are."""
        return len(self.problem.control.point)

    def observed(self, columns: slice, scope: str = BLOCK) -> bool:
        """Whether POS observes any of these columns in a scope."""
        inside = self.problem.exposures.within(scope)
        return bool((self.problem.pos.weight[inside, columns] > 0.0).any())


_Rule = Callable[[_Situation], tuple[int, ...]]


def defects(
    problem: BundleProblem, image_id: Sequence[str], error: UndeterminedError
) -> tuple[Defect, ...]:
    """What an `UndeterminedError` means.

    Images that are open together with additional parameters are their consequence, and are not
    explained on their own.

    Parameters
    ----------
    problem
        Of the adjustment that failed.
    image_id
        (n,) ids.
    error
        As raised.
    """
    if error.common:
        return _of_parameters(problem, error.common)
    return (_of_images(problem, image_id, error.images),)


def weak_parameters(problem: BundleProblem, tests: Sequence[ParameterTest]) -> tuple[Defect, ...]:
    """The same for parameters that an adjustment determines in name only.

    Parameters with a prior are left out: they are what the prior says.
    """
    pairs = enumerate(zip(problem.parameters, tests, strict=True))
    weak = [at for at, (p, test) in pairs if p.sigma is None and not test.determined]
    return _of_parameters(problem, weak)


def _of_parameters(problem: BundleProblem, common: Iterable[int]) -> tuple[Defect, ...]:
    left = {at: problem.parameters[at] for at in common}
    found = []
    for code, rule in RULES.items():
        situation = _Situation(problem, left)
        concerned = rule(situation)
        if concerned:
            named = tuple(left[at] for at in concerned)
            found.append(_defect(code, situation, parameters=named))
            left = {at: each for at, each in left.items() if at not in concerned}
    return tuple(found)


def _defect(
    code: str,
    situation: _Situation,
    *,
    parameters: tuple[CommonParameter, ...] = (),
    images: tuple[str, ...] = (),
    n_rays: int | None = None,
) -> Defect:
    """A defect; its reason counts the control points, or the rays of open images."""
    counted = {"n_control": situation.n_control} if n_rays is None else {"n_rays": n_rays}
    reason = Notice(code=f"open_{code}", values=counted)
    return Defect(parameters, images, reason, Notice(code=f"helps_{code}"))


def _unobserved(s: _Situation) -> tuple[int, ...]:
    """POS observes nothing there that contains them."""
    gnss, imu = slice(0, 3), slice(3, 6)
    concerned = [
        at for at in s.named((*_GNSS, *LEVER_ARM)) if not s.observed(gnss, s.parameters[at].scope)
    ]
    concerned += [
        at for at in s.named((*_IMU, *BORESIGHT)) if not s.observed(imu, s.parameters[at].scope)
    ]
    return tuple(sorted(concerned))


def _unseen(s: _Situation) -> tuple[int, ...]:
    """No ray is measured in an image of their camera."""
    problem = s.problem
    camera = problem.exposures.camera[problem.image[np.isfinite(problem.sigma_px)]]
    used = {problem.exposures.camera_id[int(c)] for c in np.unique(camera)} | {BLOCK}
    names = (*_RADIAL, *_POINT, *_AFFINE)
    return tuple(at for at in s.named(names) if s.parameters[at].scope not in used)


def _twice(s: _Situation) -> tuple[int, ...]:
    """They are unknown for the block and for its strips."""
    strips = {p.name for p in s.parameters.values() if s.of_strip(p)}
    both = strips & {p.name for p in s.parameters.values() if p.scope == BLOCK}
    return s.named(both)


def _attitude_twice(s: _Situation) -> tuple[int, ...]:
    """IMU shifts and boresight turn the observed angles alike."""
    shifts, boresight = s.named(IMU_SHIFTS), s.named(BORESIGHT)
    return shifts + boresight if shifts and boresight else ()


def _position_twice(s: _Situation) -> tuple[int, ...]:
    """GNSS shifts and lever arm move the observed antenna positions alike."""
    shifts, arm = s.named(GNSS_SHIFTS), s.named(LEVER_ARM)
    return shifts + arm if shifts and arm else ()


def _point_and_boresight(s: _Situation) -> tuple[int, ...]:
    """A shift of the principal point looks like a rotation or a shift of the camera."""
    point, other = s.named(_POINT), s.named((*BORESIGHT, *IMU_SHIFTS, *LEVER_ARM, *GNSS_SHIFTS))
    return point + other if point and other else ()


def _scale_and_height(s: _Situation) -> tuple[int, ...]:
    """The principal distance changes the flying height as a shift of antenna heights does."""
    radial, height = s.named(("camera_c",)), s.named(("gnss_z_shift", "lever_arm_w"))
    return radial + height if radial and height else ()


def _radial(s: _Situation) -> tuple[int, ...]:
    """Radial terms that are combinations of each other."""
    radial = s.named(_RADIAL)
    return radial if len(radial) > 1 else ()


def _gnss_of_strips(s: _Situation) -> tuple[int, ...]:
    """Tie points alone hold the strips together."""
    return tuple(at for at in s.named(_GNSS) if s.of_strip(s.parameters[at]))


def _of(*names: str) -> _Rule:
    """A rule for whatever is open of some names."""
    return lambda situation: situation.named(names)


RULES: dict[str, _Rule] = {
    "unobserved": _unobserved,
    "unseen": _unseen,
    "twice": _twice,
    "attitude_twice": _attitude_twice,
    "point_and_boresight": _point_and_boresight,
    "scale_and_height": _scale_and_height,
    "position_twice": _position_twice,
    "radial": _radial,
    "distance": _of("camera_c"),
    "gnss_of_strips": _gnss_of_strips,
    "gnss_of_block": _of(*_GNSS),
    "imu": _of(*_IMU),
    "lever_arm": _of(*LEVER_ARM),
    "boresight": _of(*BORESIGHT),
    "principal_point": _of(*_POINT),
    "deformation": _of(*_RADIAL, *_AFFINE),
}
"""In this order: each takes what it explains, the next see the rest."""


def _of_images(problem: BundleProblem, image_id: Sequence[str], images: tuple[int, ...]) -> Defect:
    situation = _Situation(problem, {})
    if len(images) == len(problem.position_m):
        return _defect(_datum(problem), situation)
    ids = tuple(str(image_id[i]) for i in images)
    n_rays = _fewest_rays(problem, images)
    return _defect("images", situation, images=ids, n_rays=n_rays)


def _fewest_rays(problem: BundleProblem, images: tuple[int, ...]) -> int:
    """Rays of the poorest of some images."""
    measured = problem.image[np.isfinite(problem.sigma_px)]
    rays = np.bincount(measured, minlength=len(problem.position_m))
    return int(rays[list(images)].min())


def _useful_pos(problem: BundleProblem) -> tuple[bool, bool]:
    """Whether POS positions and angles are more accurate than the block is large, and a radian."""
    size_m = np.linalg.norm(np.ptp(problem.position_m, axis=0))
    pos = problem.pos
    return bool((pos.sigma_antenna_m < size_m).any()), bool((pos.sigma_angles_rad < 1.0).any())


def _datum(problem: BundleProblem) -> str:
    """What the datum of the block lacks."""
    positions, angles = _useful_pos(problem)
    if positions:
        return "datum_line"
    return "datum_angles_alone" if angles else "datum"
