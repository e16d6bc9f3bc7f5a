"""The results of a block folder again, with the settings that other results state."""

from collections.abc import Sequence
from pathlib import Path, PurePath

from posstats.adjustment.calibration import calibrated
from posstats.analysis.results import results
from posstats.analysis.steps import Settings, analyse
from posstats.contract.results import AnalysisSettings, Results
from posstats.contract.survey import InputFile
from posstats.formats.block_folder import read_block
from posstats.formats.toml_section import FILE


def recompute(folder: Path, pattern: Results) -> Results:
    """Analyse a block folder as `pattern`, its earlier results, says it was analysed.

    Files that the command line named, a rule set or a calibration, are looked for in the folder.

    Raises
    ------
    PosstatsError
        If the block is refused, or a file is missing.
    """
    block = read_block(folder)
    for name in _calibrations(pattern.block.inputs):
        block = calibrated(block, folder / name)
    return results(analyse(block, _settings(folder, pattern.settings)), created=pattern.created)


def _calibrations(inputs: Sequence[InputFile]) -> list[str]:
    names = [PurePath(row.file).name for row in inputs]
    return [name for name in names if name.endswith(".toml") and name != FILE]


def _settings(folder: Path, stated: AnalysisSettings) -> Settings:
    named = PurePath(stated.rules)
    return Settings(
        rules=folder / named.name if named.suffix else stated.rules,
        scope=stated.scope,
        errors=stated.errors,
        frame=stated.frame_setting,
        robust=stated.robust,
    )
