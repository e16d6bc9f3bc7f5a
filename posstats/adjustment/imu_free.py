"""The bundle block adjustment that angle errors are measured against.

What is looked for is the error of the POS angles, so nothing may draw the solution to them: the
angles are observed with weak priors only, and no shift, drift or boresight is unknown. Positions
count with their stated accuracy, tie points with the noise that their residuals show, and ground
points of role control, where there are any, as surveyed: these fix rotations that tie points and
positions leave open. Check points take no part.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from posstats.adjustment.block_problem import bundle_problem
from posstats.adjustment.check_points import intersect_apart
from posstats.adjustment.screening import (
    contradicting_rays,
    pos_holds,
    without_control,
    without_rays,
)
from posstats.adjustment.significance import critical_value, local_tests
from posstats.arrays import Bools, Floats, Ids, Ints
from posstats.block.model import Block, Orientations
from posstats.errors import GeometryError
from posstats.geometry.ground.check_points import (
    CheckPointResiduals,
    differences,
    surveyed_check_points,
)
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.pos_observations import angles_by_rotation_vector
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem
from posstats.numerics.bundle.system import BundleSystem, State
from posstats.numerics.solvers.arrow import ArrowFactor, factorised
from posstats.numerics.solvers.robust import SMALLEST_SCALE
from posstats.numerics.solvers.weak_prior import weak_prior_rad
from posstats.statistics.global_test import GlobalTest, global_test

Progress = Callable[[int, int], object]

ORIENTATION = "bundle"
MAX_IMAGES = 3000  # the covariance of all their angles: 0.65 GB, and a few copies of it
_IMAGES_AT_ONCE = 100
_WEAK = 100.0  # times the standard deviation of a contradicted position, to look for blunders
_LEAST_REDUNDANCY = 1.0  # of all image coordinates together, to estimate their noise
_ALPHA = 0.05  # that a block without blunders loses a ray, has a position or a control point named
_PHASES = 4


@dataclass(frozen=True, eq=False)
class ImuFreeBundle:
    """An adjusted block of n images.

    Attributes
    ----------
    problem, adjusted
        Of the last adjustment: image coordinates weighted by `sigma_px`.
    overall
        Test of the stated accuracies of image coordinates, positions and control points.
    sigma_px
        Standard deviation of an image coordinate, from the residuals; NaN without redundancy.
    n_rejected
        Rays taken out as blunders.
    contradicted_positions, contradicted_control
        (q,) ids of images whose POS position, and (g,) of control points, that all others
        contradict; they stay in.
    orientations
        Adjusted, with standard deviations.
    angle_covariance_rad2
        (n, 3, n, 3) of omega, phi, kappa of all images.
    check_points
        Residuals of the check points, of orientation `ORIENTATION`.
    """

    problem: BundleProblem
    adjusted: AdjustedBundle
    overall: GlobalTest
    sigma_px: float
    n_rejected: int
    contradicted_positions: Ids
    contradicted_control: Ids
    orientations: Orientations
    angle_covariance_rad2: Floats
    check_points: CheckPointResiduals

    @property
    def n_points(self) -> Ints:
        """(n,) points that tie every image."""
        kept = ~self.adjusted.rejected
        n = len(self.adjusted.position_m)
        return np.bincount(self.problem.image[kept], minlength=n)

    @property
    def image_rms_px(self) -> float:
        """Root mean square residual of an image coordinate; NaN without rays."""
        squares = self.adjusted.residual_px[~self.adjusted.rejected] ** 2
        return float(np.sqrt(squares.mean())) if squares.size else float("nan")


def adjust_imu_free(
    block: Block, *, robust: bool = True, progress: Progress | None = None
) -> ImuFreeBundle:
    """Adjust a block without the help of its POS angles.

    Parameters
    ----------
    block
        Its ground points of role control are used, its check points are not.
    robust
        Take out rays that contradict others, then rays beyond chance; else plain least squares.
    progress
        Called as progress(done, total).

    Raises
    ------
    GeometryError
        If no rays meet, or the block has more than `MAX_IMAGES` images.
    ConvergenceError
        If the adjustment does not settle.
    """
    _require_size(len(block.orientations))
    rays = ~block.check_points[block.tie_points.point]
    tied = bundle_problem(replace(block, tie_points=block.tie_points.subset(rays)))
    if len(tied.point) == 0:
        raise GeometryError("the rays of no point meet in front of the images: check the POS")
    stated = _with_weak_angles(tied)
    if robust:
        stated = without_rays(stated, contradicting_rays(tied, _phase(progress, 0)))
    first = adjust(stated, progress=_phase(progress, 1))
    if robust:
        stated = _from(first, stated)
        stated = without_rays(stated, _blunders(stated, _phase(progress, 2)))
        first = adjust(stated, progress=_phase(progress, 2))
    scale = _image_scale(first)
    believed = max(scale, SMALLEST_SCALE) if np.isfinite(scale) else 1.0
    problem = _from(first, replace(stated, sigma_px=believed * stated.sigma_px))
    adjusted = adjust(problem, progress=_phase(progress, 3))
    orientations = _orientations(block, adjusted)
    return ImuFreeBundle(
        problem=problem,
        adjusted=adjusted,
        overall=_overall(first),
        sigma_px=scale * block.accuracy.image_px,
        n_rejected=int(np.isinf(stated.sigma_px).sum()),
        contradicted_positions=block.orientations.image[_contradicted(problem, adjusted, "gnss")],
        contradicted_control=block.tie_points.point_id[
            problem.control.point[_contradicted(problem, adjusted, "control")]
        ],
        orientations=orientations,
        angle_covariance_rad2=_angle_covariance(problem, adjusted),
        check_points=_check_points(block, problem, adjusted, orientations),
    )


def _require_size(n_images: int) -> None:
    if n_images > MAX_IMAGES:
        raise GeometryError(
            f"angle errors from the bundle adjustment need the covariance of all images, at most"
            f" {MAX_IMAGES}; the block has {n_images}: divide it, or use an adjusted orientation"
            " as the source of the errors"
        )


def _phase(progress: Progress | None, number: int) -> Progress | None:
    """Progress of one of the adjustments as part of all."""
    if progress is None:
        return None
    return lambda done, total: progress(number * total + done, _PHASES * total)


def _with_weak_angles(problem: BundleProblem) -> BundleProblem:
    pos = problem.pos
    weak = replace(pos, sigma_angles_rad=weak_prior_rad(pos.sigma_angles_rad))
    return replace(problem, pos=weak)


def _from(adjusted: AdjustedBundle, problem: BundleProblem) -> BundleProblem:
    """The problem with an adjustment's result as start values."""
    known = np.isfinite(adjusted.ground_m)
    return replace(
        problem,
        ground_from_image=adjusted.ground_from_image,
        position_m=adjusted.position_m,
        ground_m=np.where(known, adjusted.ground_m, problem.ground_m),
    )


def _image_scale(adjusted: AdjustedBundle) -> float:
    """Noise of image coordinates over the stated one; NaN without redundancy."""
    image = adjusted.groups["image"]
    if image.redundancy < _LEAST_REDUNDANCY:
        return float("nan")
    return float(np.sqrt(image.square_sum / image.redundancy))


def _blunders(problem: BundleProblem, progress: Progress | None) -> Bools:
    """(m,) rays without weight after those that contradict others beyond chance are taken out.

    Control is left out, and positions that the others contradict are made weak, so that a wrong
    one turns no good ray into a bad one. Rays are judged by the noise that their residuals show
    together, not by the stated one.
    """
    kept = without_control(problem) if pos_holds(problem) else problem
    while True:
        adjusted = adjust(kept, progress=progress)
        positions = _contradicted(kept, adjusted, "gnss")
        wrong = _worst_of_points(kept, adjusted)
        if len(positions):
            kept = _with_weak_positions(_from(adjusted, kept), positions)
        elif wrong.any():
            kept = without_rays(_from(adjusted, kept), wrong)
        else:
            blunders: Bools = np.isinf(kept.sigma_px)
            return blunders


def _with_weak_positions(problem: BundleProblem, images: Ints) -> BundleProblem:
    sigma = problem.pos.sigma_antenna_m.copy()
    sigma[images] *= _WEAK
    return replace(problem, pos=replace(problem.pos, sigma_antenna_m=sigma))


def _worst_of_points(problem: BundleProblem, adjusted: AdjustedBundle) -> Bools:
    """(m,) the worst ray of every point, if it is beyond the critical value."""
    w = _largest(local_tests(problem, adjusted)["image"].w)
    worst = np.zeros(len(problem.ground_m))
    np.maximum.at(worst, problem.point, w)
    n_tested = 2 * max(int(np.isfinite(problem.sigma_px).sum()), 1)
    scale = max(_image_scale(adjusted), SMALLEST_SCALE)
    beyond: Bools = w > critical_value(_ALPHA / n_tested) * scale
    beyond &= w == worst[problem.point]
    return beyond


def _largest(w: Floats) -> Floats:
    """(k,) largest absolute value of rows (k, q), 0 where none is known."""
    largest: Floats = np.nan_to_num(np.abs(w)).max(axis=1, initial=0.0)
    return largest


def _overall(adjusted: AdjustedBundle) -> GlobalTest:
    """Chi-square test of v'Pv of what was measured: the priors of the angles do not count."""
    measured = [adjusted.groups[name] for name in ("image", "gnss", "control")]
    square_sum = sum(group.square_sum for group in measured)
    dof = round(sum(group.redundancy for group in measured))
    return global_test(square_sum, dof)


def _contradicted(problem: BundleProblem, adjusted: AdjustedBundle, kind: str) -> Ints:
    """Rows of the antenna positions or the control beyond the critical value."""
    w = local_tests(problem, adjusted)[kind].w
    return np.flatnonzero(_largest(w) > critical_value(_ALPHA / max(w.size, 1)))


def _orientations(block: Block, adjusted: AdjustedBundle) -> Orientations:
    sigma = np.sqrt(np.diagonal(adjusted.orientation_covariance, axis1=1, axis2=2))
    return replace(
        block.orientations,
        position_m=adjusted.position_m,
        angles_rad=adjusted.angles_rad,
        sigma_position_m=sigma[:, 3:],
        sigma_angles_rad=sigma[:, :3],
    )


def _angle_covariance(problem: BundleProblem, adjusted: AdjustedBundle) -> Floats:
    """(n, 3, n, 3) of the angles of all images.

    The selected inverse of the adjustment ends at images with a common point, so columns of the
    inverse are solved for, those of some images at a time.
    """
    factor = _factor(problem, adjusted)
    by_vector = angles_by_rotation_vector(adjusted.angles_rad, adjusted.system)
    n = len(by_vector)
    covariance = np.empty((n, 3, n, 3))
    for start in range(0, n, _IMAGES_AT_ONCE):
        some = np.arange(start, min(start + _IMAGES_AT_ONCE, n))
        right = np.zeros((n, 6, len(some), 3))
        right[some, :3, np.arange(len(some))] = np.swapaxes(by_vector[some], 1, 2)
        solved, _ = factor.solve(right.reshape(n, 6, -1), np.zeros((0, 3 * len(some))))
        columns = by_vector @ solved[:, :3]
        covariance[:, :, some] = columns.reshape(n, 3, len(some), 3)
    return 0.5 * (covariance + covariance.transpose(2, 3, 0, 1))


def _factor(problem: BundleProblem, adjusted: AdjustedBundle) -> ArrowFactor:
    """Of the normal equations at the solution, of the rays that took part."""
    kept = ~adjusted.rejected
    system = BundleSystem.of(
        replace(
            problem,
            point=problem.point[kept],
            image=problem.image[kept],
            xy_px=problem.xy_px[kept],
            sigma_px=problem.sigma_px[kept],
        )
    )
    state = State(
        adjusted.ground_from_image,
        adjusted.position_m,
        adjusted.ground_m[system.rays.point],
        adjusted.common,
    )
    return factorised(system.equations(state).matrix, system.levels)


def _check_points(
    block: Block, problem: BundleProblem, adjusted: AdjustedBundle, orientations: Orientations
) -> CheckPointResiduals:
    given, points = surveyed_check_points(block)
    computed, covariance = intersect_apart(block, problem, adjusted, orientations, points)
    return differences(block, ORIENTATION, given, computed, covariance)
