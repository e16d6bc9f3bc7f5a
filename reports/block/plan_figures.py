"""Plan of the block: images, strips, models coloured by parallax, check-point vectors."""

import math
from collections.abc import Sequence
from itertools import pairwise

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.colorbar import Colorbar
from matplotlib.colors import BoundaryNorm, Colormap
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator

from posstats.arrays import Floats
from posstats.contract.check_points import CheckPointResidual
from posstats.contract.results import Results
from posstats.contract.survey import ImagePlace

from ..document import format as fmt
from ..document.drawing import Drawing
from ..document.rows import rows
from ..figures import style
from ..figures.difference_plan import differences_m, places
from ..figures.plan_view import (
    PlanView,
    arrow_scale,
    difference_arrows,
    north_and_scale,
    polylines,
    scale_arrow,
    view_of,
)
from .view import strips
from .words import Words

Label = tuple[Floats, str]  # middle in points, text

CROWDED = 150  # images from which exposure stations are drawn smaller
LABEL_LENGTH, LETTER_PT, LINE_PT = 11, 5.0, 10.0  # strip ids in the plan: letters, points
MAX_HEIGHT_IN = 3.5  # so that the plan stands on the first page, below the verdict
BESIDE_IN, BELOW_IN = 1.8, 0.95  # room for axis labels and colour bar, and for axis label and scale
BESIDE_TURNED_IN, BELOW_TURNED_IN = 0.9, 1.5  # the same with the colour bar below


def block_plan(words: Words, results: Results) -> Drawing | None:
    """Plan with north up, or right if the block is long; None without image positions."""
    images = results.images
    if not images:
        return None
    view = view_of(images)
    height, width, points_per_metre = _sizes(view)
    picture = style.new_figure(height, width)
    axis = picture.add_subplot()
    _footprints(axis, view, images)
    _models(words, picture, axis, view, results)
    _strip_labels(axis, view, results, points_per_metre)
    points = rows(results.check_point_residuals, orientation="pos")
    has_arrows = _check_points(axis, view, points)
    view.dress(axis, (words.text("axis.east"), words.text("axis.north")))
    north_and_scale(axis, view)
    caption = words.sentences([
        words.text("plan.turned" if view.turned else "plan.caption"),
        words.text("plan.arrows") if has_arrows else "",
    ])  # fmt: skip
    return style.finish(picture, "plan", words.text("plan.title"), caption)


def _sizes(view: PlanView) -> tuple[float, float, float]:
    """Height and width of the plan in inches, and points per metre, so that the block fills it."""
    beside, below = (
        (BESIDE_TURNED_IN, BELOW_TURNED_IN) if view.turned else (BESIDE_IN, BELOW_IN)
    )  # fmt: skip
    slope = view.height_m / view.width_m
    height = min(slope * (style.WIDTH_IN - beside), MAX_HEIGHT_IN - below)
    height = height if view.turned else max(height, 1.6)
    width = min(max(height / slope + beside, 3.9), style.WIDTH_IN)
    return height + below, width, height * 72.0 / view.height_m


def _footprints(axis: Axes, view: PlanView, images: Sequence[ImagePlace]) -> None:
    closed = [(*row.footprint, row.footprint[0]) for row in images if row.footprint]
    polylines(axis, view, closed, color=style.LIGHT, lw=0.35, zorder=1)


def _models(words: Words, picture: Figure, axis: Axes, view: PlanView, results: Results) -> None:
    """Models as lines between their images, in classes of colour."""
    place = {row.image: (row.x_m, row.y_m) for row in results.images}
    pairs = [m for m in results.models if m.left in place and m.right in place]
    lines = [(place[m.left], place[m.right]) for m in pairs]
    values = [m.pos_px for m in pairs]
    edges = _classes(fmt.present(values))
    palette = matplotlib.colormaps["viridis_r"].resampled(max(len(edges) - 1, 2))
    for k, (low, high) in enumerate(pairwise(edges)):
        part = [
            line for line, v in zip(lines, values, strict=True) if v is not None and low <= v < high
        ]
        polylines(axis, view, part, color=palette(k), lw=3.2, solid_capstyle="butt")
    unknown = [line for line, value in zip(lines, values, strict=True) if value is None]
    polylines(axis, view, unknown, color=style.GREY, lw=1.0, ls=":")
    size = 2.0 if len(place) < CROWDED else 1.2
    axis.plot(*view.drawn(place.values()), **style.dots(style.BLACK, size))
    if len(edges) > 1:
        bar = _colour_bar(picture, axis, view, edges, palette)
        bar.set_label(words.text("axis.model_parallax_of_pos"))


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


def _colour_bar(
    picture: Figure, axis: Axes, view: PlanView, edges: list[float], palette: Colormap
) -> Colorbar:
    scale = ScalarMappable(BoundaryNorm(edges, palette.N), palette)
    place = "bottom" if view.turned else "right"
    bar = picture.colorbar(scale, ax=axis, shrink=0.8, aspect=50 if view.turned else 26, pad=0.02,
                          spacing="uniform", location=place)  # fmt: skip
    bar.set_ticks(
        edges,
        labels=[
            fmt.number(edge, 6).rstrip("0").rstrip(".") if edge % 1 else fmt.count(edge)
            for edge in edges
        ],
    )
    bar.ax.minorticks_off()
    bar.outline.set_linewidth(0.5)
    return bar


def _strip_labels(
    axis: Axes,
    view: PlanView,
    results: Results,
    points_per_metre: float,
) -> None:
    """Strip ids beside their first exposures, each where it covers none of the others."""
    taken: list[Label] = []
    for strip in strips(results):
        stations = [(r.x_m, r.y_m) for r in results.images if r.strip == strip]
        if not stations:
            continue
        text = fmt.shortened(strip, LABEL_LENGTH)
        place = view.on_paper(stations) * points_per_metre
        offset = _free_offset(place, text, taken)
        taken.append((place[0] + offset, text))
        axis.annotate(
            text,
            tuple(view.drawn(stations)[:, 0]),
            xytext=(offset[0], offset[1]),
            textcoords="offset points",
            ha="center",
            va="center",
            fontsize=7.5,
            fontweight="bold",
            zorder=5,
            bbox={"boxstyle": "round,pad=0.1", "fc": "white", "ec": "none", "alpha": 0.75},
        )


def _free_offset(place: Floats, text: str, taken: Sequence[Label]) -> Floats:
    """Offset of a label in points: against the flight if free there, else turned, then farther."""
    back = place[0] - place[-1]
    length = float(np.hypot(*back))
    back = back / length if length else np.array([0.0, 1.0])
    across = np.array([-back[1], back[0]])
    directions = (back, back + across, back - across, across, -across)
    offsets: list[Floats] = [
        reach * d / np.hypot(*d) for reach in (9.0, 18.0, 27.0) for d in directions
    ]
    for offset in offsets:
        if not any(_overlap((place[0] + offset, text), other) for other in taken):
            return offset
    return offsets[0]


def _overlap(one: Label, other: Label) -> bool:
    apart = np.abs(one[0] - other[0])
    width = LETTER_PT * (len(one[1]) + len(other[1])) / 2.0
    return bool(apart[0] < width + 2.0 and apart[1] < LINE_PT)


def _check_points(axis: Axes, view: PlanView, points: Sequence[CheckPointResidual]) -> bool:
    """Triangles at the check points and their horizontal differences as arrows."""
    if not points:
        return False
    place, difference = places(points), differences_m(points)[:, :2]
    axis.plot(*view.drawn(place), "^", color="white", mec=style.VERMILLION, mew=1.0, ms=5.5,
              zorder=4)  # fmt: skip
    scale = arrow_scale(np.hypot(*difference.T), view)
    if scale is None:
        return False
    difference_arrows(axis, view, place, difference, scale[0], style.VERMILLION)
    scale_arrow(axis, view, scale, style.VERMILLION, row=1)
    return True
