"""`posstats paper`: the first paper's experiment, simulated, analysed, compared and reported."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from posstats.contract.choices import DEFAULT_LANGUAGE, Language
from posstats.contract.files import to_json
from posstats.papers.drift.reproduction import Reproduction, reproduction

from ..output.staged_folder import staged_folder
from ..output.timestamp import now
from ..pages.writing import write_pages
from ..papers.conclusion import summary
from ..papers.drift.conclusions import conclusions
from ..papers.drift.document import build
from ..papers.drift.report import Report
from ..papers.drift.results import results
from ..papers.drift.running import AreaOutput, run_areas
from ..papers.drift.words import words_in
from .command_line import written


def reproduce_paper(
    out: Path, seed: int, *, language: Language = DEFAULT_LANGUAGE, pdf: bool
) -> Iterator[str]:
    """Write the reproduction into `out`; yields the lines of the terminal summary."""
    created = now()
    english, words = words_in("en"), words_in(language)
    words.families()  # a typeface that is missing is missed before the work
    with staged_folder(out, replaced=("paper.pdf",)) as stage:
        areas = run_areas(stage, seed, created, language)
        run = _reproduction(areas, seed)
        found = conclusions(english, run)
        text = to_json(results(run, found, created))
        (stage / "comparison.json").write_text(text, encoding="utf-8")
        figures = {area: each.figures for area, each in areas.items()}
        document = build(words, Report(run, conclusions(words, run), figures), created)
        missing = write_pages(document, stage / "paper", pdf=pdf)
    yield from summary(english, found)
    yield from written(out, "paper", missing, pdf=pdf)


def _reproduction(areas: Mapping[int, AreaOutput], seed: int) -> Reproduction:
    return reproduction(
        {area: each.results for area, each in areas.items()},
        {area: each.causes for area, each in areas.items()},
        seed,
    )
