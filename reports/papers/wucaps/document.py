"""The document of the report on the second paper: its front and its topics in order."""

from ...document.numbering import ReportDocument
from ..conclusion import in_short
from ..document import made
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
from .front import front
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
    return made(
        words,
        front(words, report),
        in_short(words, report.conclusions),
        [topic(words, report) for topic in TOPICS],
        created,
    )
