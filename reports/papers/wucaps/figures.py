"""The figures of the report on the second paper: plan of the blocks, accuracies by method."""

from collections.abc import Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter

from posstats.contract.choices import ControlSubset
from posstats.papers.wucaps.adjustments import CONTROLS, control_points
from posstats.papers.wucaps.experiment import METHODS as ALL_METHODS
from posstats.papers.wucaps.experiment import Method, Row, SituationRun
from posstats.papers.wucaps.findings import RECOMMENDED
from posstats.papers.wucaps.reproduction import Reproduction

from ...document import format as fmt
from ...document.drawing import Drawing
from ...figures import style
from .words import CONTROL, METHODS, SITUATIONS

_LOOK: dict[ControlSubset | None, tuple[str, str]] = {
    None: (style.BLACK, "o"),
    "none": (style.VERMILLION, "v"),
    "centre": (style.ORANGE, "D"),
    "corners": (style.BLUE, "s"),
    "all": (style.GREEN, "^"),
}
_DIRECT_LABEL = "direct georeferencing"
_SHOWN: tuple[Method, ...] = tuple(m for m in ALL_METHODS if m != "reference")


def plan(run: Reproduction) -> Drawing:
    """Projection centres, control and check points of both blocks, on a kilometre grid."""
    with style.style():
        figure = style.new_figure(2.6)
        axes = figure.subplots(1, 2)
        for axis, each in zip(axes, run.runs.values(), strict=True):
            _plan(axis, each)
        style.legend_below(figure, axes[0], 5)
        caption = (
            "The simulated blocks from above: projection centres, the control points from which "
            "the variants choose (filled: the central one and the four at the corners), and the "
            "check points, which never take part in an adjustment."
        )
        return style.finish(figure, "wucaps_plan", "Plan of the two simulated blocks", caption)


def _plan(axis: Axes, run: SituationRun) -> None:
    block = run.flights.flight
    surveyed = block.ground_points
    if surveyed is None or block.adjusted is None:
        return
    centres = block.adjusted.position_m / 1e3
    ground = surveyed.position_m / 1e3
    axis.plot(*centres[:, :2].T, label="projection centre", **style.dots(style.GREY, 1.8))
    axis.plot(*ground[surveyed.is_check, :2].T, ls="", marker="x", ms=3.0, mew=0.7,
              color=style.SKY, label="check point")  # fmt: skip
    kinds: tuple[tuple[ControlSubset, str, bool], ...] = (
        ("all", "control point", False),
        ("corners", "corner", True),
        ("centre", "centre", True),
    )
    for control, label, filled in kinds:
        colour, marker = _LOOK[control]
        places = ground[control_points(block, control), :2]
        axis.plot(*places.T, ls="", marker=marker, ms=4.5, mew=0.8, mec=colour,
                  mfc=colour if filled else "none", label=label)  # fmt: skip
    axis.set_aspect("equal", adjustable="datalim")
    axis.set_title(SITUATIONS[run.situation], loc="left")
    axis.set_xlabel("east, km")
    axis.set_ylabel("north, km")


def accuracies(run: SituationRun) -> Drawing:
    """RMSE of the check points by method and control, and what the covariance predicts."""
    with style.style():
        figure = style.new_figure(3.9)
        axes = figure.subplots(1, 2, sharey=True)
        for axis, side in zip(axes, ("horizontal", "vertical"), strict=True):
            _accuracies(axis, run, side)
        axes[0].set_yticks(range(len(_SHOWN)), [METHODS[method] for method in _SHOWN])
        axes[0].invert_yaxis()
        handles, labels = axes[0].get_legend_handles_labels()
        unique = dict(zip(labels, handles, strict=True))
        figure.legend(unique.values(), unique.keys(), loc="outside lower center", ncols=4)
        name = SITUATIONS[run.situation]
        caption = (
            f"{name.capitalize()}: RMSE of the check points by method and control points "
            "(logarithmic scale). A stroke is what the standard deviations predict; the line is "
            "the bundle without systematic errors and with all control points."
        )
        title = f"Accuracy at check points, {name}"
        return style.finish(figure, f"wucaps_accuracy_{run.situation}", title, caption)


def _accuracies(axis: Axes, run: SituationRun, side: str) -> None:
    values = []
    for row, height in _places(run):
        if row.measures is None:
            continue
        colour, marker = _LOOK[row.control]
        label = _DIRECT_LABEL if row.control is None else f"control: {CONTROL[row.control]}"
        rmse = getattr(row.measures, f"{side}_m")
        predicted = getattr(row.measures, f"predicted_{side}_m")
        axis.plot([rmse, predicted], [height, height], color=style.LIGHT, lw=0.8, zorder=1)
        axis.plot(predicted, height, ls="", marker="|", ms=6.0, mew=1.0, color=colour)
        axis.plot(rmse, height, ls="", marker=marker, ms=3.6, color=colour, label=label)
        values += [rmse, predicted]
    reference = getattr(run.measures("reference", "all"), f"{side}_m")
    axis.axvline(reference, color=style.GREY, lw=0.8, zorder=0, label="no systematic errors")
    axis.set_xscale("log")
    axis.set_xlim(min(*values, reference) / 1.4, max(values) * 1.4)
    many = max(values) / min(values) > 50.0
    axis.xaxis.set_major_locator(LogLocator(subs=(1.0,) if many else (1.0, 2.0, 5.0), numticks=20))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: fmt.number(value, 1)))
    axis.xaxis.set_minor_formatter(NullFormatter())
    axis.grid(axis="x")
    axis.tick_params(axis="y", length=0)
    axis.set_xlabel(f"{side} RMSE, m")


def _places(run: SituationRun) -> Iterator[tuple[Row, float]]:
    """Rows with their place on the axis: a method's control variants one below the other."""
    for row in run.rows:
        if row.method in _SHOWN:
            step = 0.0 if row.control is None else 0.18 * (CONTROLS.index(row.control) - 1.5)
            yield row, _SHOWN.index(row.method) + step


def parallax(run: Reproduction) -> Drawing:
    """Parallax of the models by method, with the recommended control."""
    with style.style():
        figure = style.new_figure(2.7)
        axes = figure.subplots(1, 2, sharey=True)
        for axis, each in zip(axes, run.runs.values(), strict=True):
            _parallax(axis, each)
        axes[0].set_yticks(range(len(_SHOWN)), [METHODS[method] for method in _SHOWN])
        axes[0].invert_yaxis()
        caption = (
            "Mean RMS y-parallax of the stereo models at image scale (logarithmic), bundle "
            "adjustments with the control that the paper recommends. The line is what relative "
            "orientation leaves."
        )
        title = "Parallax of the models by method"
        return style.finish(figure, "wucaps_parallax", title, caption)


def _parallax(axis: Axes, run: SituationRun) -> None:
    recommended = RECOMMENDED[run.situation]
    shown = [
        row
        for row in run.rows
        if row.method in _SHOWN and row.control in (None, recommended) and row.measures
    ]
    heights = [_SHOWN.index(row.method) for row in shown]
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
    axis.set_title(SITUATIONS[run.situation], loc="left")
    axis.set_xlabel("mean RMS y-parallax, µm")
