"""Requirements: found values held against their limits, in numbers, in words and drawn."""

from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter

from posstats.contract.acceptance import JudgedRequirement

from ..document import format as fmt
from ..document.content import Content, Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.table import Column, Table, pairs, prose_column, text_column
from ..figures import style
from . import units
from .material import Material, finished, section
from .words import Words, evidence, product

MAX_SHARE = 2.0  # of a limit; beyond it a value is drawn at the edge
TITLE_LETTERS = 48

_LOOKS = {"pass": (style.BLUE, "o"), "fail": (style.VERMILLION, "X"),
          "not assessed": (style.GREY, "D")}  # fmt: skip


def requirements(material: Material) -> Part:
    """Every requirement with its verdict, and what was agreed."""
    words, acceptance = material.words, material.acceptance
    rows, grade = acceptance.requirements, acceptance.quality_grade
    content: list[Content] = [Paragraph(words.text("requirements.intro"))]
    content += filled([requirement_table(words, rows), evidence_table(words, rows)])
    content += known(shares_of_limits(words, rows))
    if grade is not None:
        content.append(Paragraph(words.text(
            "requirements.grade", grade=words.of("grade", grade.grade),
            score=fmt.fixed(grade.score, 1))))  # fmt: skip
    if acceptance.profile.omitted:
        omitted = words.joined(acceptance.profile.omitted)
        content.append(Paragraph(words.text("requirements.omitted", ids=omitted)))
    titles = words.text("column.item"), words.text("column.stated")
    agreed = product(words, acceptance.product)
    content += filled([pairs("product", words.text("table.product"), titles, agreed)])
    return section(words, "requirements", content)


def short_table(words: Words, rows: Sequence[JudgedRequirement]) -> Table:
    """Name, found value, limit and verdict of every requirement, for the first page."""
    columns = (
        text_column(words.text("column.requirement"), words.requirements(rows)),
        *_found_and_limit(words, rows),
        _verdicts(words, rows),
    )
    return Table("requirements_in_short", words.text("table.requirements_in_short"), columns)


def requirement_table(words: Words, rows: Sequence[JudgedRequirement]) -> Table:
    """Every requirement in numbers."""
    names, between = words.requirements(rows), words.text("interval.between")
    columns = (
        text_column(words.text("column.clause"), [row.clause or None for row in rows]),
        text_column(words.text("column.requirement"), names),
        *_found_and_limit(words, rows),
        Column(words.text("column.margin"), tuple(units.margin(r, words.unit) for r in rows)),
        Column(words.text("column.interval"),
               tuple(units.interval(r, words.unit, between) for r in rows)),
        _verdicts(words, rows),
    )  # fmt: skip
    notes = [words.text("note.margin"), words.text("note.interval")]
    optional = [name for name, row in zip(names, rows, strict=True) if not row.mandatory]
    if optional:
        notes.append(words.text("note.optional", names=words.listed(optional)))
    return Table("requirements", words.text("table.requirements"), columns, tuple(notes))


def evidence_table(words: Words, rows: Sequence[JudgedRequirement]) -> Table:
    """Why each requirement has its verdict, and where its limit comes from."""
    columns = (
        text_column(words.text("column.requirement"), words.requirements(rows)),
        prose_column(words.text("column.evidence"), [evidence(words, row) for row in rows]),
        prose_column(words.text("column.source"), [_source(words, row) for row in rows]),
    )
    return Table("evidence", words.text("table.evidence"), columns)


def shares_of_limits(words: Words, rows: Sequence[JudgedRequirement]) -> Drawing | None:
    """Found values with their intervals as shares of their limits; those with an upper limit."""
    named = zip(words.requirements(rows), rows, strict=True)
    shown = [(name, row, limit) for name, row in named if (limit := _upper_limit(row))]
    if not shown:
        return None
    figure = style.new_figure(0.7 + 0.2 * len(shown))
    axis = figure.add_subplot()
    for place, (_, row, limit) in enumerate(shown):
        _draw_share(axis, place, row, limit)
    axis.axvline(1.0, color=style.BLACK, lw=1.2)
    axis.set_yticks(range(len(shown)), [fmt.shortened(name, TITLE_LETTERS) for name, _, _ in shown])
    axis.set(xlim=(0.0, MAX_SHARE), ylim=(len(shown) - 0.4, -0.6))
    axis.set_xlabel(words.text("axis.share"))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:.0f}\u00a0%"))
    axis.tick_params(axis="y", length=0)
    axis.grid(axis="x")
    return finished(words, figure, "shares")


def _found_and_limit(words: Words, rows: Sequence[JudgedRequirement]) -> tuple[Column, Column]:
    return (
        Column(words.text("column.found"), tuple(units.pair(r, words.unit)[0] for r in rows)),
        Column(words.text("column.limit"), tuple(units.limit(r, words.unit) for r in rows)),
    )


def _verdicts(words: Words, rows: Sequence[JudgedRequirement]) -> Column:
    said = [words.marked("finding", row.verdict) for row in rows]
    return text_column(words.text("column.verdict"), said)


def _source(words: Words, row: JudgedRequirement) -> str:
    if not any(letter.isalpha() for letter in row.limit_formula):
        return row.source
    return words.text("source.with_formula", source=row.source, formula=row.limit_formula)


def _upper_limit(row: JudgedRequirement) -> float | None:
    """The limit of a requirement that has one above zero and a found value below or beyond it."""
    if row.found is None or row.limit is None or row.quantity in units.AT_LEAST:
        return None
    return row.limit if row.limit > 0.0 else None


def _draw_share(axis: Axes, place: int, row: JudgedRequirement, limit: float) -> None:
    """One found value with its interval, at the edge with an arrow where it lies beyond."""
    colour, marker = _LOOKS[row.verdict]
    found = (row.found or 0.0) / limit
    if row.low is not None and row.high is not None:
        ends = [min(bound / limit, MAX_SHARE) for bound in (row.low, row.high)]
        axis.plot(ends, [place, place], color=colour, lw=2.4, alpha=0.45, solid_capstyle="butt")
    inside = min(found, 0.985 * MAX_SHARE)
    axis.plot([inside], [place], marker if inside == found else ">", color=colour, ms=6.0,
              mec="white", mew=0.6)  # fmt: skip
