"""The document of the report on the second paper: its front and its topics in order."""

from posstats.version import __version__

from ...document.front import Verdict
from ...document.numbering import ReportDocument, numbered
from ..conclusion import in_short
from . import (
    calibration,
    check_points,
    conclusions,
    orientations,
    provenance,
    remarks,
    repeated,
    situations,
)
from .front import key_figures, subtitle, verdict
from .report import Report
from .words import Words

TOPICS = (
    conclusions.topic,
    situations.topic,
    check_points.topic,
    orientations.topic,
    calibration.topic,
    repeated.topic,
    remarks.topic,
    provenance.topic,
)


def build(words: Words, report: Report, created: str) -> ReportDocument:
    """Make the document.

    Parameters
    ----------
    words
        Of its language, in which the conclusions of the report are too.
    report
        Both situations and what is concluded.
    created
        ISO 8601 time stamp.
    """
    opening, sections = numbered(
        [in_short(words, report.conclusions)], [topic(words, report) for topic in TOPICS]
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
