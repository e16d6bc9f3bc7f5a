"""Topic: control points and check points, in tables and in plan."""

from collections.abc import Sequence

from posstats.contract.adjustment import AdjustmentResults, ControlPoint
from posstats.contract.check_points import CheckPointResidual, CheckPointStatistics

from ..document import format as fmt
from ..document.content import Content, Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.table import (
    Column,
    Table,
    aligned_column,
    count_column,
    number_column,
    text_column,
)
from ..figures import style
from ..figures.difference_plan import Panel, difference_plan
from .check_points import residuals
from .words import Words

SHOWN_POINTS = 60
_AXES = ("east", "north", "up")


def topic(words: Words, results: AdjustmentResults) -> Part:
    """Control points and check points."""
    title = words.text("points.title")
    tables = filled(
        [
            control_table(words, results.control_points),
            accuracy_table(words, results.check_points),
            check_table(words, residuals(results, "bundle")),
        ]
    )
    if not tables:
        return Part("points", title, (Paragraph(words.text("points.none")),))
    text = Paragraph(words.text("points.text"))
    content: tuple[Content, ...] = (text, *tables, *known(figure(words, results)))
    return Part("points", title, content)


def control_table(words: Words, rows: Sequence[ControlPoint]) -> Table:
    """Residuals of the control points."""
    shown = rows[:SHOWN_POINTS]
    differences = ([r.dx_m for r in shown], [r.dy_m for r in shown], [r.dz_m for r in shown])
    columns = (
        text_column(words.text("bundle_column.point"), [row.point for row in shown]),
        *_along_axes(words, differences, "head.adjusted"),
        aligned_column(words.text("bundle_column.largest_w"), "", [row.largest_w for row in shown]),
    )
    notes = not_shown(words, len(rows) - len(shown))
    return Table("control_points", words.text("control.caption"), columns, notes)


def accuracy_table(words: Words, rows: Sequence[CheckPointStatistics]) -> Table:
    """Check-point differences of every orientation, mean shift kept."""
    kept = [row for row in rows if row.n and not row.translation_removed]

    def column(title: str, group: str, values: Sequence[float | None]) -> Column:
        return number_column(words.text(title), "m", values, group=words.text(group))

    shifts = [row.shift_m or (None, None, None) for row in kept]
    columns = (
        text_column(
            words.text("bundle_column.orientation"),
            [words.of("bundle_orientation", r.orientation) for r in kept],
        ),
        count_column(words.text("bundle_column.points"), [row.n for row in kept]),
        column("bundle_column.h", "head.maximum", [row.max_horizontal_m for row in kept]),
        column("bundle_column.v", "head.maximum", [row.max_vertical_m for row in kept]),
        column("bundle_column.h", "head.minimum", [row.min_horizontal_m for row in kept]),
        column("bundle_column.v", "head.minimum", [row.min_vertical_m for row in kept]),
        column("bundle_column.h", "head.rmse", [row.rmse_horizontal_m for row in kept]),
        column("bundle_column.v", "head.rmse", [row.rmse_vertical_m for row in kept]),
        *(
            column(f"bundle_column.{axis}", "head.mean", [shift[k] for shift in shifts])
            for k, axis in enumerate(_AXES)
        ),
    )
    notes = (words.text("accuracy.note"),)
    return Table("check_points_shift_kept", words.text("accuracy.caption"), columns, notes)


def check_table(words: Words, rows: Sequence[CheckPointResidual]) -> Table:
    """Every check point with its standard deviations."""
    shown = rows[:SHOWN_POINTS]
    differences = ([r.dx_m for r in shown], [r.dy_m for r in shown], [r.dz_m for r in shown])
    sigmas = (
        [row.sigma_x_m for row in shown],
        [row.sigma_y_m for row in shown],
        [row.sigma_z_m for row in shown],
    )
    columns = (
        text_column(words.text("bundle_column.point"), [row.point for row in shown]),
        count_column(words.text("bundle_column.rays"), [row.n_rays for row in shown]),
        *_along_axes(words, differences, "head.computed"),
        *_along_axes(words, sigmas, "head.sigma"),
    )
    notes = not_shown(words, len(rows) - len(shown))
    return Table("check_point_list", words.text("checks.caption"), columns, notes)


def _along_axes(
    words: Words, values_m: Sequence[Sequence[float | None]], group: str
) -> tuple[Column, ...]:
    """Values east, north and up."""
    return tuple(
        aligned_column(words.text(f"bundle_column.{axis}"), "m", values, group=words.text(group))
        for axis, values in zip(_AXES, values_m, strict=True)
    )


def not_shown(words: Words, n_more: int) -> tuple[str, ...]:
    """A note on rows that a table leaves out."""
    return (words.text("table.more", n=fmt.count(n_more)),) if n_more > 0 else ()


def figure(words: Words, results: AdjustmentResults) -> Drawing | None:
    """Differences at check points from the POS and from the adjustment; None without."""
    panels = [
        Panel(words.of("panel", name), residuals(results, name)) for name in ("pos", "bundle")
    ]
    axes = (words.text("bundle_axis.east"), words.text("bundle_axis.north"))
    drawn = difference_plan(results.images, panels, axes, centred=False)
    if drawn is None:
        return None
    figure, turned = drawn
    caption = words.text("differences.turned" if turned else "differences.caption")
    return style.finish(figure, "check_points", words.text("differences.title"), caption)
