"""Accuracy at the check points: RMSE, means, percentiles and tests, whatever a profile asks."""

import math
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from posstats.arrays import Floats
from posstats.contract.acceptance import (
    Acceptance,
    Accuracy,
    JudgedRequirement,
    LargestResidual,
    MeanShift,
    Normality,
)

from ..document import format as fmt
from ..document.content import Content, Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.table import Column, Table, p_column, prose_column, text_column
from ..figures import style
from .check_points import differences_m
from .material import Material, finished, intervals, lengths, measures, section
from .words import Words

FEWEST = 5  # points that a histogram needs

_Test = tuple[str, str, str, float | None]  # name, null hypothesis, statistic, p


def accuracy(material: Material) -> Part:
    """What the check points say of the accuracy."""
    words, found = material.words, material.acceptance.accuracy
    if not found.n:
        return section(words, "accuracy", [Paragraph(words.text("accuracy.none"))])
    content: list[Content] = [Paragraph(_intro(words, found))]
    content += filled([rmse_table(words, found), mean_error_table(words, found)])
    content += filled([percentile_table(words, found)])
    content += known(histograms(words, material.acceptance))
    content += filled([significance_table(words, found)])
    return section(words, "accuracy", content)


def _intro(words: Words, found: Accuracy) -> str:
    said = [words.counted("accuracy.intro", found.n, given=fmt.count(found.n_given))]
    if found.n < found.n_given:
        said.append(words.counted("accuracy.missing", found.n_given - found.n))
    if found.survey_known:
        said.append(words.text("accuracy.survey", h=words.unit.text(found.survey_h_m),
                               v=words.unit.text(found.survey_v_m)))  # fmt: skip
    else:
        said.append(words.text("accuracy.survey_unknown"))
    return words.sentences(said)


def rmse_table(words: Words, found: Accuracy) -> Table:
    """RMSE of the check points with intervals, and of the product."""
    rows = found.rmse
    columns = (
        text_column(words.text("column.component"),
                    [words.of("component", row.component) for row in rows]),
        lengths(words, "column.rmse", [row.value_m for row in rows]),
        intervals(words, rows),
        Column(words.text("column.df"), tuple(fmt.fixed(row.df, 1) for row in rows)),
        lengths(words, "column.product", [row.product_m for row in rows]),
        measures(words, rows),
    )  # fmt: skip
    notes = (words.text("note.rmse"), words.text("note.product"))
    return Table("rmse", words.text("table.rmse"), columns, notes)


def mean_error_table(words: Words, found: Accuracy) -> Table:
    """Mean differences with their standard errors."""
    rows = found.mean_error
    columns = (
        text_column(words.text("column.component"),
                    [words.of("component", row.component) for row in rows]),
        lengths(words, "column.mean", [row.value_m for row in rows]),
        lengths(words, "column.se", [row.se_m for row in rows]),
        p_column(words.text("column.p"), [row.p for row in rows]),
        measures(words, rows),
    )  # fmt: skip
    note = words.text("note.mean")
    return Table("mean_errors", words.text("table.mean_errors"), columns, (note,))


def percentile_table(words: Words, found: Accuracy) -> Table:
    """Circular and linear errors at 90 % and 95 %."""
    rows = found.percentiles
    columns = (
        text_column(words.text("column.measure"), [row.name for row in rows]),
        text_column(words.text("column.meaning"),
                    [words.of("percentile", row.name) for row in rows]),
        lengths(words, "column.value", [row.value_m for row in rows]),
        intervals(words, rows),
        lengths(words, "column.normal", [row.normal_m for row in rows]),
        measures(words, rows),
    )  # fmt: skip
    note = words.text("note.percentiles")
    return Table("percentiles", words.text("table.percentiles"), columns, (note,))


def significance_table(words: Words, found: Accuracy) -> Table:
    """Tests on the differences, each with its null hypothesis in words."""
    rows = [_mean_shift(words, found.mean_shift)]
    rows += [_normality(words, row) for row in found.normality]
    rows += [_largest(words, row) for row in found.largest_residual]
    names, null, statistic, p = zip(*rows, strict=True)
    columns = (
        text_column(words.text("column.test"), names),
        prose_column(words.text("column.null"), null),
        text_column(words.text("column.statistic"), statistic),
        p_column(words.text("column.p"), p),
    )
    return Table("tests", words.text("table.tests"), columns, (words.text("note.tests"),))


def histograms(words: Words, acceptance: Acceptance) -> Drawing | None:
    """Differences by component with the normal curve that would just meet the limit."""
    differences = differences_m(acceptance.check_points)
    if len(differences) < FEWEST:
        return None
    figure = style.new_figure(2.35)
    allowed = _allowed_sigmas(acceptance.requirements)
    for k, axis in enumerate(figure.subplots(1, 3, sharey=True)):
        _histogram(words, axis, differences[:, k], allowed[k])
        axis.set_xlabel(f"Δ{'XYZ'[k]}, {words.unit.unit.name}")
        if k == 0:
            axis.set_ylabel(words.text("axis.points"))
    style.legend_below(figure, axis, 3)
    return finished(words, figure, "histograms")


def _untestable(words: Words, reason: str | None) -> str:
    return words.known("untestable", reason or "")


def _mean_shift(words: Words, row: MeanShift) -> _Test:
    statistic = (
        _untestable(words, row.reason) if row.p is None
        else words.text("statistic.mean_shift", t2=fmt.number(row.t2), f=fmt.number(row.f),
                        df1=fmt.count(row.df1), df2=fmt.count(row.df2))
    )  # fmt: skip
    return words.text("test.mean_shift"), words.text("null.mean_shift"), statistic, row.p


def _normality(words: Words, row: Normality) -> _Test:
    component = words.of("component", row.component)
    statistic = (
        _untestable(words, row.reason) if row.p is None
        else words.text("statistic.normality", w=fmt.fixed(row.w, 3))
    )  # fmt: skip
    null = words.text("null.normality", component=component)
    return words.text("test.normality", component=component), null, statistic, row.p


def _largest(words: Words, row: LargestResidual) -> _Test:
    component = words.of("component", row.component)
    statistic = (
        _untestable(words, row.reason) if row.p is None
        else words.text("statistic.largest", value=words.unit.text(row.value_m),
                        point=str(row.point))
    )  # fmt: skip
    null = words.text("null.largest", component=component)
    return words.text("test.largest", component=component), null, statistic, row.p


def _allowed_sigmas(rows: Sequence[JudgedRequirement]) -> list[float | None]:
    """Standard deviation per component of normal errors without mean that just meet the class."""
    limits = {row.quantity: row.limit for row in rows if row.limit}
    plane = limits.get("rmse_h") or limits.get("product_rmse_h")
    height = limits.get("rmse_v") or limits.get("product_rmse_v")
    side = plane / math.sqrt(2.0) if plane else None
    return [side, side, height or None]


def _histogram(words: Words, axis: Axes, values_m: Floats, sigma_m: float | None) -> None:
    per_si = words.unit.unit.per_si
    shown, sigma = values_m * per_si, (sigma_m or 0.0) * per_si
    reach = max(float(np.abs(shown).max()), 2.2 * sigma, 1e-9)
    edges = np.linspace(-reach, reach, 2 * max(4, math.ceil(math.sqrt(len(shown)))) + 1)
    axis.hist(shown, edges.tolist(), color=style.SKY, edgecolor="white", lw=0.5,
              label=words.text("legend.differences"))  # fmt: skip
    if sigma:
        grid = np.linspace(-reach, reach, 121)
        density = np.exp(-0.5 * (grid / sigma) ** 2) / (sigma * math.sqrt(2.0 * math.pi))
        axis.plot(grid, len(shown) * (edges[1] - edges[0]) * density, color=style.BLACK, lw=1.2,
                  label=words.text("legend.allowed"))  # fmt: skip
    axis.axvline(float(shown.mean()), color=style.VERMILLION, ls="--", lw=1.2,
                 label=words.text("legend.mean"))  # fmt: skip
    axis.xaxis.set_major_locator(MaxNLocator(5, symmetric=True))
    axis.yaxis.set_major_locator(MaxNLocator(5, integer=True))
