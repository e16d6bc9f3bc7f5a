"""A table of mean parallax per strip, for error sources and corrections."""

from collections.abc import Mapping, Sequence

from posstats.contract.results import Results

from ..document import format as fmt
from ..document.rows import first
from ..document.table import Table, number_column, text_column
from .view import StripMean, strips
from .words import Words

Means = Mapping[str, Sequence[StripMean]]
"""Titles of columns, and the strips' parallax in them."""


def strip_table(words: Words, results: Results, name: str, of: Means, ends: Means) -> Table:
    """Mean parallax per strip, px.

    Parameters
    ----------
    name
        Of the table, and of its caption: ``<name>.caption``.
    of
        The columns that the table is about; strips without a value in them are left out.
    ends
        A column before and one after them; may be empty.
    """
    kept = _strips_in(results, [row for part in of.values() for row in part])
    before, after = dict(list(ends.items())[:1]), dict(list(ends.items())[1:])
    columns = [text_column(words.text("column.strip"), kept)]
    for title, part in [*before.items(), *of.items(), *after.items()]:
        columns.append(number_column(title, "px", _means(kept, part)))
    caption = words.text(f"{name}.caption")
    return Table(name, caption, tuple(columns), _left_out(words, results, kept))


def _means(kept: Sequence[str], part: Sequence[StripMean]) -> list[float | None]:
    found = (first(part, strip=strip) for strip in kept)
    return [row.mean_px if row else None for row in found]


def _strips_in(results: Results, part: Sequence[StripMean]) -> list[str]:
    """Strips with at least one value; strips without a model would be rows of dashes."""
    known = {row.strip for row in part if not fmt.is_missing(row.mean_px)}
    return [strip for strip in strips(results) if strip in known]


def _left_out(words: Words, results: Results, kept: Sequence[str]) -> tuple[str, ...]:
    others = [strip for strip in strips(results) if strip not in kept]
    return (words.text("strips.left_out", strips=words.joined(others)),) if others else ()
