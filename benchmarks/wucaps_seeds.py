"""Repeat the second paper's experiment with many seeds and store what each situation showed.

Writes posstats/papers/wucaps/seeds.csv, from which `posstats wucaps` states how often its findings
come out and whether covariances predict accuracies. To be run again whenever a scenario or the
adjustment changes its numbers:

    python benchmarks/wucaps_seeds.py --seeds 100 --processes 2
"""

import argparse
import os
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from posstats.papers.seeds import write
from posstats.papers.wucaps.adjustments import CONTROLS
from posstats.papers.wucaps.experiment import run_situation
from posstats.papers.wucaps.findings import CRITERIA, SituationFindings, find
from posstats.papers.wucaps.situations import SITUATIONS, Situation

STORED = Path(__file__).parents[1] / "posstats" / "papers" / "wucaps" / "seeds.csv"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--processes", type=int, default=os.cpu_count())
    parser.add_argument("--out", type=Path, default=STORED)
    asked = parser.parse_args()
    runs = list(product(range(1, asked.seeds + 1), SITUATIONS))
    with ProcessPoolExecutor(asked.processes) as pool:
        found = []
        for (seed, situation), each in zip(runs, pool.map(_find, runs), strict=True):
            found.append((seed, each))
            print(f"seed {seed} {situation}: {_failed(each)}", flush=True)
    write(sorted(found, key=lambda pair: (SITUATIONS.index(pair[1].situation), pair[0])), asked.out)
    for situation in SITUATIONS:
        _summarise([each for _, each in found if each.situation == situation])


def _find(run: tuple[int, Situation]) -> SituationFindings:
    seed, situation = run
    return find(run_situation(situation, seed))


def _failed(found: SituationFindings) -> str:
    return ", ".join(f"not {name}" for name in CRITERIA if not getattr(found, name)) or "all hold"


def _summarise(found: list[SituationFindings]) -> None:
    situation = found[0].situation
    for criterion in CRITERIA:
        held = [getattr(each, criterion) for each in found]
        print(f"{situation} {criterion}: {sum(held)} of {len(held)}")
    best = {side: _pooled(found, f"reference_{side}_m") for side in ("horizontal", "vertical")}
    for control, side in product(CONTROLS, ("horizontal", "vertical")):
        rmse = _pooled(found, f"weighted_{control}_{side}_m")
        predicted = _pooled(found, f"weighted_{control}_predicted_{side}_m")
        ratios = f"{rmse / best[side]:.2f} of the reference, {rmse / predicted:.3f} of predicted"
        print(f"{situation} weighted, control {control}, {side}: {rmse:.4f} m, {ratios}")


def _pooled(found: list[SituationFindings], name: str) -> float:
    return float(np.sqrt(np.mean([getattr(each, name) ** 2 for each in found])))


if __name__ == "__main__":
    main()
