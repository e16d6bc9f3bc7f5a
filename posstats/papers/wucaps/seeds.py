"""The experiment repeated with many seeds: how often each finding comes out (``seeds.csv``).

The file is written by ``benchmarks/wucaps_seeds.py``; a test repeats some of its rows.
"""

from functools import lru_cache

import numpy as np

from posstats.papers.seeds import share_of, stored
from posstats.papers.wucaps.findings import SituationFindings
from posstats.papers.wucaps.situations import Situation


@lru_cache(maxsize=1)
def repeated() -> dict[Situation, tuple[SituationFindings, ...]]:
    """Findings by situation, one per seed, in the order of the seeds."""
    return stored("posstats.papers.wucaps", SituationFindings, lambda each: each.situation)


def share(criterion: str, situation: Situation) -> float:
    """Share of the seeds for which a criterion (a name of `CRITERIA`) holds in a situation."""
    return share_of(repeated()[situation], criterion)


def pooled(name: str, situation: Situation) -> float:
    """Root mean square over the seeds of one of the RMSE of `SituationFindings`."""
    values = [getattr(each, name) for each in repeated()[situation]]
    return float(np.sqrt(np.mean(np.square(values))))
