"""The words of one document: messages of its catalogue with the document's own values."""

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from posstats.contract.notice import Notice

from . import format as fmt
from .catalogue import Catalogue


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

    def sentences(self, said: Iterable[str]) -> str:
        """Sentences in a row; empty ones are left out."""
        return self.between.join(sentence for sentence in said if sentence)

    def interval(self, low: str, high: str) -> str:
        """Two bounds as one text."""
        missing = fmt.MISSING in (low, high)
        return fmt.MISSING if missing else f"{low}{self.text('interval.between')}{high}"

    def notice(self, said: Notice) -> str:
        """A notice of the analysis in words; its values are written by the suffix of their name."""
        return self.of("notice", said.code, **{
            name: fmt.by_name(name, value, self.joined) for name, value in said.values.items()
        })  # fmt: skip
