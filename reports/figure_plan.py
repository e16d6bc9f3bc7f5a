"""Plan of the block: images, strips, models coloured by parallax, check-point vectors."""

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import matplotlib
import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colors import BoundaryNorm, Colormap
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator
from matplotlib.transforms import ScaledTranslation, Transform, blended_transform_factory

from . import figure_style as style
from . import format as fmt
from .results_view import Results, Row, rows, strips

FloatArray = npt.NDArray[np.float64]
Label = tuple[FloatArray, str]  # middle in points, text
Limits = tuple[float, float, float, float]  # west, east, south, north

PAD = 0.07
CROWDED = 150  # images from which exposure stations are drawn smaller
LABEL_LENGTH, LETTER_PT, LINE_PT = 11, 5.0, 10.0  # strip ids in the plan: letters, points
NARROW = 0.9  # width over height below which coordinates would touch side by side
MAX_HEIGHT_IN = 3.5  # so that the plan stands on the first page, below the verdict
BESIDE_IN, BELOW_IN = 1.8, 0.95  # room for axis labels and colour bar, and for axis label and scale


def block_plan(results: Results) -> style.Drawing | None:
    """Plan with north up; None if the results hold no image positions."""
    images = rows(results, "images")
    if not images:
        return None
    limits = _limits(images)
    figure = style.new_figure(*_size(limits))
    axis = figure.add_subplot()
    _footprints(axis, images)
    _models(figure, axis, results, images)
    _strip_labels(axis, results, images, limits)
    has_vectors = _check_points(
        axis, rows(results, "check_point_residuals", orientation="pos"), limits
    )
    _frame(axis, limits)
    vectors = (
        " Arrows: horizontal differences at check points, computed from the POS as delivered minus "
        "given, at the scale of the arrow above the plan."
        if has_vectors
        else ""
    )
    caption = (
        "Plan of the block. Dots: exposure stations; lines: stereo models, coloured by the RMS "
        "vertical parallax from the POS as delivered; grey outlines: image footprints; numbers: "
        f"strips, at their first exposure.{vectors}"
    )
    return style.finish(figure, "plan", "Plan of the block", caption)


def check_point_plan(results: Results) -> style.Drawing | None:
    """Differences at check points before and after the selected correction, shift removed."""
    before = rows(results, "check_point_residuals", orientation="pos")
    after = rows(results, "check_point_residuals", orientation="selected")
    panels = [
        (words, part)
        for words, part in (("POS as delivered", before), ("after the selected correction", after))
        if part
    ]
    if not panels:
        return None
    limits = _limits(rows(results, "images") or before)
    width = (limits[1] - limits[0]) / (limits[3] - limits[2])
    figure = style.new_figure(min(max(2.9 / width, 2.2), 4.6) + 0.9)
    for axis, (words, part) in zip(
        np.atleast_1d(figure.subplots(1, len(panels), sharey=True)), panels, strict=True
    ):
        _images_behind(axis, results)
        _difference_arrows(axis, part, limits)
        axis.set_title(words, loc="left", pad=20.0)
        _frame(axis, limits, compass=False)
    caption = (
        "Differences at check points (computed minus given, mean difference removed). Solid blue: "
        "horizontal; dashed orange: vertical, drawn towards north where the computed point is too "
        "high. Each panel has its own scale arrow."
    )
    return style.finish(figure, "check_points", "Differences at check points in plan", caption)


def _limits(places: Sequence[Row]) -> Limits:
    corners = [
        corner for row in places for corner in (row.get("footprint") or [(row["x_m"], row["y_m"])])
    ]
    x, y = np.array(corners, dtype=float).T
    margin = PAD * max(np.ptp(x), np.ptp(y), 1.0)
    return (x.min() - margin, x.max() + margin, y.min() - margin, y.max() + margin)


def _size(limits: Limits) -> tuple[float, float]:
    """Height and width of the plan in inches, so that the block fills it."""
    ratio = (limits[3] - limits[2]) / (limits[1] - limits[0])
    height = min(ratio * (style.WIDTH_IN - BESIDE_IN), MAX_HEIGHT_IN - BELOW_IN)
    height = max(height, 1.6)
    return height + BELOW_IN, min(max(height / ratio + BESIDE_IN, 3.9), style.WIDTH_IN)


def _footprints(axis: Axes, images: Sequence[Row]) -> None:
    closed = [(*row["footprint"], row["footprint"][0]) for row in images if row.get("footprint")]
    _polylines(axis, closed, color=style.LIGHT, lw=0.35, zorder=1)


def _polylines(axis: Axes, lines: Sequence[Sequence[Sequence[float]]], **look: Any) -> None:
    """Several lines as one path: one element of the page instead of hundreds."""
    if lines:
        gap = [(math.nan, math.nan)]
        axis.plot(*np.array([p for line in lines for p in (*line, *gap)], dtype=float).T, **look)


def _models(figure: Figure, axis: Axes, results: Results, images: Sequence[Row]) -> None:
    """Models as lines between their images, in classes of colour."""
    place = {row["image"]: (row["x_m"], row["y_m"]) for row in images}
    pairs = [m for m in rows(results, "models") if m["left"] in place and m["right"] in place]
    lines = [(place[m["left"]], place[m["right"]]) for m in pairs]
    values = [m["pos_px"] for m in pairs]
    edges = _classes(fmt.present(values))
    palette = matplotlib.colormaps["viridis_r"].resampled(max(len(edges) - 1, 2))
    for k, (low, high) in enumerate(pairwise(edges)):
        part = [
            line for line, v in zip(lines, values, strict=True) if v is not None and low <= v < high
        ]
        _polylines(axis, part, color=palette(k), lw=3.2, solid_capstyle="butt")
    unknown = [line for line, value in zip(lines, values, strict=True) if value is None]
    _polylines(axis, unknown, color=style.GREY, lw=1.0, ls=":")
    size = 2.2 if len(place) < CROWDED else 1.2
    axis.plot(*np.array(list(place.values()), dtype=float).T, ".", color=style.BLACK, ms=size)
    if len(edges) > 1:
        _colour_bar(figure, axis, edges, palette)


def _classes(values: Sequence[float]) -> list[float]:
    """Bounds of at most nine round classes that hold all values."""
    if not values:
        return []
    low, high = min(values), max(values)
    if low > 0.0 and high / low > 20.0:
        steps = LogLocator(subs=(1.0, 2.0, 5.0), numticks=30).tick_values(low, high)
        steps = steps if len(steps) <= 10 else LogLocator().tick_values(low, high)
    else:
        steps = MaxNLocator(7, steps=[1, 2, 5, 10], min_n_ticks=1).tick_values(
            low, high * (1.0 + 1e-9)
        )
    inner = [step for step in steps if low < step < high]
    below = max((step for step in steps if step <= low), default=low)
    above = min((step for step in steps if step > high), default=math.nextafter(high, math.inf))
    return [float(step) for step in (below, *inner, above)]


def _colour_bar(figure: Figure, axis: Axes, edges: list[float], palette: Colormap) -> None:
    scale = ScalarMappable(BoundaryNorm(edges, palette.N), palette)
    bar = figure.colorbar(scale, ax=axis, shrink=0.8, aspect=26, pad=0.02, spacing="uniform")
    bar.set_label("RMS vertical parallax of the model, px")
    bar.set_ticks(
        edges,
        labels=[
            fmt.number(edge, 6).rstrip("0").rstrip(".") if edge % 1 else fmt.count(edge)
            for edge in edges
        ],
    )
    bar.ax.minorticks_off()
    bar.outline.set_linewidth(0.5)


def _strip_labels(axis: Axes, results: Results, images: Sequence[Row], limits: Limits) -> None:
    """Strip ids beside their first exposures, each where it covers none of the others."""
    height = (_size(limits)[0] - BELOW_IN) * 72.0
    points_per_metre = height / (limits[3] - limits[2])
    taken: list[Label] = []
    for strip in strips(results):
        place = np.array([(r["x_m"], r["y_m"]) for r in images if r["strip"] == strip], dtype=float)
        if not place.size:
            continue
        text = style.shortened(strip, LABEL_LENGTH)
        offset = _free_offset(place, points_per_metre, text, taken)
        taken.append((place[0] * points_per_metre + offset, text))
        axis.annotate(
            text,
            (place[0, 0], place[0, 1]),
            xytext=(offset[0], offset[1]),
            textcoords="offset points",
            ha="center",
            va="center",
            fontsize=7.5,
            fontweight="bold",
            zorder=5,
            bbox={"boxstyle": "round,pad=0.1", "fc": "white", "ec": "none", "alpha": 0.75},
        )


def _free_offset(
    place: FloatArray, points_per_metre: float, text: str, taken: Sequence[Label]
) -> FloatArray:
    """Offset of a label in points: against the flight if free there, else turned, then farther."""
    back = place[0] - place[-1]
    length = float(np.hypot(*back))
    back = back / length if length else np.array([0.0, 1.0])
    across = np.array([-back[1], back[0]])
    directions = (back, back + across, back - across, across, -across)
    offsets: list[FloatArray] = [
        reach * d / np.hypot(*d) for reach in (9.0, 18.0, 27.0) for d in directions
    ]
    for offset in offsets:
        label = (place[0] * points_per_metre + offset, text)
        if not any(_overlap(label, other) for other in taken):
            return offset
    return offsets[0]


def _overlap(one: Label, other: Label) -> bool:
    apart = np.abs(one[0] - other[0])
    width = LETTER_PT * (len(one[1]) + len(other[1])) / 2.0
    return bool(apart[0] < width + 2.0 and apart[1] < LINE_PT)


def _images_behind(axis: Axes, results: Results) -> None:
    places = [(row["x_m"], row["y_m"]) for row in rows(results, "images")]
    if places:
        axis.plot(*np.array(places, dtype=float).T, ".", color=style.LIGHT, ms=2.0)


def _check_points(axis: Axes, points: Sequence[Row], limits: Limits) -> bool:
    """Triangles at the check points and their horizontal differences as arrows."""
    if not points:
        return False
    x, y, dx, dy = (
        np.array([p[k] for p in points], dtype=float) for k in ("x_m", "y_m", "dx_m", "dy_m")
    )
    axis.plot(x, y, "^", color="white", mec=style.VERMILLION, mew=1.0, ms=5.5, zorder=4)
    return _arrows(axis, (x, y), (dx, dy), limits, style.VERMILLION)


def _difference_arrows(axis: Axes, points: Sequence[Row], limits: Limits) -> None:
    x, y, dx, dy, dz = (
        np.array([math.nan if p[k] is None else p[k] for p in points], dtype=float)
        for k in ("x_m", "y_m", "dx_m", "dy_m", "dz_m")
    )
    dx, dy, dz = (d - np.nanmean(d) if np.isfinite(d).sum() > 1 else d for d in (dx, dy, dz))
    axis.plot(x, y, "^", color="white", mec=style.BLACK, mew=0.7, ms=4.0, zorder=4)
    scale = _arrow_scale(np.hypot(np.hypot(dx, dy), dz), limits)
    if scale is None:
        return
    _quiver(axis, (x, y), (dx, dy), scale, style.BLUE, "-")
    _quiver(axis, (x, y), (np.zeros_like(dz), dz), scale, style.VERMILLION, "--")
    _scale_arrow(axis, scale, limits, style.BLACK, row=0)


def _arrows(
    axis: Axes,
    start: tuple[FloatArray, FloatArray],
    difference: tuple[FloatArray, FloatArray],
    limits: Limits,
    colour: str,
) -> bool:
    scale = _arrow_scale(np.hypot(*difference), limits)
    if scale is None:
        return False
    _quiver(axis, start, difference, scale, colour, "-")
    _scale_arrow(axis, scale, limits, colour)
    return True


def _arrow_scale(lengths: FloatArray, limits: Limits) -> tuple[float, float] | None:
    """Magnification on the ground and the round length of the scale arrow in metres."""
    if not np.isfinite(lengths).any() or np.nanmax(lengths) == 0.0:
        return None
    largest = float(np.nanmax(lengths))
    return 0.1 * max(limits[1] - limits[0], limits[3] - limits[2]) / largest, _round_down(largest)


def _quiver(
    axis: Axes,
    start: tuple[FloatArray, FloatArray],
    difference: tuple[FloatArray, FloatArray],
    scale: tuple[float, float],
    colour: str,
    line: str,
) -> None:
    for x, y, dx, dy in zip(*start, *difference, strict=True):
        if not math.isfinite(dx + dy):
            continue
        tip = (x + scale[0] * dx, y + scale[0] * dy)
        arrow = {"arrowstyle": "-|>", "color": colour, "lw": 1.1, "ls": line}
        arrow |= {"mutation_scale": 6, "shrinkA": 0, "shrinkB": 0}
        axis.annotate("", tip, (x, y), arrowprops=arrow, zorder=4)


def _scale_arrow(
    axis: Axes, scale: tuple[float, float], limits: Limits, colour: str, row: int = 1
) -> None:
    """Arrow of a round length with its length in words, above the plan."""
    east = limits[0] + scale[0] * scale[1]
    above = _above(axis, row)
    head = {"marker": ">", "ms": 4.5, "markevery": [1]}
    axis.plot([limits[0], east], [1.0, 1.0], color=colour, lw=1.2, transform=above, clip_on=False,
              solid_capstyle="butt", **head)  # type: ignore[arg-type]  # fmt: skip
    axis.annotate(fmt.with_unit(scale[1], "m", 1), (east, 1.0), xycoords=above, xytext=(5, 0),
                  textcoords="offset points", va="center", annotation_clip=False)  # fmt: skip


def _above(axis: Axes, row: int) -> Transform:
    """East in metres, rows of text above the axes; right of the north arrow."""
    figure = axis.get_figure(root=True)
    shift = ScaledTranslation(24.0 / 72.0, (9.0 + 13.0 * row) / 72.0, figure.dpi_scale_trans)  # type: ignore[union-attr]
    return blended_transform_factory(axis.transData, axis.transAxes) + shift


def _round_down(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above the value."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value * (1 + 1e-12))


def _frame(axis: Axes, limits: Limits, *, compass: bool = True) -> None:
    axis.set_xlim(limits[0], limits[1])
    axis.set_ylim(limits[2], limits[3])
    axis.set_aspect("equal")
    axis.set_xlabel("east, m")
    if axis.get_subplotspec() is None or axis.get_subplotspec().is_first_col():  # type: ignore[union-attr]
        axis.set_ylabel("north, m")
    style.plain_ticks(axis)
    narrow = limits[1] - limits[0] < NARROW * (limits[3] - limits[2])
    axis.xaxis.set_major_locator(MaxNLocator(3, steps=[1, 2, 5, 10]))
    axis.tick_params(axis="x", rotation=90 if narrow else 0)
    axis.yaxis.set_major_locator(MaxNLocator(6))
    for side in ("top", "right"):
        axis.spines[side].set_visible(True)
    if compass:
        _north_and_scale(axis, limits)


def _north_and_scale(axis: Axes, limits: Limits) -> None:
    """North arrow and scale bar above the plan, where they hide nothing."""
    length = _round_down(0.25 * (limits[1] - limits[0]))
    above = _above(axis, 0)
    axis.annotate("N\n↑", (0.0, 1.0), xycoords="axes fraction", xytext=(0, 3), linespacing=1.0,
                  textcoords="offset points", fontweight="bold", annotation_clip=False)  # fmt: skip
    axis.plot([limits[0], limits[0] + length], [1.0, 1.0], color=style.BLACK, lw=2.0,
              solid_capstyle="butt", transform=above, clip_on=False)  # fmt: skip
    unit, factor = ("km", 1e-3) if length >= 1000.0 else ("m", 1.0)
    axis.annotate(fmt.with_unit(length * factor, unit, 1), (limits[0] + length, 1.0),
                  xycoords=above, xytext=(5, 0), textcoords="offset points", va="center",
                  annotation_clip=False)  # fmt: skip
