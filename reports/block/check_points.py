"""Topic: accuracy on the ground, by check points."""

from collections.abc import Sequence

from posstats.contract.check_points import CheckPointStatistics
from posstats.contract.results import Results

from ..document.content import Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.rows import rows
from ..document.table import Column, Table, count_column, number_column, text_column
from ..figures import style
from ..figures.difference_plan import Panel, difference_plan
from .words import BlockReport, Words

AXES = ("east", "north", "up")


def topic(report: BlockReport) -> Part:
    """Differences by every orientation, mean removed and kept."""
    words, results = report.words, report.results
    tables = filled(table(words, results, is_removed) for is_removed in (True, False))
    title = words.text("check_points.title")
    if not tables:
        return Part("check-points", title, (Paragraph(words.text("check_points.none")),))
    text = Paragraph(words.text("check_points.text"))
    return Part("check-points", title, (text, *tables, *known(figure(words, results))))


def table(words: Words, results: Results, translation_removed: bool) -> Table:
    """Check-point differences of every orientation, mean shift removed or kept."""
    chosen = results.verdict.corrected_angles
    stated = rows(results.check_points, translation_removed=translation_removed)
    kept = [row for row in stated if row.n]
    how = "removed" if translation_removed else "kept"
    columns = (
        text_column(
            words.text("column.orientation"),
            [words.orientation(row.orientation, chosen) for row in kept],
        ),
        count_column(words.text("column.points"), [row.n for row in kept]),
        *_sizes(words, kept),
        *(() if translation_removed else _shifts(words, kept)),
    )
    notes = (words.of("check_points_note", how),)
    caption = words.of("check_points_caption", how)
    return Table(f"check_points_shift_{how}", caption, columns, notes)


def _sizes(words: Words, kept: Sequence[CheckPointStatistics]) -> tuple[Column, ...]:
    of = {
        "max": ([r.max_horizontal_m for r in kept], [r.max_vertical_m for r in kept]),
        "min": ([r.min_horizontal_m for r in kept], [r.min_vertical_m for r in kept]),
        "rmse": ([r.rmse_horizontal_m for r in kept], [r.rmse_vertical_m for r in kept]),
    }
    letters = words.text("column.horizontal"), words.text("column.vertical")
    return tuple(
        number_column(letter, "m", values, group=words.of("statistic", name))
        for name, sides in of.items()
        for letter, values in zip(letters, sides, strict=True)
    )


def _shifts(words: Words, kept: Sequence[CheckPointStatistics]) -> tuple[Column, ...]:
    """The mean difference along the axes."""
    shifts = [row.shift_m or (None, None, None) for row in kept]
    group = words.text("statistic.mean")
    return tuple(
        number_column(words.of("direction", axis), "m", [shift[k] for shift in shifts], group=group)
        for k, axis in enumerate(AXES)
    )


def figure(words: Words, results: Results) -> Drawing | None:
    """Differences before and after the selected correction, mean removed."""
    panels = [
        Panel(words.of("panel", name), rows(results.check_point_residuals, orientation=name))
        for name in ("pos", "selected")
    ]
    axes = words.text("axis.east"), words.text("axis.north")
    drawn = difference_plan(results.images, panels, axes, centred=True)
    if drawn is None:
        return None
    picture, is_turned = drawn
    caption = words.text("check_points.turned" if is_turned else "check_points.figure")
    return style.finish(picture, "check_points", words.text("check_points.figure_title"), caption)
