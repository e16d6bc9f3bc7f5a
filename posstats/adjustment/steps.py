"""The chain from a block to its adjustment: the only place that knows the order of the steps.

Control is chosen, the block adjusted robustly without it and with weak POS, which finds rays that
contradict each other whatever control and POS say; then data snooping judges every observation,
weights are estimated on request, tests follow, and at last the points that took no part are
intersected from the adjusted orientations.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from posstats.adjustment.additional_parameters import additional_parameters
from posstats.adjustment.axes import images_with_wrong_axes
from posstats.adjustment.block_problem import bundle_problem
from posstats.adjustment.check_points import intersect_apart
from posstats.adjustment.control import chosen_control
from posstats.adjustment.diagnosis import GROSS, MistakenDataError, likely_mistake
from posstats.adjustment.parameter_choice import Dropped, select_parameters
from posstats.adjustment.priors import with_fitting_priors
from posstats.adjustment.screening import (
    contradicting_rays,
    pos_holds,
    without_control,
    without_rays,
)
from posstats.adjustment.significance import (
    Correlations,
    LocalTest,
    ParameterTest,
    correlations,
    local_tests,
    parameter_tests,
    scale,
)
from posstats.adjustment.snooping import Snooping, snoop
from posstats.adjustment.undetermined import singular_block, undetermined
from posstats.adjustment.weights import EstimatedWeights, estimate_weights
from posstats.arrays import Bools, Floats
from posstats.block.model import Block, GroundPoints, Orientations
from posstats.contract.adjustment import Undetermined
from posstats.contract.choices import ControlChoice
from posstats.errors import ConvergenceError, GeometryError, UndeterminedError
from posstats.geometry.ground.check_points import (
    CheckPointResiduals,
    check_point_residuals,
    differences,
    surveyed_check_points,
)
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem
from posstats.settings import AdjustmentSettings
from posstats.statistics.global_test import GlobalTest, global_test

Progress = Callable[[str, float], object]

ORIENTATION = "bundle"


@dataclass(frozen=True, eq=False)
class Adjustment:
    """An adjusted block.

    Attributes
    ----------
    block
        Its ground points have the roles of the adjustment.
    settings
        What was asked for.
    stated
        The problem of the block before anything was rejected or reweighted.
    rejected
        (m,) rays of it that the robust adjustment took out.
    problem, adjusted
        Of the last adjustment.
    overall, parameters, common_correlations, single
        Tests of the whole, of the additional parameters, and of the observations by group.
    snooping
        What data snooping found; its indices are those of `stated`.
    dropped
        Parameters that were dropped, in order.
    weights
        Estimated ones, or None.
    undetermined
        What the measurements leave open.
    orientations
        Adjusted, projection centres, system of the block, with standard deviations scaled by
        `scale`.
    check_points, pos_check_points
        Residuals of the points that took no part, from the adjusted orientations and from POS.
    check_point_position_m, check_point_covariance_m2
        (g, 3), (g, 3, 3) of them, computing frame, scaled by `scale`; NaN where unknown.
    """

    block: Block
    settings: AdjustmentSettings
    stated: BundleProblem
    rejected: Bools
    problem: BundleProblem
    adjusted: AdjustedBundle
    overall: GlobalTest
    parameters: tuple[ParameterTest, ...]
    common_correlations: Correlations
    single: Mapping[str, LocalTest]
    snooping: Snooping
    dropped: tuple[Dropped, ...]
    weights: EstimatedWeights | None
    undetermined: tuple[Undetermined, ...]
    orientations: Orientations
    check_points: CheckPointResiduals
    pos_check_points: CheckPointResiduals
    check_point_position_m: Floats
    check_point_covariance_m2: Floats

    @property
    def scale(self) -> float:
        """sigma0, by which standard deviations are scaled; 1 without redundancy."""
        return scale(self.adjusted)

    @cached_property
    def pose_covariance(self) -> Floats:
        """(n, 6, 6) of rotation vector (ground frame) and projection centre, scaled."""
        image = np.arange(len(self.adjusted.position_m))
        return self.scale**2 * self.adjusted.inverse.blocks(image, image)

    @property
    def control_points(self) -> GroundPoints | None:
        """The ground points that are control in the last adjustment."""
        surveyed = self.block.ground_points
        if surveyed is None:
            return None
        used = {self.block.tie_points.point_id[k] for k in self.problem.control.point}
        return surveyed.subset(np.array([point in used for point in surveyed.point], dtype=bool))


def adjust_block(
    block: Block, settings: AdjustmentSettings | None = None, *, progress: Progress | None = None
) -> Adjustment:
    """Adjust a block.

    Parameters
    ----------
    block
        From `read_block` or `posstats.synthetic.simulate`.
    settings
        Default: control by its roles, drift of the block, no self-calibration, robust.
    progress
        Called as progress(step, share done 0..1).

    Raises
    ------
    PosstatsError
        If control points cannot be chosen, or the block is not determined.
    MistakenDataError
        If measurements contradict each other because of a mistake that can be named.
    ConvergenceError
        If the adjustment does not settle.
    """
    settings = settings or AdjustmentSettings()
    report = progress or _no_progress
    block, control = _with_roles(block, settings.control)
    parameters = additional_parameters(block, settings)
    tied = replace(block, tie_points=block.tie_points.subset(_takes_part(block)))
    report("intersecting points", 0.0)
    stated = bundle_problem(tied, parameters, control=control)
    stated = replace(stated, bauer_radius_mm=settings.bauer_radius_mm)
    ids = block.orientations.image
    try:
        _require_points(tied, stated)
        rejected = _screened(stated, settings, report)
        report("adjustment", 0.3)
        problem = without_rays(stated, rejected | _of_wrong_axes(stated))
        adjusted = adjust(problem)
        _refuse_mistakes(tied, stated, control, adjusted.sigma0)
        problem = with_fitting_priors(problem, adjusted)
        weights = _first_weights(problem) if settings.estimate_weights else None
        report("data snooping", 0.4)
        snooping = snoop(weights.problem if weights else problem)
        problem, adjusted = snooping.problem, snooping.result
        dropped: tuple[Dropped, ...] = ()
        if settings.drop_insignificant:
            report("dropping parameters", 0.6)
            selection = select_parameters(problem)
            problem, adjusted, dropped = selection.problem, selection.result, selection.dropped
        if settings.estimate_weights:
            report("estimating weights", 0.7)
            weights = _combined(weights, estimate_weights(problem))
            problem, adjusted = weights.problem, weights.result
    except UndeterminedError as error:
        raise singular_block(error, stated, ids) from error
    except (ConvergenceError, GeometryError) as error:
        mistake = likely_mistake(tied, parameters, control, np.inf)
        if mistake is None:
            raise
        raise MistakenDataError(mistake) from error
    report("check points", 0.8)
    return _result(block, settings, stated, rejected, problem, adjusted, snooping, dropped, weights)


def _no_progress(_step: str, _done: float) -> None:
    pass


def _with_roles(block: Block, choice: ControlChoice) -> tuple[Block, Bools]:
    """The block with control and check points as chosen, and (g,) which are control."""
    control = chosen_control(block, choice)
    surveyed = block.ground_points
    if surveyed is None:
        return block, control
    is_check = surveyed.is_check if choice == "roles" else ~control
    return replace(block, ground_points=replace(surveyed, is_check=is_check)), control


def _takes_part(block: Block) -> Bools:
    """(m,) rays that are not to check points."""
    return ~block.check_points[block.tie_points.point]


def _of_wrong_axes(stated: BundleProblem) -> Bools:
    """(m,) rays of images with wrong axes, with which nothing converges; snooping names these."""
    wrong: Bools = np.isin(stated.image, images_with_wrong_axes(stated))
    return wrong


def _require_points(tied: Block, stated: BundleProblem) -> None:
    if len(stated.point) > 0:
        return
    if np.bincount(tied.tie_points.point, minlength=1).max() < 2:
        raise GeometryError("no tie or control point is measured in two images")
    raise GeometryError("the rays of no point meet in front of the images: check the POS")


def _screened(stated: BundleProblem, settings: AdjustmentSettings, report: Progress) -> Bools:
    """(m,) rejected rays."""
    if not settings.robust:
        return np.zeros(len(stated.point), dtype=bool)
    report("robust adjustment", 0.05)
    return contradicting_rays(stated, lambda k, n: report("robust adjustment", 0.05 + 0.25 * k / n))


def _first_weights(problem: BundleProblem) -> EstimatedWeights | None:
    """Weights for data snooping: without control, whose blunders would hide in its variance."""
    if not pos_holds(problem):
        return None
    found = estimate_weights(without_control(problem))
    return replace(found, problem=replace(found.problem, control=problem.control))


def _combined(first: EstimatedWeights | None, last: EstimatedWeights) -> EstimatedWeights:
    """The last estimate with factors against the stated variances."""
    if first is None:
        return last
    factor = {name: first.factor[name] * last.factor[name] for name in last.factor}
    return replace(last, factor=factor)


def _refuse_mistakes(tied: Block, stated: BundleProblem, control: Bools, sigma0: float) -> None:
    if not sigma0 >= GROSS:
        return
    mistake = likely_mistake(tied, stated.parameters, control, sigma0)
    if mistake is not None:
        raise MistakenDataError(mistake)


def _result(
    block: Block,
    settings: AdjustmentSettings,
    stated: BundleProblem,
    rejected: Bools,
    problem: BundleProblem,
    adjusted: AdjustedBundle,
    snooping: Snooping,
    dropped: tuple[Dropped, ...],
    weights: EstimatedWeights | None,
) -> Adjustment:
    tests = parameter_tests(problem, adjusted)
    orientations = _orientations(block, adjusted)
    residuals, position, covariance = _check_points(block, stated, problem, adjusted, orientations)
    return Adjustment(
        block=block,
        settings=settings,
        stated=stated,
        rejected=rejected,
        problem=problem,
        adjusted=adjusted,
        overall=global_test(adjusted.square_sum, adjusted.dof),
        parameters=tests,
        common_correlations=_correlations(adjusted),
        single=local_tests(problem, adjusted),
        snooping=snooping,
        dropped=dropped,
        weights=weights,
        undetermined=undetermined(problem, adjusted, tests, block.orientations.image),
        orientations=orientations,
        check_points=residuals,
        pos_check_points=check_point_residuals(block, block.orientations, "pos"),
        check_point_position_m=position,
        check_point_covariance_m2=covariance,
    )


def _correlations(adjusted: AdjustedBundle) -> Correlations:
    if len(adjusted.common):
        return correlations(adjusted)
    none, values = np.empty(0, dtype=np.intp), np.empty(0)
    return Correlations(none, none, values, none, none, values)


def _orientations(block: Block, adjusted: AdjustedBundle) -> Orientations:
    variance = np.diagonal(adjusted.orientation_covariance, axis1=1, axis2=2)
    sigma = scale(adjusted) * np.sqrt(variance)
    return replace(
        block.orientations,
        position_m=adjusted.position_m,
        angles_rad=adjusted.angles_rad,
        sigma_position_m=sigma[:, 3:],
        sigma_angles_rad=sigma[:, :3],
    )


def _check_points(
    block: Block,
    stated: BundleProblem,
    problem: BundleProblem,
    adjusted: AdjustedBundle,
    orientations: Orientations,
) -> tuple[CheckPointResiduals, Floats, Floats]:
    """Residuals, positions and covariances of the check points."""
    given, points = surveyed_check_points(block)
    wrong = np.isin(block.tie_points.image, images_with_wrong_axes(stated))
    block = replace(block, tie_points=block.tie_points.subset(~wrong))
    computed, covariance = intersect_apart(block, problem, adjusted, orientations, points)
    covariance *= scale(adjusted) ** 2
    residuals = differences(block, ORIENTATION, given, computed, covariance)
    return residuals, computed.position_m, covariance
