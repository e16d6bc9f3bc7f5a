"""Differences at check points in plan, by several orientations side by side."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from posstats.arrays import Floats
from posstats.contract.check_points import CheckPointResidual
from posstats.contract.survey import ImagePlace

from . import style
from .plan_view import (
    PlanView,
    arrow_scale,
    difference_arrows,
    north_and_scale,
    scale_arrow,
    view_around,
    view_of,
)

BESIDE_TURNED_IN = 0.9  # room for axis labels


@dataclass(frozen=True)
class Panel:
    """Check points by one orientation, below a title."""

    title: str
    points: Sequence[CheckPointResidual]


def difference_plan(
    images: Sequence[ImagePlace],
    panels: Sequence[Panel],
    names: tuple[str, str],
    *,
    centred: bool,
) -> tuple[Figure, bool] | None:
    """Panels with arrows at their points, and whether north is to the right; None without points.

    Parameters
    ----------
    images
        Of the block, behind the arrows.
    panels
        Those without points are left out.
    names
        Of the coordinates east and north.
    centred
        Whether the mean difference is taken off.
    """
    panels = [panel for panel in panels if panel.points]
    if not panels:
        return None
    shown = [(point.x_m, point.y_m) for point in panels[0].points]
    view = view_of(images) if images else view_around(shown)
    figure, axes = _panels(view, len(panels))
    for axis, panel in zip(axes, panels, strict=True):
        images_behind(axis, view, images)
        with_north = view.turned and axis is axes[0]
        _differences(axis, view, panel.points, row=1 if with_north else 0, centred=centred)
        axis.set_title(panel.title, loc="right" if view.turned else "left",
                       pad=4 if view.turned else 20)  # fmt: skip
        view.dress(axis, names)
        if with_north:
            north_and_scale(axis, view)
    return figure, view.turned


def _panels(view: PlanView, count: int) -> tuple[Figure, Sequence[Axes]]:
    """Panels one above the other if the plan is turned, else side by side."""
    slope = view.height_m / view.width_m
    if view.turned:
        each = min((style.WIDTH_IN - BESIDE_TURNED_IN) * slope, 2.6) + 0.4
        figure = style.new_figure(count * each + 0.45)
        return figure, list(np.atleast_1d(figure.subplots(count, 1, sharex=True)))
    figure = style.new_figure(min(max(2.9 * slope, 2.2), 4.6) + 0.9)
    return figure, list(np.atleast_1d(figure.subplots(1, count, sharey=True)))


def images_behind(axis: Axes, view: PlanView, images: Sequence[ImagePlace]) -> None:
    """Exposure stations as pale dots, for orientation."""
    if images:
        places = [(image.x_m, image.y_m) for image in images]
        axis.plot(*view.drawn(places), **style.dots(style.LIGHT, 1.6))


def _differences(
    axis: Axes, view: PlanView, points: Sequence[CheckPointResidual], row: int, *, centred: bool
) -> None:
    """Horizontal and vertical differences as arrows, the mean of each removed if `centred`."""
    place, difference = places(points), differences_m(points)
    if centred and np.isfinite(difference).all(axis=1).sum() > 1:
        difference = difference - np.nanmean(difference, axis=0)
    axis.plot(*view.drawn(place), "^", color="white", mec=style.BLACK, mew=0.7, ms=4.0, zorder=4)
    scale = arrow_scale(np.linalg.norm(difference, axis=1), view)
    if scale is None:
        return
    vertical = np.column_stack([np.zeros(len(points)), difference[:, 2]])
    difference_arrows(axis, view, place, difference[:, :2], scale[0], style.BLUE)
    difference_arrows(axis, view, place, vertical, scale[0], style.VERMILLION, "--")
    scale_arrow(axis, view, scale, style.BLACK, row)


def places(points: Sequence[CheckPointResidual]) -> Floats:
    """(n, 2) east and north, as given."""
    return np.array([(point.x_m, point.y_m) for point in points])


def differences_m(points: Sequence[CheckPointResidual]) -> Floats:
    """(n, 3) computed minus given, NaN where unknown."""
    return np.array([(point.dx_m, point.dy_m, point.dz_m) for point in points], dtype=float)
