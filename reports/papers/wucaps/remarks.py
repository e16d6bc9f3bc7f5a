"""Topic: what to make of the second paper's experiment."""

from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.seeds import pooled, share

from ...document import format as fmt
from ...document.content import Bullets, Part
from .. import seeds
from .repeated import SIDES
from .report import Report
from .words import Words


def topic(words: Words, report: Report) -> Part:
    """Regression, raw angles, free unknowns, control, and what was left out."""
    run = report.run
    said = (
        _regression(words, run),
        _raw_angles(words, run),
        _free(words, run),
        _necessity(words),
        words.text("remarks.not_simulated"),
    )
    return Part("remarks", words.text("remarks.title"), (Bullets(said),))


def _regression(words: Words, run: Reproduction) -> str:
    n_chosen = sum(
        decision.correct
        for each in run.runs.values()
        for decision in each.analysis.chosen.decisions
    )
    lines = [each.measures("strip_lines") for each in run.runs.values()]
    picked = "remarks.picked" if n_chosen else "remarks.picked_none"
    return words.text(
        "remarks.regression",
        picked=words.text(picked, n=fmt.count(n_chosen)),
        vertical=words.joined(fmt.with_unit(each.vertical_m, "m") for each in lines),
        where=words.joined(words.terrain(situation) for situation in run.runs),
    )


def _raw_angles(words: Words, run: Reproduction) -> str:
    flat = run.runs["flat"]
    return words.text(
        "remarks.raw_angles",
        bundle=fmt.with_unit(flat.measures("bundle", "centre").horizontal_m, "m"),
        pos=fmt.with_unit(flat.measures("pos").horizontal_m, "m"),
        sigma0=fmt.number(flat.row("bundle", "centre").sigma0, 2),
    )


def _free(words: Words, run: Reproduction) -> str:
    sizes = []
    for situation, each in run.runs.items():
        found = each.measures("free", "centre")
        sizes.append(
            words.text(
                "remarks.size",
                horizontal=fmt.with_unit(found.horizontal_m, "m"),
                vertical=fmt.with_unit(found.vertical_m, "m"),
                terrain=words.terrain(situation),
            )
        )
    return words.text("remarks.free", sizes=words.joined(sizes))


def _necessity(words: Words) -> str:
    horizontal, vertical = (
        [
            fmt.number(pooled(f"weighted_{c}_{side}_m", "mountain")
                       / pooled(f"reference_{side}_m", "mountain"), 2)
            for c in ("none", "centre", "corners")
        ]
        for side in SIDES
    )  # fmt: skip
    return words.text(
        "remarks.necessity",
        horizontal=" / ".join(horizontal),
        vertical=" / ".join(vertical),
        without=seeds.percent(1.0 - share("less_control_is_not_enough", "mountain")),
    )
