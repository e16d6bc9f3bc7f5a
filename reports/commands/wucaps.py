"""`posstats wucaps`: the second paper's experiment, simulated, adjusted and reported."""

import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from posstats.contract.versions import versions
from posstats.papers.wucaps.adjustments import CONTROLS
from posstats.papers.wucaps.experiment import Row, SituationRun, run_situation
from posstats.papers.wucaps.findings import CRITERIA
from posstats.papers.wucaps.reproduction import Reproduction, reproduction
from posstats.papers.wucaps.seeds import pooled, repeated, share
from posstats.papers.wucaps.situations import SITUATIONS, Situation
from posstats.version import __version__

from ..block.report import write_pages
from ..output.progress import progress_bar
from ..output.staged_folder import staged_folder
from ..output.timestamp import now
from ..papers.drift.conclusions import Conclusion
from ..papers.wucaps import document as wucaps_document
from ..papers.wucaps.conclusions import beyond, conclusions
from .command_line import written

SCHEMA = "posstats-wucaps/1"


def reproduce_wucaps(out: Path, seed: int, *, pdf: bool) -> Iterator[str]:
    """Write the reproduction into `out`; yields the lines of the terminal summary."""
    created = now()
    with staged_folder(out) as stage, progress_bar("simulating") as progress:
        runs: dict[Situation, SituationRun] = {}
        for k, situation in enumerate(SITUATIONS):

            def advance(done: float, name: str = situation, before: int = k) -> None:
                progress(f"adjusting the {name} block", 0.45 * (before + done))

            runs[situation] = run_situation(situation, seed, progress=advance)
        run = reproduction(runs, seed)
        found, asked = conclusions(run), beyond(run)
        progress("writing the report", 0.9)
        (stage / "wucaps.json").write_text(_json(run, found, asked, created), encoding="utf-8")
        document = wucaps_document.build(run, found, asked, created, list(versions().items()))
        missing = write_pages(document, stage / "wucaps", pdf=pdf)
    for number, each in enumerate(found, start=1):
        yield f"{number}. {each.title}: {'holds' if each.holds else 'DOES NOT HOLD'}"
    yield from written(out, "wucaps", missing, pdf=pdf)


def _json(
    run: Reproduction, found: Sequence[Conclusion], asked: Sequence[Conclusion], created: str
) -> str:
    """The text of wucaps.json."""
    values = {
        "schema": SCHEMA,
        "posstats_version": __version__,
        "created": created,
        "simulated": True,
        "seed": run.seed,
        "rows": [_row(each, row) for each in run.runs.values() for row in each.rows],
        "relative_parallax_mm": {s: each.relative_mm for s, each in run.runs.items()},
        "conclusions": [_conclusion(each) for each in found],
        "beyond": [_conclusion(each) for each in asked],
        "seed_shares": [
            {"finding": name, "situation": s, "n_seeds": len(repeated()[s]),
             "share": share(name, s)}
            for name in CRITERIA for s in run.runs
        ],
        "predictions": [_prediction(s, f"weighted_{c}") for s in run.runs for c in CONTROLS]
        + [_prediction(s, "reference") for s in run.runs],
    }  # fmt: skip
    return json.dumps(values, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def _row(run: SituationRun, row: Row) -> dict[str, Any]:
    best = run.measures("reference", "all")
    measures = None if row.measures is None else asdict(row.measures)
    ratio = {} if row.measures is None else {
        "horizontal_over_reference": row.measures.horizontal_m / best.horizontal_m,
        "vertical_over_reference": row.measures.vertical_m / best.vertical_m,
    }  # fmt: skip
    return {
        "situation": run.situation,
        "method": row.method,
        "control": row.control,
        "sigma0": row.sigma0,
        "undetermined": list(row.undetermined),
        "determined": measures is not None and not row.undetermined,
        **(measures or {}),
        **ratio,
    }


def _conclusion(each: Conclusion) -> dict[str, Any]:
    return {"text": each.text, "holds": each.holds, "evidence": " ".join(each.evidence)}


def _prediction(situation: Situation, name: str) -> dict[str, Any]:
    """RMSE over all seeds, and as predicted."""
    values = {
        f"{kind}{side}_m": pooled(f"{name}_{kind}{side}_m", situation)
        for kind in ("", "predicted_")
        for side in ("horizontal", "vertical")
    }
    return {"situation": situation, "adjustment": name, **values}
