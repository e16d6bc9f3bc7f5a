"""Tables of regressions: one strip beside Table 3, the lines of all strips and blocks."""

from collections.abc import Callable, Mapping

from posstats.contract.comparison import Compared
from posstats.papers.drift.findings import known
from posstats.papers.drift.reproduction import Reproduction

from ...document import format as fmt
from ...document.rows import rows
from ...document.table import Column, Table, count_column, number_column, p_column, text_column
from .columns import SOURCES, Source, cell, compared
from .words import Words


def one_strip(words: Words, run: Reproduction) -> Table:
    """Table 3: published beside strip 1 of area 1."""
    angles = list(dict.fromkeys(str(each.angle) for each in compared(run, 3)))
    by_angle = {
        angle: {each.quantity: each for each in compared(run, 3, angle=angle)} for angle in angles
    }
    listed = [(angle, source) for angle in angles for source in SOURCES]

    def column(title: str, quantity: str, shown: Callable[[float | None], str]) -> Column:
        cells = [cell(source, by_angle[angle][quantity], shown) for angle, source in listed]
        return Column(title, tuple(cells))

    columns = (
        text_column(words.text("angle_column.title"), [words.angle(angle) for angle, _ in listed]),
        text_column("", [words.of("source", source) for _, source in listed]),
        text_column(
            words.text("one_strip.line"),
            [_equation(source, by_angle[angle]) for angle, source in listed],
        ),
        column("R²", "r_squared", lambda value: fmt.fixed(value, 4)),
        column("F₀", "f_statistic", _statistic),
        column("p", "p_value", _probability),
    )
    notes = (words.text("one_strip.note_time"), words.text("one_strip.note_test"))
    together = (len(SOURCES),) * len(angles)
    return Table("one_strip", words.text("one_strip.caption"), columns, notes, together=together)


def _equation(source: Source, found: Mapping[str, Compared]) -> str:
    intercept, slope = found["intercept"], found["slope_per_t"]
    if source == "ratio":
        return fmt.MISSING
    if source == "published":
        return f"{fmt.as_printed(intercept.published)} + {fmt.as_printed(slope.published)} t"
    if intercept.reproduced is None or slope.reproduced is None:
        return fmt.MISSING
    unit, rate = fmt.angle_unit([intercept.reproduced]), fmt.NANORADIAN_PER_SECOND
    constant = fmt.with_unit(unit.scaled(intercept.reproduced), unit.name)
    return f"{constant} + {fmt.with_unit(rate.scaled(slope.reproduced), rate.name)} t"


def lines(words: Words, run: Reproduction) -> Table:
    """Regressions of all angles, of every block and strip."""
    made = [(area, row) for area, results in run.results.items()
            for row in rows(results.regression, frame="ground")]  # fmt: skip
    unit, rate = fmt.MICRORADIAN, fmt.NANORADIAN_PER_SECOND
    scopes = [words.text("lines.block") if r.scope == "block" else r.scope for _, r in made]
    columns = (
        text_column(words.text("area.column"), [str(area) for area, _ in made]),
        text_column(words.text("lines.scope"), scopes),
        text_column(words.text("angle_column.title"), [words.angle(row.angle) for _, row in made]),
        count_column("n", [row.n for _, row in made]),
        number_column("a₀", unit.name, [unit.scaled(row.intercept_rad) for _, row in made]),
        number_column("a₁", rate.name, [rate.scaled(row.slope_rad_per_s) for _, row in made]),
        Column("R²", tuple(_r_squared(known(row.r_squared)) for _, row in made)),
        Column("F₀", tuple(_statistic(row.f_statistic) for _, row in made)),
        p_column("p", [row.p_value for _, row in made]),
        p_column("GLS p", [row.gls_p_value for _, row in made]),
    )
    block = frozenset(k for k, (_, row) in enumerate(made) if row.scope == "block")
    notes = (words.text("lines.note"),)
    return Table("lines", words.text("lines.caption"), columns, notes, block)


def _r_squared(value: float) -> str:
    return "< 0.0001" if value < 1e-4 else fmt.fixed(value, 4)


def _statistic(value: float | None) -> str:
    return fmt.fixed(value, 4) if value is not None and abs(value) < 10.0 else fmt.number(value, 5)


def _probability(value: float | None) -> str:
    return fmt.fixed(value, 4) if value is not None and value >= 5e-5 else "< 0.0001"
