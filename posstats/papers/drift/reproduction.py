"""One run of the experiment: the three areas, what they show, and the comparison with print."""

from collections.abc import Mapping
from dataclasses import dataclass

from posstats.contract.comparison import Compared
from posstats.contract.results import Results
from posstats.papers.drift.areas import TrueCauses, area_scenario
from posstats.papers.drift.comparison import compare
from posstats.papers.drift.findings import AreaFindings, find


@dataclass(frozen=True, eq=False)
class Reproduction:
    """A run of the experiment.

    Attributes
    ----------
    seed
        Of the run; see `posstats.papers.drift.areas.area_seed`.
    results, findings
        By area.
    compared
        Every printed number beside the reproduced one.
    """

    seed: int
    results: Mapping[int, Results]
    findings: Mapping[int, AreaFindings]
    compared: tuple[Compared, ...]


def reproduction(
    results: Mapping[int, Results], causes: Mapping[int, TrueCauses], seed: int
) -> Reproduction:
    """Compare the three areas with the printed numbers.

    Parameters
    ----------
    results, causes
        What was found, and what the errors of the POS make alone, by area.
    seed
        Of the run.
    """
    findings = {
        area: find(area, each, area_scenario(area), causes[area]) for area, each in results.items()
    }
    return Reproduction(seed, results, findings, compare(results))
