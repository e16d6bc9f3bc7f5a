"""The document of the report on the first paper: its front and its topics in order."""

from ...document.content import Labelled
from ...document.numbering import ReportDocument
from ..conclusion import in_short
from ..document import made
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
from .front import front
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
    return made(
        words,
        front(words, report),
        Labelled("A", in_short(words, report.conclusions)),
        [topic(words, report) for topic in TOPICS],
        created,
    )
