"""The experiment repeated with many seeds: how often each finding comes out (``seeds.csv``).

The file is written by ``benchmarks/wucaps_seeds.py``; a test repeats some of its rows.
"""

import csv
from collections.abc import Iterable
from dataclasses import asdict, fields
from functools import lru_cache
from importlib.resources import files
from pathlib import Path

import numpy as np
from msgspec import convert

from posstats.papers.wucaps.findings import SituationFindings
from posstats.papers.wucaps.situations import Situation

_COLUMNS = ("seed", *(field.name for field in fields(SituationFindings)))


@lru_cache(maxsize=1)
def repeated() -> dict[Situation, tuple[SituationFindings, ...]]:
    """Findings by situation, one per seed, in the order of the seeds."""
    text = (files("posstats.papers.wucaps") / "seeds.csv").read_text(encoding="utf-8")
    found: dict[Situation, list[SituationFindings]] = {}
    for row in csv.DictReader(text.splitlines()):
        each = convert(row, SituationFindings, strict=False)
        found.setdefault(each.situation, []).append(each)
    return {situation: tuple(each) for situation, each in found.items()}


def share(criterion: str, situation: Situation) -> float:
    """Share of the seeds for which a criterion (a name of `CRITERIA`) holds in a situation."""
    found = repeated()[situation]
    return sum(bool(getattr(each, criterion)) for each in found) / len(found)


def pooled(name: str, situation: Situation) -> float:
    """Root mean square over the seeds of one of the RMSE of `SituationFindings`."""
    values = [getattr(each, name) for each in repeated()[situation]]
    return float(np.sqrt(np.mean(np.square(values))))


def write(found: Iterable[tuple[int, SituationFindings]], path: Path) -> None:
    """Write pairs of seed and findings as the CSV file that `repeated` reads."""
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, _COLUMNS, lineterminator="\n")
        writer.writeheader()
        for seed, each in found:
            values = asdict(each).items()
            rounded = {k: f"{v:.9g}" if isinstance(v, float) else v for k, v in values}
            writer.writerow({"seed": seed} | rounded)
