"""`posstats wucaps`: the second paper's experiment, simulated, adjusted and reported."""

from collections.abc import Callable, Iterator
from pathlib import Path

from posstats.contract.choices import DEFAULT_LANGUAGE, Language
from posstats.contract.files import to_json
from posstats.papers.wucaps.experiment import SituationRun, run_situation
from posstats.papers.wucaps.reproduction import Reproduction, reproduction
from posstats.papers.wucaps.situations import SITUATIONS, Situation

from ..output.progress import progress_bar
from ..output.staged_folder import staged_folder
from ..output.timestamp import now
from ..pages.writing import write_pages
from ..papers.conclusion import summary
from ..papers.wucaps.conclusions import beyond, conclusions
from ..papers.wucaps.document import build
from ..papers.wucaps.report import Report
from ..papers.wucaps.results import results
from ..papers.wucaps.words import Words, words_in
from .command_line import written


def reproduce_wucaps(
    out: Path, seed: int, *, language: Language = DEFAULT_LANGUAGE, pdf: bool
) -> Iterator[str]:
    """Write the reproduction into `out`; yields the lines of the terminal summary."""
    created = now()
    english, words = words_in("en"), words_in(language)
    words.families()  # a typeface that is missing is missed before the work
    with (
        staged_folder(out, replaced=("wucaps.pdf",)) as stage,
        progress_bar("simulating") as progress,
    ):
        run = reproduction(_runs(seed, progress), seed)
        report = _report(english, run)
        progress("writing the report", 0.9)
        text = to_json(results(report, created))
        (stage / "wucaps.json").write_text(text, encoding="utf-8")
        document = build(words, _report(words, run), created)
        missing = write_pages(document, stage / "wucaps", pdf=pdf)
    yield from summary(english, report.conclusions)
    yield from written(out, "wucaps", missing, pdf=pdf)


def _report(words: Words, run: Reproduction) -> Report:
    return Report(run, conclusions(words, run), beyond(words, run))


def _runs(seed: int, progress: Callable[[str, float], None]) -> dict[Situation, SituationRun]:
    """Simulate and orient both situations."""
    runs: dict[Situation, SituationRun] = {}
    for k, situation in enumerate(SITUATIONS):

        def advance(done: float, name: str = situation, before: int = k) -> None:
            progress(f"adjusting the {name} block", 0.45 * (before + done))

        runs[situation] = run_situation(situation, seed, progress=advance)
    return runs
