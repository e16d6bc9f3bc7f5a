"""What `make seeds` runs for one seed: findings of made-up runs, without a simulation."""

import runpy
from types import SimpleNamespace

from helpers import ROOT
from paper_doubles import wucaps_run
from report_results import area_results

from posstats.papers.drift import findings as drift
from posstats.papers.drift.areas import TrueCauses, area_scenario
from posstats.papers.wucaps import findings as wucaps


def test_the_first_papers_seeds_take_the_findings_of_results(monkeypatch):
    find = runpy.run_path(str(ROOT / "benchmarks" / "paper_seeds.py"))["_find"]
    results, causes = area_results(5, 8), TrueCauses(0.28, 0.004)
    analysis = SimpleNamespace(block=None, models=None)
    doubles = {"run_area": analysis, "results": results, "true_causes": causes}
    for name, double in doubles.items():
        monkeypatch.setitem(find.__globals__, name, lambda *_, double=double: double)
    assert find((4, 1)) == drift.find(1, results, area_scenario(1), causes)


def test_the_second_papers_seeds_take_the_findings_of_a_situation(monkeypatch):
    find = runpy.run_path(str(ROOT / "benchmarks" / "wucaps_seeds.py"))["_find"]
    situation, run = next(iter(wucaps_run().runs.items()))
    monkeypatch.setitem(find.__globals__, "run_situation", lambda *_: run)
    assert find((4, situation)) == wucaps.find(run)
