"""What templates see: a frozen document of numbered sections, tables and figures."""

from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import ClassVar

from .content import Bullets, Content, Labelled, Paragraph, Part
from .drawing import Drawing
from .format import shortened
from .front import Front
from .letters import width
from .table import Table

LONG_SUBJECT = 64  # letters


@dataclass(frozen=True)
class NumberedTable:
    """A table with its number in the document."""

    kind: ClassVar[str] = "table"
    number: str
    table: Table


@dataclass(frozen=True)
class NumberedFigure:
    """A figure with its number in the document."""

    kind: ClassVar[str] = "figure"
    number: str
    drawing: Drawing


Item = Paragraph | Bullets | NumberedTable | NumberedFigure


@dataclass(frozen=True)
class Section:
    """A numbered section; `id` is the anchor of the contents list."""

    id: str
    number: int
    title: str
    items: tuple[Item, ...]


@dataclass(frozen=True, kw_only=True)
class ReportDocument(Front):
    """All that templates see: the front, what stands before the contents, the sections."""

    opening: tuple[Item, ...] = ()
    sections: tuple[Section, ...]

    @property
    def delivered(self) -> str:
        """The subtitle, by the name that templates of an acceptance document know it by."""
        return self.subtitle

    @property
    def text(self) -> str:
        """Every character that can be shown, for choosing the glyphs to embed."""
        return repr(self)

    @property
    def is_long(self) -> bool:
        """Whether the subject needs smaller letters."""
        return width(self.subject) > LONG_SUBJECT

    @property
    def running(self) -> str:
        """The subject as it stands above every page, its middle left out if it is long."""
        wide = width(self.subject) / max(len(self.subject), 1)
        return shortened(self.subject, int(LONG_SUBJECT / max(wide, 1.0)))


def assembled(front: Front, opening: Iterable[Content], parts: Iterable[Part]) -> ReportDocument:
    """Put a document together, its tables and figures numbered in the order of reading.

    Parameters
    ----------
    front
        The first page.
    opening
        What stands before the contents.
    parts
        The sections.
    """
    first_page, sections = _numbered(opening, parts)
    given = {each.name: getattr(front, each.name) for each in fields(front)}
    return ReportDocument(**given, opening=first_page, sections=sections)


def _numbered(
    opening: Iterable[Content], parts: Iterable[Part]
) -> tuple[tuple[Item, ...], tuple[Section, ...]]:
    numbering = _Numbering()
    return numbering.items(opening), tuple(
        Section(part.id, number, part.title, numbering.items(part.content))
        for number, part in enumerate(parts, start=1)
    )


class _Numbering:
    """Numbers tables and figures in the order of reading, but for those with their own label."""

    def __init__(self) -> None:
        self._tables = 0
        self._figures = 0

    def items(self, content: Iterable[Content]) -> tuple[Item, ...]:
        return tuple(self._item(part) for part in content)

    def _item(self, part: Content) -> Item:
        if isinstance(part, Labelled):
            return _with_label(part)
        if isinstance(part, Table):
            self._tables += 1
            return NumberedTable(str(self._tables), part)
        if isinstance(part, Drawing):
            self._figures += 1
            return NumberedFigure(str(self._figures), part)
        return part


def _with_label(part: Labelled) -> NumberedTable | NumberedFigure:
    if isinstance(part.item, Table):
        return NumberedTable(part.label, part.item)
    return NumberedFigure(part.label, part.item)
