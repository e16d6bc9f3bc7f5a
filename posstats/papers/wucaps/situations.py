"""The paper's two situations, simulated: the flight, its calibration flight, and it without errors.

All blocks are made by one scenario. The calibration flight is another flight over other points,
with the same boresight and with shifts and drifts of its own.
"""

from dataclasses import dataclass, replace
from typing import Literal, get_args

from posstats.block.model import Block
from posstats.contract.choices import PAPER_SEED
from posstats.synthetic import Scenario, shipped_scenario, simulate
from posstats.synthetic.scenario import AngleError, PositionError

Situation = Literal["flat", "mountain"]

SITUATIONS: tuple[Situation, ...] = get_args(Situation)
_BLOCKS_PER_SEED = 4  # two situations, each with a flight and a calibration flight


@dataclass(frozen=True, eq=False)
class Flights:
    """What is simulated of one situation.

    Attributes
    ----------
    flight
        The block to be oriented.
    without_errors
        The same images of the same points with the same noise, its POS without boresight, shifts
        and drifts.
    calibration
        The block from which the boresight is taken.
    """

    flight: Block
    without_errors: Block
    calibration: Block


def situation_scenario(situation: Situation) -> Scenario:
    """The scenario that comes with posstats."""
    return shipped_scenario(f"wucaps-{situation}")


def flight_seed(seed: int, situation: Situation) -> int:
    """Seed of a flight in the run of a seed; that of its calibration flight is one more.

    No two blocks of any two runs share random numbers. With the default seed every flight has the
    seed of its scenario file.
    """
    return _BLOCKS_PER_SEED * seed + 2 * SITUATIONS.index(situation)


def simulated(situation: Situation, seed: int = PAPER_SEED) -> Flights:
    """Simulate the blocks of a situation in the run of a seed."""
    scenario, own = situation_scenario(situation), flight_seed(seed, situation)
    calibration = replace(scenario, block=replace(scenario.block, name="calibration flight"))
    return Flights(
        flight=simulate(scenario, own),
        without_errors=simulate(without_systematic_errors(scenario), own),
        calibration=simulate(calibration, own + 1),
    )


def without_systematic_errors(scenario: Scenario) -> Scenario:
    """The scenario with nothing but white noise in its POS; the noise is the same."""
    errors = scenario.errors
    noise_only = replace(
        errors,
        position=PositionError(noise_m=errors.position.noise_m),
        omega=_noise(errors.omega),
        phi=_noise(errors.phi),
        kappa=_noise(errors.kappa),
        pitch=_noise(errors.pitch),
        roll=_noise(errors.roll),
        yaw=_noise(errors.yaw),
    )
    return replace(scenario, errors=noise_only)


def _noise(error: AngleError) -> AngleError:
    return AngleError(noise_rad=error.noise_rad)
