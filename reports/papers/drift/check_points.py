"""Topic: check points before and after correction (Table 4)."""

from posstats.papers.drift.findings import only_row
from posstats.papers.drift.reproduction import Reproduction

from ...document import format as fmt
from ...document.content import Labelled, Paragraph, Part
from ...document.table import Column, Table, count_column, text_column
from .columns import SOURCES, cell, compared
from .report import Report
from .words import Words

_SIDES = {"horizontal": "side.h", "vertical": "side.v"}


def topic(words: Words, report: Report) -> Part:
    """Table 4, and what the mean would add."""
    text = words.text("check_points.text", kept=_kept(words, report.run))
    return Part(
        "check-points",
        words.text("check_points.title"),
        (Paragraph(text), Labelled("4", table(words, report.run))),
    )


def _kept(words: Words, run: Reproduction) -> str:
    """Horizontal RMSE of the POS with the mean difference kept, by area."""
    found = [
        only_row(results.check_points, orientation="pos", translation_removed=False)
        for results in run.results.values()
    ]
    return words.joined(fmt.with_unit(row.rmse_horizontal_m, "m") for row in found)


def table(words: Words, run: Reproduction) -> Table:
    """Table 4: published and simulated residuals, and their ratio, line by line."""
    found = compared(run, 4)
    places = list(dict.fromkeys((each.area, str(each.orientation)) for each in found))
    keyed = {(each.area, each.orientation, each.quantity): each for each in found}
    listed = [(area, orientation, source) for area, orientation in places for source in SOURCES]
    columns = [
        text_column(words.text("area.column"), [str(area) for area, *_ in listed]),
        text_column(
            words.text("check_points.orientation"),
            [words.of("oriented", name) for _, name, _ in listed],
        ),
        count_column(
            words.text("check_points.points"),
            [keyed[area, name, "n_check_points"].published for area, name, _ in listed],
        ),
        text_column("", [words.of("source", source) for *_, source in listed]),
    ]
    for statistic in ("max", "min", "rmse"):
        for side, letter in _SIDES.items():
            quantity = f"{statistic}_{side}_m"
            cells = [cell(source, keyed[a, name, quantity], _metres) for a, name, source in listed]
            group = words.of("statistic", statistic)
            columns.append(Column(words.text(letter), tuple(cells), "m", group=group))
    notes = (words.text("check_points.note"),)
    ratios = frozenset(k for k, (*_, source) in enumerate(listed) if source == "ratio")
    triples = (len(SOURCES),) * len(places)
    caption = words.text("check_points.caption")
    return Table("check_points", caption, tuple(columns), notes, ratios, triples)


def _metres(value: float | None) -> str:
    return fmt.fixed(value, 3)
