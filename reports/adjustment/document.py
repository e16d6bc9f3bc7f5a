"""The document of the report on an adjustment: its front and its topics in order."""

from posstats.contract.adjustment import AdjustmentResults
from posstats.contract.choices import DEFAULT_LANGUAGE, Language

from ..document.content import known
from ..document.front import Verdict
from ..document.numbering import ReportDocument, numbered
from ..figures import style
from ..typefaces import cjk
from . import (
    blunders,
    limits,
    observations,
    orientations,
    parameters,
    plan,
    points,
    provenance,
)
from .front import key_figures, subtitle
from .verdict import paragraph
from .words import Words, words_in

TOPICS = (
    observations.topic,
    parameters.topic,
    orientations.topic,
    points.topic,
    blunders.topic,
    limits.topic,
    provenance.topic,
)


def build(results: AdjustmentResults, language: Language = DEFAULT_LANGUAGE) -> ReportDocument:
    """Make the document.

    Parameters
    ----------
    results
        The content of ``adjustment.json``, the only source of the report.
    language
        ``en`` or ``zh``.

    Raises
    ------
    PosstatsError
        If there is no such language, or no typeface for it is installed.
    """
    words = words_in(language)
    with style.style(_families(words)):
        opening, sections = numbered(
            known(plan.figure(words, results)), [topic(words, results) for topic in TOPICS]
        )
    return ReportDocument(
        language=language,
        title=words.text("bundle_document.title"),
        subject=results.block.name,
        subtitle=subtitle(words, results),
        mark=words.text("mark.simulated") if results.block.simulated else "",
        created=(results.created or "").partition("T")[0],
        version=results.posstats_version,
        verdict=Verdict(paragraph(words, results)),
        key_figures=key_figures(words, results),
        opening=opening,
        sections=sections,
    )


def _families(words: Words) -> tuple[str, ...]:
    """Families of the texts in figures."""
    return cjk.figure_families(words.text("bundle_axis.east"))
