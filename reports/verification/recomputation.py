"""The results of a block folder again, with the settings that other results state."""

import json
from pathlib import Path, PurePath
from typing import Any

from posstats.adjustment.calibration import calibrated
from posstats.analysis.results import results
from posstats.analysis.steps import analyse
from posstats.contract.files import to_json
from posstats.formats.block_folder import read_block
from posstats.formats.block_toml import FILE
from posstats.settings import Settings


def recompute(folder: Path, pattern: dict[str, Any]) -> dict[str, Any]:
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
    analysis = analyse(block, _settings(folder, pattern["settings"]))
    values: dict[str, Any] = json.loads(to_json(results(analysis, created=pattern["created"])))
    return values


def _calibrations(pattern: dict[str, Any]) -> list[str]:
    names = [PurePath(row["file"]).name for row in pattern["block"]["inputs"]]
    return [name for name in names if name.endswith(".toml") and name != FILE]


def _settings(folder: Path, stated: dict[str, Any]) -> Settings:
    rules = stated["rules"]
    named = PurePath(rules)
    return Settings(
        rules=folder / named.name if named.suffix else rules,
        scope=stated["scope"],
        errors=stated["errors"],
        frame=stated["frame_setting"],
        robust=stated["robust"],
    )
