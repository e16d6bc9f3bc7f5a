"""Rays that contradict other rays, whatever control and POS say."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from posstats.adjustment.axes import images_with_wrong_axes
from posstats.arrays import Bools, Floats
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem

_FAR = 5.0  # standard deviations: nearer ones are left to data snooping, which counts them all
_WEAK_POS = 100.0  # times the stated standard deviations
_MUTE = 1e4  # times its standard deviation a ray follows the others, and its redundancy has digits


def contradicting_rays(
    problem: BundleProblem, progress: Callable[[int, int], object] | None = None
) -> Bools:
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
    limit = _FAR * _image_scale(result)
    known = np.isfinite(result.ground_m[problem.point, 0])
    suspected: Bools = result.rejected & known & ~wrong
    suspected &= _largest(result, problem.sigma_px[:, None]) > limit
    if suspected.any():
        suspected &= _largest_w(relaxed, result, suspected) > limit
    return suspected


def _image_scale(result: AdjustedBundle) -> float:
    """Standard deviation of image coordinates over the stated one."""
    image = result.groups["image"]
    return float(np.sqrt(image.square_sum / max(image.redundancy, 1.0)))


def _largest(result: AdjustedBundle, sigma_px: Floats) -> Floats:
    """(m,) the larger residual of a ray over sigma_px, (m, 1) or (m, 2); NaN behind a camera."""
    largest: Floats = np.abs(result.residual_px / sigma_px).max(axis=1)
    return largest


def _largest_w(problem: BundleProblem, result: AdjustedBundle, suspected: Bools) -> Floats:
    """(m,) how far suspected rays are from where the others see their points, over its sigma.

    That sigma holds the point's own, which of a point of few rays is larger than the measurement's:
    by that one alone, a good ray that was once rejected would stay so. A ray of weight p and
    redundancy number r is foretold with the variance (1 - r) / p.
    """
    gone = result.rejected & ~suspected
    sigma_px = np.where(suspected, _MUTE, 1.0) * np.where(gone, np.inf, problem.sigma_px)
    muted = adjust(
        replace(
            problem,
            sigma_px=sigma_px,
            ground_from_image=result.ground_from_image,
            position_m=result.position_m,
            ground_m=np.where(np.isnan(result.ground_m), problem.ground_m, result.ground_m),
        )
    )
    foretold = _MUTE**2 * (1.0 - muted.redundancy_px)
    return _largest(muted, problem.sigma_px[:, None] * np.sqrt(1.0 + foretold))


def pos_holds(problem: BundleProblem) -> bool:
    """Whether every image has POS positions and angles with a weight."""
    return bool((problem.pos.weight > 0.0).all())


def without_rays(problem: BundleProblem, rays: Bools) -> BundleProblem:
    """The problem without weight of rays (m,)."""
    return replace(problem, sigma_px=np.where(rays, np.inf, problem.sigma_px))


def without_control(problem: BundleProblem) -> BundleProblem:
    """The problem without control points."""
    return replace(problem, control=problem.control.subset(slice(0)))
