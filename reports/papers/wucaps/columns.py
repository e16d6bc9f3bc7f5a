"""Columns that several tables of the report on the second paper have."""

from collections.abc import Callable, Iterable, Sequence

from posstats.papers.wucaps.experiment import Row
from posstats.papers.wucaps.measures import Measures

from ...document import format as fmt
from ...document.table import Column, text_column
from .words import Words


def names(words: Words, rows: Sequence[Row]) -> tuple[Column, Column]:
    """How the images were oriented, and with which control points."""
    methods = [words.method(row.method) for row in rows]
    controls = [
        fmt.MISSING if row.control is None
        else words.control(row.control) + ("*" if row.undetermined else "")
        for row in rows
    ]  # fmt: skip
    return (
        text_column(words.text("wucaps_column.method"), methods),
        text_column(words.text("wucaps_column.control"), controls),
    )


def values(rows: Sequence[Row], value: Callable[[Measures], float]) -> list[float | None]:
    """A measure of every row; None where the normal equations are singular."""
    return [None if row.measures is None else value(row.measures) for row in rows]


def metres(title: str, lengths: Iterable[float | None], group: str) -> Column:
    """Lengths in millimetres' places."""
    return Column(title, tuple(fmt.fixed(value, 3) for value in lengths), "m", group=group)


def references(rows: Sequence[Row]) -> frozenset[int]:
    """Places of the rows with which the others are compared."""
    return frozenset(k for k, row in enumerate(rows) if row.method == "reference")
