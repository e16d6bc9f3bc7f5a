"""Topic: groups of observations, and the image residuals over the format."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.ticker import MaxNLocator

from posstats.arrays import Floats
from posstats.contract.adjustment import AdjustmentResults, FormatCell, GroupSummary

from ..document import format as fmt
from ..document.content import Content, Paragraph, Part, filled
from ..document.drawing import Drawing
from ..document.table import Table, count_column, number_column, text_column
from ..figures import style
from .units import scaled, unit_of
from .words import Words

LEAST_RAYS = 5
_ARROW_SHARE = 0.8  # of a cell, for the largest mean residual
_ARROW = {"arrowstyle": "-|>", "color": style.BLUE, "lw": 1.0, "mutation_scale": 5,
          "shrinkA": 0, "shrinkB": 0}  # fmt: skip


def topic(words: Words, results: AdjustmentResults) -> Part:
    """What is adjusted, how well it fits, and what is left over the image format."""
    said = [words.text("observations.text")]
    if results.settings.estimate_weights:
        said.append(words.text("observations.weights"))
    content: tuple[Content, ...] = (
        Paragraph(words.sentences(said)),
        *filled([table(words, results.groups)]),
        *figures(words, results.image_residuals),
    )
    return Part("observations", words.text("observations.title"), content)


def table(words: Words, groups: Sequence[GroupSummary]) -> Table:
    """Groups of observations with their residuals and variance factors."""
    rows = [row for row in groups if row.n]
    units = [unit_of(row.unit) for row in rows]
    rms = scaled([row.rms for row in rows], units)
    detectable = scaled([row.median_detectable for row in rows], units)
    columns = [
        text_column(
            words.text("bundle_column.observations"), [words.of("group", r.group) for r in rows]
        ),
        count_column(words.text("bundle_column.number"), [row.n for row in rows]),
        number_column(
            words.text("bundle_column.redundancy"), "", [row.redundancy for row in rows], 4
        ),
        number_column(words.text("bundle_column.rms"), "", rms),
        number_column(words.text("bundle_column.detectable"), "", detectable),
        text_column(words.text("bundle_column.unit"), [unit.name for unit in units]),
        number_column(
            words.text("bundle_column.factor"), "", [row.variance_factor for row in rows]
        ),
    ]
    factors = [row.weight_factor for row in rows]
    if any(factor is not None for factor in factors):
        title, unit = words.text("bundle_column.estimated"), words.text("unit.stated")
        columns.append(number_column(title, unit, factors))
    notes = (words.text("groups.factor"), words.text("groups.detectable"))
    return Table("groups", words.text("groups.caption"), tuple(columns), notes)


def figures(words: Words, cells: Sequence[FormatCell]) -> list[Drawing]:
    """Mean residual vectors over the image format, one figure per camera."""
    known = [cell for cell in cells if cell.n >= LEAST_RAYS]
    return [
        _figure(words, camera, [cell for cell in known if cell.camera == camera], number)
        for number, camera in enumerate(dict.fromkeys(cell.camera for cell in known), start=1)
    ]


def _figure(words: Words, camera: str, cells: Sequence[FormatCell], number: int) -> Drawing:
    place = np.array([(cell.x_px, cell.y_px) for cell in cells])
    mean = np.array([(cell.dx_px, cell.dy_px) for cell in cells])
    size, largest = _spacing(place), float(np.hypot(*mean.T).max())
    scale = _ARROW_SHARE * size / largest if largest > 0.0 else 1.0
    width, height = np.ptp(place, axis=0) + size
    figure = style.new_figure(min(4.2 * height / width + 0.7, 4.4), 5.2)
    axis = figure.add_subplot(aspect="equal")
    axis.plot(*place.T, **style.dots(style.LIGHT, 2.0))
    for start, arrow in zip(place, scale * mean, strict=True):
        axis.annotate("", tuple(start + arrow), tuple(start), arrowprops=_ARROW,
                      annotation_clip=False)  # fmt: skip  # else none that ends outside
    _dress(words, axis, place, size)
    caption = _caption(words, camera, cells, size, largest)
    return style.finish(figure, f"residuals_{number}", words.text("residuals.title"), caption)


def _dress(words: Words, axis: Axes, place: Floats, size: float) -> None:
    """Limits and ticks of the format."""
    low, high = place.min(axis=0) - size / 2.0, place.max(axis=0) + size / 2.0
    axis.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]),
             xlabel=words.text("bundle_axis.x"), ylabel=words.text("bundle_axis.y"))  # fmt: skip
    style.plain_ticks(axis)
    for side in (axis.xaxis, axis.yaxis):
        side.set_major_locator(MaxNLocator(5, steps=[1, 2, 5, 10]))


def _caption(
    words: Words, camera: str, cells: Sequence[FormatCell], size: float, largest: float
) -> str:
    rms = [cell.rms_px for cell in cells]
    place = words.text("residuals.of_camera", camera=camera) if camera else ""
    return words.text(
        "residuals.caption",
        camera=place,
        size=fmt.count(size),
        largest=fmt.with_unit(largest, "px", 2),
        low=fmt.number(min(rms), 2),
        high=fmt.with_unit(max(rms), "px", 2),
    )


def _spacing(place: Floats) -> float:
    """Side of a cell."""
    steps = np.diff(np.unique(place[:, 0]))
    return float(np.min(steps)) if len(steps) else 1000.0
