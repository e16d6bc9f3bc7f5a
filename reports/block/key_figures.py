"""The key figures of a block: a few numbers that stand below its verdict."""

from posstats.contract.results import Results

from ..document import format as fmt
from ..document.key_figure import KeyFigure
from ..document.rows import first


def key_figures(results: Results) -> tuple[KeyFigure, ...]:
    """Parallax from POS, after correction and after relative orientation; check-point accuracy."""
    numbers = results.verdict
    figures = [_parallax_figure("POS as delivered", numbers.raw_px, numbers.raw_mm)]
    if numbers.corrected_angles:
        figures.append(
            _parallax_figure("POS, corrected", numbers.corrected_px, numbers.corrected_mm)
        )
    figures.append(
        _parallax_figure("Relative orientation", numbers.relative_px, numbers.relative_mm)
    )
    point = first(results.check_points, orientation="selected", translation_removed=False)
    if point and not fmt.is_missing(point.rmse_horizontal_m):
        value = f"{fmt.number(point.rmse_horizontal_m)} / {fmt.number(point.rmse_vertical_m)}"
        label = "Check points, corrected" if numbers.corrected_angles else "Check points"
        remark = f"RMSE H / V, {point.n} points, mean kept"
        figures.append(KeyFigure(label, value, "m", remark))
    return tuple(figures)


def _parallax_figure(label: str, px: float | None, mm: float | None) -> KeyFigure:
    remark = "mean vertical parallax" + (
        "" if fmt.is_missing(mm) else f", {fmt.with_unit(mm, 'mm', 2)}"
    )
    return KeyFigure(label, fmt.number(px), "px", remark)
