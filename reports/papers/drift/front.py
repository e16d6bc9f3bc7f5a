"""What stands before the topics of the report on the first paper."""

from posstats.papers.drift.comparison import TABLE3_AREA
from posstats.papers.drift.findings import STRIP
from posstats.papers.drift.reproduction import Reproduction

from ...document import format as fmt
from ...document.key_figure import KeyFigure
from ..conclusion import how_many
from ..document import PaperFront
from .repeated import n_seeds
from .report import Report
from .words import Words


def front(words: Words, report: Report) -> PaperFront:
    """What was simulated, what was found, in numbers."""
    run = report.run
    return PaperFront(_subtitle(words, run), _verdict(words, report), _key_figures(words, run))


def _subtitle(words: Words, run: Reproduction) -> str:
    """What was simulated."""
    blocks = [results.block for results in run.results.values()]
    return words.text(
        "front.subtitle",
        images=fmt.count(sum(block.n_images for block in blocks)),
        strips=fmt.count(sum(block.n_strips for block in blocks)),
        models=fmt.count(sum(block.n_models for block in blocks)),
        points=fmt.count(sum(block.n_tie_points for block in blocks)),
    )


def _verdict(words: Words, report: Report) -> str:
    """What was found, in short."""
    run = report.run
    means = words.joined(
        words.text("front.mean", ratio=fmt.fixed(each.ratio, 2), area=str(each.area))
        for each in run.compared
        if (each.quantity, each.strip) == ("pos_mean_mm", None)
    )
    held = how_many(words, report.conclusions)
    seed = str(run.seed)
    return words.text("front.verdict", held=held, means=means, seed=seed, total=n_seeds())


def _key_figures(words: Words, run: Reproduction) -> tuple[KeyFigure, ...]:
    """Parallaxes of area 1, and the line of omega over its first strip."""
    keyed = {(e.table, e.area, e.strip, e.angle, e.quantity): e for e in run.compared}
    line = keyed[3, TABLE3_AREA, STRIP, "omega", "r_squared"]
    raw = keyed[2, TABLE3_AREA, None, None, "pos_mean_mm"]
    relative = keyed[2, TABLE3_AREA, None, None, "independent_mean_mm"]
    found = run.findings[TABLE3_AREA]
    ratio = fmt.fixed(found.over_relative, 2)
    return (
        _figure(words, "key.pos", raw.reproduced, "mm", raw.published),
        _figure(words, "key.relative", relative.reproduced, "mm", relative.published),
        _figure(words, "key.r_squared", line.reproduced, "", line.published),
        KeyFigure(words.text("key.corrected"), fmt.fixed(found.corrected_omega_mm, 4), "mm",
                  words.text("key.corrected_remark", ratio=ratio)),
    )  # fmt: skip


def _figure(
    words: Words, label: str, value: float | None, unit: str, published: float
) -> KeyFigure:
    printed = f"{fmt.fixed(published, 4)}{f' {unit}' if unit else ''}"
    remark = words.text("key.published", value=printed)
    return KeyFigure(words.text(label), fmt.fixed(value, 4), unit, remark)
