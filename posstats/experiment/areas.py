"""The paper's three test areas, simulated and analysed like any block."""

from collections.abc import Mapping
from typing import Any

from posstats.analysis import Analysis, Progress, Settings, analyse
from posstats.results import results
from posstats.synthetic import Scenario, shipped_scenario, simulate

AREAS = (1, 2, 3)
DEFAULT_SEED = 1


def area_scenario(area: int) -> Scenario:
    """The scenario that comes with posstats for a test area of Table 1."""
    return shipped_scenario(f"area{area}")


def area_seed(seed: int, area: int) -> int:
    """Seed of an area in the run of a seed: consecutive, so that no two areas share random numbers.

    With the default seed every area has the seed of its scenario file.
    """
    return seed + area - AREAS[0]


def run_area(area: int, seed: int = DEFAULT_SEED, *, progress: Progress | None = None) -> Analysis:
    """Simulate a test area and analyse it by the paper's rules.

    Parameters
    ----------
    area
        1, 2 or 3.
    seed
        Of the whole experiment; see `area_seed`.
    progress
        As of `posstats.analyse`.
    """
    block = simulate(area_scenario(area), area_seed(seed, area))
    return analyse(block, Settings(rules="paper"), progress=progress)


def area_results(
    area: int, seed: int = DEFAULT_SEED, *, created: str | None = None
) -> Mapping[str, Any]:
    """The results dictionary of `run_area`."""
    return results(run_area(area, seed), created=created)
