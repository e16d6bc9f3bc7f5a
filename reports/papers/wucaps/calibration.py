"""Topic: the usual alternative, a boresight from another flight."""

from collections.abc import Iterable

import numpy as np

from posstats.numerics.bundle.parameters import BORESIGHT
from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.situations import situation_scenario

from ...document import format as fmt
from ...document.content import Paragraph, Part
from ...document.table import Column, Table, text_column
from .report import Report
from .words import Words


def topic(words: Words, report: Report) -> Part:
    """What calibration gives, and what it leaves."""
    text = Paragraph(words.text("calibration.text"))
    return Part("calibration", words.text("calibration.title"), (text, table(words, report.run)))


def table(words: Words, run: Reproduction) -> Table:
    """The boresight: injected, and as the calibration flights give it."""
    lines = [
        (situation, k, name.removeprefix("boresight_"))
        for situation in run.runs
        for k, name in enumerate(BORESIGHT)
    ]
    true = [getattr(situation_scenario(s).errors, name).constant_rad for s, _, name in lines]
    found = [float(run.runs[s].calibration.boresight_rad[k]) for s, k, _ in lines]
    sigma = [float(np.sqrt(run.runs[s].calibration.covariance[k, k])) for s, k, _ in lines]
    errors = [(f - t) / s for f, t, s in zip(found, true, sigma, strict=True)]
    columns = (
        text_column(
            words.text("wucaps_column.situation"),
            [words.situation(s) if k == 0 else "" for s, k, _ in lines],
        ),
        text_column(
            words.text("boresight.angle"), [words.of("boresight", name) for *_, name in lines]
        ),
        _degrees(words.text("boresight.injected"), true),
        _degrees(words.text("boresight.estimated"), found),
        _degrees(words.text("boresight.sigma"), sigma),
        Column(words.text("boresight.ratio"), tuple(fmt.fixed(error, 1) for error in errors)),
    )
    return Table("boresight", words.text("boresight.caption"), columns)


def _degrees(title: str, values_rad: Iterable[float]) -> Column:
    return Column(title, tuple(fmt.fixed(np.degrees(value), 4) for value in values_rad), "°")
