"""What the commands do: read, compute, write whole folders, and say what came out."""

import datetime as dt
import os
from collections.abc import Iterator
from pathlib import Path

from posstats.analysis import Settings, analyse
from posstats.block import Block
from posstats.block_io import read_block, write_block, write_orientations
from posstats.results import results, to_json
from posstats.scenario import load_scenario
from posstats.stereo import stereo_models
from posstats.synthetic import simulate

from .format import number
from .output import staged_folder
from .progress import progress_bar
from .report import write_report
from .summary import summary


def analyse_block(folder: Path, out: Path, settings: Settings, *, pdf: bool) -> Iterator[str]:
    """Analyse a block folder into `out`; yields the lines of the terminal summary."""
    with staged_folder(out) as stage, progress_bar("reading the block") as progress:
        block = read_block(folder)
        analysis = analyse(block, settings, progress=lambda step, done: progress(step, 0.7 * done))
        values = results(analysis, created=_now())
        (stage / "results.json").write_text(to_json(values), encoding="utf-8")
        selected = analysis.corrected_orientations["selected"]
        write_orientations(block, selected.angles_rad, stage / "corrected_orientations.csv")
        progress("writing the report", 0.75)
        note = write_report(values, stage, pdf=pdf)
    yield from summary(values)
    if note:
        yield note
    yield f"report: {out / ('report.html' if note or not pdf else 'report.pdf')}"


def simulate_block(scenario: Path, out: Path, seed: int | None) -> Iterator[str]:
    """Simulate a scenario into a block folder; yields what was written."""
    block = simulate(load_scenario(scenario), seed)
    with staged_folder(out) as stage:
        write_block(block, stage)
    yield from _described(block)
    yield f"simulated block: {out}"


def check_block(folder: Path) -> Iterator[str]:
    """Validate a block folder; yields a summary."""
    block = read_block(folder)
    yield from _described(block)
    for warning in block.warnings:
        yield f"warning: {warning}"
    yield "accepted"


def _described(block: Block) -> Iterator[str]:
    checks = int(block.check_points.sum())
    yield (
        f"{block.name}: {len(block.orientations)} images in {len(block.orientations.strips)} strips,"
        f" {len(stereo_models(block))} stereo models"
    )
    yield (
        f"{len(block.tie_points)} measurements of {len(block.tie_points.point_id)} points,"
        f" {checks} check points"
    )


def _now() -> str:
    """The time of the report; fixed by SOURCE_DATE_EPOCH for reproducible output."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH")
    moment = (
        dt.datetime.now(dt.UTC) if epoch is None else dt.datetime.fromtimestamp(int(epoch), dt.UTC)
    )
    return moment.isoformat(timespec="seconds")
