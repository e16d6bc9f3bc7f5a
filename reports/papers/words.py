"""The words that the reports on both papers share."""

from dataclasses import dataclass

from ..document import words as document
from ..typefaces import cjk


@dataclass(frozen=True)
class Words(document.Words):
    """A catalogue with the conclusions, angles and tables of the papers."""

    def angle(self, name: str) -> str:
        """An angle of the exterior orientation."""
        return self.of("angle", name)

    def line(self, of: str, shown: str) -> str:
        """What is shown of an area or situation."""
        return self.text("conclusions.line", of=of, shown=shown)

    def families(self) -> tuple[str, ...]:
        """Families of the texts in figures.

        Raises
        ------
        MissingFontError
            If the language needs a typeface that is not installed.
        """
        return cjk.figure_families(self.text("conclusions.title"))
