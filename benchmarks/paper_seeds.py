"""Repeat the paper's experiment with many seeds and store what each area showed.

Writes posstats/papers/drift/seeds.csv, from which `posstats paper` states how often its findings
come out. To be run again whenever a scenario or the analysis changes its numbers:

    python benchmarks/paper_seeds.py --seeds 100 --processes 2
"""

import argparse
import os
from concurrent.futures import ProcessPoolExecutor
from itertools import product
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from posstats.analysis.results import results
from posstats.papers.drift.areas import AREAS, area_scenario, run_area, true_causes
from posstats.papers.drift.findings import CRITERIA, AreaFindings, find
from posstats.papers.seeds import write

STORED = Path(__file__).parents[1] / "posstats" / "papers" / "drift" / "seeds.csv"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--seeds", type=int, default=100)
    parser.add_argument("--processes", type=int, default=os.cpu_count())
    parser.add_argument("--out", type=Path, default=STORED)
    asked = parser.parse_args()
    runs = list(product(range(1, asked.seeds + 1), AREAS))
    with ProcessPoolExecutor(asked.processes) as pool:
        found = []
        for run, each in zip(runs, pool.map(_find, runs), strict=True):
            found.append((run[0], each))
            print(f"seed {run[0]} area {run[1]}: {_failed(each)}", flush=True)
    write(sorted(found, key=lambda pair: (pair[1].area, pair[0])), asked.out)
    for area, criterion in product(AREAS, CRITERIA):
        held = [getattr(each, criterion) for _, each in found if each.area == area]
        print(f"area {area} {criterion}: {sum(held)} of {len(held)}")


def _find(run: tuple[int, int]) -> AreaFindings:
    seed, area = run
    analysis = run_area(area, seed)
    causes = true_causes(analysis.block, analysis.models)
    return find(area, results(analysis), area_scenario(area), causes)


def _failed(found: AreaFindings) -> str:
    return ", ".join(f"not {name}" for name in CRITERIA if not getattr(found, name)) or "all hold"


if __name__ == "__main__":
    main()
