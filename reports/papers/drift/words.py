"""The words of the report on the first paper."""

from collections.abc import Iterable

from posstats.papers.drift.findings import AreaFindings

from ...document.catalogue import catalogue
from .. import words as papers

DOMAINS = ("document", "papers", "drift_paper")


class Words(papers.Words):
    """The catalogue of the report."""

    def area(self, area: int) -> str:
        """An area in the middle of a sentence."""
        return self.text("area.nth", area=str(area))

    def areas(self, areas: Iterable[int]) -> str:
        """Several areas in the middle of a sentence."""
        return self.text("area.several", areas=self.joined(map(str, areas)))

    def area_title(self, area: int) -> str:
        """An area at the head of a column."""
        return self.text("area.title", area=str(area))

    def angles(self, found: AreaFindings) -> str:
        """The angles that were corrected."""
        return self.joined(map(self.angle, filter(None, found.corrected_angles.split("+"))))


def words_in(language: str) -> Words:
    """The words in a language."""
    return Words(catalogue(language, *DOMAINS))
