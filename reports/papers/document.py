"""The document of a paper's reproduction: its front, conclusions in short, topics in order."""

from collections.abc import Iterable
from dataclasses import dataclass

from posstats.version import __version__

from ..document.content import Content, Part
from ..document.front import Verdict
from ..document.key_figure import KeyFigure
from ..document.numbering import ReportDocument, numbered
from .words import Words


@dataclass(frozen=True)
class PaperFront:
    """What differs on the first pages: what was simulated, what was found, in numbers."""

    subtitle: str
    verdict: str
    key_figures: tuple[KeyFigure, ...]


def made(
    words: Words, front: PaperFront, opening: Content, topics: Iterable[Part], created: str
) -> ReportDocument:
    """Make the document.

    Parameters
    ----------
    words
        Of its language.
    front, opening, topics
        In the order of reading.
    created
        ISO 8601 time stamp.
    """
    first_page, sections = numbered([opening], topics)
    return ReportDocument(
        language=words.catalogue.language,
        title=words.text("front.title"),
        subject=words.text("front.subject"),
        subtitle=front.subtitle,
        mark=words.text("mark.simulated"),
        created=created.partition("T")[0],
        version=__version__,
        verdict=Verdict(front.verdict),
        key_figures=front.key_figures,
        opening=first_page,
        sections=sections,
    )
