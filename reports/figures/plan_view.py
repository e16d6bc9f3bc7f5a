"""Plans: the ground in view, turned if it is long; north arrow, scale bar, scaled differences."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import PathPatch
from matplotlib.path import Path
from matplotlib.ticker import MaxNLocator
from matplotlib.transforms import ScaledTranslation, Transform, blended_transform_factory

from posstats.arrays import Floats
from posstats.contract.survey import ImagePlace

from ..document import format as fmt
from . import style

Point = Sequence[float]  # east and north in metres

PAD = 0.07
LONG = 1.6  # north over east from which a plan is turned
HEAD = 0.011  # of the larger side of a plan: an arrowhead among many
NARROW = 0.9  # width over height below which coordinates would touch side by side


@dataclass(frozen=True)
class PlanView:
    """The ground in view, in metres; if `turned`, north is to the right and east is down."""

    west: float
    east: float
    south: float
    north: float
    turned: bool

    @property
    def width_m(self) -> float:
        """Extent along the lower edge of the drawing."""
        return self.north - self.south if self.turned else self.east - self.west

    @property
    def height_m(self) -> float:
        """Extent along the left edge of the drawing."""
        return self.east - self.west if self.turned else self.north - self.south

    @property
    def left_m(self) -> float:
        """Coordinate of the left edge of the drawing."""
        return self.south if self.turned else self.west

    def drawn(self, points: Iterable[Point]) -> Floats:
        """Places (2, n) on the axes of points given as east, north."""
        east, north = np.array(list(points), dtype=float).reshape(-1, 2).T
        return np.array([north, east] if self.turned else [east, north])

    def on_paper(self, points: Iterable[Point]) -> Floats:
        """Places (n, 2) of points in metres right and up from the lower left corner."""
        x, y = self.drawn(points)
        up = self.east - y if self.turned else y - self.south
        return np.column_stack([x - self.left_m, up])

    def dress(self, axis: Axes, names: tuple[str, str]) -> None:
        """Limits, scale, ticks and the names of the coordinates (east, north)."""
        sides = [(self.west, self.east), (self.south, self.north)]
        if self.turned:
            sides, names = [sides[1], sides[0][::-1]], names[::-1]
        axis.set(xlim=sides[0], ylim=sides[1], xlabel=names[0], ylabel=names[1], aspect="equal")
        style.plain_ticks(axis)
        axis.xaxis.set_major_locator(MaxNLocator(6 if self.turned else 3, steps=[1, 2, 5, 10]))
        axis.yaxis.set_major_locator(MaxNLocator(3 if self.turned else 6))
        axis.tick_params(axis="x", rotation=90 if self.width_m < NARROW * self.height_m else 0)
        for side in ("top", "right"):
            axis.spines[side].set_visible(True)
        axis.label_outer()


def view_of(images: Sequence[ImagePlace]) -> PlanView:
    """The view that shows images, with their footprints if they have them, and a margin."""
    return view_around(
        corner for image in images for corner in (image.footprint or ((image.x_m, image.y_m),))
    )


def view_around(points: Iterable[Point]) -> PlanView:
    """The view that shows points and a margin."""
    x, y = np.array(list(points), dtype=float).T
    margin = PAD * max(min(np.ptp(x), np.ptp(y)), 0.3 * max(np.ptp(x), np.ptp(y)), 1.0)
    return PlanView(
        west=float(x.min() - margin),
        east=float(x.max() + margin),
        south=float(y.min() - margin),
        north=float(y.max() + margin),
        turned=bool(np.ptp(y) > LONG * np.ptp(x)),
    )


def polylines(axis: Axes, view: PlanView, lines: Sequence[Sequence[Point]], **look: Any) -> None:
    """Several lines as one path: one element of the page instead of hundreds."""
    if lines:
        gap = [(math.nan, math.nan)]
        axis.plot(*view.drawn(point for line in lines for point in (*line, *gap)), **look)


def arrow_scale(lengths_m: Floats, view: PlanView) -> tuple[float, float] | None:
    """Magnification on the ground and the round length of the scale arrow in metres."""
    if not np.isfinite(lengths_m).any() or np.nanmax(lengths_m) == 0.0:
        return None
    largest = float(np.nanmax(lengths_m))
    return 0.1 * max(view.width_m, view.height_m) / largest, _round_down(largest)


def difference_arrows(
    axis: Axes,
    view: PlanView,
    start: Floats,
    difference: Floats,
    scale: float,
    colour: str,
    line: str = "-",
) -> None:
    """Arrows of differences (n, 2) at points (n, 2), magnified by `scale`; none where unknown."""
    look = {"arrowstyle": "-|>", "color": colour, "lw": 1.1, "ls": line}
    look |= {"mutation_scale": 6, "shrinkA": 0, "shrinkB": 0}
    known = np.isfinite(difference).all(axis=1)
    tails = view.drawn(start[known]).T
    tips = view.drawn(start[known] + scale * difference[known]).T
    for tail, tip in zip(tails, tips, strict=True):
        axis.annotate("", tuple(tip), tuple(tail), arrowprops=look, zorder=4,
                      annotation_clip=False)  # fmt: skip  # else none that ends outside


def many_arrows(
    axis: Axes,
    view: PlanView,
    start: Floats,
    difference: Floats,
    scale: float,
    colour: str,
    line: str = "-",
) -> None:
    """The same for hundreds of known differences: two elements of the page, small heads."""
    shaft = scale * difference
    tips = start + shaft
    polylines(axis, view, [list(ends) for ends in zip(start, tips, strict=True)],
              color=colour, lw=0.8, ls=line, solid_capstyle="butt", zorder=4)  # fmt: skip
    length = np.maximum(np.hypot(*shaft.T), 1e-300)[:, None]
    head = np.minimum(HEAD * max(view.width_m, view.height_m), 0.5 * length)
    along = head * shaft / length
    across = 0.4 * np.column_stack([-along[:, 1], along[:, 0]])
    corners = np.stack([tips, tips - along + across, tips - along - across, tips], axis=1)
    drawn = view.drawn(corners.reshape(-1, 2)).T
    codes = np.tile([Path.MOVETO, Path.LINETO, Path.LINETO, Path.CLOSEPOLY], len(start))
    axis.add_patch(PathPatch(Path(drawn, codes), fc=colour, ec="none", zorder=4))


def scale_arrow(
    axis: Axes, view: PlanView, scale: tuple[float, float], colour: str, row: int
) -> None:
    """Arrow of a round length with its length in words, above the plan."""
    end = view.left_m + scale[0] * scale[1]
    _bar(axis, view, end, row, fmt.with_unit(scale[1], "m", 1), color=colour, lw=1.2,
         marker=">", ms=4.5, markevery=[1])  # fmt: skip


def north_and_scale(axis: Axes, view: PlanView) -> None:
    """North arrow and scale bar above the plan, where they hide nothing."""
    length = _round_down(0.25 * view.width_m)
    axis.annotate("N →" if view.turned else "N\n↑", (0.0, 1.0), xycoords="axes fraction",
                  xytext=(0, 5 if view.turned else 3), linespacing=1.0,
                  textcoords="offset points", fontweight="bold", annotation_clip=False)  # fmt: skip
    unit, factor = ("km", 1e-3) if length >= 1000.0 else ("m", 1.0)
    words = fmt.with_unit(length * factor, unit, 1)
    _bar(axis, view, view.left_m + length, 0, words, color=style.BLACK, lw=2.0)


def _bar(axis: Axes, view: PlanView, end: float, row: int, words: str, **look: Any) -> None:
    above = _above(axis, view, row)
    axis.plot([view.left_m, end], [1.0, 1.0], transform=above, clip_on=False,
              solid_capstyle="butt", **look)  # fmt: skip
    axis.annotate(words, (end, 1.0), xycoords=above, xytext=(5, 0), textcoords="offset points",
                  va="center", annotation_clip=False)  # fmt: skip


def _above(axis: Axes, view: PlanView, row: int) -> Transform:
    """Metres along the plan, rows of text above it; right of the north arrow."""
    figure = axis.get_figure(root=True)
    right = 34.0 if view.turned else 24.0
    shift = ScaledTranslation(right / 72.0, (9.0 + 13.0 * row) / 72.0, figure.dpi_scale_trans)  # type: ignore[union-attr]
    return blended_transform_factory(axis.transData, axis.transAxes) + shift


def _round_down(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above the value."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(step * power for step in (1.0, 2.0, 5.0) if step * power <= value * (1 + 1e-12))
