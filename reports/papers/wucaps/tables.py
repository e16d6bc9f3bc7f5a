"""The tables of the report on the second paper."""

from collections.abc import Callable, Iterable, Sequence

import numpy as np

from posstats.numerics.bundle.parameters import BORESIGHT
from posstats.papers.wucaps.adjustments import CONTROLS
from posstats.papers.wucaps.experiment import Row, SituationRun
from posstats.papers.wucaps.findings import CRITERIA
from posstats.papers.wucaps.measures import Measures
from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.seeds import pooled, repeated, share
from posstats.papers.wucaps.situations import situation_scenario
from posstats.synthetic import Scenario

from ...document import format as fmt
from ...document.table import Column, Table, text_column
from .words import CONTROL, METHOD_NOTES, METHODS, SITUATIONS

MICROMETRE = fmt.Unit("µm", 1e3)  # of values in mm
MILLIDEGREE = fmt.Unit("0.001°", float(np.degrees(1e3)))

_FINDINGS = {
    "calibration_is_not_enough": "a calibrated POS alone is not enough",
    "unknowns_are_needed": "the bundle needs unknowns of the POS",
    "errors_are_removed": "recommended control removes the errors",
    "less_control_is_not_enough": "less control does not",
    "calibration_is_dispensable": "calibration is dispensable",
    "parallax_is_removed": "models are free of parallax",
    "one_point_leaves_free_unknowns_open": "free drifts and one point: not determined",
}


def situations(run: Reproduction) -> Table:
    """What is flown."""
    scenarios = [situation_scenario(situation) for situation in run.runs]
    flights = [each.flights.flight for each in run.runs.values()]
    lines: list[tuple[str, Sequence[str]]] = [
        ("scale", [f"1:{fmt.count(s.flight.scale_denominator)}" for s in scenarios]),
        ("flying height, m", [fmt.count(s.height_m) for s in scenarios]),
        ("principal distance, mm", [fmt.count(s.camera.principal_distance_mm) for s in scenarios]),
        ("format, cm", ["23 × 23"] * len(scenarios)),
        ("pixel of the scan, µm", [_micrometres(s, 1.0) for s in scenarios]),
        ("forward and side overlap, %", [
            f"{100.0 * s.flight.forward_overlap:.0f}, {100.0 * s.flight.side_overlap:.0f}"
            for s in scenarios]),
        ("strips × images", [f"{len(b.orientations.strips)} × {s.flight.image_counts[0]}"
                             for s, b in zip(scenarios, flights, strict=True)]),
        ("speed, m/s; turn, s", [f"{fmt.count(s.flight.speed_m_per_s)}; "
                                 f"{fmt.count(s.flight.turn_s)}" for s in scenarios]),
        ("relief (standard deviation), m", [
            fmt.number(s.terrain.relief_m / np.sqrt(2.0), 2) for s in scenarios]),
        ("tie points", [fmt.count(len(b.tie_points.point_id) - s.check_points.n
                                  - s.control_points.n)
                        for s, b in zip(scenarios, flights, strict=True)]),
        ("check points, control points", [f"{s.check_points.n}, {s.control_points.n}"
                                          for s in scenarios]),
        ("survey error, m", [fmt.number(s.check_points.ground_m, 1) for s in scenarios]),
    ]  # fmt: skip
    columns = [text_column("", [name for name, _ in lines])]
    for k, situation in enumerate(run.runs):
        columns.append(Column(SITUATIONS[situation], tuple(cells[k] for _, cells in lines)))
    caption = (
        "The two simulated blocks. Kind of camera, terrain and scale are the paper's; everything "
        "else is assumed."
    )
    return Table("situations", caption, tuple(columns))


def _micrometres(scenario: Scenario, pixels: float) -> str:
    pixel_mm = scenario.camera.pixel_size_mm
    return fmt.number(None if pixel_mm is None else 1e3 * pixels * pixel_mm, 2)


def errors(run: Reproduction) -> Table:
    """What errs."""
    scenarios = [situation_scenario(situation) for situation in run.runs]
    degrees = [np.degrees(s.errors.omega.strip_rad) for s in scenarios]
    lines: list[tuple[str, Sequence[str]]] = [
        ("image coordinates, µm", [_micrometres(s, s.errors.image_px) for s in scenarios]),
        ("GNSS: noise, m", [fmt.number(s.errors.position.noise_m, 2) for s in scenarios]),
        ("GNSS: shift of a strip, m", [
            fmt.number(s.errors.position.strip_shift_m, 2) for s in scenarios]),
        ("GNSS: drift of a strip, m in 100 s", [
            fmt.number(100.0 * s.errors.position.strip_drift_m_per_s, 2) for s in scenarios]),
        ("IMU: noise, °", [fmt.fixed(np.degrees(s.errors.omega.noise_rad), 3) for s in scenarios]),
        ("IMU: shift of a strip, °", [fmt.fixed(each, 3) for each in degrees]),
        ("IMU: drift of a strip, ° in 100 s", [
            fmt.fixed(100.0 * np.degrees(s.errors.omega.strip_drift_rad_per_s), 3)
            for s in scenarios]),
        ("boresight roll, pitch, yaw, °", [
            ", ".join(fmt.fixed(np.degrees(getattr(s.errors, name).constant_rad), 2)
                      for name in ("roll", "pitch", "yaw")) for s in scenarios]),
    ]  # fmt: skip
    columns = [text_column("", [name for name, _ in lines])]
    for k, situation in enumerate(run.runs):
        columns.append(Column(SITUATIONS[situation], tuple(cells[k] for _, cells in lines)))
    caption = (
        "The simulated errors: standard deviations of normal distributions, alike in the three "
        "axes or angles; shift and drift are drawn anew for every strip, the boresight is constant."
    )
    note = ("All are assumed, of the kind that the paper describes; the reference has the noise of "
            "GNSS and IMU only.",)  # fmt: skip
    return Table("errors", caption, tuple(columns), note)


def check_points(run: SituationRun) -> Table:
    """RMSE of the check points by every method."""
    reference = run.measures("reference", "all")
    shown = run.rows
    columns = [
        *_names(shown),
        _metres("H", _values(shown, lambda m: m.horizontal_m), "RMSE"),
        _metres("V", _values(shown, lambda m: m.vertical_m), "RMSE"),
        _metres("H", _values(shown, lambda m: m.predicted_horizontal_m), "predicted"),
        _metres("V", _values(shown, lambda m: m.predicted_vertical_m), "predicted"),
        _times("H", _values(shown, lambda m: m.horizontal_m / reference.horizontal_m)),
        _times("V", _values(shown, lambda m: m.vertical_m / reference.vertical_m)),
    ]
    caption = (
        f"{SITUATIONS[run.situation].capitalize()}: RMSE of the check points (H: horizontal, V: "
        "vertical), the RMSE that the standard deviations predict, and RMSE over that of the "
        "bundle without systematic errors and with all control points."
    )
    notes = (
        *METHOD_NOTES,
        f"{fmt.MISSING}: the normal equations are singular. *: a parameter is not determined.",
    )
    strong = frozenset(k for k, row in enumerate(shown) if row.method == "reference")
    return Table(f"check_points_{run.situation}", caption, tuple(columns), notes, strong)


def orientations(run: SituationRun) -> Table:
    """RMSE of the orientations against truth, and parallax of the models."""
    shown = run.rows
    columns = [
        *_names(shown),
        _metres("H", _values(shown, lambda m: m.position_horizontal_m), "projection centre"),
        _metres("V", _values(shown, lambda m: m.position_vertical_m), "projection centre"),
        _one_decimal("omega", _values(shown, lambda m: m.omega_rad), MILLIDEGREE),
        _one_decimal("phi", _values(shown, lambda m: m.phi_rad), MILLIDEGREE),
        _one_decimal("kappa", _values(shown, lambda m: m.kappa_rad), MILLIDEGREE),
        _one_decimal("parallax", _values(shown, lambda m: m.parallax_mm), MICROMETRE),
    ]
    caption = (
        f"{SITUATIONS[run.situation].capitalize()}: RMSE of the orientations against truth, and "
        "mean RMS y-parallax of the stereo models at image scale; relative orientation leaves "
        f"{fmt.fixed(1e3 * run.relative_mm, 1)} µm."
    )
    strong = frozenset(k for k, row in enumerate(shown) if row.method == "reference")
    return Table(f"orientations_{run.situation}", caption, tuple(columns), METHOD_NOTES, strong)


def _values(rows: Sequence[Row], value: Callable[[Measures], float]) -> list[float | None]:
    return [None if row.measures is None else value(row.measures) for row in rows]


def _one_decimal(title: str, values: Iterable[float | None], unit: fmt.Unit) -> Column:
    return Column(title, tuple(fmt.fixed(unit.scaled(value), 1) for value in values), unit.name)


def _names(rows: Sequence[Row]) -> tuple[Column, Column]:
    methods = [METHODS[row.method] for row in rows]
    controls = [
        fmt.MISSING if row.control is None
        else CONTROL[row.control] + ("*" if row.undetermined else "")
        for row in rows
    ]  # fmt: skip
    return text_column("Orientation", methods), text_column("Control", controls)


def _metres(title: str, values: Iterable[float | None], group: str) -> Column:
    return Column(title, tuple(fmt.fixed(value, 3) for value in values), "m", group=group)


def _times(title: str, values: Iterable[float | None]) -> Column:
    return Column(title, tuple(fmt.fixed(v, 2) for v in values), group="over reference")


def boresight(run: Reproduction) -> Table:
    """The boresight: injected, and as the calibration flights give it."""
    lines = [
        (situation, k, name.removeprefix("boresight_"))
        for situation in run.runs
        for k, name in enumerate(BORESIGHT)
    ]
    true = [getattr(situation_scenario(s).errors, name).constant_rad for s, _, name in lines]
    found = [float(run.runs[s].calibration.boresight_rad[k]) for s, k, _ in lines]
    sigma = [float(np.sqrt(run.runs[s].calibration.covariance[k, k])) for s, k, _ in lines]
    columns = (
        text_column("Situation", [SITUATIONS[s] if k == 0 else "" for s, k, _ in lines]),
        text_column("Angle", [name for *_, name in lines]),
        _degrees("injected", true),
        _degrees("estimated", found),
        _degrees("standard deviation", sigma),
        Column("error / sigma", tuple(
            fmt.fixed((f - t) / s, 1) for f, t, s in zip(found, true, sigma, strict=True))),
    )  # fmt: skip
    caption = (
        "Boresight from the calibration flights (bundle adjustment with all control points, shifts "
        "and drifts weighted). Its standard deviation comes from the shifts of the IMU by strip, "
        "which a flight of so few strips does not average out."
    )
    return Table("boresight", caption, columns)


def _degrees(title: str, values_rad: Iterable[float]) -> Column:
    return Column(title, tuple(fmt.fixed(np.degrees(value), 4) for value in values_rad), "°")


def shares(run: Reproduction) -> Table:
    """How often each finding comes out over the stored seeds."""
    columns = [text_column("Finding", [_FINDINGS[name] for name in CRITERIA])]
    for situation in run.runs:
        cells = [fmt.fixed(100.0 * share(name, situation), 0) for name in CRITERIA]
        columns.append(Column(SITUATIONS[situation], tuple(cells), "% of seeds"))
    caption = (
        "How often each finding comes out when the experiment is repeated with "
        f"{len(repeated()['flat'])} different seeds of the random numbers."
    )
    notes = ("Made by benchmarks/wucaps_seeds.py and stored with the package.",)
    return Table("shares", caption, tuple(columns), notes)


def predictions(run: Reproduction) -> Table:
    """RMSE over all stored seeds against what the covariances predict."""
    names = [(f"weighted_{control}", CONTROL[control]) for control in CONTROLS]
    lines = [(s, name, words) for s in run.runs
             for name, words in (*names, ("reference", "no systematic errors, all"))]  # fmt: skip
    columns = [
        text_column("Situation", [SITUATIONS[s] if name == "weighted_none" else ""
                                  for s, name, _ in lines]),
        text_column("Control", [words for *_, words in lines]),
    ]  # fmt: skip
    for side, letter in (("horizontal", "H"), ("vertical", "V")):
        rmse = [pooled(f"{name}_{side}_m", s) for s, name, _ in lines]
        predicted = [pooled(f"{name}_predicted_{side}_m", s) for s, name, _ in lines]
        best = [pooled(f"reference_{side}_m", s) for s, *_ in lines]
        words = f"{side} ({letter})"
        columns += [
            _metres("RMSE", rmse, words),
            _metres("predicted", predicted, words),
            Column("ratio", tuple(_ratio(rmse, predicted)), group=words),
            Column("over reference", tuple(_ratio(rmse, best)), group=words),
        ]
    caption = (
        f"RMSE of the check points over {len(repeated()['flat'])} seeds (drifts weighted), the "
        "RMSE that the covariances predict, their ratio, and RMSE over that without systematic "
        "errors."
    )
    return Table("predictions", caption, tuple(columns))


def _ratio(values: Iterable[float], others: Iterable[float]) -> list[str]:
    return [fmt.fixed(a / b, 2) for a, b in zip(values, others, strict=True)]
