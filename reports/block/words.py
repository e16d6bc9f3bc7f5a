"""The words of a block's report, and what every topic of it is made from."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from posstats.contract.results import Results

from ..document import words as document
from ..document.catalogue import catalogue
from ..document.content import Part

DOMAINS = ("document", "notices", "block")


@dataclass(frozen=True)
class Words(document.Words):
    """The catalogue of the report, with the names of orientations and scopes."""

    def orientation(self, name: str, chosen: Sequence[str] = ()) -> str:
        """An orientation or correction; `chosen` are the angles that were corrected."""
        if name != "selected":
            return self.of("orientation", name)
        angles = " + ".join(map(self.angle, chosen)) or self.text("orientation.no_angle")
        return self.text("orientation.selected", angles=angles)

    def angle(self, name: str) -> str:
        """An angle of either frame."""
        return self.of("angle", name)

    def scope(self, scope: str) -> str:
        """``block``, or the strip in words."""
        return self.text("scope.block") if scope == "block" else self.text("scope.strip", id=scope)

    def yes(self, value: bool) -> str:
        """Yes or no."""
        return self.text("answer.yes" if value else "answer.no")

    def rotations(self, codes: Iterable[str]) -> str:
        """Rotations that measurements leave open, as an enumeration."""
        return self.joined(self.of("rotation", code) for code in dict.fromkeys(codes))


def words_in(language: str) -> Words:
    """The words in a language."""
    return Words(catalogue(language, *DOMAINS))


@dataclass(frozen=True)
class BlockReport:
    """What was found, and the words to say it with."""

    results: Results
    words: Words


Topic = Callable[[BlockReport], Part | None]
"""A file of this package: text, tables and figures of one section; None where it has none."""
