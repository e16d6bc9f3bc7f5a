"""What the topics of the report on the first paper are made of."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from posstats.papers.drift.reproduction import Reproduction

from ...document.content import Labelled, Paragraph, Part
from ...document.drawing import Drawing
from ..conclusion import Conclusion


@dataclass(frozen=True, eq=False)
class Report:
    """The three areas beside the published tables, conclusions, Figures 1, 2 and 3 by area."""

    run: Reproduction
    conclusions: Sequence[Conclusion]
    figures: Mapping[int, Sequence[Drawing]]

    def bars_topic(self, name: str, number: int, said: tuple[str, str], numbers: Labelled) -> Part:
        """The topic of a figure with bars: title and text, the figure by area, its numbers."""
        title, text = said
        return Part(name, title, (Paragraph(text), *self.lettered(number), numbers))

    def lettered(self, number: int) -> list[Labelled]:
        """A figure of the paper for every area: 1a, 1b, 1c."""
        return [
            Labelled(f"{number}{letter}", drawings[number - 1])
            for letter, drawings in zip("abc", self.figures.values(), strict=True)
        ]
