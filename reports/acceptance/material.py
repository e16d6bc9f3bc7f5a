"""What the topics of an acceptance document are written from, and the forms that they share."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

from matplotlib.figure import Figure

from posstats.contract.acceptance import Acceptance, MeanError, PercentileError, Rmse
from posstats.contract.results import Results
from posstats.contract.survey import InputFile

from ..document.content import Content, Paragraph, Part
from ..document.drawing import Drawing
from ..document.table import Column, Table, count_column, text_column
from ..figures import style
from .words import Words


@dataclass(frozen=True)
class Material:
    """The data of a document with its words; `unshown` are letters that no typeface shows."""

    words: Words
    acceptance: Acceptance
    results: Results
    unshown: str = ""


Topic = Callable[[Material], Part]


def section(words: Words, name: str, content: Iterable[Content]) -> Part:
    """A topic by its name, which is also its anchor."""
    return Part(name.replace("_", "-"), words.text(f"section.{name}"), tuple(content))


def led(words: Words, family: str, names: Iterable[str]) -> list[Content]:
    """Paragraphs with a word before each that says what it is about."""
    return [Paragraph(words.of(family, name), words.of(f"{family}_lead", name)) for name in names]


def finished(words: Words, figure: Figure, name: str) -> Drawing:
    """A figure with its title and caption."""
    return style.finish(
        figure, name, words.text(f"figure_title.{name}"), words.text(f"figure.{name}")
    )


def lengths(words: Words, title: str, values_m: Sequence[float | None]) -> Column:
    """A column of accuracies."""
    cells = tuple(words.unit.number(value) for value in values_m)
    return Column(words.text(title), cells, words.unit.unit.name)


def intervals(words: Words, rows: Sequence[Rmse | PercentileError]) -> Column:
    """A column of confidence intervals."""
    bounds = [(words.unit.number(row.low_m), words.unit.number(row.high_m)) for row in rows]
    cells = tuple(words.interval(*both) for both in bounds)
    return Column(words.text("column.interval"), cells, words.unit.unit.name)


def measures(words: Words, rows: Sequence[Rmse | MeanError | PercentileError]) -> Column:
    """A column of the measures of ISO 19157."""
    return count_column(words.text("column.iso"), [row.iso_19157 for row in rows])


def file_table(words: Words, name: str, listed: Sequence[InputFile], *others: Column) -> Table:
    """Files with their SHA-256; `name` is ``inputs``, ``rules`` or ``attachments``."""
    columns = (
        text_column(words.text("column.file"), [each.file for each in listed]),
        *others,
        text_column("SHA-256", [each.sha256 for each in listed]),
    )
    return Table(f"{name}_files", words.text(f"table.{name}"), columns)


def scope_name(words: Words, scope: str) -> str:
    """The block or a strip in words."""
    return words.text("row.block") if scope == "block" else words.text("row.strip", strip=scope)
