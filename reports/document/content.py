"""What reports are made of: paragraphs, lists, tables and figures, in sections."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar

from .drawing import Drawing
from .table import Table


@dataclass(frozen=True)
class Paragraph:
    """A paragraph of plain text, perhaps with a word before it that says what it is about."""

    kind: ClassVar[str] = "paragraph"
    text: str
    lead: str = ""


@dataclass(frozen=True)
class Bullets:
    """A list of plain texts."""

    kind: ClassVar[str] = "bullets"
    texts: tuple[str, ...]


@dataclass(frozen=True)
class Labelled:
    """A table or figure with a number of its own, such as ``2a`` of a source's Table 2."""

    label: str
    item: Table | Drawing


Content = Paragraph | Bullets | Labelled | Table | Drawing


@dataclass(frozen=True)
class Part:
    """A section before its tables and figures are numbered."""

    id: str
    title: str
    content: tuple[Content, ...]


def filled(tables: Iterable[Table]) -> tuple[Table, ...]:
    """The tables that have rows."""
    return tuple(table for table in tables if table.rows)


def known(*drawings: Drawing | None) -> tuple[Drawing, ...]:
    """The figures that could be drawn."""
    return tuple(drawing for drawing in drawings if drawing)
