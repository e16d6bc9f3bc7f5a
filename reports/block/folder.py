"""The numbers of an analysis as files."""

from pathlib import Path
from typing import Any

from posstats.analysis.results import results
from posstats.analysis.steps import Analysis
from posstats.contract.files import as_values, to_json
from posstats.formats.block_folder import write_orientations

from .wording import with_words


def write_analysis(analysis: Analysis, folder: Path, *, created: str) -> dict[str, Any]:
    """Write ``results.json`` and ``corrected_orientations.csv``; returns the results."""
    folder.mkdir(parents=True, exist_ok=True)
    found = with_words(results(analysis, created=created))
    (folder / "results.json").write_text(to_json(found), encoding="utf-8")
    plain_results: dict[str, Any] = as_values(found)
    selected = analysis.corrected_orientations["selected"]
    write_orientations(analysis.block, selected.angles_rad, folder / "corrected_orientations.csv")
    return plain_results
