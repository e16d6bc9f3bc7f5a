"""Figures of the acceptance document, their words from its catalogue."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import FuncFormatter, MaxNLocator

from posstats.arrays import Floats
from posstats.contract.results import ImageAngleErrors, ModelParallax, Results

from ..block import line_figures as figure_regression
from ..block import plan_figures as figure_plan
from ..block.bar_figures import Bars, bar_figure
from ..block.view import angles, strips_with_models
from ..document import format as fmt
from ..document.drawing import Drawing
from ..document.rows import rows
from ..figures import style
from ..figures.plan_view import (
    PlanView,
    arrow_scale,
    difference_arrows,
    many_arrows,
    north_and_scale,
    scale_arrow,
    view_around,
)
from ..typefaces import cjk
from . import units
from .evidence import parallax_series
from .units import Row
from .words import Words

MAX_SHARE = 2.0  # of a limit; beyond it a value is drawn at the edge
FEWEST = 5  # points that a histogram needs
TITLE_LETTERS = 48
PLAN_WIDTH_IN, PLAN_HEIGHT_IN = 5.2, 4.6
CROWDED = 60  # points from which their arrows are drawn smaller

_LOOKS = {"pass": (style.BLUE, "o"), "fail": (style.VERMILLION, "X"),
          "not assessed": (style.GREY, "D")}  # fmt: skip


def draw(words: Words, acceptance: Mapping[str, Any], results: Results) -> dict[str, Drawing]:
    """Every figure that the data allow, by name."""
    with style.style(_families(acceptance, results)):
        drawings = [
            shares_of_limits(words, acceptance),
            histograms(words, acceptance),
            point_plan(words, acceptance, results),
            parallax(words, results, acceptance["orientation"]),
            regression(words, results),
        ]
    return {drawing.name: drawing for drawing in drawings if drawing}


def shares_of_limits(words: Words, acceptance: Mapping[str, Any]) -> Drawing | None:
    """Found values with their intervals as shares of their limits; those with an upper limit."""
    named = zip(
        words.requirements(acceptance["requirements"]), acceptance["requirements"], strict=True
    )
    shown = [(name, row) for name, row in named if _has_share(row)]
    if not shown:
        return None
    figure = style.new_figure(0.7 + 0.2 * len(shown))
    axis = figure.add_subplot()
    for k, (_, row) in enumerate(shown):
        _share(axis, k, row)
    axis.axvline(1.0, color=style.BLACK, lw=1.2)
    axis.set_yticks(range(len(shown)), [fmt.shortened(name, TITLE_LETTERS) for name, _ in shown])
    axis.set(xlim=(0.0, MAX_SHARE), ylim=(len(shown) - 0.4, -0.6))
    axis.set_xlabel(words.text("axis.share"))
    axis.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100 * value:.0f}\u00a0%"))
    axis.tick_params(axis="y", length=0)
    axis.grid(axis="x")
    return _finished(words, figure, "shares")


def histograms(words: Words, acceptance: Mapping[str, Any]) -> Drawing | None:
    """Differences by component with the normal curve that would just meet the limit."""
    differences = _differences(acceptance["check_points"])
    if len(differences) < FEWEST:
        return None
    figure = style.new_figure(2.35)
    allowed = _allowed_sigmas(acceptance)
    for k, axis in enumerate(figure.subplots(1, 3, sharey=True)):
        _histogram(words, axis, differences[:, k], allowed[k], words.unit.unit)
        axis.set_xlabel(f"Δ{'XYZ'[k]}, {words.unit.unit.name}")
        if k == 0:
            axis.set_ylabel(words.text("axis.points"))
    style.legend_below(figure, axis, 3)
    return _finished(words, figure, "histograms")


def point_plan(words: Words, acceptance: Mapping[str, Any], results: Results) -> Drawing | None:
    """Differences at the check points in plan, mean kept; blunders ringed."""
    points = [p for p in acceptance["check_points"] if p["status"] == "ok"]
    if not points:
        return None
    stations = [(image.x_m, image.y_m) for image in results.images]
    view = view_around([*((p["x_m"], p["y_m"]) for p in points), *stations])
    axis = _plan_axis(view)
    figure_plan.images_behind(axis, view, results.images)
    blunders = [(p["x_m"], p["y_m"]) for p in points if p["blunder"]]
    if blunders:
        axis.plot(*view.drawn(blunders), "o", ms=11, mfc="none", mec=style.PURPLE, mew=1.6,
                  zorder=5)  # fmt: skip
    _arrows(axis, view, points)
    view.dress(axis, (words.text("axis.east"), words.text("axis.north")))
    north_and_scale(axis, view)
    return _finished(words, axis.get_figure(root=True), "point_plan")


def _plan_axis(view: PlanView) -> Axes:
    height = min(PLAN_WIDTH_IN * view.height_m / view.width_m, PLAN_HEIGHT_IN)
    return style.new_figure(height + 0.95).add_subplot()


def _arrows(axis: Axes, view: PlanView, points: Sequence[Row]) -> None:
    """Horizontal and vertical differences, at a scale that blunders do not spoil."""
    crowded = len(points) > CROWDED
    place = np.array([(p["x_m"], p["y_m"]) for p in points])
    difference = _differences(points)
    axis.plot(*view.drawn(place), **style.dots(style.BLACK, 1.4 if crowded else 2.4))
    regular = np.array([not p["blunder"] for p in points])
    lengths = np.linalg.norm(difference, axis=1)
    scale = arrow_scale(lengths[regular] if regular.any() else lengths, view)
    if scale is None:
        return
    vertical = np.column_stack([np.zeros(len(points)), difference[:, 2]])
    arrows = many_arrows if crowded else difference_arrows
    arrows(axis, view, place, difference[:, :2], scale[0], style.BLUE)
    arrows(axis, view, place, vertical, scale[0], style.VERMILLION, "--")
    scale_arrow(axis, view, scale, style.BLACK, row=1)


def parallax(words: Words, results: Results, orientation: str) -> Drawing | None:
    """Mean vertical parallax per strip: POS, assessed orientation, relative orientation."""
    kept = strips_with_models(results)
    groups = [
        _bars(results, kept, title, value)
        for title, value in parallax_series(words, results, orientation)
    ]
    if not groups[-1].of_strip:
        return None
    names = words.text("axis.strip"), words.text("axis.parallax")
    figure = bar_figure(groups, kept, "px", names)
    return _finished(words, figure, "parallax_by_strip")


def regression(words: Words, results: Results) -> Drawing | None:
    """Errors of the three angles over time with the fitted lines, one panel each."""
    frame = results.settings.frame
    data = {a: figure_regression.used_errors(results, a) for a in angles(frame)}
    shown = {angle: part for angle, part in data.items() if part}
    if not shown:
        return None
    figure = style.new_figure(1.05 * len(shown) + 0.9)
    axes = np.atleast_1d(figure.subplots(len(shown), 1, sharex=True))
    for axis, (angle, part) in zip(axes, shown.items(), strict=True):
        _angle_panel(words, axis, results, frame, angle, part)
    axes[-1].set_xlabel(words.text("axis.time"))
    figure.align_ylabels(list(axes))
    figure_regression.legend(figure, axes[0])
    return _finished(words, figure, "regression_by_angle")


def _angle_panel(
    words: Words,
    axis: Axes,
    results: Results,
    frame: str,
    angle: str,
    part: Sequence[ImageAngleErrors],
) -> None:
    errors = figure_regression.errors_of(part, angle)
    start = min(row.time_s for row in part)
    labels = words.text("legend.ols"), words.text("legend.gls")
    panel = figure_regression.Panel(axis, fmt.angle_unit(errors), start, labels)
    lines = figure_regression.fitted_lines(results, frame, angle)
    strip = words.text("row.strip", strip="{strip}")
    figure_regression.draw_errors(panel, part, angle, lines, strip)
    panel.keep_large(errors)
    panel.label(words.known("angle", angle))


def _finished(words: Words, figure: Any, name: str) -> Drawing:
    return style.finish(
        figure, name, words.text(f"figure_title.{name}"), words.text(f"figure.{name}")
    )


def _families(acceptance: Mapping[str, Any], results: Results) -> tuple[str, ...]:
    """Families for the words of the language and the strips' names."""
    named = "".join(strips_with_models(results))
    return cjk.figure_families(named + ("中" if acceptance["language"] == "zh" else ""))


def _has_share(row: Row) -> bool:
    known = not fmt.is_missing(row["found"]) and not fmt.is_missing(row["limit"])
    return known and row["limit"] > 0.0 and row["quantity"] not in units.AT_LEAST


def _share(axis: Axes, place: int, row: Row) -> None:
    """One found value with its interval, at the edge with an arrow where it lies beyond."""
    colour, marker = _LOOKS[row["verdict"]]
    found = row["found"] / row["limit"]
    if not fmt.is_missing(row["low"]) and not fmt.is_missing(row["high"]):
        ends = [min(row[key] / row["limit"], MAX_SHARE) for key in ("low", "high")]
        axis.plot(ends, [place, place], color=colour, lw=2.4, alpha=0.45, solid_capstyle="butt")
    inside = min(found, 0.985 * MAX_SHARE)
    axis.plot([inside], [place], marker if inside == found else ">", color=colour, ms=6.0,
              mec="white", mew=0.6)  # fmt: skip


def _differences(points: Sequence[Row]) -> Floats:
    known = [(p["dx_m"], p["dy_m"], p["dz_m"]) for p in points if p["status"] == "ok"]
    return np.array(known, dtype=float).reshape(-1, 3)


def _allowed_sigmas(acceptance: Mapping[str, Any]) -> list[float | None]:
    """Standard deviation per component of normal errors without mean that just meet the class."""
    limits = {r["quantity"]: r["limit"] for r in acceptance["requirements"] if r["limit"]}
    plane = limits.get("rmse_h") or limits.get("product_rmse_h")
    height = limits.get("rmse_v") or limits.get("product_rmse_v")
    side = plane / math.sqrt(2.0) if plane else None
    return [side, side, height or None]


def _histogram(
    words: Words, axis: Axes, values_m: Floats, sigma_m: float | None, unit: fmt.Unit
) -> None:
    shown = values_m * unit.per_si
    reach = max(float(np.abs(shown).max()), 2.2 * (sigma_m or 0.0) * unit.per_si, 1e-9)
    edges = np.linspace(-reach, reach, 2 * max(4, math.ceil(math.sqrt(len(shown)))) + 1)
    axis.hist(shown, edges.tolist(), color=style.SKY, edgecolor="white", lw=0.5,
              label=words.text("legend.differences"))  # fmt: skip
    if sigma_m:
        grid, sigma = np.linspace(-reach, reach, 121), sigma_m * unit.per_si
        density = np.exp(-0.5 * (grid / sigma) ** 2) / (sigma * math.sqrt(2.0 * math.pi))
        axis.plot(grid, len(shown) * (edges[1] - edges[0]) * density, color=style.BLACK, lw=1.2,
                  label=words.text("legend.allowed"))  # fmt: skip
    axis.axvline(float(shown.mean()), color=style.VERMILLION, ls="--", lw=1.2,
                 label=words.text("legend.mean"))  # fmt: skip
    axis.xaxis.set_major_locator(MaxNLocator(5, symmetric=True))
    axis.yaxis.set_major_locator(MaxNLocator(5, integer=True))


def _bars(
    results: Results,
    strips: Sequence[str],
    title: str,
    value: Callable[[ModelParallax], float | None],
) -> Bars:
    values = {s: fmt.present(map(value, rows(results.models, strip=s))) for s in strips}
    means = {s: sum(part) / len(part) for s, part in values.items() if part}
    every = [value for part in values.values() for value in part]
    mean = sum(every) / len(every) if every else None
    return Bars(title, {s: value for s, value in means.items() if value > 0.0}, mean)
