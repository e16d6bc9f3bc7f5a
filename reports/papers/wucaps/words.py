"""How the report on the second paper calls its situations, methods and control points."""

from posstats.contract.choices import ControlSubset
from posstats.papers.wucaps.experiment import Method
from posstats.papers.wucaps.situations import Situation

from ...document.catalogue import catalogue
from .. import words as papers

DOMAINS = ("document", "papers", "wucaps")


class Words(papers.Words):
    """The catalogue of the report."""

    def terrain(self, situation: Situation) -> str:
        """The terrain of a situation in the middle of a sentence."""
        return self.of("terrain", situation)

    def situation(self, situation: Situation) -> str:
        """A situation in the middle of a sentence: its terrain and scale."""
        return self.of("situation", situation)

    def situation_title(self, situation: Situation) -> str:
        """The same at the beginning of a sentence."""
        return self.of("situation_title", situation)

    def method(self, method: Method) -> str:
        """A way of orienting."""
        return self.of("method", method)

    def control(self, control: ControlSubset) -> str:
        """Which control points take part."""
        return self.of("control", control)


def words_in(language: str) -> Words:
    """The words in a language."""
    return Words(catalogue(language, *DOMAINS))
