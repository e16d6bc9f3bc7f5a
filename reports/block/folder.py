"""The numbers of an analysis as files."""

from pathlib import Path

from posstats.analysis.results import results
from posstats.analysis.steps import Analysis
from posstats.contract.files import to_json
from posstats.contract.results import Results
from posstats.formats.block_folder import write_orientations

from .wording import with_words


def write_analysis(analysis: Analysis, folder: Path, *, created: str) -> Results:
    """Write ``results.json`` and ``corrected_orientations.csv``; returns the results."""
    folder.mkdir(parents=True, exist_ok=True)
    found = with_words(results(analysis, created=created))
    (folder / "results.json").write_text(to_json(found), encoding="utf-8")
    selected = analysis.corrected_orientations["selected"]
    write_orientations(analysis.block, selected.angles_rad, folder / "corrected_orientations.csv")
    return found
