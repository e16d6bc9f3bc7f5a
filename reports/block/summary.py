"""The short summary that a command prints, in English."""

import textwrap
from collections.abc import Iterator

from posstats.contract.results import Results

from ..document.rows import rows
from ..output.terminal import WIDTH
from . import verdict
from .view import decided_by_strip
from .words import BlockReport, words_in

SHOWN_STRIPS = 12


def summary(results: Results) -> Iterator[str]:
    """The verdict of the report, its decisions and its warnings, as lines of text."""
    report = BlockReport(results, words_in("en"))
    block = results.block
    simulated = " (simulated)" if block.simulated else ""
    yield f"{block.name}{simulated}: {block.n_images} images, {block.n_models} models"
    yield ""
    yield from textwrap.wrap(verdict.paragraph(report), WIDTH)
    yield ""
    for line in _decisions(report):
        yield from textwrap.wrap(line, WIDTH, subsequent_indent="  ")
    for warning in results.warnings:
        yield from textwrap.wrap(f"warning: {warning}", WIDTH, subsequent_indent="  ")


def _decisions(report: BlockReport) -> Iterator[str]:
    """One line per angle; reasons where the block was decided as a whole."""
    results = report.results
    if not decided_by_strip(results):
        for row in results.selection:
            yield f"{row.angle}: {row.form} ({report.words.reason(row.notices)})"
        return
    for angle in dict.fromkeys(row.angle for row in results.selection):
        decided = rows(results.selection, angle=angle)
        made = [f"strip {row.scope} {row.form}" for row in decided if row.correct]
        more = f" and {len(made) - SHOWN_STRIPS} more" if len(made) > SHOWN_STRIPS else ""
        which = f": {', '.join(made[:SHOWN_STRIPS])}{more}" if made else ""
        yield f"{angle}: corrected in {len(made)} of {len(decided)} strips{which}"
