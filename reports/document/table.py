"""Tables as objects: columns, units, alignment, caption."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import islice
from typing import Literal

from . import format as fmt

Align = Literal["left", "right", "prose"]
SHORT_ROWS = 16
LONG_WORD = 24  # letters from which an id may be broken over lines


@dataclass(frozen=True)
class Column:
    """One column with its cells as text."""

    title: str
    cells: tuple[str, ...]
    unit: str = ""
    align: Align = "right"
    group: str = ""

    @property
    def has_long_words(self) -> bool:
        """Whether a cell holds a word (an id, a checksum) that no column can hold in one line."""
        return any(len(word) > LONG_WORD for cell in self.cells for word in cell.split())


@dataclass(frozen=True)
class HeadGroup:
    """A heading over several neighbouring columns."""

    title: str
    span: int


@dataclass(frozen=True)
class Table:
    """A table that can be read alone.

    `name` is an identifier, `caption` says what is shown and how it was computed, `notes` explain
    signs and missing values, `strong` are the indices of rows that sum up the others, `together`
    says how many rows each may not be parted by the end of a page (as it comes where empty).
    """

    name: str
    caption: str
    columns: tuple[Column, ...]
    notes: tuple[str, ...] = ()
    strong: frozenset[int] = frozenset()
    together: tuple[int, ...] = ()

    @property
    def rows(self) -> tuple[tuple[str, ...], ...]:
        """Cells by row."""
        return tuple(zip(*(column.cells for column in self.columns), strict=True))

    @property
    def bodies(self) -> tuple[tuple[tuple[int, tuple[str, ...]], ...], ...]:
        """Rows with their indices, in groups that stay on one page."""
        numbered = iter(enumerate(self.rows))
        lengths = self.together or (len(self.rows),)
        return tuple(tuple(islice(numbered, length)) for length in lengths)

    @property
    def is_short(self) -> bool:
        """Whether the table should stay on one page: few rows of one line each."""
        return len(self.rows) <= SHORT_ROWS and all(c.align != "prose" for c in self.columns)

    @property
    def groups(self) -> tuple[HeadGroup, ...]:
        """Headings over the columns; empty if no column belongs to a group."""
        if not any(column.group for column in self.columns):
            return ()
        merged: list[HeadGroup] = []
        for column in self.columns:
            if merged and column.group and merged[-1].title == column.group:
                merged[-1] = HeadGroup(column.group, merged[-1].span + 1)
            else:
                merged.append(HeadGroup(column.group, 1))
        return tuple(merged)


def text_column(title: str, cells: Iterable[str | None], group: str = "") -> Column:
    """A column of words."""
    return Column(
        title, tuple(fmt.MISSING if cell is None else cell for cell in cells), "", "left", group
    )


def prose_column(title: str, cells: Iterable[str]) -> Column:
    """A column of sentences, which takes the width that the others leave."""
    return Column(title, tuple(cells), align="prose")


def count_column(title: str, values: Iterable[float | None], group: str = "") -> Column:
    """A column of whole numbers."""
    return Column(title, tuple(fmt.count(value) for value in values), group=group)


def aligned_column(
    title: str, unit: str, values: Sequence[float | None], digits: int = 3, group: str = ""
) -> Column:
    """A column of numbers of one kind: all with the same decimals, so that they compare by eye."""
    decimals = fmt.shared_decimals(values, digits)
    return Column(title, tuple(fmt.fixed(value, decimals) for value in values), unit, group=group)


def number_column(
    title: str, unit: str, values: Iterable[float | None], digits: int = 3, group: str = ""
) -> Column:
    """A column of numbers of different magnitude: each with its own significant digits."""
    return Column(title, tuple(fmt.number(value, digits) for value in values), unit, group=group)


def p_column(title: str, values: Iterable[float | None], group: str = "") -> Column:
    """A column of p-values."""
    return Column(title, tuple(fmt.p_value(value) for value in values), group=group)


def pairs(
    name: str, caption: str, titles: tuple[str, str], items: Iterable[tuple[str, str]]
) -> Table:
    """A table of names and values."""
    listed = list(items)
    columns = (
        text_column(titles[0], [key for key, _ in listed]),
        text_column(titles[1], [value for _, value in listed]),
    )
    return Table(name, caption, columns)
