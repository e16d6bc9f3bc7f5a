"""`posstats analyse`: from a block folder to a folder of results and its report."""

from collections.abc import Iterator
from pathlib import Path

from posstats.adjustment.calibration import calibrated
from posstats.analysis.steps import analyse
from posstats.contract.choices import Language
from posstats.formats.block_folder import read_block
from posstats.settings import Settings

from ..block.folder import write_analysis
from ..block.report import write_report
from ..block.summary import summary
from ..output.progress import progress_bar
from ..output.staged_folder import staged_folder
from ..output.timestamp import now
from .command_line import written


def analyse_block(
    folder: Path,
    out: Path,
    settings: Settings,
    calibration: Path | None,
    *,
    language: Language,
    pdf: bool,
) -> Iterator[str]:
    """Analyse a block folder into `out`; yields the lines of the terminal summary."""
    with (
        staged_folder(out, replaced=("report.pdf",)) as stage,
        progress_bar("reading the block") as progress,
    ):
        block = read_block(folder)
        if calibration is not None:
            block = calibrated(block, calibration)
        analysis = analyse(block, settings, progress=lambda step, done: progress(step, 0.7 * done))
        values = write_analysis(analysis, stage, created=now())
        progress("writing the report", 0.75)
        missing = write_report(values, stage, language=language, pdf=pdf)
    yield from summary(values)
    yield from written(out, "report", missing, pdf=pdf)
