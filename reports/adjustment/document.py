"""The document of the report on an adjustment: its front and its topics in order."""

from posstats.contract.adjustment import AdjustmentResults
from posstats.contract.choices import DEFAULT_LANGUAGE, Language

from ..document.content import known
from ..document.front import Front, Verdict
from ..document.numbering import ReportDocument, assembled
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
        opening = known(plan.figure(words, results))
        parts = [topic(words, results) for topic in TOPICS]
    return assembled(_front(words, results), opening, parts)


def _front(words: Words, results: AdjustmentResults) -> Front:
    return Front(
        language=words.catalogue.language,
        title=words.text("bundle_document.title"),
        subject=results.block.name,
        subtitle=subtitle(words, results),
        mark=words.text("mark.simulated") if results.block.simulated else "",
        created=(results.created or "").partition("T")[0],
        version=results.posstats_version,
        verdict=Verdict(paragraph(words, results)),
        key_figures=key_figures(words, results),
    )


def _families(words: Words) -> tuple[str, ...]:
    """Families of the texts in figures."""
    return cjk.figure_families(words.text("bundle_axis.east"))
