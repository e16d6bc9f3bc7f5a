"""Why a bundle adjustment does not determine an unknown, and what would, in words."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from posstats.adjustment.significance import ParameterTest
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
_SHOWN = 6
_WEIGHT = "a prior standard deviation (weighted observation)"


@dataclass(frozen=True)
class Defect:
    """Unknowns that are open for one reason.

    Attributes
    ----------
    parameters, images
        Indices of additional parameters; of images, where these alone are open.
    subject
        Which, as the beginning of a sentence.
    reason, remedy
        Why, and what would help: half sentences.
    """

    parameters: tuple[int, ...]
    images: tuple[int, ...]
    subject: str
    reason: str
    remedy: str

    @property
    def sentence(self) -> str:
        """Which, why, and what would help."""
        return f"{self.subject}: {self.reason}. What helps: {self.remedy}."


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
    def control(self) -> str:
        """How much control there is."""
        n = len(self.problem.control.point)
        return {0: "no control", 1: "one control point"}.get(n, f"{n} control points")

    def observed(self, columns: slice, scope: str = BLOCK) -> bool:
        """Whether POS observes any of these columns in a scope."""
        inside = self.problem.exposures.within(scope)
        return bool((self.problem.pos.weight[inside, columns] > 0.0).any())


_Rule = Callable[[_Situation], tuple[tuple[int, ...], str, str]]


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
        return _of_parameters(problem, error.common, "not determined")
    return (_of_images(problem, image_id, error.images),)


def weak_parameters(problem: BundleProblem, tests: Sequence[ParameterTest]) -> tuple[Defect, ...]:
    """The same for parameters that an adjustment determines in name only.

    Parameters with a prior are left out: they are what the prior says.
    """
    pairs = enumerate(zip(problem.parameters, tests, strict=True))
    weak = [at for at, (p, test) in pairs if p.sigma is None and not test.determined]
    return _of_parameters(problem, weak, "hardly determined")


def _of_parameters(
    problem: BundleProblem, common: Iterable[int], verdict: str
) -> tuple[Defect, ...]:
    left = {at: problem.parameters[at] for at in common}
    found = []
    for rule in _RULES:
        concerned, reason, remedy = rule(_Situation(problem, left))
        if concerned:
            names = _listed([_called(left[at]) for at in concerned])
            verb = "is" if len(concerned) == 1 else "are"
            found.append(Defect(concerned, (), f"{names} {verb} {verdict}", reason, remedy))
            left = {at: each for at, each in left.items() if at not in concerned}
    return tuple(found)


def _called(parameter: CommonParameter) -> str:
    return parameter.name if parameter.scope == BLOCK else f"{parameter.name} of {parameter.scope}"


def _listed(names: Sequence[str]) -> str:
    shown = list(names[:_SHOWN])
    if len(names) > _SHOWN:
        shown.append(f"{len(names) - _SHOWN} more")
    return " and ".join([", ".join(shown[:-1]), shown[-1]] if len(shown) > 1 else shown)


def _unobserved(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    gnss, imu = slice(0, 3), slice(3, 6)
    concerned = [
        at for at in s.named((*_GNSS, *LEVER_ARM)) if not s.observed(gnss, s.parameters[at].scope)
    ]
    concerned += [
        at for at in s.named((*_IMU, *BORESIGHT)) if not s.observed(imu, s.parameters[at].scope)
    ]
    return (
        tuple(sorted(concerned)),
        "POS observes nothing there that contains them",
        "leave them out, or give the POS observations a standard deviation",
    )


def _unseen(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    problem = s.problem
    camera = problem.exposures.camera[problem.image[np.isfinite(problem.sigma_px)]]
    used = {problem.exposures.camera_id[int(c)] for c in np.unique(camera)} | {BLOCK}
    names = (*_RADIAL, *_POINT, *_AFFINE)
    return (
        tuple(at for at in s.named(names) if s.parameters[at].scope not in used),
        "no ray is measured in an image of this camera",
        "measure tie points there, or leave them out",
    )


def _twice(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    strips = {p.name for p in s.parameters.values() if s.of_strip(p)}
    both = strips & {p.name for p in s.parameters.values() if p.scope == BLOCK}
    return (
        s.named(both),
        "they are unknown for the block and for its strips, whose sum alone counts",
        "take one of the two",
    )


def _attitude_twice(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    shifts, boresight = s.named(IMU_SHIFTS), s.named(BORESIGHT)
    return (
        shifts + boresight if shifts and boresight else (),
        "IMU shifts and boresight turn the observed angles alike: kappa and yaw always, the others"
        " in strips of one heading",
        "take one of the two for the yaw, fly strips of opposite headings, or take the boresight"
        " from a calibration",
    )


def _position_twice(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    shifts, arm = s.named(GNSS_SHIFTS), s.named(LEVER_ARM)
    return (
        shifts + arm if shifts and arm else (),
        "GNSS shifts and lever arm move the observed antenna positions alike: in height always, as"
        " the aircraft does not turn over, horizontally in strips of one heading",
        "measure the lever arm on the aircraft, fly strips of opposite headings, or leave out the"
        " shift in height",
    )


def _point_and_boresight(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    point, other = s.named(_POINT), s.named((*BORESIGHT, *IMU_SHIFTS, *LEVER_ARM, *GNSS_SHIFTS))
    return (
        point + other if point and other else (),
        "a shift of the principal point looks like a small rotation or a shift of the camera"
        " wherever heights and headings are alike",
        "strips of opposite headings, height differences, or a calibrated camera",
    )


def _scale_and_height(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    radial, height = s.named(("camera_c",)), s.named(("gnss_z_shift", "lever_arm_w"))
    return (
        radial + height if radial and height else (),
        "over flat ground the principal distance changes the flying height as a shift of the"
        " antenna heights does",
        "two flying heights, or the principal distance of a calibration",
    )


def _radial(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    radial = s.named(_RADIAL)
    return (
        radial if len(radial) > 1 else (),
        "their effects on the image are combinations of each other: bauer_s1 is brown_k1 with a"
        " change of the principal distance, and powers of a radius that reaches only a part of the"
        " principal distance differ little",
        "take one set, Bauer's or Brown's, and its first terms",
    )


def _distance(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    return (
        s.named(("camera_c",)),
        f"with {s.control} and without large height differences, the principal distance and the"
        " flying height have the same effect, and only observed antenna heights separate them",
        "control points of different heights together with GNSS, oblique images, or the principal"
        " distance of a calibration",
    )


def _gnss_of_strips(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    return (
        tuple(at for at in s.named(_GNSS) if s.of_strip(s.parameters[at])),
        f"with {s.control}, tie points alone hold the strips together: they may shift, stretch and"
        " bend as the antenna positions of every strip are free to",
        "control points at both ends of the strips, cross strips with their own control, or"
        f" {_WEIGHT}",
    )


def _gnss_of_block(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    return (
        s.named(_GNSS),
        f"with {s.control}, the block moves along with its antenna positions",
        f"one full control point for shifts, four in the corners for drifts, or {_WEIGHT}",
    )


def _imu(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    return (
        s.named(_IMU),
        f"with {s.control}, the images can turn together: about the line of flight where a strip"
        " has no neighbour, about all axes where antenna positions are free or not observed",
        f"side overlap with another strip, GNSS, control beside the line of flight, or {_WEIGHT}",
    )


def _lever_arm(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    return (
        s.named(LEVER_ARM),
        f"with {s.control}, only rotations of the aircraft tell the lever arm from a shift of the"
        " block, and nadir images of one heading have none",
        "full control points, strips of opposite headings, or the lever arm measured on the"
        " aircraft",
    )


def _boresight(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    return (
        s.named(BORESIGHT),
        f"with {s.control}, the images can turn together: nothing but the IMU gives their attitude"
        " about the line of flight",
        "side overlap, strips of opposite headings, GNSS, or control beside the line of flight",
    )


def _principal_point(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    return (
        s.named(_POINT),
        f"with {s.control}, all images shift alike, and positions or attitudes that are not"
        " observed follow",
        "strips of opposite headings with observed positions and angles, or a calibrated camera",
    )


def _deformation(s: _Situation) -> tuple[tuple[int, ...], str, str]:
    return (
        s.named((*_RADIAL, *_AFFINE)),
        f"with {s.control}, tie points do not cover the images well enough to show this"
        " deformation, or the block deforms with it",
        "tie points out to the corners of the images, strips across, more control, or a"
        " calibrated camera",
    )


_RULES: tuple[_Rule, ...] = (
    _unobserved, _unseen, _twice, _attitude_twice, _point_and_boresight, _scale_and_height,
    _position_twice, _radial, _distance, _gnss_of_strips, _gnss_of_block, _imu, _lever_arm,
    _boresight, _principal_point, _deformation,
)  # fmt: skip
"""In this order: each takes what it explains, the next see the rest."""


def _of_images(problem: BundleProblem, image_id: Sequence[str], images: tuple[int, ...]) -> Defect:
    if len(images) == len(problem.position_m):
        reason, remedy = _datum(problem)
        subject = "The orientations of all images are"
    else:
        reason, remedy = _single_images(problem, images)
        verb = "orientation of {} is" if len(images) == 1 else "orientations of {} are"
        subject = f"The {verb}".format(_listed([image_id[i] for i in images]))
    return Defect((), images, f"{subject} not determined", reason, remedy)


def _single_images(problem: BundleProblem, images: tuple[int, ...]) -> tuple[str, str]:
    rays = np.bincount(
        problem.image[np.isfinite(problem.sigma_px)], minlength=len(problem.position_m)
    )
    return (
        f"their rays to points of other images and to control ({int(rays[list(images)].min())} in"
        " the poorest of them) and what POS observes of them do not suffice",
        "measure tie points across to the other images, give their POS observations weight, or"
        " leave them out",
    )


def _useful_pos(problem: BundleProblem) -> tuple[bool, bool]:
    """Whether POS positions and angles are more accurate than the block is large, and a radian."""
    size_m = np.linalg.norm(np.ptp(problem.position_m, axis=0))
    pos = problem.pos
    return bool((pos.sigma_antenna_m < size_m).any()), bool((pos.sigma_angles_rad < 1.0).any())


def _datum(problem: BundleProblem) -> tuple[str, str]:
    situation = _Situation(problem, {})
    positions, angles = _useful_pos(problem)
    if positions:
        return (
            f"with {situation.control}, the block can turn about the line on which the observed"
            " antenna positions lie",
            "a second strip, a control point beside the line, or IMU angles",
        )
    if angles:
        return (
            f"angles alone, with {situation.control}, define neither position nor scale",
            "two full control points, or GNSS positions",
        )
    return (
        f"with {situation.control} and no POS observation of weight, the datum (position, rotation"
        " and scale of the block) is not defined",
        "GNSS positions of several strips, or three full control points not on a line",
    )
