"""Made-up runs of the two papers' experiments, every number of its own."""

from dataclasses import fields
from types import SimpleNamespace

import numpy as np
from report_results import area_results

from posstats.adjustment.calibration import Calibration
from posstats.papers.drift import reproduction as drift
from posstats.papers.drift.areas import TrueCauses
from posstats.papers.wucaps import reproduction as wucaps
from posstats.papers.wucaps.adjustments import CONTROLS
from posstats.papers.wucaps.experiment import METHODS, Row, SituationRun
from posstats.papers.wucaps.measures import Measures
from posstats.papers.wucaps.situations import SITUATIONS, simulated

N_STRIPS = {1: 5, 2: 9, 3: 4}
"""Of the areas, as the first paper prints them."""
N_DIRECT = 4
"""Methods of the second paper without an adjustment: they come first."""


def drift_run() -> drift.Reproduction:
    """Three small areas with the strips of the paper."""
    results = {area: area_results(n, 8, seed=area) for area, n in N_STRIPS.items()}
    causes = {area: TrueCauses(0.27 + 0.01 * area, 0.004) for area in N_STRIPS}
    return drift.reproduction(results, causes, seed=4)


def wucaps_run() -> wucaps.Reproduction:
    """Both situations with measures by formula; free unknowns without control are singular."""
    runs = {situation: _situation(k, situation) for k, situation in enumerate(SITUATIONS)}
    return wucaps.reproduction(runs, seed=4)


def _situation(k, situation) -> SituationRun:
    ways = [(method, None) for method in METHODS[:N_DIRECT]]
    ways += [(method, c) for method in METHODS[N_DIRECT:-1] for c in CONTROLS]
    ways.append((METHODS[-1], "all"))
    return SituationRun(
        situation=situation,
        flights=simulated(situation),
        calibration=_calibration(k),
        analysis=SimpleNamespace(chosen=SimpleNamespace(decisions=())),
        relative_mm=0.0071 + 0.001 * k,
        rows=tuple(_row(100 * k + place, *way) for place, way in enumerate(ways)),
    )


def _row(place: int, method, control) -> Row:
    if (method, control) == ("free", "none"):
        return Row(method, control, None, undetermined=("gnss_x_shift",))
    sizes = [0.1, 0.2, 0.09, 0.18, 0.4, 0.5, 1e-4, 2e-4, 3e-4, 0.01]
    values = [size * (1.0 + 0.0137 * place) for size in sizes]
    names = [field.name for field in fields(Measures)]
    undetermined = ("gnss_x_shift",) if (method, control) == ("free", "centre") else ()
    measures = Measures(**dict(zip(names, values, strict=True)))
    sigma0 = None if control is None else 1.0 + 0.01 * place
    return Row(method, control, measures, sigma0, undetermined)


def _calibration(k: int) -> Calibration:
    return Calibration(
        boresight_rad=np.array([-0.003, 0.005, 0.008]) + 1e-4 * k,
        lever_arm_m=None,
        covariance=np.diag([3e-4, 4e-4, 5e-4]) ** 2,
        block="calibration",
        camera="c",
        n_images=9,
        posstats_version="0.1.0",
    )
