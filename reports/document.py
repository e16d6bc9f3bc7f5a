"""What templates see: a frozen document of numbered sections, tables and figures."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar

from . import figures, sections
from .figure_style import Drawing
from .key_figures import KeyFigure, key_figures
from .results_view import Results
from .sections import Bullets, Content, Paragraph
from .tables import Table
from .verdict import is_coarse, paragraph

SIMULATED = "Simulated data"


@dataclass(frozen=True)
class NumberedTable:
    """A table with its number in the document."""

    kind: ClassVar[str] = "table"
    number: int
    table: Table


@dataclass(frozen=True)
class NumberedFigure:
    """A figure with its number in the document."""

    kind: ClassVar[str] = "figure"
    number: int
    drawing: Drawing


Item = Paragraph | Bullets | NumberedTable | NumberedFigure


@dataclass(frozen=True)
class Section:
    """A numbered section; `id` is the anchor of the contents list."""

    id: str
    number: int
    title: str
    items: tuple[Item, ...]


@dataclass(frozen=True)
class ReportDocument:
    """All that templates see.

    `created` is a date as text or empty, `mark` a mark for every page (simulated data) or empty,
    `opening` the items between the verdict and the contents.
    """

    title: str
    block: str
    subtitle: str
    mark: str
    created: str
    version: str
    verdict: str
    coarse: bool
    key_figures: tuple[KeyFigure, ...]
    opening: tuple[Item, ...]
    sections: tuple[Section, ...]

    @property
    def text(self) -> str:
        """Every character that can be shown, for choosing the glyphs to embed."""
        return repr(self)


def build(results: Results, drawings: dict[str, Drawing] | None = None) -> ReportDocument:
    """Make the document of a block's report.

    Parameters
    ----------
    results
        The results dictionary (``results.json``), the only source of the report.
    drawings
        The figures of the results, if they have been drawn already.
    """
    opening, parts = sections.block_report(results, drawings or figures.draw(results))
    numbering = _Numbering()
    block = results["block"]
    return ReportDocument(
        title="Vertical parallax and POS angle errors",
        block=str(block["name"]),
        subtitle=sections.subtitle(results),
        mark=SIMULATED if block.get("simulated") else "",
        created=str(results.get("created") or "").partition("T")[0],
        version=str(results.get("posstats_version") or ""),
        verdict=paragraph(results),
        coarse=is_coarse(results),
        key_figures=key_figures(results),
        opening=numbering.items(opening),
        sections=tuple(
            Section(part.id, number, part.title, numbering.items(part.content))
            for number, part in enumerate(parts, start=1)
        ),
    )


class _Numbering:
    """Numbers tables and figures in the order of reading."""

    def __init__(self) -> None:
        self._tables = 0
        self._figures = 0

    def items(self, content: Iterable[Content]) -> tuple[Item, ...]:
        return tuple(self._item(part) for part in content)

    def _item(self, part: Content) -> Item:
        if isinstance(part, Table):
            self._tables += 1
            return NumberedTable(self._tables, part)
        if isinstance(part, Drawing):
            self._figures += 1
            return NumberedFigure(self._figures, part)
        return part
