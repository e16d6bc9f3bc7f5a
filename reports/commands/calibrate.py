"""`posstats calibrate`: from the block folder of a calibration flight to a calibration file."""

import textwrap
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from posstats.adjustment.calibration import Calibration, calibrate, write_calibration
from posstats.adjustment.results import adjustment_results
from posstats.errors import PosstatsError
from posstats.formats.block_folder import read_block
from posstats.settings import AdjustmentSettings

from ..adjustment import verdict as adjustment_verdict
from ..adjustment.wording import with_words
from ..adjustment.words import words_in
from ..document import format as fmt
from ..output.progress import progress_bar
from ..output.terminal import WIDTH
from .adjust import adjusted


def calibrate_folder(folder: Path, out: Path, settings: AdjustmentSettings) -> Iterator[str]:
    """Estimate the calibration of a block folder into the file `out`; yields what it is.

    Raises
    ------
    PosstatsError
        If the file cannot be in that place, or the block cannot be adjusted.
    """
    if out.is_dir() or not out.parent.is_dir():
        raise PosstatsError(f"{out} cannot be written: is it a file in a folder that exists?")
    with progress_bar("reading the block") as progress:
        adjustment = adjusted(read_block(folder), settings, progress)
        calibration = calibrate(adjustment)
    write_calibration(calibration, out)
    yield f"camera {calibration.camera}, from {calibration.n_images} images of {calibration.block}"
    yield from _described(calibration)
    results = with_words(adjustment_results(adjustment))
    yield f"sigma0: {fmt.number(results.sigma0)} ({fmt.p_phrase(results.chi2_p)})"
    yield ""
    yield from textwrap.wrap(adjustment_verdict.blunders(words_in("en"), results), WIDTH)
    for warning in results.warnings:
        yield from textwrap.wrap(f"warning: {warning}", WIDTH, subsequent_indent="  ")
    yield ""
    yield f"calibration: {out}"


def _described(calibration: Calibration) -> Iterator[str]:
    values = list(np.degrees(calibration.boresight_rad))
    sigmas = np.sqrt(np.diagonal(calibration.covariance))
    shown = [*np.degrees(sigmas[:3]), *sigmas[3:]]
    if calibration.lever_arm_m is not None:
        values += list(calibration.lever_arm_m)
    for k, (name, value, sigma) in enumerate(zip(calibration.names, values, shown, strict=True)):
        decimals, unit = (4, "°") if k < 3 else (3, " m")
        yield f"{name}: {fmt.fixed(value, decimals)}{unit} ± {fmt.fixed(sigma, decimals)}{unit}"
