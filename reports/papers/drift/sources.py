"""Topic: error sources (Figure 1), relative orientation with POS angles held."""

from posstats.contract.results import Results
from posstats.numerics.kernels.rotation import ANGLE_NAMES
from posstats.papers.drift.reproduction import Reproduction

from ...block.bar_figures import held_angles
from ...block.view import HELD
from ...document import format as fmt
from ...document.content import Labelled, Part
from ...document.drawing import Drawing
from ...document.table import Column, Table, text_column
from .bars import drawn, percent, titles
from .columns import millimetres
from .report import Report
from .words import Words


def topic(words: Words, report: Report) -> Part:
    """Figure 1 and the numbers behind it."""
    said = words.text("sources.title"), words.text("sources.text")
    return report.bars_topic("sources", 1, said, Labelled("D", table(words, report.run)))


def table(words: Words, run: Reproduction) -> Table:
    """Numbers behind Figure 1: parallax with angles held, and what each angle keeps."""
    found = list(run.findings.values())
    held, kept = words.text("sources.held"), words.text("sources.kept")
    heads = {"angles": words.text("sources.all_three")}
    heads |= {angle: words.angle(angle) for angle in ANGLE_NAMES}
    columns = [text_column(words.text("area.column"), [str(each.area) for each in found])]
    for name, title in heads.items():
        columns.append(millimetres(title, [getattr(e, f"held_{name}_mm") for e in found], held))
    none = words.text("sources.none")
    columns.append(millimetres(none, [each.dependent_mm for each in found], held))
    for angle in ANGLE_NAMES:
        cells = tuple(fmt.fixed(100.0 * each.kept_by[angle], 1) for each in found)
        columns.append(Column(words.angle(angle), cells, "%", group=kept))
    return Table("held", words.text("sources.caption"), tuple(columns))


def figure(words: Words, area: int, results: Results) -> Drawing:
    """Figure 1 of an area."""
    bars = held_angles(results, "mm", titles(words, {held: held for held in HELD}))
    every, omega, phi, kappa, none = bars
    title = words.text("sources.figure_title", area=str(area))
    caption = words.text(
        "sources.figure_caption",
        area=str(area),
        omega=percent(omega, every),
        phi=percent(phi, none),
        kappa=percent(kappa, none),
    )
    return drawn(words, results, bars, f"area{area}_error_sources", (title, caption))
