"""`posstats analyse`: from a block folder to a folder of results and its report."""

import datetime as dt
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from posstats.analysis import Settings, analyse
from posstats.block_io import read_block, write_orientations
from posstats.results import results, to_json

from .output import staged_folder
from .pdf import PdfUnavailableError
from .progress import progress_bar
from .report import write_report
from .summary import summary


def analyse_block(folder: Path, out: Path, settings: Settings, *, pdf: bool) -> Iterator[str]:
    """Analyse a block folder into `out`; yields the lines of the terminal summary."""
    with staged_folder(out) as stage, progress_bar("reading the block") as progress:
        block = read_block(folder)
        analysis = analyse(block, settings, progress=lambda step, done: progress(step, 0.7 * done))
        values = results(analysis, created=_now())
        (stage / "results.json").write_text(to_json(values), encoding="utf-8")
        selected = analysis.corrected_orientations["selected"]
        write_orientations(block, selected.angles_rad, stage / "corrected_orientations.csv")
        progress("writing the report", 0.75)
        missing = _write_report(values, stage, pdf)
    yield from summary(values)
    yield ""
    if missing:
        yield missing
    yield f"report: {out / 'report.html'}" + (
        f", {out / 'report.pdf'}" if pdf and not missing else ""
    )


def _write_report(values: dict[str, Any], stage: Path, pdf: bool) -> str:
    """Write the report; says what is missing for a PDF, the rest being written all the same."""
    try:
        write_report(values, stage, pdf=pdf)
    except PdfUnavailableError as missing:
        return str(missing)
    return ""


def _now() -> str:
    """The time of the report; fixed by SOURCE_DATE_EPOCH for reproducible output."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    moment = (
        dt.datetime.now(dt.UTC) if epoch is None else dt.datetime.fromtimestamp(int(epoch), dt.UTC)
    )
    return moment.isoformat(timespec="seconds")
