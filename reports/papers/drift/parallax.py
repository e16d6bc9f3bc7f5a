"""Topic: vertical parallax by strip (Table 2)."""

from collections import Counter
from collections.abc import Sequence

from posstats.contract.comparison import Compared
from posstats.papers.drift.reproduction import Reproduction

from ...document import format as fmt
from ...document.content import Labelled, Paragraph, Part
from ...document.table import Column, Table, text_column
from .columns import MM_DECIMALS, compared
from .report import Report
from .words import Words

METHODS = ("pos", "independent", "dependent")
_STATISTICS = ("max", "min", "mean")


def topic(words: Words, report: Report) -> Part:
    """Table 2, a part for every way of orienting the models."""
    tables = [
        Labelled(f"2{letter}", table(words, report.run, method))
        for letter, method in zip("abc", METHODS, strict=True)
    ]
    text, trend = Paragraph(words.text("parallax.text")), Paragraph(words.text("parallax.trend"))
    return Part("parallax", words.text("parallax.title"), (text, *tables, trend))


def table(words: Words, run: Reproduction, method: str) -> Table:
    """Table 2 for one way of orienting the models."""
    found = compared(run, 2)
    places = list(dict.fromkeys((each.area, each.strip) for each in found))
    columns = [
        text_column(words.text("area.column"), [str(area) for area, _ in places]),
        text_column(
            words.text("strip.column"), [strip or words.text("strip.all") for _, strip in places]
        ),
    ]
    for statistic in _STATISTICS:
        quantity = f"{method}_{statistic}_mm"
        by_place = {(e.area, e.strip): e for e in found if e.quantity == quantity}
        shown = [by_place.get(place) for place in places]
        columns += _side_by_side(words, shown, words.of("statistic", statistic))
    notes = (words.text("parallax.note"),)
    whole = frozenset(k for k, (_, strip) in enumerate(places) if strip is None)
    by_area = tuple(Counter(area for area, _ in places).values())
    caption = words.text(f"parallax.{method}")
    return Table(f"parallax_{method}", caption, tuple(columns), notes, whole, by_area)


def _side_by_side(words: Words, shown: Sequence[Compared | None], group: str) -> list[Column]:
    published = [fmt.fixed(each.published if each else None, MM_DECIMALS) for each in shown]
    simulated = [fmt.fixed(each.reproduced if each else None, MM_DECIMALS) for each in shown]
    ratios = [fmt.fixed(each.ratio if each else None, 2) for each in shown]
    return [
        Column(words.text("source.publ"), tuple(published), "mm", group=group),
        Column(words.text("source.sim"), tuple(simulated), "mm", group=group),
        Column(words.text("source.ratio"), tuple(ratios), group=group),
    ]
