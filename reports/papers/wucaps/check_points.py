"""Topic: accuracy at check points, by method and control."""

from collections.abc import Iterator

from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from posstats.papers.wucaps.adjustments import CONTROLS
from posstats.papers.wucaps.experiment import Row, SituationRun

from ...document import format as fmt
from ...document.content import Content, Paragraph, Part
from ...document.drawing import Drawing
from ...document.table import Column, Table
from ...figures import style
from .columns import metres, names, references, values
from .look import LOOK, SHOWN
from .report import Report
from .words import Words


def topic(words: Words, report: Report) -> Part:
    """Figure and table of each situation."""
    content: list[Content] = [Paragraph(words.text("check_points.text"))]
    for each in report.run.runs.values():
        content += [figure(words, each), table(words, each)]
    return Part("check-points", words.text("check_points.title"), tuple(content))


def table(words: Words, run: SituationRun) -> Table:
    """RMSE of the check points by every method."""
    best = run.measures("reference", "all")
    shown = run.rows
    horizontal, vertical = words.text("side.h"), words.text("side.v")
    rmse, predicted = words.text("check_points.rmse"), words.text("check_points.predicted")
    over = words.text("check_points.over_reference")
    columns = (
        *names(words, shown),
        metres(horizontal, values(shown, lambda m: m.horizontal_m), rmse),
        metres(vertical, values(shown, lambda m: m.vertical_m), rmse),
        metres(horizontal, values(shown, lambda m: m.predicted_horizontal_m), predicted),
        metres(vertical, values(shown, lambda m: m.predicted_vertical_m), predicted),
        _times(horizontal, values(shown, lambda m: m.horizontal_m / best.horizontal_m), over),
        _times(vertical, values(shown, lambda m: m.vertical_m / best.vertical_m), over),
    )
    situation = words.situation_title(run.situation)
    caption = words.text("check_points.caption", situation=situation)
    notes = (words.text("method_notes.text"), words.text("check_points.note"))
    return Table(f"check_points_{run.situation}", caption, columns, notes, references(shown))


def _times(title: str, ratios: list[float | None], group: str) -> Column:
    return Column(title, tuple(fmt.fixed(ratio, 2) for ratio in ratios), group=group)


def figure(words: Words, run: SituationRun) -> Drawing:
    """RMSE of the check points by method and control, and what the covariance predicts."""
    with style.style(words.families()):
        made = style.new_figure(3.9)
        axes = made.subplots(1, 2, sharey=True)
        for axis, side in zip(axes, ("horizontal", "vertical"), strict=True):
            _accuracies(words, axis, run, side)
        axes[0].set_yticks(range(len(SHOWN)), [words.method(method) for method in SHOWN])
        axes[0].invert_yaxis()
        handles, labels = axes[0].get_legend_handles_labels()
        unique = dict(zip(labels, handles, strict=True))
        made.legend(unique.values(), unique.keys(), loc="outside lower center", ncols=4)
        title = words.text("accuracy.title", situation=words.situation(run.situation))
        caption = words.text("accuracy.caption", situation=words.situation_title(run.situation))
        return style.finish(made, f"wucaps_accuracy_{run.situation}", title, caption)


def _accuracies(words: Words, axis: Axes, run: SituationRun, side: str) -> None:
    drawn = []
    for row, height in _places(run):
        if row.measures is None:
            continue
        colour, marker = LOOK[row.control]
        rmse = getattr(row.measures, f"{side}_m")
        predicted = getattr(row.measures, f"predicted_{side}_m")
        axis.plot([rmse, predicted], [height, height], color=style.LIGHT, lw=0.8, zorder=1)
        axis.plot(predicted, height, ls="", marker="|", ms=6.0, mew=1.0, color=colour)
        axis.plot(rmse, height, ls="", marker=marker, ms=3.6, color=colour,
                  label=_label(words, row))  # fmt: skip
        drawn += [rmse, predicted]
    reference = getattr(run.measures("reference", "all"), f"{side}_m")
    axis.axvline(reference, color=style.GREY, lw=0.8, zorder=0,
                 label=words.text("accuracy.reference"))  # fmt: skip
    _logarithmic(axis, [*drawn, reference])
    axis.grid(axis="x")
    axis.tick_params(axis="y", length=0)
    axis.set_xlabel(words.text(f"accuracy.{side}"))


def _label(words: Words, row: Row) -> str:
    if row.control is None:
        return words.text("accuracy.direct")
    return words.text("accuracy.control", control=words.control(row.control))


def _logarithmic(axis: Axes, shown: list[float]) -> None:
    axis.set_xscale("log")
    axis.set_xlim(min(shown) / 1.4, max(shown) * 1.4)
    many = max(shown) / min(shown) > 50.0
    axis.xaxis.set_major_locator(LogLocator(subs=(1.0,) if many else (1.0, 2.0, 5.0), numticks=20))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: fmt.number(value, 1)))
    axis.xaxis.set_minor_formatter(NullFormatter())


def _places(run: SituationRun) -> Iterator[tuple[Row, float]]:
    """Rows with their place on the axis: a method's control variants one below the other."""
    for row in run.rows:
        if row.method in SHOWN:
            step = 0.0 if row.control is None else 0.18 * (CONTROLS.index(row.control) - 1.5)
            yield row, SHOWN.index(row.method) + step
