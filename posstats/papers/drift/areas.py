"""The paper's three test areas, simulated and analysed like any block."""

from dataclasses import dataclass, replace

from posstats.analysis.steps import Analysis, Progress, analyse
from posstats.block.image_pairs import StereoModels
from posstats.block.model import Block, Orientations
from posstats.contract.choices import PAPER_SEED
from posstats.geometry.stereo.parallax import block_statistics, model_rms_px
from posstats.settings import Settings
from posstats.synthetic import Scenario, shipped_scenario, simulate

AREAS = (1, 2, 3)


def area_scenario(area: int) -> Scenario:
    """The scenario that comes with posstats for a test area of Table 1."""
    return shipped_scenario(f"area{area}")


def area_seed(seed: int, area: int) -> int:
    """Seed of an area in the run of a seed: consecutive, so that no two areas share random numbers.

    With the default seed every area has the seed of its scenario file.
    """
    return seed + area - AREAS[0]


def run_area(area: int, seed: int = PAPER_SEED, *, progress: Progress | None = None) -> Analysis:
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


@dataclass(frozen=True)
class TrueCauses:
    """Mean RMS y-parallax, mm, that errors of the POS make alone: the truth in all else.

    Attributes
    ----------
    angles_mm
        POS angles at true positions.
    positions_mm
        POS positions with true angles.
    """

    angles_mm: float
    positions_mm: float


def true_causes(block: Block, models: StereoModels) -> TrueCauses:
    """What only a simulation can tell: which error of the POS makes the parallax.

    Parameters
    ----------
    block
        Simulated; its adjusted orientations are the truth.
    models
        Its stereo models.
    """
    pos, truth = block.orientations, block.adjusted
    if truth is None:
        raise ValueError("only a simulated block knows its true orientations")

    def mean_mm(orientations: Orientations) -> float:
        rms_px = model_rms_px(models.with_orientations(orientations))
        return block_statistics(models, rms_px).mean_mm

    return TrueCauses(
        angles_mm=mean_mm(replace(truth, angles_rad=pos.angles_rad)),
        positions_mm=mean_mm(replace(truth, position_m=pos.position_m)),
    )
