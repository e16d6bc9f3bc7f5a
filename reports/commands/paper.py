"""`posstats paper`: the first paper's experiment, simulated, analysed, compared and reported."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path

from posstats.papers.drift.comparison import TABLE3_AREA
from posstats.papers.drift.findings import CRITERIA
from posstats.papers.drift.reproduction import Reproduction, reproduction
from posstats.papers.drift.seeds import repeated, share
from posstats.version import __version__

from ..block.report import write_pages
from ..output.staged_folder import staged_folder
from ..output.timestamp import now
from ..papers.drift import document as paper_document
from ..papers.drift.areas import run_areas
from ..papers.drift.conclusions import Conclusion, conclusions
from .command_line import written

SCHEMA = "posstats-comparison/1"


def reproduce_paper(out: Path, seed: int, *, pdf: bool) -> Iterator[str]:
    """Write the reproduction into `out`; yields the lines of the terminal summary."""
    created = now()
    with staged_folder(out, replaced=("paper.pdf",)) as stage:
        areas = run_areas(stage, seed, created)
        run = reproduction(
            {area: each.results for area, each in areas.items()},
            {area: each.causes for area, each in areas.items()},
            seed,
        )
        found = conclusions(run)
        (stage / "comparison.json").write_text(_comparison(run, found, created), encoding="utf-8")
        figures = {area: each.figures for area, each in areas.items()}
        document = paper_document.build(run, found, figures, created)
        missing = write_pages(document, stage / "paper", pdf=pdf)
    for number, each in enumerate(found, start=1):
        yield f"{number}. {each.title}: {'holds' if each.holds else 'DOES NOT HOLD'}"
    yield from written(out, "paper", missing, pdf=pdf)


def _comparison(run: Reproduction, found: Sequence[Conclusion], created: str) -> str:
    """The text of comparison.json."""
    values = {
        "schema": SCHEMA,
        "posstats_version": __version__,
        "created": created,
        "simulated": True,
        "seed": run.seed,
        "rows": [asdict(each) for each in run.compared],
        "conclusions": [
            {"text": each.text, "holds": each.holds, "evidence": " ".join(each.evidence)}
            for each in found
        ],
        "seed_shares": [
            {"finding": name, "area": area, "n_seeds": len(repeated()[area]),
             "share": share(name, area)}
            for name in CRITERIA for area in run.results
            if name != "only_omega_is_linear" or area == TABLE3_AREA
        ],
    }  # fmt: skip
    return json.dumps(values, indent=1, ensure_ascii=False, allow_nan=False) + "\n"
