"""The key figures of a block: a few numbers that stand below its verdict."""

from dataclasses import dataclass

from ..block.view import Results, Row, first, verdict
from . import format as fmt


@dataclass(frozen=True)
class KeyFigure:
    """One number of the verdict, with what it is and a remark."""

    label: str
    value: str
    unit: str
    remark: str


def key_figures(results: Results) -> tuple[KeyFigure, ...]:
    """Parallax from POS, after correction and after relative orientation; check-point accuracy."""
    numbers = verdict(results)
    figures = [
        _parallax_figure(numbers, name, label)
        for name, label in (
            ("raw", "POS as delivered"),
            ("corrected", "POS, corrected"),
            ("relative", "Relative orientation"),
        )
        if name != "corrected" or numbers.get("corrected_angles")
    ]
    point = first(results, "check_points", orientation="selected", translation_removed=False)
    if not fmt.is_missing(point.get("rmse_horizontal_m")):
        value = f"{fmt.number(point['rmse_horizontal_m'])} / {fmt.number(point['rmse_vertical_m'])}"
        label = "Check points, corrected" if numbers.get("corrected_angles") else "Check points"
        remark = f"RMSE H / V, {point['n']} points, mean kept"
        figures.append(KeyFigure(label, value, "m", remark))
    return tuple(figures)


def _parallax_figure(numbers: Row, name: str, label: str) -> KeyFigure:
    mm = numbers.get(f"{name}_mm")
    remark = "mean vertical parallax" + (
        "" if fmt.is_missing(mm) else f", {fmt.with_unit(mm, 'mm', 2)}"
    )
    return KeyFigure(label, fmt.number(numbers.get(f"{name}_px")), "px", remark)
