"""The experiment repeated with many seeds: how often each finding comes out (``seeds.csv``).

The file is written by ``benchmarks/paper_seeds.py``; a test repeats some of its rows.
"""

import math
from functools import lru_cache

from posstats.papers.drift.findings import AreaFindings
from posstats.papers.seeds import share_of, stored


@lru_cache(maxsize=1)
def repeated() -> dict[int, tuple[AreaFindings, ...]]:
    """Findings by area, one per seed, in the order of the seeds."""
    return stored("posstats.papers.drift", AreaFindings, lambda each: each.area)


def share(criterion: str, area: int) -> float:
    """Share of the seeds for which a criterion (a name of `CRITERIA`) holds in an area."""
    return share_of(repeated()[area], criterion)


def share_interval(criterion: str, area: int) -> tuple[float, float]:
    """95 % interval of `share` by Wilson's score (J. Am. Stat. Assoc. 22 (1927), 209-212)."""
    n, p, z = len(repeated()[area]), share(criterion, area), 1.959964
    middle = (p + z**2 / (2 * n)) / (1.0 + z**2 / n)
    half = z / (1.0 + z**2 / n) * math.sqrt(p * (1.0 - p) / n + z**2 / (4.0 * n**2))
    return middle - half, middle + half
