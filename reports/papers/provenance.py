"""Topic: how a paper's reproduction was made."""

from collections.abc import Iterable, Sequence

from ..document.content import Content, Labelled, Paragraph, Part
from ..document.table import Table, pairs
from .words import Words

Pair = tuple[str, str]


def topic(
    words: Words,
    text: str,
    settings: Iterable[Pair],
    versions: Iterable[Pair],
    letters: Sequence[str] = (),
) -> Part:
    """What was simulated from, and with which software.

    Parameters
    ----------
    text
        How to make the numbers again.
    settings, versions
        Names and values.
    letters
        Of the two tables; those of a report that numbers its tables have none.
    """
    tables: tuple[Table, ...] = (
        pairs("settings", words.text("provenance.settings"), _titles(words, "item", "value"),
              settings),
        pairs("versions", words.text("provenance.versions"), _titles(words, "package", "version"),
              versions),
    )  # fmt: skip
    shown: tuple[Content, ...] = tables
    if letters:
        shown = tuple(Labelled(*each) for each in zip(letters, tables, strict=True))
    return Part("provenance", words.text("provenance.title"), (Paragraph(text), *shown))


def _titles(words: Words, name: str, value: str) -> tuple[str, str]:
    return words.text(f"provenance.{name}"), words.text(f"provenance.{value}")
