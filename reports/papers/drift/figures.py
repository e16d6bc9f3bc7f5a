"""Figures 1 to 3 of the first source paper, redrawn for a simulated test area."""

from posstats.contract.results import Results

<<<<<<< HEAD
from posstats.contract.results import Regression, Results
from posstats.papers.drift.findings import known, only_row

from ...block.bar_figures import Bars, bar_figure, corrections, held_angles
from ...block.line_figures import (
    Panel,
    generalised,
    legend_entries,
    ordinary,
)
from ...block.view import GROUND_ANGLES, errors_of, strips, strips_with_models, used_errors
from ...document import format as fmt
=======
>>>>>>> h-pap
from ...document.drawing import Drawing
from ...figures import style
from . import corrected, regression, sources
from .words import Words

AXES = ("strip", "mean RMS vertical parallax")
LINES = ("OLS line, 95 % band", "GLS line, 95 % band")
HELD = {
    "angles": "all three angles held",
    "omega": "omega held",
    "phi": "phi held",
    "kappa": "kappa held",
    "none": "none held",
}
CORRECTED = {
    "pos": "POS as delivered",
    "omega": "omega corrected",
    "phi": "phi corrected",
    "kappa": "kappa corrected",
    "independent": "relative orientation",
}


def draw_area(words: Words, area: int, results: Results) -> tuple[Drawing, Drawing, Drawing]:
    """The paper's three figures for one area, in millimetres at image scale and over time.

    Parameters
    ----------
    words
        Of the report.
    area
        Number of the area; part of the figures' names.
    results
        Of the simulated area, in the ground frame with a block-wide line.

    Returns
    -------
    tuple
        ``area<n>_error_sources``, ``area<n>_regression``, ``area<n>_corrected`` (Figures 1 to 3).
    """
<<<<<<< HEAD
    with style.style():
        return _error_sources(area, results), _regression(area, results), _corrected(area, results)


def _error_sources(area: int, results: Results) -> Drawing:
    bars = held_angles(results, "mm", HELD)
    figure = bar_figure(bars, strips_with_models(results), "mm", AXES)
    every, omega, phi, kappa, none = bars
    caption = (
        f"Simulated area {area}, predicted: mean RMS vertical parallax by strip, logarithmic, "
        "after relative orientation with POS angles of the right image held. Grey: what none held "
        "leaves. "
        f"Holding omega alone leaves {_percent(omega, every)} of the parallax with all three "
        f"angles held; holding phi or kappa alone leaves {_percent(phi, none)} and "
        f"{_percent(kappa, none)} of that with none held."
    )
    title = f"Simulated area {area}: vertical parallax with POS angles held"
    return style.finish(figure, f"area{area}_error_sources", title, caption)


def _corrected(area: int, results: Results) -> Drawing:
    bars = corrections(results, "mm", CORRECTED)
    figure = bar_figure(bars, strips_with_models(results), "mm", AXES)
    pos, omega, phi, kappa, relative = bars
    caption = (
        f"Simulated area {area}, predicted: mean RMS vertical parallax by strip, logarithmic, from "
        "the POS, with the line of one angle taken off, and after relative orientation (grey). "
        f"Correcting omega leaves {_percent(omega, pos)} of the parallax of the POS, "
        f"{_percent(omega, relative)} of that of relative orientation; correcting phi leaves "
        f"{_percent(phi, pos)} of that of the POS, and correcting kappa {_percent(kappa, pos)}."
    )
    title = f"Simulated area {area}: vertical parallax with one angle corrected"
    return style.finish(figure, f"area{area}_corrected", title, caption)


def _percent(part: Bars, whole: Bars) -> str:
    """Mean parallax as a share of another, never parted from its sign."""
    if part.mean is None or not whole.mean:
        return fmt.MISSING
    return fmt.with_unit(100.0 * part.mean / whole.mean, "%")


def _regression(area: int, results: Results) -> Drawing:
    figure = style.new_figure(3.85)
    panels = figure.subplots(len(GROUND_ANGLES), 1, sharex=True)
    for axis, angle in zip(panels, GROUND_ANGLES, strict=True):
        _angle_panel(axis, results, angle)
    _name_strips(panels[0], results)
    panels[-1].set_xlabel("time since the first exposure, s")
    figure.align_ylabels(panels)
    handles, labels = legend_entries(panels[0])
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))
    caption = (
        f"Simulated area {area}, predicted: errors of the POS angles (POS minus estimated, ground "
        "frame) over time, with line and 95 % band of the block by ordinary (OLS) and generalised "
        f"least squares (GLS). {_drifts(results)} The unit differs between panels."
    )
    title = f"Simulated area {area}: errors of omega, phi and kappa over time"
    return style.finish(figure, f"area{area}_regression", title, caption)


def _angle_panel(axis: Axes, results: Results, angle: str) -> None:
    data = used_errors(results, angle)
    errors = errors_of(data, angle)
    panel = Panel(axis, fmt.angle_unit(errors), _start(results), LINES)
    for strip, (colour, _) in style.strip_style(strips(results)).items():
        part = [row for row in data if row.strip == strip]
        panel.points([row.time_s for row in part], errors_of(part, angle), "_",
                     style.dots(colour, 2.2))  # fmt: skip
    line = _line(results, angle)
    panel.fit([row.time_s for row in data], ordinary(line), generalised(line))
    panel.keep_large(errors)
    panel.label("error")
    axis.set_title(_test(angle, line), loc="left", pad=14.0 if angle == GROUND_ANGLES[0] else 5.0)


def _test(angle: str, line: Regression) -> str:
    """What the regression of an angle says, for the head of its panel."""
    ordinary_p, generalised_p = fmt.p_phrase(line.p_value), fmt.p_phrase(line.gls_p_value)
    return (
        f"{angle}: {_r_squared(known(line.r_squared))}, {ordinary_p} (OLS), {generalised_p} (GLS)"
    )


def _r_squared(value: float) -> str:
    """Four decimals as the paper prints them, and never a 0 or 1 that only rounding makes."""
    if value < 1e-4:
        return "R² < 0.0001"
    return f"R² = {fmt.fixed(value, 4)}" if value <= 0.9999 else "R² > 0.9999"


def _drifts(results: Results) -> str:
    """How far the line of each angle goes in the time of the block, and the scatter about it."""
    times = [row.time_s for row in results.angle_errors]
    parts = []
    for angle in GROUND_ANGLES:
        line = _line(results, angle)
        change = abs(known(line.slope_rad_per_s)) * (max(times) - min(times))
        scatter = _small_angle(known(line.sigma_rad))
        parts.append(f"{_small_angle(change)} for {angle} (scatter about it {scatter})")
    return f"From the first exposure to the last the OLS lines change by {fmt.joined(parts)}."


def _small_angle(value_rad: float) -> str:
    unit = fmt.angle_unit([value_rad])
    return fmt.with_unit(unit.scaled(value_rad), unit.name)


def _line(results: Results, angle: str) -> Regression:
    return only_row(results.regression, frame="ground", angle=angle, scope="block")


def _start(results: Results) -> float:
    return min(row.time_s for row in results.angle_errors)


def _name_strips(axis: Axes, results: Results) -> None:
    """Ids of the strips over a panel, in the middle of their time."""
    for k, strip in enumerate(strips(results)):
        times = [row.time_s for row in results.angle_errors if row.strip == strip]
        place = (min(times) + max(times)) / 2.0 - _start(results)
        axis.text(place, 1.02, f"strip {strip}" if k == 0 else strip, ha="center", va="bottom",
                  transform=axis.get_xaxis_transform(), fontsize=7.5)  # fmt: skip
=======
    with style.style(words.families()):
        return (
            sources.figure(words, area, results),
            regression.figure(words, area, results),
            corrected.figure(words, area, results),
        )
>>>>>>> h-pap
