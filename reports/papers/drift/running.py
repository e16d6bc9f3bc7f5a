"""The three test areas, each simulated, analysed and written in a process of its own."""

import multiprocessing
import signal
from collections.abc import Callable, Mapping
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass
from pathlib import Path

from posstats.contract.choices import Language
from posstats.contract.results import Results
from posstats.errors import PosstatsError
from posstats.papers.drift.areas import AREAS, TrueCauses, run_area, true_causes

from ...block.csv_files import write_tables
from ...block.document import build, drawings
from ...block.folder import write_analysis
from ...document.drawing import Drawing
from ...output.progress import progress_bar
from ...pages.writing import write_figures
from .figures import draw_area
from .words import words_in

_Numbers = tuple[Results, TrueCauses]

_PROCESSES = 2  # the two large areas take nearly all the time


@dataclass(frozen=True, eq=False)
class AreaOutput:
    """Results of an area, what its errors make alone, and its Figures 1, 2 and 3."""

    results: Results
    causes: TrueCauses
    figures: tuple[Drawing, ...]


def run_areas(
    folder: Path, seed: int, created: str, language: Language
) -> Mapping[int, AreaOutput]:
    """Simulate and analyse the areas into ``area1``, ``area2`` and ``area3`` of a folder.

    The words of the three figures are in the language, those of the areas' own files English.

    Raises
    ------
    PosstatsError
        If an area fails, or its process is killed.
    """
    # Forked, so that the libraries are loaded once; before the progress bar starts its thread.
    context = multiprocessing.get_context("fork")
    with ProcessPoolExecutor(_PROCESSES, context, _obey_parent) as pool:
        analysed = {
            pool.submit(_analysed, area, seed, folder / f"area{area}", created): area
            for area in AREAS
        }
        try:
            with progress_bar("three test areas") as progress:
                return _reported(pool, analysed, folder, language, progress)
        except BrokenProcessPool as error:
            raise PosstatsError(
                "the process of a test area was killed: is there less than 2 GB of memory?"
            ) from error
        except BaseException:  # such as Ctrl-C: nobody waits for areas that are still running
            for worker in multiprocessing.active_children():
                worker.terminate()
            raise


def _reported(
    pool: ProcessPoolExecutor,
    analysed: Mapping[Future[_Numbers], int],
    folder: Path,
    language: Language,
    progress: Callable[[str, float], None],
) -> Mapping[int, AreaOutput]:
    """Have each area's files written as soon as it is analysed, by whichever process is free."""
    numbers: dict[int, _Numbers] = {}
    drawn: dict[int, Future[tuple[Drawing, ...]]] = {}
    for done, future in enumerate(as_completed(analysed), start=1):
        area = analysed[future]
        numbers[area] = future.result()
        drawn[area] = pool.submit(
            _written, area, numbers[area][0], folder / f"area{area}", language
        )
        progress(f"area {area} analysed", 0.7 * done / len(analysed))
    return {area: AreaOutput(*numbers[area], drawn[area].result()) for area in AREAS}


def _analysed(area: int, seed: int, folder: Path, created: str) -> _Numbers:
    analysis = run_area(area, seed)
    causes = true_causes(analysis.block, analysis.models)
    return write_analysis(analysis, folder, created=created), causes


def _written(area: int, values: Results, folder: Path, language: Language) -> tuple[Drawing, ...]:
    write_tables(values, folder / "tables")
    write_figures(drawings(build(values)), folder / "figures")
    return draw_area(words_in(language), area, values)


def _obey_parent() -> None:
    """Leave Ctrl-C to the parent, and end at once when it says so."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
