"""One situation of the paper: every way to orient the flight, and what each is worth."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from posstats.adjustment.calibration import Calibration, apply_calibration, calibration_of
from posstats.analysis.rules import Decision
from posstats.analysis.steps import Analysis, analyse
from posstats.block.image_pairs import StereoModels, stereo_models
from posstats.block.model import Block, Orientations
from posstats.contract.choices import PAPER_SEED, ControlSubset
from posstats.errors import UndeterminedError
from posstats.numerics.kernels.rotation import ANGLE_NAMES
from posstats.papers.wucaps.adjustments import (
    CONTROLS,
    Unknowns,
    adjusted_block,
    pos_parameters,
)
from posstats.papers.wucaps.measures import Measures, measured
from posstats.papers.wucaps.situations import Flights, Situation, simulated
from posstats.settings import Settings

Method = Literal[
    "pos",
    "calibrated",
    "regression",
    "strip_lines",
    "bundle",
    "bundle_calibrated",
    "weighted",
    "weighted_calibrated",
    "free",
    "reference",
]
"""Direct georeferencing from the POS as recorded; with the boresight of another flight taken off;
with the first paper's time regression, by its rules; with the line of every angle and strip taken
off, whatever the rules say. Bundle adjustment without unknowns of the POS, of the recorded and of
the calibrated POS; with boresight and strip-wise shifts and drifts as weighted observations, of
both; with these free. The bundle of the flight without systematic errors."""

METHODS: tuple[Method, ...] = get_args(Method)
_BUNDLES: dict[Method, tuple[Unknowns, bool]] = {
    "bundle": ("none", False),
    "bundle_calibrated": ("none", True),
    "weighted": ("weighted", False),
    "weighted_calibrated": ("weighted", True),
    "free": ("free", False),
}


@dataclass(frozen=True)
class Row:
    """One way to orient the flight.

    Attributes
    ----------
    method
        How.
    control
        Which control points took part; None of direct georeferencing, which has none.
    measures
        None where the adjustment is singular.
    sigma0
        Of the adjustment.
    undetermined
        Names of unknowns that are not determined; of weighted ones none, their priors are known.
    """

    method: Method
    control: ControlSubset | None
    measures: Measures | None
    sigma0: float | None = None
    undetermined: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class SituationRun:
    """Everything about one situation.

    Attributes
    ----------
    situation, flights
        What was simulated.
    calibration
        From the calibration flight, with all its control points.
    analysis
        The first paper's, of the flight.
    relative_mm
        Mean RMS y-parallax that relative orientation leaves.
    rows
        One per method and control.
    """

    situation: Situation
    flights: Flights
    calibration: Calibration
    analysis: Analysis
    relative_mm: float
    rows: tuple[Row, ...]

    def row(self, method: Method, control: ControlSubset | None = None) -> Row:
        """The row of a method and its control."""
        return next(r for r in self.rows if (r.method, r.control) == (method, control))

    def measures(self, method: Method, control: ControlSubset | None = None) -> Measures:
        """The measures of a method that gave an orientation."""
        found = self.row(method, control).measures
        if found is None:
            raise ValueError(f"{method} with control {control} is not determined")
        return found


def run_situation(
    situation: Situation,
    seed: int = PAPER_SEED,
    *,
    progress: Callable[[float], object] | None = None,
) -> SituationRun:
    """Simulate a situation and orient its flight in every way.

    Parameters
    ----------
    situation
        ``flat`` or ``mountain``.
    seed
        Of the whole experiment; see `posstats.papers.wucaps.situations.flight_seed`.
    progress
        Called with the share done, 0 to 1.
    """
    flights = simulated(situation, seed)
    models = stereo_models(flights.flight)
    calibration = calibrated_from(flights.calibration)
    analysis = analyse(flights.flight, Settings(rules="paper", robust=False))
    rows = list(_direct(flights.flight, models, calibration, analysis))
    bundles = _bundles(flights, models, calibration)
    n_bundles = len(_BUNDLES) * len(CONTROLS) + 1
    for done, row in enumerate(bundles, start=1):
        rows.append(row)
        if progress is not None:
            progress(done / n_bundles)
    return SituationRun(
        situation=situation,
        flights=flights,
        calibration=calibration,
        analysis=analysis,
        relative_mm=float(np.nanmean(analysis.independent.y_parallax_rms_mm)),
        rows=tuple(rows),
    )


def calibrated_from(block: Block) -> Calibration:
    """The boresight of a flight, from its adjustment with all control points.

    Its covariance is that of the stated weights: they are those of the simulation.
    """
    result = adjusted_block(block, "all", "weighted")
    adjusted = result.adjusted
    return calibration_of(block, result.problem, adjusted, adjusted.common_covariance)


def _direct(
    block: Block, models: StereoModels, calibration: Calibration, analysis: Analysis
) -> Iterator[Row]:
    orientations: dict[Method, Orientations] = {
        "pos": block.orientations,
        "calibrated": apply_calibration(block, calibration).orientations,
        "regression": analysis.corrected_orientations["selected"],
        "strip_lines": _without_strip_lines(analysis),
    }
    for method, each in orientations.items():
        yield Row(method, None, measured(block, models, each))


def _without_strip_lines(analysis: Analysis) -> Orientations:
    """The POS without the OLS line of every angle and strip."""
    ground = analysis.frames[0]
    pos = analysis.block.orientations
    lines = tuple(
        Decision(angle, "ground", strip, True, "linear", "ols", "all")
        for strip in pos.strips
        for angle in ANGLE_NAMES
    )
    return ground.correct(pos, lines)


def _bundles(flights: Flights, models: StereoModels, calibration: Calibration) -> Iterator[Row]:
    for method, (unknowns, calibrated) in _BUNDLES.items():
        block = flights.flight
        if calibrated:
            block = apply_calibration(block, calibration, unknown=unknowns != "none")
        for control in CONTROLS:
            yield _bundle(block, models, method, control, unknowns)
    yield _bundle(flights.without_errors, models, "reference", "all", "none")


def _bundle(
    block: Block, models: StereoModels, method: Method, control: ControlSubset, unknowns: Unknowns
) -> Row:
    try:
        result = adjusted_block(block, control, unknowns)
    except UndeterminedError as error:
        return Row(method, control, None, undetermined=_names(block, unknowns, error))
    measures = measured(block, models, result.orientations, result.check_points)
    undetermined = result.undetermined if unknowns == "free" else ()
    return Row(method, control, measures, result.adjusted.sigma0, undetermined)


def _names(block: Block, unknowns: Unknowns, error: UndeterminedError) -> tuple[str, ...]:
    """Names of the parameters that singular normal equations leave open."""
    parameters = pos_parameters(block, unknowns)
    return tuple(dict.fromkeys(parameters[k].name for k in error.common))
