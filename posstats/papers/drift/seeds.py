"""The experiment repeated with many seeds: how often each finding comes out (``seeds.csv``).

The file is written by ``benchmarks/paper_seeds.py``; a test repeats some of its rows.
"""

import csv
import math
from collections.abc import Iterable
from dataclasses import asdict, fields
from functools import lru_cache
from importlib.resources import files
from pathlib import Path

from msgspec import convert

from posstats.papers.drift.findings import AreaFindings

_COLUMNS = ("seed", *(field.name for field in fields(AreaFindings)))


@lru_cache(maxsize=1)
def repeated() -> dict[int, tuple[AreaFindings, ...]]:
    """Findings by area, one per seed, in the order of the seeds."""
    text = (files("posstats.papers.drift") / "seeds.csv").read_text(encoding="utf-8")
    found: dict[int, list[AreaFindings]] = {}
    for row in csv.DictReader(text.splitlines()):
        each = convert(row, AreaFindings, strict=False)
        found.setdefault(each.area, []).append(each)
    return {area: tuple(each) for area, each in found.items()}


def share(criterion: str, area: int) -> float:
    """Share of the seeds for which a criterion (a name of `CRITERIA`) holds in an area."""
    found = repeated()[area]
    return sum(bool(getattr(each, criterion)) for each in found) / len(found)


def share_interval(criterion: str, area: int) -> tuple[float, float]:
    """95 % interval of `share` by Wilson's score (J. Am. Stat. Assoc. 22 (1927), 209-212)."""
    n, p, z = len(repeated()[area]), share(criterion, area), 1.959964
    middle = (p + z**2 / (2 * n)) / (1.0 + z**2 / n)
    half = z / (1.0 + z**2 / n) * math.sqrt(p * (1.0 - p) / n + z**2 / (4.0 * n**2))
    return middle - half, middle + half


def write(found: Iterable[tuple[int, AreaFindings]], path: Path) -> None:
    """Write pairs of seed and findings as the CSV file that `repeated` reads."""
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, _COLUMNS, lineterminator="\n")
        writer.writeheader()
        for seed, each in found:
            values = asdict(each).items()
            rounded = {k: f"{v:.9g}" if isinstance(v, float) else v for k, v in values}
            writer.writerow({"seed": seed} | rounded)
