"""Topic: the test areas (Table 1), and what their simulation adds to the truth."""

from collections.abc import Callable

from posstats.papers.drift.areas import area_scenario
from posstats.papers.drift.reproduction import Reproduction
from posstats.synthetic import Scenario

from ...document import format as fmt
from ...document.content import Labelled, Paragraph, Part
from ...document.table import Column, Table, text_column
from .columns import compared
from .report import Report
from .words import Words

_DECIMALS = {
    "principal_distance_mm": 1,
    "width_px": 0,
    "height_px": 0,
    "pixel_size_mm": 3,
    "scale_denominator": 0,
    "forward_overlap": 2,
    "side_overlap": 2,
    "n_strips": 0,
    "n_images": 0,
    "n_control_points": 0,
    "n_tie_points": 0,
}
_CHOSEN: dict[str, Callable[[Scenario], float]] = {
    "error.omega_constant": lambda s: 1e3 * s.errors.omega.constant_rad,
    "error.omega_drift": lambda s: 1e7 * s.errors.omega.drift_rad_per_s,
    "error.omega_noise": lambda s: 1e6 * s.errors.omega.noise_rad,
    "error.phi_noise": lambda s: 1e6 * s.errors.phi.noise_rad,
    "error.kappa_noise": lambda s: 1e6 * s.errors.kappa.noise_rad,
    "error.position_noise": lambda s: 1e2 * s.errors.position.noise_m,
    "error.tie_points": lambda s: s.errors.image_px,
    "error.check_points": lambda s: s.check_points.image_px,
    "error.survey": lambda s: s.check_points.ground_m,
    "error.speed": lambda s: s.flight.speed_m_per_s,
    "error.turn": lambda s: s.flight.turn_s,
    "error.tilt": lambda s: 1e3 * s.flight.tilt_rad,
    "error.relief": lambda s: s.terrain.relief_m,
}


def topic(words: Words, report: Report) -> Part:
    """What was photographed, and how it is simulated."""
    return Part(
        "areas",
        words.text("areas.title"),
        (
            Paragraph(words.text("areas.text")),
            Paragraph(words.text("areas.device")),
            Labelled("1", table(words, report.run)),
            Labelled("C", errors(words, report.run)),
        ),
    )


def table(words: Words, run: Reproduction) -> Table:
    """Table 1: the three areas as printed and as simulated."""
    names = [words.of("quantity", quantity) for quantity in _DECIMALS]
    columns = [text_column(words.text("quantity.column"), names)]
    for area in run.results:
        found = {each.quantity: each for each in compared(run, 1, area=area)}
        shown = [(found[quantity], decimals) for quantity, decimals in _DECIMALS.items()]
        group = words.area_title(area)
        published = tuple(fmt.fixed(each.published, decimals) for each, decimals in shown)
        simulated = tuple(fmt.fixed(each.reproduced, decimals) for each, decimals in shown)
        columns.append(Column(words.text("source.published"), published, group=group))
        columns.append(Column(words.text("source.simulated"), simulated, group=group))
    return Table("areas", words.text("areas.caption"), tuple(columns))


def errors(words: Words, run: Reproduction) -> Table:
    """What the simulation adds to the truth: the parameters that were fitted."""
    names = [words.text(name) for name in _CHOSEN]
    columns = [text_column(words.text("quantity.column"), names)]
    for area in run.results:
        scenario = area_scenario(area)
        cells = tuple(fmt.as_chosen(value(scenario)) for value in _CHOSEN.values())
        columns.append(Column(words.area_title(area), cells))
    notes = (words.text("errors.note"),)
    return Table("simulated_errors", words.text("errors.caption"), tuple(columns), notes)
