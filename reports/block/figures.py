"""All figures of a block's report, as SVG text."""

from pathlib import Path

from posstats.contract.results import Results

from ..document.drawing import Drawing
from ..figures.style import style
from . import bar_figures as figure_parallax
from . import plan_figures as figure_plan
from .line_figures import regressions


def draw(results: Results) -> dict[str, Drawing]:
    """Every figure that the results allow, by name; what cannot be drawn is left out.

    Parameters
    ----------
    results
        What the analysis found.

    Returns
    -------
    dict
        ``plan``, ``models``, ``error_sources``, ``regression_<frame>_<angle>``, ``corrected``,
        ``check_points``, in the order of the report.
    """
    with style():
        drawings = [
            figure_plan.block_plan(results),
            figure_parallax.by_model(results),
            figure_parallax.error_sources(results),
            *regressions(results),
            figure_parallax.corrected(results),
            figure_plan.check_point_plan(results),
        ]
    return {drawing.name: drawing for drawing in drawings if drawing}


def write_figures(
    results: Results, folder: Path, drawings: dict[str, Drawing] | None = None
) -> list[Path]:
    """Write every figure as ``<name>.svg`` into a folder, made if it does not exist.

    `drawings` are those of the results if they have been drawn already.
    """
    folder.mkdir(parents=True, exist_ok=True)
    written = []
    for name, drawing in (drawings or draw(results)).items():
        path = folder / f"{name}.svg"
        path.write_text(f'<?xml version="1.0" encoding="utf-8"?>\n{drawing.svg}', encoding="utf-8")
        written.append(path)
    return written
