"""The words of one document: messages of its catalogue with the document's own values."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

from posstats.contract.notice import Notice

from . import format as fmt
from .catalogue import Catalogue, name_in

_LISTED = ("ids", "lines")  # values of a notice that stand one after the other


@dataclass(frozen=True)
class Words:
    """Texts of a catalogue; a kind of document with needs of its own has a class of its own."""

    catalogue: Catalogue

    @cached_property
    def between(self) -> str:
        """What stands between two sentences."""
        return self.catalogue.text("sentence.between")

    def text(self, message: str, /, **values: str) -> str:
        """A message of the catalogue."""
        return self.catalogue.text(message, **values)

    def of(self, family: str, key: str, /, **values: str) -> str:
        """The message of a family for a key of the data."""
        return self.catalogue.of(family, key, **values)

    def known(self, family: str, key: str) -> str:
        """The message of a family for a key, or the key where the family lacks it."""
        return self.of(family, key) if self.catalogue.holds(family, key) else key

    def counted(self, message: str, n: int, /, **values: str) -> str:
        """A plural message with its count as ``n``."""
        return self.catalogue.plural(message, n, n=fmt.count(n), **values)

    def joined(self, words: Iterable[str]) -> str:
        """An enumeration: ``a, b and c``."""
        return self.catalogue.joined(words)

    def first(self, names: Sequence[str], most: int, *, sentence: bool = False) -> str:
        """The first names in a row, and how many there are besides.

        In a `sentence` they are enumerated where all are shown: ``a, b and c``.
        """
        if sentence and len(names) <= most:
            return self.joined(names)
        return self._row(names[:most], len(names) - most)

    def sentences(self, said: Iterable[str]) -> str:
        """Sentences in a row; empty ones are left out."""
        return self.between.join(sentence for sentence in said if sentence)

    def interval(self, low: str, high: str) -> str:
        """Two bounds as one text."""
        missing = fmt.MISSING in (low, high)
        return fmt.MISSING if missing else f"{low}{self.text('interval.between')}{high}"

    def notice(self, said: Notice, *, plain: bool = False) -> str:
        """A notice in words: numbers are written by their names, plurals decided by its ``n``.

        `plain` leaves numbers as Python prints them. A text among the values is translated where
        the catalogue has ``value.<name>.<text>``.
        """
        values = {name: self._written(said, name, plain) for name in said.values}
        n = said.values.get("n")
        message = name_in("notice", said.code)
        if isinstance(n, int):
            return self.catalogue.plural(message, n, **values)
        return self.text(message, **values)

    def reason(self, said: Iterable[Notice], *, plain: bool = False) -> str:
        """Notices that give one reason together: clauses of a sentence."""
        return self.text("clause.between").join(self.notice(each, plain=plain) for each in said)

    def _written(self, said: Notice, name: str, plain: bool) -> str:
        value = said.values[name]
        if name == "why":
            others = {key: each for key, each in said.values.items() if key != "why"}
            return self.notice(Notice(code=str(value), values=others), plain=plain)
        if isinstance(value, str):
            key = f"{name}.{value}"
            return self.of("value", key) if self.catalogue.holds("value", key) else value
        if name in _LISTED and isinstance(value, tuple | list):
            return self._first(value, said, plain)
        return fmt.by_name(name, value, self.joined, plain=plain)

    def _first(self, texts: Iterable[object], said: Notice, plain: bool) -> str:
        """Texts in a row; if they are the first few of ``n``, how many there are besides."""
        shown = [str(each) for each in texts]
        n = said.values.get("n")
        return self._row(shown, n - len(shown) if isinstance(n, int) else 0, plain=plain)

    def _row(self, shown: Sequence[str], hidden: int = 0, *, plain: bool = False) -> str:
        """Texts one after the other, and how many are hidden."""
        if hidden <= 0:
            return self.text("list.between").join(shown)
        more = str(hidden) if plain else fmt.count(hidden)
        return self.joined([*shown, self.text("list.more", n=more)])
