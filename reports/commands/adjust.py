"""`posstats adjust`: from a block folder to its bundle block adjustment and the report on it."""

import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any, cast, get_args

from posstats.adjustment import adjust_block
from posstats.adjustment.calibration import calibrated
from posstats.adjustment.control import read_ids
from posstats.adjustment.results import adjustment_results, write_adjustment
from posstats.contract.files import to_json
from posstats.errors import PosstatsError
from posstats.formats.block_folder import read_block
from posstats.settings import AdjustmentSettings, ControlChoice, ControlSubset, NamedControl

from ..adjustment import document as adjustment_document
from ..adjustment import verdict as adjustment_verdict
from ..block.report import write_pages
from ..block.summary import WIDTH
from ..block.wording import warnings
from ..output.progress import progress_bar
from ..output.staged_folder import staged_folder
from ..output.timestamp import now
from .command_line import written


def control_choice(text: str | None) -> ControlChoice:
    """The control that a user names: a choice, or a file of ids; None: the roles of the points.

    Raises
    ------
    PosstatsError
        If it is neither.
    """
    if text is None:
        return "roles"
    if text in get_args(NamedControl):
        return cast(NamedControl, text)
    path = Path(text)
    if not path.is_file():
        choices = ", ".join(get_args(ControlSubset))
        raise PosstatsError(f"--control {text}: found neither a choice ({choices}) nor a file")
    return read_ids(path)


def adjust_folder(
    folder: Path, out: Path, settings: AdjustmentSettings, calibration: Path | None, *, pdf: bool
) -> Iterator[str]:
    """Adjust a block folder into `out`; yields the lines of the terminal summary."""
    with staged_folder(out) as stage, progress_bar("reading the block") as progress:
        block = read_block(folder)
        if calibration is not None:
            block = calibrated(block, calibration, unknown=settings.drift != "none")
        adjustment = adjust_block(
            block, settings, progress=lambda step, done: progress(step, 0.8 * done)
        )
        values = adjustment_results(adjustment, created=now())
        values["warnings"] = [*warnings(block.notices), *values["warnings"]]
        values["settings"]["calibration"] = None if calibration is None else calibration.name
        (stage / "adjustment.json").write_text(to_json(values), encoding="utf-8")
        write_adjustment(adjustment, stage)
        progress("writing the report", 0.85)
        missing = write_pages(adjustment_document.build(values), stage / "adjustment", pdf=pdf)
    yield from _summary(values)
    yield from written(out, "adjustment", missing, pdf=pdf)


def _summary(values: dict[str, Any]) -> Iterator[str]:
    block = values["block"]
    simulated = " (simulated)" if block["simulated"] else ""
    yield f"{block['name']}{simulated}: {block['n_images']} images, {block['n_rays']} image rays"
    yield ""
    yield from textwrap.wrap(adjustment_verdict.paragraph(values), WIDTH)
    for warning in values["warnings"]:
        yield from textwrap.wrap(f"warning: {warning}", WIDTH, subsequent_indent="  ")
