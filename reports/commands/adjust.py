"""`posstats adjust`: from a block folder to its bundle block adjustment and the report on it."""

import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import cast, get_args

from posstats.adjustment import Adjustment, adjust_block
from posstats.adjustment.calibration import calibrated
from posstats.adjustment.control import read_ids
from posstats.adjustment.diagnosis import MistakenDataError
from posstats.adjustment.results import adjustment_results
from posstats.adjustment.steps import Progress
from posstats.adjustment.undetermined import UndeterminedBlockError
from posstats.adjustment.writing import write_adjustment
from posstats.block.model import Block
from posstats.contract.adjustment import AdjustmentResults
from posstats.contract.choices import (
    DEFAULT_LANGUAGE,
    ControlChoice,
    ControlSubset,
    Language,
    NamedControl,
)
from posstats.contract.files import to_json
from posstats.errors import PosstatsError
from posstats.formats.block_folder import read_block
from posstats.settings import AdjustmentSettings

from ..adjustment import document as adjustment_document
from ..adjustment import verdict as adjustment_verdict
from ..adjustment.wording import mistaken, not_determined, with_words
from ..adjustment.words import words_in
from ..output.progress import progress_bar
from ..output.staged_folder import staged_folder
from ..output.terminal import WIDTH
from ..output.timestamp import now
from ..pages.writing import write_pages
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


def adjusted(
    block: Block,
    settings: AdjustmentSettings,
    progress: Progress,
    language: Language = DEFAULT_LANGUAGE,
) -> Adjustment:
    """The adjustment of a block.

    Raises
    ------
    PosstatsError
        If there is none: what is not determined, why, and what would help, or which mistake
        makes the measurements contradict each other, in words.
    """
    try:
        return adjust_block(block, settings, progress=progress)
    except UndeterminedBlockError as error:
        raise PosstatsError(not_determined(error, language)) from error
    except MistakenDataError as error:
        raise PosstatsError(mistaken(error, language)) from error


def adjust_folder(
    folder: Path,
    out: Path,
    settings: AdjustmentSettings,
    calibration: Path | None,
    *,
    language: Language = DEFAULT_LANGUAGE,
    pdf: bool,
) -> Iterator[str]:
    """Adjust a block folder into `out`; yields the lines of the terminal summary."""
    with (
        staged_folder(out, replaced=("adjustment.pdf",)) as stage,
        progress_bar("reading the block") as progress,
    ):
        block = read_block(folder)
        if calibration is not None:
            block = calibrated(block, calibration, unknown=settings.drift != "none")
        adjustment = adjusted(
            block, settings, lambda step, done: progress(step, 0.8 * done), language
        )
        taken_off = None if calibration is None else calibration.name
        results = adjustment_results(adjustment, created=now(), calibration=taken_off)
        said = with_words(results)
        (stage / "adjustment.json").write_text(to_json(said), encoding="utf-8")
        write_adjustment(adjustment, stage)
        progress("writing the report", 0.85)
        document = adjustment_document.build(results, language)
        missing = write_pages(document, stage / "adjustment", pdf=pdf)
    yield from _summary(said)
    yield from written(out, "adjustment", missing, pdf=pdf)


def _summary(results: AdjustmentResults) -> Iterator[str]:
    block = results.block
    simulated = " (simulated)" if block.simulated else ""
    yield f"{block.name}{simulated}: {block.n_images} images, {block.n_rays} image rays"
    yield ""
    yield from textwrap.wrap(adjustment_verdict.paragraph(words_in("en"), results), WIDTH)
    for warning in results.warnings:
        yield from textwrap.wrap(f"warning: {warning}", WIDTH, subsequent_indent="  ")
