"""One run of the experiment: both situations, and what they show."""

from collections.abc import Mapping
from dataclasses import dataclass

from posstats.papers.wucaps.experiment import SituationRun
from posstats.papers.wucaps.findings import SituationFindings, find
from posstats.papers.wucaps.situations import Situation


@dataclass(frozen=True, eq=False)
class Reproduction:
    """A run of the experiment.

    Attributes
    ----------
    seed
        Of the run; see `posstats.papers.wucaps.situations.flight_seed`.
    runs, findings
        By situation.
    """

    seed: int
    runs: Mapping[Situation, SituationRun]
    findings: Mapping[Situation, SituationFindings]


def reproduction(runs: Mapping[Situation, SituationRun], seed: int) -> Reproduction:
    """What the runs of a seed show."""
    return Reproduction(seed, runs, {situation: find(run) for situation, run in runs.items()})
