"""Figures of the report on an adjustment: plan, image residuals, check points."""

from collections.abc import Sequence

import msgspec
import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from posstats.arrays import Floats
from posstats.contract.check_points import CheckPointResidual
from posstats.contract.survey import ImagePlace

from ..block.plan_figures import difference_plan
from ..document import format as fmt
from ..document.drawing import Drawing
from ..figures import style
from ..figures.plan_view import PlanView, north_and_scale, polylines, view_of
from .view import Results, Row, rows

MAX_PLAN_IN = 3.4
LEAST_RAYS = 5
_ARROW_SHARE = 0.8  # of a cell, for the largest mean residual


def draw(results: Results) -> dict[str, Drawing]:
    """Every figure that the results allow, by name."""
    words = {"pos": "POS as delivered", "bundle": "adjusted"}
    with style.style():
        drawings = [
            plan(results),
            *image_residuals(results),
            difference_plan(
                msgspec.convert(results["images"], tuple[ImagePlace, ...]),
                msgspec.convert(results["check_point_residuals"], tuple[CheckPointResidual, ...]),
                words,
                centred=False,
            ),
        ]
    return {drawing.name: drawing for drawing in drawings if drawing}


def plan(results: Results) -> Drawing | None:
    """Images, strips, control and check points."""
    images = rows(results, "images")
    if not images:
        return None
    view = view_of(msgspec.convert(images, list[ImagePlace]))
    slope = view.height_m / view.width_m
    height = min(max(slope * (style.WIDTH_IN - 1.2), 1.4), MAX_PLAN_IN - 1.0)
    figure = style.new_figure(height + 1.1, min(max(height / slope + 1.2, 3.9), style.WIDTH_IN))
    axis = figure.add_subplot()
    closed = [(*row["footprint"], row["footprint"][0]) for row in images if row["footprint"]]
    polylines(axis, view, closed, color=style.LIGHT, lw=0.35, zorder=1)
    lines = [
        [(row["x_m"], row["y_m"]) for row in images if row["strip"] == strip]
        for strip in dict.fromkeys(row["strip"] for row in images)
    ]
    polylines(axis, view, lines, color=style.GREY, lw=0.7)
    stations = [(row["x_m"], row["y_m"]) for row in images]
    axis.plot(*view.drawn(stations), **style.dots(style.BLACK, 1.8))
    _points(axis, view, results)
    view.dress(axis)
    north_and_scale(axis, view)
    if axis.get_legend_handles_labels()[1]:
        style.legend_below(figure, axis, 2)
    caption = (
        f"Plan of the block{', north to the right' if view.turned else ''}. Dots: exposure "
        "stations, joined along the strips; grey outlines: image footprints; triangles: control "
        "points (filled) and check points (open)."
    )
    return style.finish(figure, "plan", "Plan of the block", caption)


def _points(axis: Axes, view: PlanView, results: Results) -> None:
    control = [(row["x_m"], row["y_m"]) for row in rows(results, "control_points")]
    checks = rows(results, "check_point_residuals", orientation="bundle")
    if control:
        axis.plot(*view.drawn(control), "^", color=style.VERMILLION, ms=5.5, label="control point")
    if checks:
        places = [(row["x_m"], row["y_m"]) for row in checks]
        axis.plot(*view.drawn(places), "^", color="white", mec=style.BLUE, mew=1.0, ms=5.0,
                  label="check point")  # fmt: skip


def image_residuals(results: Results) -> list[Drawing]:
    """Mean residual vectors over the image format, one figure per camera."""
    cells = [row for row in rows(results, "image_residuals") if row["n"] >= LEAST_RAYS]
    cameras = list(dict.fromkeys(row["camera"] for row in cells))
    return [
        _residuals(camera, [row for row in cells if row["camera"] == camera], number)
        for number, camera in enumerate(cameras, start=1)
    ]


def _residuals(camera: str, cells: Sequence[Row], number: int) -> Drawing:
    place = np.array([(row["x_px"], row["y_px"]) for row in cells])
    mean = np.array([(row["dx_px"], row["dy_px"]) for row in cells])
    size = _spacing(place)
    largest = float(np.hypot(*mean.T).max())
    scale = _ARROW_SHARE * size / largest if largest > 0.0 else 1.0
    width, height = np.ptp(place, axis=0) + size
    figure = style.new_figure(min(4.2 * height / width + 0.7, 4.4), 5.2)
    axis = figure.add_subplot()
    axis.plot(*place.T, **style.dots(style.LIGHT, 2.0))
    look = {"arrowstyle": "-|>", "color": style.BLUE, "lw": 1.0, "mutation_scale": 5}
    look |= {"shrinkA": 0, "shrinkB": 0}
    for start, arrow in zip(place, scale * mean, strict=True):
        axis.annotate("", tuple(start + arrow), tuple(start), arrowprops=look)
    low, high = place.min(axis=0) - size / 2.0, place.max(axis=0) + size / 2.0
    axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal",
             xlabel="x, px", ylabel="y, px")  # fmt: skip
    style.plain_ticks(axis)
    axis.xaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    axis.yaxis.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))
    rms = [row["rms_px"] for row in cells]
    caption = (
        f"Mean image residuals (measured minus adjusted) over the format"
        f"{f' of camera {camera}' if camera else ''}, in cells of {fmt.count(size)} px; the "
        f"longest arrow is {fmt.with_unit(largest, 'px', 2)}. Arrows that follow a pattern show an "
        "image deformation that was not modelled. RMS within single cells: "
        f"{fmt.number(min(rms), 2)} to {fmt.with_unit(max(rms), 'px', 2)}."
    )
    return style.finish(figure, f"residuals_{number}", "Image residuals over the format", caption)


def _spacing(place: Floats) -> float:
    """Side of a cell."""
    steps = np.diff(np.unique(place[:, 0])) if len(np.unique(place[:, 0])) > 1 else [1000.0]
    return float(np.min(steps))
