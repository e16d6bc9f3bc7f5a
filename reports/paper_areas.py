"""The three test areas, each simulated, analysed and written in a process of its own."""

import multiprocessing
import signal
from collections.abc import Mapping
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from posstats.errors import PosstatsError
from posstats.experiment.areas import AREAS, TrueCauses, run_area, true_causes

from . import paper_figures
from .analysis_folder import write_analysis
from .figure_style import Drawing
from .progress import progress_bar
from .report import write_report

_PROCESSES = 2  # the two large areas take nearly all the time


@dataclass(frozen=True, eq=False)
class AreaOutput:
    """Results dictionary of an area, what its errors make alone, and its Figures 1, 2 and 3."""

    results: dict[str, Any]
    causes: TrueCauses
    figures: tuple[Drawing, ...]


def run_areas(folder: Path, seed: int, created: str) -> Mapping[int, AreaOutput]:
    """Simulate and analyse the areas into ``area1``, ``area2`` and ``area3`` of a folder.

    Raises
    ------
    PosstatsError
        If an area fails, or its process is killed.
    """
    # Forked, so that the libraries are loaded once; before the progress bar starts its thread.
    context = multiprocessing.get_context("fork")
    with ProcessPoolExecutor(_PROCESSES, context, _obey_parent) as pool:
        futures = {
            pool.submit(_area, area, seed, folder / f"area{area}", created): area for area in AREAS
        }
        try:
            _show_progress(futures)
            return {area: future.result() for future, area in futures.items()}
        except BrokenProcessPool as error:
            raise PosstatsError(
                "the process of a test area was killed: is there less than 2 GB of memory?"
            ) from error
        except BaseException:  # such as Ctrl-C: nobody waits for areas that are still running
            for worker in multiprocessing.active_children():
                worker.terminate()
            raise


def _area(area: int, seed: int, folder: Path, created: str) -> AreaOutput:
    analysis = run_area(area, seed)
    values = write_analysis(analysis, folder, created=created)
    causes = true_causes(analysis.block)
    del analysis  # the largest thing in memory, while pages and figures are made
    write_report(values, folder, pdf=False)
    return AreaOutput(values, causes, paper_figures.draw_area(area, values))


def _show_progress(futures: Mapping[Future[AreaOutput], int]) -> None:
    with progress_bar("three test areas") as progress:
        for done, future in enumerate(as_completed(futures), start=1):
            progress(f"area {futures[future]} analysed", 0.8 * done / len(futures))


def _obey_parent() -> None:
    """Leave Ctrl-C to the parent, and end at once when it says so."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
