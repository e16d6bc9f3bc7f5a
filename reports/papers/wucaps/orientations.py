"""Topic: orientations against truth, and parallax of the models."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from posstats.papers.wucaps.experiment import SituationRun
from posstats.papers.wucaps.findings import RECOMMENDED
from posstats.papers.wucaps.reproduction import Reproduction

from ...document import format as fmt
from ...document.content import Paragraph, Part
from ...document.drawing import Drawing
from ...document.table import Column, Table
from ...figures import style
from .columns import metres, names, references, values
from .look import SHOWN
from .report import Report
from .words import Words

MICROMETRE = fmt.Unit("µm", 1e3)  # of values in mm
MILLIDEGREE = fmt.Unit("0.001°", float(np.degrees(1e3)))


def topic(words: Words, report: Report) -> Part:
    """A table of each situation, and the parallax of both."""
    run = report.run
    return Part(
        "orientations",
        words.text("orientations.title"),
        (
            Paragraph(words.text("orientations.text")),
            *(table(words, each) for each in run.runs.values()),
            figure(words, run),
        ),
    )


def table(words: Words, run: SituationRun) -> Table:
    """RMSE of the orientations against truth, and parallax of the models."""
    shown = run.rows
    centre = words.text("orientations.centre")
    columns = (
        *names(words, shown),
        metres(words.text("side.h"), values(shown, lambda m: m.position_horizontal_m), centre),
        metres(words.text("side.v"), values(shown, lambda m: m.position_vertical_m), centre),
        _one_decimal(words.angle("omega"), values(shown, lambda m: m.omega_rad), MILLIDEGREE),
        _one_decimal(words.angle("phi"), values(shown, lambda m: m.phi_rad), MILLIDEGREE),
        _one_decimal(words.angle("kappa"), values(shown, lambda m: m.kappa_rad), MILLIDEGREE),
        _one_decimal(
            words.text("orientations.parallax"), values(shown, lambda m: m.parallax_mm), MICROMETRE
        ),
    )
    caption = words.text(
        "orientations.caption",
        situation=words.situation_title(run.situation),
        left=fmt.fixed(1e3 * run.relative_mm, 1),
    )
    notes = (words.text("method_notes.text"),)
    return Table(f"orientations_{run.situation}", caption, columns, notes, references(shown))


def _one_decimal(title: str, found: Sequence[float | None], unit: fmt.Unit) -> Column:
    return Column(title, tuple(fmt.fixed(unit.scaled(value), 1) for value in found), unit.name)


def figure(words: Words, run: Reproduction) -> Drawing:
    """Parallax of the models by method, with the recommended control."""
    with style.style(words.families()):
        made = style.new_figure(2.7)
        axes = made.subplots(1, 2, sharey=True)
        for axis, each in zip(axes, run.runs.values(), strict=True):
            _parallax(words, axis, each)
        axes[0].set_yticks(range(len(SHOWN)), [words.method(method) for method in SHOWN])
        axes[0].invert_yaxis()
        title, caption = words.text("parallax.title"), words.text("parallax.caption")
        return style.finish(made, "wucaps_parallax", title, caption)


def _parallax(words: Words, axis: Axes, run: SituationRun) -> None:
    recommended = RECOMMENDED[run.situation]
    shown = [
        row
        for row in run.rows
        if row.method in SHOWN and row.control in (None, recommended) and row.measures
    ]
    heights = [SHOWN.index(row.method) for row in shown]
    micrometres = np.array([1e3 * row.measures.parallax_mm for row in shown if row.measures])
    least = 1e3 * run.relative_mm
    axis.set_xscale("log")
    start = least / 2.0
    axis.barh(heights, micrometres - start, 0.6, left=start, color=style.BLUE)
    axis.axvline(least, color=style.BLACK, lw=0.8)
    for height, value in zip(heights, micrometres, strict=True):
        axis.text(1.1 * value, height, fmt.number(float(value), 2), va="center", fontsize=7.5)
    axis.set_xlim(start, micrometres.max() * 2.5)
    axis.xaxis.set_major_locator(LogLocator(subs=(1.0,), numticks=20))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: fmt.number(value, 1)))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.tick_params(axis="y", length=0)
    axis.set_title(words.situation(run.situation), loc="left")
    axis.set_xlabel(words.text("parallax.axis"))
