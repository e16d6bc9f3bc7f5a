"""Angle errors over time: their lines, and what was taken off before the assessment."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from posstats.contract.results import ImageAngleErrors, Regression, Results, Selection

from ..block import line_figures
from ..block.view import angles, decided_by_strip, errors_of, used_errors
from ..document import format as fmt
from ..document.content import Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.rows import first
from ..document.table import Column, Table, count_column, number_column, p_column, text_column
from ..figures import style
from .material import Material, finished, scope_name, section
from .words import Words

SHOWN_DECISIONS = 40


def regression(material: Material) -> Part:
    """Lines over time, and the decisions that rest on them."""
    words, results = material.words, material.results
    found = filled([regression_table(words, results), decision_table(words, results)])
    text = "regression.intro" if found else "regression.none"
    pictures = known(regression_figure(words, results))
    return section(words, "regression", (Paragraph(words.text(text)), *pictures, *found))


def regression_table(words: Words, results: Results) -> Table:
    """Lines of the angle errors over time, for the block (or the strips decided by)."""
    kept = _regressions(results)
    unit = fmt.rate_unit(
        slope for row in kept for slope in (row.slope_rad_per_s, row.gls_slope_rad_per_s)
    )
    columns = (
        text_column(words.text("column.angle"), [words.known("angle", r.angle) for r in kept]),
        text_column(words.text("column.scope"), [scope_name(words, r.scope) for r in kept]),
        count_column(words.text("column.images"), [r.n for r in kept]),
        number_column(words.text("column.slope"), unit.name,
                      [unit.scaled(r.slope_rad_per_s) for r in kept], group="OLS"),
        Column("R²", tuple(fmt.fixed(r.r_squared, 3) for r in kept), group="OLS"),
        p_column("p", [r.p_value for r in kept], "OLS"),
        number_column(words.text("column.slope"), unit.name,
                      [unit.scaled(r.gls_slope_rad_per_s) for r in kept], group="GLS"),
        _slope_interval(words, kept, unit),
        p_column("p", [r.gls_p_value for r in kept], "GLS"),
    )  # fmt: skip
    note = words.text("note.regression")
    return Table("regression", words.text("table.regression"), columns, (note,))


def decision_table(words: Words, results: Results) -> Table:
    """Which angle errors were taken off before the assessment."""
    chosen = [r for r in results.selection if r.correct or not decided_by_strip(results)]
    shown = chosen[:SHOWN_DECISIONS]
    fits = [first(results.regression, angle=r.angle, frame=r.frame, scope=r.scope) for r in shown]
    r_squared = [None if fit is None else fit.r_squared for fit in fits]
    columns = (
        text_column(words.text("column.angle"), [words.known("angle", r.angle) for r in shown]),
        text_column(words.text("column.frame"), [words.known("frame", r.frame) for r in shown]),
        text_column(words.text("column.scope"), [scope_name(words, r.scope) for r in shown]),
        Column("R²", tuple(fmt.fixed(value, 3) for value in r_squared)),
        p_column("p", [_decisive_p(*both) for both in zip(shown, fits, strict=True)]),
        text_column(words.text("column.decision"), [words.of("form", r.form) for r in shown]),
    )
    notes = [words.text("note.decisions", rules=words.known("setting_value",
                                                            results.settings.rules))]  # fmt: skip
    if len(shown) < len(chosen):
        notes.append(words.text("note.decisions_shown", shown=fmt.count(len(shown)),
                                total=fmt.count(len(chosen))))  # fmt: skip
    strong = frozenset(k for k, row in enumerate(shown) if row.correct)
    strong = strong if len(strong) < len(shown) else frozenset()
    return Table("decisions", words.text("table.decisions"), columns, tuple(notes), strong)


def regression_figure(words: Words, results: Results) -> Drawing | None:
    """Errors of the three angles over time with the fitted lines, one panel each."""
    data = {a: used_errors(results, a) for a in angles(results.settings.frame)}
    shown = {angle: part for angle, part in data.items() if part}
    if not shown:
        return None
    figure = style.new_figure(1.05 * len(shown) + 0.9)
    axes = np.atleast_1d(figure.subplots(len(shown), 1, sharex=True))
    for axis, (angle, part) in zip(axes, shown.items(), strict=True):
        _angle_panel(words, axis, results, angle, part)
    axes[-1].set_xlabel(words.text("axis.time"))
    figure.align_ylabels(list(axes))
    line_figures.legend(figure, axes[0])
    return finished(words, figure, "regression_by_angle")


def _angle_panel(
    words: Words, axis: Axes, results: Results, angle: str, part: Sequence[ImageAngleErrors]
) -> None:
    errors = errors_of(part, angle)
    start = min(row.time_s for row in part)
    labels = words.text("legend.ols"), words.text("legend.gls")
    panel = line_figures.Panel(axis, fmt.angle_unit(errors), start, labels)
    lines = line_figures.fitted_lines(results, results.settings.frame, angle)
    strip = words.text("row.strip", strip="{strip}")
    line_figures.draw_errors(panel, part, angle, lines, strip)
    panel.keep_large(errors)
    panel.label(words.known("angle", angle))


def _regressions(results: Results) -> list[Regression]:
    by_strip = decided_by_strip(results)
    return [
        row for row in results.regression
        if not (row.notice or row.reason) and (row.scope == "block" or by_strip)
    ][:SHOWN_DECISIONS]  # fmt: skip


def _slope_interval(words: Words, kept: Sequence[Regression], unit: fmt.Unit) -> Column:
    bounds = [row.gls_slope_ci95 or (None, None) for row in kept]
    cells = tuple(
        words.interval(*(fmt.number(unit.scaled(each)) for each in both)) for both in bounds
    )
    return Column(words.text("column.interval"), cells, unit.name, group="GLS")


def _decisive_p(decision: Selection, fit: Regression | None) -> float | None:
    if fit is None:
        return None
    if decision.form == "constant":
        return fit.constant_p_value
    return fit.gls_p_value if decision.fit == "gls" else fit.p_value
