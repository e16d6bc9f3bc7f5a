"""The plan of an adjusted block: images, strips, control and check points."""

from matplotlib.axes import Axes

from posstats.contract.adjustment import AdjustmentResults

from ..document.drawing import Drawing
from ..figures import style
from ..figures.plan_view import PlanView, north_and_scale, polylines, view_of
from .check_points import residuals
from .words import Words

MAX_PLAN_IN = 3.4


def figure(words: Words, results: AdjustmentResults) -> Drawing | None:
    """The plan; None without images."""
    if not results.images:
        return None
    view = view_of(results.images)
    slope = view.height_m / view.width_m
    height = min(max(slope * (style.WIDTH_IN - 1.2), 1.4), MAX_PLAN_IN - 1.0)
    figure = style.new_figure(height + 1.1, min(max(height / slope + 1.2, 3.9), style.WIDTH_IN))
    axis = figure.add_subplot()
    _images(axis, view, results)
    _points(words, axis, view, results)
    view.dress(axis, (words.text("bundle_axis.east"), words.text("bundle_axis.north")))
    north_and_scale(axis, view)
    if axis.get_legend_handles_labels()[1]:
        style.legend_below(figure, axis, 2)
    caption = words.text("plan.turned" if view.turned else "plan.caption")
    return style.finish(figure, "plan", words.text("plan.title"), caption)


def _images(axis: Axes, view: PlanView, results: AdjustmentResults) -> None:
    """Footprints, and exposure stations joined along the strips."""
    images = results.images
    closed = [(*row.footprint, row.footprint[0]) for row in images if row.footprint]
    polylines(axis, view, closed, color=style.LIGHT, lw=0.35, zorder=1)
    strips: dict[str, list[tuple[float, float]]] = {}
    for row in images:
        strips.setdefault(row.strip, []).append((row.x_m, row.y_m))
    polylines(axis, view, list(strips.values()), color=style.GREY, lw=0.7)
    stations = [(row.x_m, row.y_m) for row in images]
    axis.plot(*view.drawn(stations), **style.dots(style.BLACK, 1.8))


def _points(words: Words, axis: Axes, view: PlanView, results: AdjustmentResults) -> None:
    control = [(row.x_m, row.y_m) for row in results.control_points]
    checks = [(row.x_m, row.y_m) for row in residuals(results, "bundle")]
    if control:
        axis.plot(*view.drawn(control), "^", color=style.VERMILLION, ms=5.5,
                  label=words.text("legend.control"))  # fmt: skip
    if checks:
        axis.plot(*view.drawn(checks), "^", color="white", mec=style.BLUE, mew=1.0, ms=5.0,
                  label=words.text("legend.check"))  # fmt: skip
