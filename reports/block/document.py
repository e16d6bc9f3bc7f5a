"""The document of a block's report: its front and its topics in order."""

from posstats.contract.choices import DEFAULT_LANGUAGE, Language
from posstats.contract.results import Results

from ..document.content import known
from ..document.drawing import Drawing
from ..document.numbering import NumberedFigure, ReportDocument, assembled
from ..figures import style
from ..typefaces import cjk
from . import (
    angle_errors,
    bundle,
    check_points,
    corrected,
    decisions,
    error_sources,
    limits,
    parallax,
    provenance,
    regression,
)
from .front import front
from .plan_figures import block_plan
from .view import strips
from .words import BlockReport, Topic, words_in

TOPICS: tuple[Topic, ...] = (
    parallax.topic,
    error_sources.topic,
    angle_errors.topic,
    bundle.topic,
    regression.topic,
    decisions.topic,
    corrected.topic,
    check_points.topic,
    limits.topic,
    provenance.topic,
)


def build(results: Results, language: Language = DEFAULT_LANGUAGE) -> ReportDocument:
    """Make the document of a block's report.

    Parameters
    ----------
    results
        What the analysis found, the only source of the report.
    language
        ``en`` or ``zh``.

    Raises
    ------
    PosstatsError
        If there is no such language, or no typeface for it is installed.
    """
    report = BlockReport(results, words_in(language))
    with style.style(_families(report)):
        plan = block_plan(report.words, results)
        parts = [part for topic in TOPICS if (part := topic(report))]
    return assembled(front(report), known(plan), parts)


def drawings(document: ReportDocument) -> list[Drawing]:
    """The figures of a document in the order of reading."""
    items = (document.opening, *(section.items for section in document.sections))
    return [item.drawing for part in items for item in part if isinstance(item, NumberedFigure)]


def _families(report: BlockReport) -> tuple[str, ...]:
    """Families of the texts in figures: words of the language, and the strips' names."""
    return cjk.figure_families("".join([report.words.text("axis.east"), *strips(report.results)]))
