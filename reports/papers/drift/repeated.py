"""Topic: how often each finding comes out over the stored seeds."""

from posstats.papers.drift.comparison import TABLE3_AREA
from posstats.papers.drift.findings import CRITERIA
from posstats.papers.drift.reproduction import Reproduction
from posstats.papers.drift.seeds import repeated, share, share_interval

from ...document import format as fmt
from ...document.content import Labelled, Paragraph, Part
from ...document.table import Column, Table, text_column
from .. import seeds
from .report import Report
from .words import Words

OF_ONE_AREA = "only_omega_is_linear"
"""The finding that is about Table 3, hence about one area."""


def topic(words: Words, report: Report) -> Part:
    """The experiment over all stored seeds."""
    text = Paragraph(words.text("repeated.text", total=n_seeds()))
    table = Labelled("F", shares(words, report.run))
    return Part("repeated", words.text("seeds.title"), (text, table))


def n_seeds() -> str:
    """How often the experiment was repeated."""
    return fmt.count(len(repeated()[TABLE3_AREA]))


def shares(words: Words, run: Reproduction) -> Table:
    """How often each finding comes out over the stored seeds."""
    findings = [words.of("finding", name) for name in CRITERIA]
    columns = [text_column(words.text("seeds.finding"), findings)]
    for area in run.results:
        cells = tuple(
            seeds.percent(share(name, area)) if is_about(name, area) else fmt.MISSING
            for name in CRITERIA
        )
        columns.append(Column(words.area_title(area), cells, words.text("seeds.share")))
    caption = words.text("shares.caption", total=n_seeds())
    return Table("shares", caption, tuple(columns), (_note(words),))


def is_about(criterion: str, area: int) -> bool:
    """Whether a finding is about an area."""
    return criterion != OF_ONE_AREA or area == TABLE3_AREA


def _note(words: Words) -> str:
    """What shares of a hundred seeds can tell."""
    low, high = share_interval(OF_ONE_AREA, TABLE3_AREA)
    return words.text(
        "shares.note",
        sure=seeds.percent(share_interval("angles_dominate", TABLE3_AREA)[0]),
        share=seeds.percent(share(OF_ONE_AREA, TABLE3_AREA)),
        low=seeds.percent(low),
        high=seeds.percent(high),
    )
