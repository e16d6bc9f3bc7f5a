"""Why measurements contradict each other grossly: the usual mistakes are tried out.

Wrong conventions pass the checks of the format: angles of another system or in another order, and
coordinates whose axes are exchanged. Each is undone in turn and the block adjusted again; the first
that makes the contradiction go away is named.
"""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from posstats.adjustment.block_problem import bundle_problem
from posstats.adjustment.screening import contradicting_rays, without_rays
from posstats.block import Block, Orientations
from posstats.bundle import adjust
from posstats.bundle.parameters import CommonParameter
from posstats.errors import ConvergenceError, GeometryError

_Bools = NDArray[np.bool_]

GROSS = 10.0
"""sigma0 from which mistakes are tried out: no random error is off by so much."""
_CURED = 0.2  # of sigma0: what is left by the right convention


def likely_mistake(
    block: Block,
    parameters: tuple[CommonParameter, ...],
    control: _Bools,
    sigma0: float,
) -> str | None:
    """The first mistake in words that, undone, brings sigma0 down to a fifth; None without.

    Parameters
    ----------
    block
        With rays of tie points and control only.
    parameters, control
        As for `bundle_problem`.
    sigma0
        Of the block as it is; infinite where it could not be adjusted.
    """
    limit = min(_CURED * sigma0, GROSS)
    return next(
        (w for w, other in _undone(block) if _sigma0(other, parameters, control) < limit), None
    )


def _sigma0(block: Block, parameters: tuple[CommonParameter, ...], control: _Bools) -> float:
    problem = bundle_problem(block, parameters, control=control)
    if len(problem.point) == 0:
        return float("inf")
    try:
        return adjust(without_rays(problem, contradicting_rays(problem))).sigma0
    except (ConvergenceError, GeometryError):
        return float("inf")


def _undone(block: Block) -> Iterator[tuple[str, Block]]:
    """The block without each of the usual mistakes."""
    pos = block.orientations
    other = "phi-omega-kappa" if pos.system == "omega-phi-kappa" else "omega-phi-kappa"
    changes: dict[str, Callable[[Orientations], Orientations]] = {
        f"the angles are {other}, not {pos.system} (block.angles)": _other_system,
        "the angles are in gon, not in degrees (block.angle_unit)": lambda o: o.with_angles(
            0.9 * o.angles_rad
        ),
        "the angles are in degrees, not in gon (block.angle_unit)": lambda o: o.with_angles(
            o.angles_rad / 0.9
        ),
        "omega and phi are exchanged": lambda o: o.with_angles(o.angles_rad[:, [1, 0, 2]]),
        "x and y of the POS positions are exchanged": lambda o: replace(
            o, position_m=_exchanged(o.position_m)
        ),
    }
    for words, change in changes.items():
        yield words, replace(block, orientations=change(pos))
    ties = block.tie_points
    for words, xy in (
        ("x and y of the image coordinates are exchanged", ties.xy_px[:, ::-1] * [-1.0, -1.0]),
        ("x of the image coordinates has the wrong sign", ties.xy_px * [-1.0, 1.0]),
        ("y of the image coordinates has the wrong sign", ties.xy_px * [1.0, -1.0]),
    ):
        yield words, replace(block, tie_points=replace(ties, xy_px=np.ascontiguousarray(xy)))
    surveyed = block.ground_points
    if surveyed is not None:
        turned = replace(surveyed, position_m=_exchanged(surveyed.position_m))
        yield (
            "x and y of the ground points are exchanged",
            replace(block, ground_points=turned),
        )


def _other_system(pos: Orientations) -> Orientations:
    """The same numbers read in the other angle system."""
    if pos.system == "omega-phi-kappa":
        return replace(pos, system="phi-omega-kappa")
    return replace(pos, system="omega-phi-kappa")


def _exchanged(position_m: NDArray[np.float64]) -> NDArray[np.float64]:
    """X and y exchanged."""
    return np.ascontiguousarray(position_m[:, [1, 0, 2]])
