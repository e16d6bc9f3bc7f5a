"""The results of a block folder again, with the settings that other results state."""

from pathlib import Path, PurePath

from posstats.adjustment.calibration import calibrated
from posstats.analysis.results import results
from posstats.analysis.steps import analyse
from posstats.contract.results import AnalysisSettings, Results
from posstats.formats.block_folder import read_block
from posstats.formats.block_toml import FILE
from posstats.settings import Settings

from ..block.wording import with_words


def recompute(folder: Path, pattern: Results) -> Results:
    """Analyse a block folder as `pattern`, its earlier results, says it was analysed.

    Files that the command line named, a rule set or a calibration, are looked for in the folder.

    Raises
    ------
    PosstatsError
        If the block is refused, or a file is missing.
    """
    block = read_block(folder)
    for name in _calibrations(pattern):
        block = calibrated(block, folder / name)
    analysis = analyse(block, _settings(folder, pattern.settings))
    return with_words(results(analysis, created=pattern.created))


def _calibrations(pattern: Results) -> list[str]:
    names = [PurePath(row.file).name for row in pattern.block.inputs]
    return [name for name in names if name.endswith(".toml") and name != FILE]


def _settings(folder: Path, stated: AnalysisSettings) -> Settings:
    rules = stated.rules
    named = PurePath(rules)
    return Settings(
        rules=folder / named.name if named.suffix else rules,
        scope=stated.scope,
        errors=stated.errors,
        frame=stated.frame_setting,
        robust=stated.robust,
    )
