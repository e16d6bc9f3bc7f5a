"""The numbers of an analysis as files."""

from pathlib import Path
from typing import Any

from posstats.analysis.results import results
from posstats.analysis.steps import Analysis
from posstats.formats.block_folder import write_orientations
from posstats.plain_values import to_json


def write_analysis(analysis: Analysis, folder: Path, *, created: str) -> dict[str, Any]:
    """Write ``results.json`` and ``corrected_orientations.csv``; returns the results."""
    folder.mkdir(parents=True, exist_ok=True)
    values = results(analysis, created=created)
    (folder / "results.json").write_text(to_json(values), encoding="utf-8")
    selected = analysis.corrected_orientations["selected"]
    write_orientations(analysis.block, selected.angles_rad, folder / "corrected_orientations.csv")
    return values
