"""Regression of angle errors on time: data, line, confidence band and residuals, OLS and GLS."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.special import stdtrit

from . import figure_style as style
from . import format as fmt
from .results_view import Results, Row, angles, decided_by_strip, first, rows, setting

FloatArray = npt.NDArray[np.float64]


@dataclass(frozen=True)
class Line:
    """A fitted line with its 95 % confidence band, in radians over absolute time in seconds."""

    intercept_rad: float
    slope_rad_per_s: float
    origin_s: float
    intercept_se: float
    slope_se: float
    covariance: float
    df_resid: float

    def at(self, time_s: FloatArray) -> FloatArray:
        """Fitted error at times."""
        return self.intercept_rad + self.slope_rad_per_s * (time_s - self.origin_s)

    def half_width(self, time_s: FloatArray) -> FloatArray:
        """Half of the 95 % confidence interval of the line at times."""
        dt = time_s - self.origin_s
        variance = self.intercept_se**2 + 2.0 * dt * self.covariance + (dt * self.slope_se) ** 2
        quantile = float(stdtrit(self.df_resid, 0.975)) if self.df_resid > 0 else math.nan
        return quantile * np.sqrt(np.maximum(variance, 0.0))


def ordinary(row: Row) -> Line | None:
    """The OLS line of a regression row, or None if it could not be fitted."""
    return _line(row, "intercept_rad", "slope_rad_per_s", "intercept_se_rad", "slope_se",
                 "cov_intercept_slope", "df_resid")  # fmt: skip


def generalised(row: Row) -> Line | None:
    """The GLS line of a regression row, or None if it could not be fitted."""
    return _line(row, "gls_intercept_rad", "gls_slope_rad_per_s", "gls_intercept_se",
                 "gls_slope_se", "gls_cov_intercept_slope", "gls_df_resid")  # fmt: skip


def _line(row: Row, *names: str) -> Line | None:
    keys = [*names[:2], "time_origin_s", *names[2:]]
    values = [row.get(key) for key in keys]
    if any(fmt.is_missing(value) for value in values):
        return None
    return Line(*(float(value) for value in values if value is not None))


def regressions(results: Results) -> list[style.Drawing]:
    """One figure per angle of the frame of the corrections, if its errors are in the results."""
    frame = setting(results, "frame", "ground")
    drawings = [_regression(results, frame, angle) for angle in angles(frame)]
    return [drawing for drawing in drawings if drawing]


def _regression(results: Results, frame: str, angle: str) -> style.Drawing | None:
    data = [row for row in rows(results, "angle_errors") if row.get("used")
            and not fmt.is_missing(row.get(f"{angle}_rad"))]  # fmt: skip
    if not data:
        return None
    unit = fmt.angle_unit(row[f"{angle}_rad"] for row in data)
    start = min(row["time_s"] for row in data)
    figure = style.new_figure(3.7)
    upper, lower = figure.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
    lines = _fitted(results, frame, angle)
    _points(upper, lower, data, angle, unit, start, lines)
    for scope, (ols, gls) in lines.items():
        times = np.array([row["time_s"] for row in data if scope in ("block", row["strip"])])
        _draw_line(upper, ols, times, start, unit, style.BLACK, "-", "OLS line, 95 % band")
        _draw_line(upper, gls, times, start, unit, style.PURPLE, "--", "GLS line, 95 % band")
    for row in rows(results, "selection", frame=frame, angle=angle, form="constant"):
        _draw_constant(upper, results, row, unit)
    _keep_data_large(upper, [row[f"{angle}_rad"] * unit.per_si for row in data])
    _axes(upper, lower, angle, unit)
    _legend(figure, upper)
    caption = _caption(angle, frame, start, bool(lines))
    name = f"regression_{frame}_{angle}"
    return style.finish(figure, name, f"Regression of the error of {angle} on time", caption)


def _fitted(results: Results, frame: str, angle: str) -> dict[str, tuple[Line | None, Line | None]]:
    """Lines of the scope the analysis decided at: the block's, or one per strip."""
    by_strip = decided_by_strip(results)
    fitted = {}
    for row in rows(results, "regression", frame=frame, angle=angle):
        if (row["scope"] != "block") == by_strip and (ordinary(row) or generalised(row)):
            fitted[row["scope"]] = (ordinary(row), generalised(row))
    return fitted


def _points(
    upper: Axes,
    lower: Axes,
    data: Sequence[Row],
    angle: str,
    unit: fmt.Unit,
    start: float,
    lines: dict[str, tuple[Line | None, Line | None]],
) -> None:
    strips = list(dict.fromkeys(row["strip"] for row in data))
    for strip, (colour, marker) in style.strip_style(strips).items():
        part = [row for row in data if row["strip"] == strip]
        time = np.array([row["time_s"] for row in part])
        error = np.array([row[f"{angle}_rad"] for row in part])
        look = {"color": colour, "marker": marker, "ls": "", "ms": 3.2, "mew": 0.6, "mfc": "none"}
        upper.plot(time - start, error * unit.per_si, label=style.shortened(strip), **look)  # type: ignore[arg-type]
        ols = lines.get("block", lines.get(strip, (None, None)))[0]
        if ols:
            lower.plot(time - start, (error - ols.at(time)) * unit.per_si, **look)  # type: ignore[arg-type]


def _draw_line(
    axis: Axes,
    line: Line | None,
    times: FloatArray,
    start: float,
    unit: fmt.Unit,
    colour: str,
    dash: str,
    label: str,
) -> None:
    if line is None or not times.size:
        return
    grid = np.linspace(times.min(), times.max(), 40)
    middle, half = line.at(grid), line.half_width(grid)
    known = label in axis.get_legend_handles_labels()[1]
    axis.fill_between(grid - start, (middle - half) * unit.per_si, (middle + half) * unit.per_si,
                      color=colour, alpha=0.22, lw=0)  # fmt: skip
    axis.plot(grid - start, middle * unit.per_si, color=colour, ls=dash, lw=1.3,
              label="_" if known else label)  # fmt: skip


def _draw_constant(axis: Axes, results: Results, decision: Row, unit: fmt.Unit) -> None:
    """The constant that is taken off the whole block."""
    which = {key: decision[key] for key in ("frame", "angle", "scope")}
    constant = first(results, "regression", **which).get("constant_rad")
    if decision["scope"] == "block" and constant is not None:
        axis.axhline(constant * unit.per_si, color=style.GREEN, ls="-.", lw=1.3,
                     label="constant taken off")  # fmt: skip


def _keep_data_large(axis: Axes, values: Sequence[float]) -> None:
    """Limits at which no wide confidence band makes the data small."""
    room = max(max(values) - min(values), 1e-12)
    low, high = axis.get_ylim()
    axis.set_ylim(max(low, min(values) - 0.3 * room), min(high, max(values) + 0.3 * room))


def _axes(upper: Axes, lower: Axes, angle: str, unit: fmt.Unit) -> None:
    upper.set_ylabel(f"error of {angle}, {unit.name}")
    lower.set_ylabel(f"residual, {unit.name}")
    lower.set_xlabel("time since the first exposure shown, s")
    lower.axhline(0.0, color=style.GREY, lw=0.8)
    for axis in (upper, lower):
        axis.grid(axis="y")
        axis.ticklabel_format(useOffset=False)
    upper.figure.align_ylabels([upper, lower])


def _legend(figure: Figure, axis: Axes) -> None:
    _, labels = axis.get_legend_handles_labels()
    longest = max(len(label) for label in labels)
    style.legend_below(figure, axis, max(3, min(9, 110 // (longest + 6))))


def _caption(angle: str, frame: str, start: float, fitted: bool) -> str:
    lines = (
        " Solid: ordinary least squares; dashed: generalised least squares; shaded: 95 % "
        "confidence band of each line. Below: residuals of the OLS line (GLS bands are wider where "
        "the errors of neighbouring images are correlated)."
        if fitted
        else " No line could be fitted; the reason is given with the table of regressions."
    )
    return (
        f"Error of {angle} (POS minus estimated, {frame} frame) over time, one sign per strip; the "
        f"first exposure shown is at {fmt.count(start)} s.{lines}"
    )
