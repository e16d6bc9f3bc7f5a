"""The numbers that the first source paper prints (Tables 1 to 4), and what they imply."""

import math
import tomllib
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import Any, Literal

from scipy.special import fdtrc

Row = dict[str, Any]
TableNumber = Literal[1, 2, 3, 4]


def published(table: TableNumber, **conditions: object) -> list[Row]:
    """Rows of a printed table whose values equal the conditions, e.g. ``published(2, area=1)``.

    Lengths in the unit that the column's name gives; slopes and intercepts of Table 3 as printed,
    since the paper gives neither their unit nor the origin of time.
    """
    content = _content()[f"table{table}"]
    rows = (dict(zip(content["columns"], row, strict=True)) for row in content["rows"])
    return [row for row in rows if all(row[key] == value for key, value in conditions.items())]


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
            angle=row["angle"],
            df_resid=df_resid,
            r_squared=row["f_statistic"] / (row["f_statistic"] + df_resid),
            p_value=float(fdtrc(1, df_resid, row["f_statistic"])),
            zero_crossing_t=-row["intercept"] / row["slope_per_t"],
        )
        for row in published(3)
    )


def consistent_residual_df(most: int = 1000) -> tuple[int, ...]:
    """Residual degrees of freedom for which all printed R2 (cut to 3) and p (cut to 4) agree."""
    return tuple(df for df in range(1, most + 1) if _agree(recomputed(df)))


def _agree(rows: Iterable[PrintedRegression]) -> bool:
    return all(
        _cut(each.r_squared, 3) == printed["r_squared"]
        and _cut(each.p_value, 4) == printed["p_value"]
        for each, printed in zip(rows, published(3), strict=True)
    )


def _cut(value: float, decimals: int) -> float:
    """The value without the decimals that were not printed."""
    return math.floor(value * 10.0**decimals) / 10.0**decimals


@lru_cache(maxsize=1)
def _content() -> dict[str, Any]:
    text = (files("posstats") / "experiment" / "published.toml").read_text(encoding="utf-8")
    content: dict[str, Any] = tomllib.loads(text)
    return content
