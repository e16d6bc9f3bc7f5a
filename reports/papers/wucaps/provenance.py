"""Topic: scenarios, seeds, settings and software of the second paper's reproduction."""

from posstats.contract.versions import versions
from posstats.papers.wucaps.findings import RECOMMENDED
from posstats.papers.wucaps.situations import Situation, flight_seed

from ...document.content import Part
from .. import provenance
from .report import Report
from .words import Words


def topic(words: Words, report: Report) -> Part:
    """How to make the numbers again."""
    run = report.run
    text = words.text("provenance.text", seed=str(run.seed))
    seeds = [_seeds(words, situation, run.seed) for situation in run.runs]
    recommended = [
        (
            words.text("provenance.control", situation=words.situation(situation)),
            words.control(RECOMMENDED[situation]),
        )
        for situation in run.runs
    ]
    return provenance.topic(words, text, [*seeds, *recommended], versions().items())


def _seeds(words: Words, situation: Situation, seed: int) -> tuple[str, str]:
    own = flight_seed(seed, situation)
    return (
        words.text("provenance.seed", situation=words.situation(situation)),
        words.text("provenance.seeds", name=situation, seed=str(own), other=str(own + 1)),
    )
