"""The experiment repeated with many seeds: how often each finding comes out (``seeds.csv``).

The file is written by ``benchmarks/wucaps_seeds.py``; a test repeats some of its rows.
"""

import csv
from collections.abc import Iterable
from dataclasses import asdict
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from typing import Any, get_type_hints

import numpy as np

from posstats.papers.wucaps.findings import SituationFindings
from posstats.papers.wucaps.situations import Situation

_TYPES = get_type_hints(SituationFindings)


@lru_cache(maxsize=1)
def repeated() -> dict[Situation, tuple[SituationFindings, ...]]:
    """Findings by situation, one per seed, in the order of the seeds."""
    text = (files("posstats.papers.wucaps") / "seeds.csv").read_text(encoding="utf-8")
    found: dict[Situation, list[SituationFindings]] = {}
    for row in csv.DictReader(text.splitlines()):
        values: dict[str, Any] = {
            name: float(row[name]) if kind is float else row[name] for name, kind in _TYPES.items()
        }
        each = SituationFindings(**values)
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
        writer = csv.DictWriter(stream, ["seed", *_TYPES], lineterminator="\n")
        writer.writeheader()
        for seed, each in found:
            values = asdict(each).items()
            rounded = {k: f"{v:.9g}" if isinstance(v, float) else v for k, v in values}
            writer.writerow({"seed": seed} | rounded)
