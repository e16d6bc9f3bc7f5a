"""The adjustments of a block that are compared: control points, and unknowns of the POS.

They are plain least squares of all observations, without a search for blunders: there are none,
and a search would take systematic errors of the POS for blunders and so remove some.
"""

from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np

from posstats.adjustment.additional_parameters import additional_parameters
from posstats.adjustment.block_problem import bundle_problem
from posstats.adjustment.check_points import intersect_apart
from posstats.adjustment.control import chosen_control
from posstats.adjustment.significance import parameter_tests
from posstats.arrays import Bools
from posstats.block.model import Block, Orientations
from posstats.contract.choices import ControlSubset
from posstats.geometry.ground.check_points import (
    CheckPointResiduals,
    differences,
    surveyed_check_points,
)
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.parameters import BORESIGHT, CommonParameter
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem
from posstats.settings import AdjustmentSettings, DriftPriors

Unknowns = Literal["none", "weighted", "free"]
"""Of the POS: no systematic errors; boresight, and shifts and drifts of every strip, as weighted
observations; these shifts and drifts as free unknowns (which hold the boresight)."""

CONTROLS: tuple[ControlSubset, ...] = get_args(ControlSubset)
_FREE = DriftPriors(None, None, None, None, None)


@dataclass(frozen=True, eq=False)
class AdjustedBlock:
    """An adjusted block.

    Attributes
    ----------
    problem, adjusted
        Before and after.
    orientations
        Adjusted.
    check_points
        Residuals of the check points, intersected afterwards, with standard deviations from the
        covariance of the orientations, scaled by sigma0.
    """

    problem: BundleProblem
    adjusted: AdjustedBundle
    orientations: Orientations
    check_points: CheckPointResiduals

    @property
    def undetermined(self) -> tuple[str, ...]:
        """Names of the parameters that are not determined in one strip at least."""
        tests = parameter_tests(self.problem, self.adjusted)
        return tuple(dict.fromkeys(test.name for test in tests if not test.determined))


def control_points(block: Block, control: ControlSubset) -> Bools:
    """(g,) which ground points take part; check points never do."""
    surveyed = block.ground_points
    if surveyed is None:
        return np.empty(0, dtype=bool)
    candidates = np.flatnonzero(~surveyed.is_check)
    without_checks = replace(block, ground_points=surveyed.subset(candidates))
    chosen = np.zeros(len(surveyed), dtype=bool)
    chosen[candidates] = chosen_control(without_checks, control)
    return chosen


def adjusted_block(block: Block, control: ControlSubset, unknowns: Unknowns) -> AdjustedBlock:
    """Adjust a block and intersect its check points.

    Raises
    ------
    UndeterminedError
        If control, POS and unknowns leave the block open.
    """
    rays = block.tie_points.subset(~block.check_points[block.tie_points.point])
    problem = bundle_problem(
        replace(block, tie_points=rays),
        pos_parameters(block, unknowns),
        control=control_points(block, control),
    )
    adjusted = adjust(problem)
    orientations = replace(
        block.orientations, position_m=adjusted.position_m, angles_rad=adjusted.angles_rad
    )
    given, points = surveyed_check_points(block)
    computed, covariance = intersect_apart(block, problem, adjusted, orientations, points)
    covariance *= adjusted.sigma0**2
    residuals = differences(block, "bundle", given, computed, covariance)
    return AdjustedBlock(problem, adjusted, orientations, residuals)


def pos_parameters(block: Block, unknowns: Unknowns) -> tuple[CommonParameter, ...]:
    """The additional unknowns; weighted ones with the default priors of `posstats adjust`."""
    if unknowns == "none":
        return ()
    if unknowns == "weighted":
        return additional_parameters(block, AdjustmentSettings(drift="strip"))
    free = additional_parameters(block, AdjustmentSettings(drift="strip", priors=_FREE))
    return tuple(parameter for parameter in free if parameter.name not in BORESIGHT)
