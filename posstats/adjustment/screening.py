"""Rays that contradict other rays, whatever control and POS say."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from posstats.adjustment.axes import images_with_wrong_axes
from posstats.bundle import adjust
from posstats.bundle.problem import BundleProblem, Control

_Bools = NDArray[np.bool_]

_FAR = 5.0  # standard deviations: nearer ones are left to data snooping, which counts them all
_WEAK_POS = 100.0  # times the stated standard deviations


def contradicting_rays(
    problem: BundleProblem, progress: Callable[[int, int], object] | None = None
) -> _Bools:
    """(m,) rays that a robust adjustment rejects, far from all others.

    Control is left out and POS weak, so that a wrong control point or exposure does not turn
    good rays into bad ones. Images of wrong axes are left to data snooping, which names them.

    Raises
    ------
    ConvergenceError, GeometryError, UndeterminedError
        As `adjust`.
    """
    wrong = np.isin(problem.image, images_with_wrong_axes(problem))
    pos = problem.pos
    weak = replace(
        pos,
        sigma_antenna_m=_WEAK_POS * pos.sigma_antenna_m,
        sigma_angles_rad=_WEAK_POS * pos.sigma_angles_rad,
    )
    relaxed = replace(without_rays(problem, wrong), pos=weak)
    if pos_holds(problem):
        relaxed = without_control(relaxed)
    result = adjust(relaxed, robust=True, progress=progress)
    image = result.groups["image"]
    sigma_px = problem.sigma_px * np.sqrt(image.square_sum / max(image.redundancy, 1.0))
    far = np.abs(result.residual_px).max(axis=1) > _FAR * sigma_px
    known = np.isfinite(result.ground_m[problem.point, 0])
    contradicting: _Bools = result.rejected & far & known & ~wrong
    return contradicting


def pos_holds(problem: BundleProblem) -> bool:
    """Whether every image has POS positions and angles with a weight."""
    return bool((problem.pos.weight > 0.0).all())


def without_rays(problem: BundleProblem, rays: _Bools) -> BundleProblem:
    """The problem without weight of rays (m,)."""
    return replace(problem, sigma_px=np.where(rays, np.inf, problem.sigma_px))


def without_control(problem: BundleProblem) -> BundleProblem:
    """The problem without control points."""
    control = problem.control
    none = Control(control.point[:0], control.position_m[:0], control.covariance_m2[:0])
    return replace(problem, control=none)
