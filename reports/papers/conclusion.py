"""A paper's conclusions, tested: in short for the first page, with their evidence as a topic."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from posstats.contract.conclusion import StatedConclusion

from ..document import format as fmt
from ..document.table import Table, prose_column, text_column
from .words import Words


@dataclass(frozen=True)
class Conclusion:
    """What the paper concludes, whether the simulation bears it out, and by which numbers.

    `title` is the conclusion in a few words, `evidence` one statement per line.
    """

    title: str
    text: str
    holds: bool
    evidence: tuple[str, ...]

    def stated(self) -> StatedConclusion:
        """The conclusion as it is written down."""
        return StatedConclusion(text=self.text, holds=self.holds, evidence=" ".join(self.evidence))


def in_short(words: Words, found: Sequence[Conclusion]) -> Table:
    """The conclusions in a few words, for the first page."""
    columns = (
        text_column("", _numbers(found)),
        text_column(words.text("conclusions.column"), [each.title for each in found]),
        text_column(words.text("conclusions.simulated"), [judged(words, each) for each in found]),
    )
    failed = frozenset(k for k, each in enumerate(found) if not each.holds)
    return Table("conclusions", words.text("conclusions.caption"), columns, strong=failed)


def evidence(
    words: Words, name: str, caption: str, title: str, found: Sequence[Conclusion]
) -> Table:
    """Conclusions in full, with what says so.

    Parameters
    ----------
    name
        Of the table.
    caption, title
        Of the table and of the column that holds the conclusions.
    found
        The conclusions.
    """
    columns = (
        text_column("", _numbers(found)),
        text_column(title, [each.text for each in found]),
        text_column(words.text("conclusions.simulated"), [judged(words, each) for each in found]),
        prose_column(
            words.text("conclusions.evidence"), ["\n".join(each.evidence) for each in found]
        ),
    )
    return Table(name, caption, columns)


def how_many(words: Words, found: Sequence[Conclusion]) -> str:
    """How many conclusions hold, and which do not."""
    failed = [fmt.count(k) for k, each in enumerate(found, start=1) if not each.holds]
    values = {"held": fmt.count(len(found) - len(failed)), "total": fmt.count(len(found))}
    if not failed:
        return words.text("conclusions.all", **values)
    which = words.joined(failed)
    return words.catalogue.plural("conclusions.but", len(failed), which=which, **values)


def summary(words: Words, found: Sequence[Conclusion]) -> Iterator[str]:
    """The conclusions for the terminal, a line each."""
    for number, each in enumerate(found, start=1):
        verdict = judged(words, each)
        yield f"{number}. {each.title}: {verdict if each.holds else verdict.upper()}"


def judged(words: Words, conclusion: Conclusion) -> str:
    """Holds, or does not hold."""
    return words.text("conclusions.holds" if conclusion.holds else "conclusions.fails")


def _numbers(found: Sequence[Conclusion]) -> list[str]:
    return [str(k) for k in range(1, len(found) + 1)]
