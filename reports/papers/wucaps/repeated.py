"""Topic: the experiment over all stored seeds."""

from collections.abc import Iterable

from posstats.papers.wucaps.adjustments import CONTROLS
from posstats.papers.wucaps.findings import CRITERIA, RECOMMENDED
from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.seeds import pooled, repeated, share

from ...document import format as fmt
from ...document.content import Paragraph, Part
from ...document.table import Column, Table, text_column
from .. import seeds
from .columns import metres
from .report import Report
from .words import Words

SIDES = ("horizontal", "vertical")


def topic(words: Words, report: Report) -> Part:
    """How often findings come out, and what covariances predict."""
    run = report.run
    return Part(
        "repeated",
        words.text("seeds.title"),
        (Paragraph(_text(words, run)), shares(words, run), predictions(words, run)),
    )


def _text(words: Words, run: Reproduction) -> str:
    deviations = [
        pooled(f"weighted_{c}_{side}_m", s) / pooled(f"weighted_{c}_predicted_{side}_m", s) - 1.0
        for s in run.runs
        for c in CONTROLS
        for side in SIDES
    ]
    return words.text(
        "repeated.text",
        strips=str(len(run.runs["flat"].flights.flight.orientations.strips)),
        total=n_seeds(),
        worst=fmt.fixed(100.0 * max(map(abs, deviations)), 0),
        over=_over_reference(words, run),
    )


def n_seeds() -> str:
    """How often the experiment was repeated."""
    return fmt.count(len(repeated()["flat"]))


def _over_reference(words: Words, run: Reproduction) -> str:
    """Ratios of the pooled RMSE, horizontal / vertical, of all situations."""
    said = []
    for situation in run.runs:
        name = f"weighted_{RECOMMENDED[situation]}"
        ratios = [
            fmt.number(pooled(f"{name}_{side}_m", situation)
                       / pooled(f"reference_{side}_m", situation))
            for side in SIDES
        ]  # fmt: skip
        terrain = words.terrain(situation)
        said.append(words.text("repeated.over", ratios=" / ".join(ratios), terrain=terrain))
    return words.joined(said)


def shares(words: Words, run: Reproduction) -> Table:
    """How often each finding comes out over the stored seeds."""
    findings = [words.of("finding", name) for name in CRITERIA]
    columns = [text_column(words.text("seeds.finding"), findings)]
    for situation in run.runs:
        cells = tuple(seeds.percent(share(name, situation)) for name in CRITERIA)
        columns.append(Column(words.situation(situation), cells, words.text("seeds.share")))
    caption = words.text("shares.caption", total=n_seeds())
    return Table("shares", caption, tuple(columns), (words.text("shares.note"),))


def predictions(words: Words, run: Reproduction) -> Table:
    """RMSE over all stored seeds against what the covariances predict."""
    named = {f"weighted_{control}": words.control(control) for control in CONTROLS}
    named["reference"] = words.text("predictions.reference")
    lines = [(situation, name) for situation in run.runs for name in named]
    columns = [
        text_column(
            words.text("wucaps_column.situation"),
            [words.situation(s) if name == "weighted_none" else "" for s, name in lines],
        ),
        text_column(words.text("wucaps_column.control"), [named[name] for _, name in lines]),
    ]
    for side in SIDES:
        rmse = [pooled(f"{name}_{side}_m", s) for s, name in lines]
        predicted = [pooled(f"{name}_predicted_{side}_m", s) for s, name in lines]
        best = [pooled(f"reference_{side}_m", s) for s, _ in lines]
        group = words.text(f"predictions.{side}")
        columns += [
            metres(words.text("check_points.rmse"), rmse, group),
            metres(words.text("check_points.predicted"), predicted, group),
            _ratio(words.text("predictions.ratio"), rmse, predicted, group),
            _ratio(words.text("check_points.over_reference"), rmse, best, group),
        ]
    return Table("predictions", words.text("predictions.caption", total=n_seeds()), tuple(columns))


def _ratio(title: str, values: Iterable[float], others: Iterable[float], group: str) -> Column:
    cells = tuple(fmt.fixed(a / b, 2) for a, b in zip(values, others, strict=True))
    return Column(title, cells, group=group)
