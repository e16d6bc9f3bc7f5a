"""Topic: angle errors over time (Table 3, Figure 2)."""

from matplotlib.axes import Axes

from posstats.contract.results import Regression, Results
from posstats.numerics.kernels.rotation import ANGLE_NAMES
from posstats.papers.drift.findings import known, only_row

from ...block.line_figures import Panel, generalised, legend_entries, ordinary
from ...block.view import errors_of, strips, used_errors
from ...document import format as fmt
from ...document.content import Labelled, Paragraph, Part
from ...document.drawing import Drawing
from ...figures import style
from .regression_tables import lines, one_strip
from .report import Report
from .words import Words


def topic(words: Words, report: Report) -> Part:
    """One strip beside Table 3, Figure 2, the lines of all strips and blocks."""
    return Part(
        "regression",
        words.text("regression.title"),
        (
            Paragraph(words.text("regression.text")),
            Labelled("3a", one_strip(words, report.run)),
            *report.lettered(2),
            Labelled("3b", lines(words, report.run)),
        ),
    )


def figure(words: Words, area: int, results: Results) -> Drawing:
    """Figure 2 of an area: a panel for every angle."""
    made = style.new_figure(3.85)
    panels = made.subplots(len(ANGLE_NAMES), 1, sharex=True)
    for axis, angle in zip(panels, ANGLE_NAMES, strict=True):
        _angle_panel(words, axis, results, angle)
    _name_strips(words, panels[0], results)
    panels[-1].set_xlabel(words.text("regression.time"))
    made.align_ylabels(panels)
    handles, labels = legend_entries(panels[0])
    made.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    drifts = _drifts(words, results)
    title = words.text("regression.figure_title", area=str(area))
    caption = words.text("regression.figure_caption", area=str(area), drifts=drifts)
    return style.finish(made, f"area{area}_regression", title, caption)


def _angle_panel(words: Words, axis: Axes, results: Results, angle: str) -> None:
    data = used_errors(results, angle)
    errors = errors_of(data, angle)
    labels = words.text("regression.ols"), words.text("regression.gls")
    panel = Panel(axis, fmt.angle_unit(errors), _start(results), labels)
    for strip, (colour, _) in style.strip_style(strips(results)).items():
        part = [row for row in data if row.strip == strip]
        panel.points([row.time_s for row in part], errors_of(part, angle), "_",
                     style.dots(colour, 2.2))  # fmt: skip
    line = _line(results, angle)
    panel.fit([row.time_s for row in data], ordinary(line), generalised(line))
    panel.keep_large(errors)
    panel.label(words.text("regression.error"))
    first = angle == ANGLE_NAMES[0]
    axis.set_title(_test(words, angle, line), loc="left", pad=14.0 if first else 5.0)


def _test(words: Words, angle: str, line: Regression) -> str:
    """What the regression of an angle says, for the head of its panel."""
    return words.text(
        "regression.panel",
        angle=words.angle(angle),
        r_squared=_r_squared(known(line.r_squared)),
        ols=fmt.p_phrase(line.p_value),
        gls=fmt.p_phrase(line.gls_p_value),
    )


def _r_squared(value: float) -> str:
    """Four decimals as the paper prints them, and never a 0 or 1 that only rounding makes."""
    if value < 1e-4:
        return "R² < 0.0001"
    return f"R² = {fmt.fixed(value, 4)}" if value <= 0.9999 else "R² > 0.9999"


def _drifts(words: Words, results: Results) -> str:
    """How far the line of each angle goes in the time of the block, and the scatter about it."""
    times = [row.time_s for row in results.angle_errors]
    parts = []
    for angle in ANGLE_NAMES:
        line = _line(results, angle)
        change = abs(known(line.slope_rad_per_s)) * (max(times) - min(times))
        parts.append(
            words.text(
                "regression.drift",
                change=_small_angle(change),
                angle=words.angle(angle),
                scatter=_small_angle(known(line.sigma_rad)),
            )
        )
    return words.text("regression.drifts", drifts=words.joined(parts))


def _small_angle(value_rad: float) -> str:
    unit = fmt.angle_unit([value_rad])
    return fmt.with_unit(unit.scaled(value_rad), unit.name)


def _line(results: Results, angle: str) -> Regression:
    return only_row(results.regression, frame="ground", angle=angle, scope="block")


def _start(results: Results) -> float:
    return min(row.time_s for row in results.angle_errors)


def _name_strips(words: Words, axis: Axes, results: Results) -> None:
    """Ids of the strips over a panel, in the middle of their time."""
    for k, strip in enumerate(strips(results)):
        times = [row.time_s for row in results.angle_errors if row.strip == strip]
        place = (min(times) + max(times)) / 2.0 - _start(results)
        name = words.text("strip.nth", strip=strip) if k == 0 else strip
        axis.text(place, 1.02, name, ha="center", va="bottom",
                  transform=axis.get_xaxis_transform(), fontsize=7.5)  # fmt: skip
