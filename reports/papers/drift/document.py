"""The document of the report on the first paper: its front and its topics in order."""

from posstats.version import __version__

from ...document.content import Labelled
from ...document.front import Verdict
from ...document.numbering import ReportDocument, numbered
from ..conclusion import in_short
from . import (
    areas,
    check_points,
    conclusions,
    corrected,
    differences,
    parallax,
    printed_numbers,
    provenance,
    regression,
    repeated,
    sources,
)
from .front import key_figures, subtitle, verdict
from .report import Report
from .words import Words

TOPICS = (
    conclusions.topic,
    areas.topic,
    parallax.topic,
    sources.topic,
    regression.topic,
    corrected.topic,
    check_points.topic,
    repeated.topic,
    printed_numbers.topic,
    differences.topic,
    provenance.topic,
)
"""Tables and figures 1 to 4 have the paper's numbers, further tables letters."""


def build(words: Words, report: Report, created: str) -> ReportDocument:
    """Make the document.

    Parameters
    ----------
    words
        Of its language, in which conclusions and figures of the report are too.
    report
        The three areas, what is concluded, and the figures.
    created
        ISO 8601 time stamp.
    """
    opening, sections = numbered(
        [Labelled("A", in_short(words, report.conclusions))],
        [topic(words, report) for topic in TOPICS],
    )
    return ReportDocument(
        language=words.catalogue.language,
        title=words.text("front.title"),
        subject=words.text("front.subject"),
        subtitle=subtitle(words, report.run),
        mark=words.text("mark.simulated"),
        created=created.partition("T")[0],
        version=__version__,
        verdict=Verdict(verdict(words, report)),
        key_figures=key_figures(words, report.run),
        opening=opening,
        sections=sections,
    )
