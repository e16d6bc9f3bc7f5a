"""The numbers that the first source paper prints (Tables 1 to 4), and what they imply."""

import math
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import Literal, overload

from msgspec import convert
from scipy.special import fdtrc

TableNumber = Literal[1, 2, 3, 4]

STRIP_RESIDUAL_DF = 58
"""Of Table 3: the only number for which its R2, F0 and p agree (`consistent_residual_df`)."""


@dataclass(frozen=True, kw_only=True)
class PrintedArea:
    """A row of Table 1; the unit is in the name."""

    area: int
    principal_distance_mm: float
    width_px: int
    height_px: int
    pixel_size_mm: float
    scale_denominator: int
    forward_overlap: float
    side_overlap: float
    n_strips: int
    n_images: int
    n_control_points: int
    n_tie_points: int


@dataclass(frozen=True, kw_only=True)
class PrintedParallax:
    """A row of Table 2: RMS vertical parallax of the models of a strip, in three ways."""

    area: int
    strip: str
    pos_max_mm: float
    pos_min_mm: float
    pos_mean_mm: float
    independent_max_mm: float
    independent_min_mm: float
    independent_mean_mm: float
    dependent_max_mm: float
    dependent_min_mm: float
    dependent_mean_mm: float


@dataclass(frozen=True, kw_only=True)
class PrintedLine:
    """A row of Table 3, as printed: the paper gives neither unit nor origin of time."""

    angle: str
    intercept: float
    slope_per_t: float
    r_squared: float
    f_statistic: float
    p_value: float


@dataclass(frozen=True, kw_only=True)
class PrintedCheckPoints:
    """A row of Table 4: differences after removal of their mean."""

    area: int
    n_check_points: int
    orientation: Literal["pos", "omega_corrected"]
    max_horizontal_m: float
    max_vertical_m: float
    min_horizontal_m: float
    min_vertical_m: float
    rmse_horizontal_m: float
    rmse_vertical_m: float


PrintedRow = PrintedArea | PrintedParallax | PrintedLine | PrintedCheckPoints
_ROWS: dict[TableNumber, type[PrintedRow]] = {
    1: PrintedArea,
    2: PrintedParallax,
    3: PrintedLine,
    4: PrintedCheckPoints,
}


@overload
def published(table: Literal[1], **conditions: object) -> list[PrintedArea]: ...
@overload
def published(table: Literal[2], **conditions: object) -> list[PrintedParallax]: ...
@overload
def published(table: Literal[3], **conditions: object) -> list[PrintedLine]: ...
@overload
def published(table: Literal[4], **conditions: object) -> list[PrintedCheckPoints]: ...
def published(table: TableNumber, **conditions: object) -> list[PrintedRow]:  # type: ignore[misc]
    """Rows of a printed table whose values equal the conditions, e.g. ``published(2, area=1)``."""
    return [
        row
        for row in _printed(table)
        if all(getattr(row, name) == value for name, value in conditions.items())
    ]


@dataclass(frozen=True)
class PrintedRegression:
    """A row of Table 3 recomputed from its F0.

    Attributes
    ----------
    angle
        Of the row.
    r_squared, p_value
        That F0 gives with `df_resid` residual degrees of freedom (eq. 3 and 4, one regressor):
        R2 = F0 / (F0 + df), p the upper tail of F(1, df).
    zero_crossing_t
        Time at which the printed line is zero, in the paper's unit.
    """

    angle: str
    df_resid: int
    r_squared: float
    p_value: float
    zero_crossing_t: float


def recomputed(df_resid: int) -> tuple[PrintedRegression, ...]:
    """Table 3 with R2 and p computed from its F0 and residual degrees of freedom."""
    return tuple(
        PrintedRegression(
            angle=row.angle,
            df_resid=df_resid,
            r_squared=row.f_statistic / (row.f_statistic + df_resid),
            p_value=float(fdtrc(1, df_resid, row.f_statistic)),
            zero_crossing_t=-row.intercept / row.slope_per_t,
        )
        for row in published(3)
    )


def consistent_residual_df(most: int = 1000) -> tuple[int, ...]:
    """Residual degrees of freedom for which all printed R2 (cut to 3) and p (cut to 4) agree."""
    return tuple(df for df in range(1, most + 1) if _agree(recomputed(df)))


def _agree(rows: Iterable[PrintedRegression]) -> bool:
    return all(
        _cut(each.r_squared, 3) == printed.r_squared and _cut(each.p_value, 4) == printed.p_value
        for each, printed in zip(rows, published(3), strict=True)
    )


def _cut(value: float, decimals: int) -> float:
    """The value without the decimals that were not printed."""
    return math.floor(value * 10.0**decimals) / 10.0**decimals


def implied_scatter(angle: str, time_spread: float) -> float:
    """Standard deviation about a printed line that its slope and R2 imply, in its unit.

    From eq. 3, with s_t the standard deviation of the times: slope s_t sqrt((1 - R2) / R2). R2 is
    taken from F0, of which more digits are printed.
    """
    (row,) = published(3, angle=angle)
    r_squared = row.f_statistic / (row.f_statistic + STRIP_RESIDUAL_DF)
    return float(abs(row.slope_per_t) * time_spread * math.sqrt((1.0 - r_squared) / r_squared))


def printed_gain(area: int) -> tuple[float, float]:
    """RMSE before over after of Table 4, minus 1, horizontal and vertical."""
    (before,), (after,) = (
        published(4, area=area, orientation=name) for name in ("pos", "omega_corrected")
    )
    horizontal, vertical = (
        getattr(before, f"rmse_{side}_m") / getattr(after, f"rmse_{side}_m") - 1.0
        for side in ("horizontal", "vertical")
    )
    return horizontal, vertical


def least_zero_mean_rmse(n: int, smallest: float, largest: float) -> float:
    """Least RMS of n numbers of mean zero whose magnitudes go from `smallest` to `largest`.

    One number is `largest`; the others are `smallest`, but those of the sign whose sum is too
    small, which share what is missing evenly. Table 4's residuals must not be below it.
    """
    return min(_rms_of_signs(n, k, smallest, largest) for k in range(1, n))


def _rms_of_signs(n: int, k: int, smallest: float, largest: float) -> float:
    """The same with k numbers of the sign of the largest; infinite where they cannot balance."""
    own, other = largest + (k - 1) * smallest, (n - k) * smallest
    if own >= other:
        shared = own / (n - k)
        squares = largest**2 + (k - 1) * smallest**2 + (n - k) * shared**2
        return math.sqrt(squares / n) if shared <= largest else math.inf
    if k == 1:
        return math.inf
    shared = (other - largest) / (k - 1)
    squares = largest**2 + (k - 1) * shared**2 + (n - k) * smallest**2
    return math.sqrt(squares / n) if shared <= largest else math.inf


def impossible_vertical_rmse() -> list[tuple[PrintedCheckPoints, float]]:
    """Rows of Table 4 whose vertical RMSE is below what a removed mean allows, with that, m."""
    least = [
        least_zero_mean_rmse(row.n_check_points, row.min_vertical_m, row.max_vertical_m)
        for row in published(4)
    ]
    pairs = zip(published(4), least, strict=True)
    return [(row, bound) for row, bound in pairs if row.rmse_vertical_m < bound]


@dataclass(frozen=True)
class _Table:
    """A table as it stands in the file."""

    columns: tuple[str, ...]
    rows: tuple[tuple[int | float | str, ...], ...]


@lru_cache(maxsize=len(_ROWS))
def _printed(table: TableNumber) -> tuple[PrintedRow, ...]:
    text = (files("posstats.papers.drift") / "published.toml").read_text(encoding="utf-8")
    content = convert(tomllib.loads(text)[f"table{table}"], _Table)
    named = (dict(zip(content.columns, row, strict=True)) for row in content.rows)
    return tuple(convert(each, _ROWS[table]) for each in named)
