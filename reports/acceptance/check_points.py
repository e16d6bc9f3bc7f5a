"""Check points: every one with its differences, in a table and in plan."""

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from posstats.arrays import Floats
from posstats.contract.acceptance import JudgedPoint
from posstats.contract.survey import ImagePlace

from ..document import format as fmt
from ..document.content import Content, Paragraph, Part, known
from ..document.drawing import Drawing
from ..document.table import Column, Table, count_column, text_column
from ..figures import style
from ..figures.difference_plan import images_behind
from ..figures.plan_view import (
    PlanView,
    arrow_scale,
    difference_arrows,
    many_arrows,
    north_and_scale,
    scale_arrow,
    view_around,
)
from . import units
from .material import Material, finished, section
from .words import Words

PLAN_WIDTH_IN, PLAN_HEIGHT_IN = 5.2, 4.6
CROWDED = 60  # points from which their arrows are drawn smaller


def check_points(material: Material) -> Part:
    """Every check point of the assessed orientation."""
    words, points = material.words, material.acceptance.check_points
    if not points:
        return section(words, "check_points", [Paragraph(words.text("check_points.none"))])
    orientation = words.orientation(material.acceptance.orientation)
    said = [words.text("check_points.intro", orientation=orientation)]
    blunders = [point.point for point in points if point.blunder]
    if blunders:
        names = words.joined(blunders)
        said.append(words.counted("check_points.blunders", len(blunders), names=names))
    content: list[Content] = [Paragraph(words.sentences(said)), point_table(words, points)]
    content += known(point_plan(words, points, material.results.images))
    return section(words, "check_points", content)


def point_table(words: Words, points: Sequence[JudgedPoint]) -> Table:
    """Every check point with its coordinates, differences and the accuracy of its survey."""
    given = (("X", [p.x_m for p in points]), ("Y", [p.y_m for p in points]),
             ("Z", [p.z_m for p in points]))  # fmt: skip
    columns = (
        text_column(words.text("column.point"), [p.point for p in points]),
        *(
            Column(title, tuple(fmt.fixed(value, 2) for value in values), "m",
                   group=words.text("group.given"))
            for title, values in given
        ),
        *_differences(words, points),
        *_survey(words, points),
        count_column(words.text("column.rays"), [p.n_rays for p in points]),
        text_column(words.text("column.remark"), [_remark(words, p) for p in points]),
    )  # fmt: skip
    notes = (words.text("note.check_points"), words.text("note.check_point_survey"))
    return Table("check_points", words.text("table.check_points"), columns, notes)


def point_plan(
    words: Words, points: Sequence[JudgedPoint], images: Sequence[ImagePlace]
) -> Drawing | None:
    """Differences at the check points in plan, mean kept; blunders ringed."""
    found = [point for point in points if point.status == "ok"]
    if not found:
        return None
    view = view_around([*((p.x_m, p.y_m) for p in found), *((i.x_m, i.y_m) for i in images)])
    figure = _plan_figure(view)
    axis = figure.add_subplot()
    images_behind(axis, view, images)
    blunders = [(p.x_m, p.y_m) for p in found if p.blunder]
    if blunders:
        axis.plot(*view.drawn(blunders), "o", ms=11, mfc="none", mec=style.PURPLE, mew=1.6,
                  zorder=5)  # fmt: skip
    _draw_arrows(axis, view, found)
    view.dress(axis, (words.text("axis.east"), words.text("axis.north")))
    north_and_scale(axis, view)
    return finished(words, figure, "point_plan")


def differences_m(points: Sequence[JudgedPoint]) -> Floats:
    """(n, 3) of the points that were intersected."""
    known_ones = [(p.dx_m, p.dy_m, p.dz_m) for p in points if p.status == "ok"]
    return np.array(known_ones, dtype=float).reshape(-1, 3)


def _differences(words: Words, points: Sequence[JudgedPoint]) -> list[Column]:
    columns = {
        "ΔX": [p.dx_m for p in points],
        "ΔY": [p.dy_m for p in points],
        "ΔZ": [p.dz_m for p in points],
        "ΔH": [p.dh_m for p in points],
    }
    return _lengths(words, columns, "group.differences")


def _survey(words: Words, points: Sequence[JudgedPoint]) -> list[Column]:
    columns = {
        words.text("column.plane"): [p.survey_sigma_xy_m for p in points],
        words.text("column.height"): [p.survey_sigma_z_m for p in points],
    }
    stated = fmt.present(value for values in columns.values() for value in values)
    return _lengths(words, columns, "group.survey") if stated else []


def _lengths(words: Words, columns: dict[str, list[float | None]], group: str) -> list[Column]:
    """Columns of small lengths under one heading, all with the same decimals."""
    unit = words.unit.unit
    decimals = units.decimals_for((v for values in columns.values() for v in values), words.unit)
    return [
        Column(title, tuple(fmt.fixed(unit.scaled(value), decimals) for value in values),
               unit.name, group=words.text(group))
        for title, values in columns.items()
    ]  # fmt: skip


def _remark(words: Words, point: JudgedPoint) -> str:
    if point.status != "ok":
        return words.known("status", point.status)
    return words.text("status.blunder") if point.blunder else ""


def _plan_figure(view: PlanView) -> Figure:
    height = min(PLAN_WIDTH_IN * view.height_m / view.width_m, PLAN_HEIGHT_IN)
    return style.new_figure(height + 0.95)


def _draw_arrows(axis: Axes, view: PlanView, points: Sequence[JudgedPoint]) -> None:
    """Horizontal and vertical differences, at a scale that blunders do not spoil."""
    crowded = len(points) > CROWDED
    place = np.array([(p.x_m, p.y_m) for p in points])
    difference = differences_m(points)
    axis.plot(*view.drawn(place), **style.dots(style.BLACK, 1.4 if crowded else 2.4))
    regular = np.array([not p.blunder for p in points])
    lengths = np.linalg.norm(difference, axis=1)
    scale = arrow_scale(lengths[regular] if regular.any() else lengths, view)
    if scale is None:
        return
    vertical = np.column_stack([np.zeros(len(points)), difference[:, 2]])
    arrows = many_arrows if crowded else difference_arrows
    arrows(axis, view, place, difference[:, :2], scale[0], style.BLUE)
    arrows(axis, view, place, vertical, scale[0], style.VERMILLION, "--")
    scale_arrow(axis, view, scale, style.BLACK, row=1)
