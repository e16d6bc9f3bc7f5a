"""Topic: the two simulated blocks, their errors, their plan."""

from collections.abc import Callable, Mapping

import numpy as np
from matplotlib.axes import Axes

from posstats.block.model import Block
from posstats.contract.choices import ControlSubset
from posstats.papers.wucaps.adjustments import control_points
from posstats.papers.wucaps.experiment import SituationRun
from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.situations import situation_scenario
from posstats.synthetic import Scenario

from ...document import format as fmt
from ...document.content import Paragraph, Part
from ...document.drawing import Drawing
from ...document.table import Column, Table, text_column
from ...figures import style
from .look import LOOK
from .report import Report
from .words import Words

Cell = Callable[[Scenario, Block], str]
"""What a table says of a scenario and the flight that was simulated by it."""

_DRAWN: tuple[tuple[ControlSubset, str, bool], ...] = (
    ("all", "plan.all", False),
    ("corners", "plan.corners", True),
    ("centre", "plan.one", True),
)
"""Control points with the id of their label, and whether they are filled."""


def topic(words: Words, report: Report) -> Part:
    """What is flown, what errs, where it lies."""
    run = report.run
    return Part(
        "situations",
        words.text("situations.title"),
        (
            Paragraph(words.text("situations.text")),
            blocks(words, run),
            errors(words, run),
            plan(words, run),
        ),
    )


def blocks(words: Words, run: Reproduction) -> Table:
    """What is flown."""
    return Table("situations", words.text("situations.caption"), _columns(words, run, _FLOWN))


def errors(words: Words, run: Reproduction) -> Table:
    """What errs."""
    notes = (words.text("errors.note"),)
    return Table("errors", words.text("errors.caption"), _columns(words, run, _ERRORS), notes)


def _columns(words: Words, run: Reproduction, lines: Mapping[str, Cell]) -> tuple[Column, ...]:
    """Names of the lines, then a column for every situation."""
    columns = [text_column("", [words.text(name) for name in lines])]
    for situation, each in run.runs.items():
        scenario, flight = situation_scenario(situation), each.flights.flight
        cells = tuple(cell(scenario, flight) for cell in lines.values())
        columns.append(Column(words.situation(situation), cells))
    return tuple(columns)


def _images(scenario: Scenario, flight: Block) -> str:
    return f"{len(flight.orientations.strips)} × {scenario.flight.image_counts[0]}"


def _tie_points(scenario: Scenario, flight: Block) -> str:
    n_surveyed = scenario.check_points.n + scenario.control_points.n
    return fmt.count(len(flight.tie_points.point_id) - n_surveyed)


def _overlaps(scenario: Scenario, _: Block) -> str:
    flight = scenario.flight
    return f"{100.0 * flight.forward_overlap:.0f}, {100.0 * flight.side_overlap:.0f}"


def _speed(scenario: Scenario, _: Block) -> str:
    return f"{fmt.count(scenario.flight.speed_m_per_s)}; {fmt.count(scenario.flight.turn_s)}"


def _micrometres(scenario: Scenario, pixels: float) -> str:
    pixel_mm = scenario.camera.pixel_size_mm
    return fmt.number(None if pixel_mm is None else 1e3 * pixels * pixel_mm, 2)


def _degrees(angle_rad: float, decimals: int) -> str:
    return fmt.fixed(float(np.degrees(angle_rad)), decimals)


def _boresight(scenario: Scenario, _: Block) -> str:
    errors = scenario.errors
    angles = (errors.roll, errors.pitch, errors.yaw)
    return ", ".join(_degrees(angle.constant_rad, 2) for angle in angles)


_FLOWN: dict[str, Cell] = {
    "situations.scale": lambda s, _: f"1:{fmt.count(s.flight.scale_denominator)}",
    "situations.height": lambda s, _: fmt.count(s.height_m),
    "situations.distance": lambda s, _: fmt.count(s.camera.principal_distance_mm),
    "situations.format": lambda *_: "23 × 23",
    "situations.pixel": lambda s, _: _micrometres(s, 1.0),
    "situations.overlaps": _overlaps,
    "situations.images": _images,
    "situations.speed": _speed,
    "situations.relief": lambda s, _: fmt.number(s.terrain.relief_m / np.sqrt(2.0), 2),
    "situations.tie_points": _tie_points,
    "situations.points": lambda s, _: f"{s.check_points.n}, {s.control_points.n}",
    "situations.survey": lambda s, _: fmt.number(s.check_points.ground_m, 1),
}
_ERRORS: dict[str, Cell] = {
    "errors.image": lambda s, _: _micrometres(s, s.errors.image_px),
    "errors.gnss_noise": lambda s, _: fmt.number(s.errors.position.noise_m, 2),
    "errors.gnss_shift": lambda s, _: fmt.number(s.errors.position.strip_shift_m, 2),
    "errors.gnss_drift": lambda s, _: fmt.number(100.0 * s.errors.position.strip_drift_m_per_s, 2),
    "errors.imu_noise": lambda s, _: _degrees(s.errors.omega.noise_rad, 3),
    "errors.imu_shift": lambda s, _: _degrees(s.errors.omega.strip_rad, 3),
    "errors.imu_drift": lambda s, _: _degrees(100.0 * s.errors.omega.strip_drift_rad_per_s, 3),
    "errors.boresight": _boresight,
}


def plan(words: Words, run: Reproduction) -> Drawing:
    """Projection centres, control and check points of both blocks, on a kilometre grid."""
    with style.style(words.families()):
        figure = style.new_figure(2.6)
        axes = figure.subplots(1, 2)
        for axis, each in zip(axes, run.runs.values(), strict=True):
            _plan(words, axis, each)
        style.legend_below(figure, axes[0], 5)
        title, caption = words.text("plan.title"), words.text("plan.caption")
        return style.finish(figure, "wucaps_plan", title, caption)


def _plan(words: Words, axis: Axes, run: SituationRun) -> None:
    block = run.flights.flight
    surveyed = block.ground_points
    if surveyed is None or block.adjusted is None:
        return
    centres = block.adjusted.position_m / 1e3
    ground = surveyed.position_m / 1e3
    axis.plot(*centres[:, :2].T, label=words.text("plan.centre"), **style.dots(style.GREY, 1.8))
    axis.plot(*ground[surveyed.is_check, :2].T, ls="", marker="x", ms=3.0, mew=0.7,
              color=style.SKY, label=words.text("plan.check"))  # fmt: skip
    for control, label, filled in _DRAWN:
        colour, marker = LOOK[control]
        places = ground[control_points(block, control), :2]
        axis.plot(*places.T, ls="", marker=marker, ms=4.5, mew=0.8, mec=colour,
                  mfc=colour if filled else "none", label=words.text(label))  # fmt: skip
    axis.set_aspect("equal", adjustable="datalim")
    axis.set_title(words.situation(run.situation), loc="left")
    axis.set_xlabel(words.text("plan.east"))
    axis.set_ylabel(words.text("plan.north"))
