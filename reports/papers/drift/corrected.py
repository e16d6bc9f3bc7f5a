"""Topic: parallax after correction of one angle (Figure 3)."""

from posstats.contract.results import Results
from posstats.numerics.kernels.rotation import ANGLE_NAMES
from posstats.papers.drift.reproduction import Reproduction

from ...block.bar_figures import corrections
from ...document import format as fmt
from ...document.content import Labelled, Part
from ...document.drawing import Drawing
from ...document.table import Column, Table, text_column
from .bars import drawn, percent, titles
from .columns import millimetres
from .report import Report
from .words import Words

_SHOWN = {
    "pos": "pos",
    **{angle: f"{angle}_corrected" for angle in ANGLE_NAMES},
    "independent": "relative",
}
"""Groups of bars by their names in the results, with the keys of their titles."""


def topic(words: Words, report: Report) -> Part:
    """Figure 3 and the numbers behind it."""
    said = words.text("corrected.title"), words.text("corrected.text")
    return report.bars_topic("corrected", 3, said, Labelled("E", table(words, report.run)))


def table(words: Words, run: Reproduction) -> Table:
    """Numbers behind Figure 3."""
    found = list(run.findings.values())
    alone = words.text("corrected.alone")
    columns = (
        text_column(words.text("area.column"), [str(each.area) for each in found]),
        millimetres(words.text("oriented.pos"), [each.pos_mm for each in found]),
        *(
            millimetres(
                words.angle(angle), [getattr(e, f"corrected_{angle}_mm") for e in found], alone
            )
            for angle in ANGLE_NAMES
        ),
        millimetres(words.text("bars.relative"), [each.independent_mm for each in found]),
        Column(
            words.text("corrected.over_relative"),
            tuple(fmt.fixed(each.over_relative, 2) for each in found),
        ),
    )
    return Table("corrected", words.text("corrected.caption"), columns)


def figure(words: Words, area: int, results: Results) -> Drawing:
    """Figure 3 of an area."""
    bars = corrections(results, "mm", titles(words, _SHOWN))
    pos, omega, phi, kappa, relative = bars
    title = words.text("corrected.figure_title", area=str(area))
    caption = words.text(
        "corrected.figure_caption",
        area=str(area),
        omega=percent(omega, pos),
        omega_relative=percent(omega, relative),
        phi=percent(phi, pos),
        kappa=percent(kappa, pos),
    )
    return drawn(words, results, bars, f"area{area}_corrected", (title, caption))
