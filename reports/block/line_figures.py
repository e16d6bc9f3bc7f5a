"""Regression of angle errors on time: data, line, confidence band and residuals, OLS and GLS."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from scipy.special import stdtrit

from posstats.arrays import Floats
from posstats.contract.results import ImageAngleErrors, Regression, Results

from ..document import format as fmt
from ..document.rows import rows
from ..figures import style
from .view import decided_by_strip, errors_of


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

    def at(self, time_s: Floats) -> Floats:
        """Fitted error at times."""
        return self.intercept_rad + self.slope_rad_per_s * (time_s - self.origin_s)

    def value(self, time_s: float) -> float:
        """Fitted error at one time."""
        return self.intercept_rad + self.slope_rad_per_s * (time_s - self.origin_s)

    def half_width(self, time_s: Floats) -> Floats:
        """Half of the 95 % confidence interval of the line at times."""
        dt = time_s - self.origin_s
        variance = self.intercept_se**2 + 2.0 * dt * self.covariance + (dt * self.slope_se) ** 2
        quantile = float(stdtrit(self.df_resid, 0.975)) if self.df_resid > 0 else math.nan
        return quantile * np.sqrt(np.maximum(variance, 0.0))


Lines = dict[str, tuple[Line | None, Line | None]]
"""OLS and GLS line of each scope."""


@dataclass(frozen=True)
class Panel:
    """Axes on which angle errors, shown in a unit, stand over the time since a start.

    `labels` name the OLS and the GLS line in the legend.
    """

    axis: Axes
    unit: fmt.Unit
    start_s: float
    labels: tuple[str, str]

    def points(
        self, time_s: npt.ArrayLike, error_rad: npt.ArrayLike, label: str, look: dict[str, Any]
    ) -> None:
        """Mark errors at times."""
        shown = np.asarray(error_rad) * self.unit.per_si
        self.axis.plot(np.asarray(time_s) - self.start_s, shown, label=label, **look)

    def fit(
        self,
        time_s: Sequence[float],
        ols: Line | None,
        gls: Line | None,
        zero: Line | None = None,
    ) -> None:
        """Draw lines and their bands over the span of times, less a line that is to be zero."""
        grid = np.linspace(min(time_s), max(time_s), 40)
        base = zero.at(grid) if zero else 0.0
        # Both black: lines that agree look like one.
        for line, label, dash, shade in (
            (ols, self.labels[0], "-", 0.22), (gls, self.labels[1], (0, (4, 2)), 0.13)
        ):  # fmt: skip
            if line:
                self._line(grid, line.at(grid) - base, line.half_width(grid), label, dash, shade)

    def _line(
        self,
        time_s: Floats,
        middle_rad: Floats,
        half_rad: Floats,
        label: str,
        dash: Any,
        shade: float,
    ) -> None:
        time, scale = time_s - self.start_s, self.unit.per_si
        label = "_" if label in self.axis.get_legend_handles_labels()[1] else label
        self.axis.fill_between(time, (middle_rad - half_rad) * scale,
                               (middle_rad + half_rad) * scale, color=style.BLACK, alpha=shade,
                               lw=0, label=label)  # fmt: skip
        self.axis.plot(time, middle_rad * scale, color=style.BLACK, ls=dash, lw=1.2, label=label)

    def keep_large(self, errors_rad: Sequence[float]) -> None:
        """Limits at which no wide confidence band makes the data small."""
        values = [error * self.unit.per_si for error in errors_rad]
        room = max(max(values) - min(values), 1e-12)
        low, high = self.axis.get_ylim()
        self.axis.set_ylim(max(low, min(values) - 0.3 * room), min(high, max(values) + 0.3 * room))

    def label(self, quantity: str) -> None:
        """Name the vertical axis, with its unit."""
        self.axis.set_ylabel(f"{quantity}, {self.unit.name}")
        self.axis.grid(axis="y")
        self.axis.ticklabel_format(useOffset=False)


def ordinary(row: Regression) -> Line | None:
    """The OLS line of a regression row, or None if it could not be fitted."""
    return _line(row.intercept_rad, row.slope_rad_per_s, row.time_origin_s, row.intercept_se_rad,
                 row.slope_se, row.cov_intercept_slope, row.df_resid)  # fmt: skip


def generalised(row: Regression) -> Line | None:
    """The GLS line of a regression row, or None if it could not be fitted."""
    return _line(row.gls_intercept_rad, row.gls_slope_rad_per_s, row.time_origin_s,
                 row.gls_intercept_se, row.gls_slope_se, row.gls_cov_intercept_slope,
                 row.gls_df_resid)  # fmt: skip


def _line(*values: float | None) -> Line | None:
    known = fmt.present(values)
    return Line(*known) if len(known) == len(values) else None


def fitted_lines(results: Results, frame: str, angle: str) -> Lines:
    """Lines of the scope the analysis decided at: the block's, or one per strip."""
    is_by_strip = decided_by_strip(results)
    fitted = {}
    for row in rows(results.regression, frame=frame, angle=angle):
        if (row.scope != "block") == is_by_strip and (ordinary(row) or generalised(row)):
            fitted[row.scope] = (ordinary(row), generalised(row))
    return fitted


def draw_errors(
    panel: Panel,
    data: Sequence[ImageAngleErrors],
    angle: str,
    lines: Lines,
    strip_words: str,
) -> None:
    """Errors of an angle with the fitted lines; `strip_words` has ``{strip}`` for a strip."""
    for strip, part, look in by_strip(data):
        errors = errors_of(part, angle)
        label = strip_words.format(strip=fmt.shortened(strip))
        panel.points([row.time_s for row in part], errors, label, look)
    for scope, (ols, gls) in lines.items():
        times = times_in(data, scope)
        if times:
            panel.fit(times, ols, gls)


def by_strip(
    data: Sequence[ImageAngleErrors],
) -> Iterator[tuple[str, list[ImageAngleErrors], dict[str, Any]]]:
    """Each strip, its rows and the look of its marks."""
    strips = dict.fromkeys(row.strip for row in data)
    for strip, (colour, marker) in style.strip_style(list(strips)).items():
        look = {"color": colour, "marker": marker, "ls": "", "ms": 3.2, "mew": 0.6, "mfc": "none"}
        yield strip, [row for row in data if row.strip == strip], look


def times_in(data: Sequence[ImageAngleErrors], scope: str) -> list[float]:
    """Times of the images of a scope."""
    return [row.time_s for row in data if scope in ("block", row.strip)]


def legend(figure: Figure, axis: Axes) -> None:
    """Strips and lines under the figure."""
    handles, labels = legend_entries(axis)
    longest = max(len(label) for label in labels)
    figure.legend(handles, labels, loc="outside lower center",
                  ncols=max(3, min(9, len(labels), 110 // (longest + 6))))  # fmt: skip


def legend_entries(axis: Axes) -> tuple[list[Any], list[str]]:
    """Handles and labels for a legend, where a line and its band have one label."""
    labelled: dict[str, list[Artist]] = {}
    for handle, label in zip(*axis.get_legend_handles_labels(), strict=True):
        labelled.setdefault(label, []).append(handle)
    return [tuple(handles) for handles in labelled.values()], list(labelled)
