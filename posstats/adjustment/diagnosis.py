"""Why measurements contradict each other grossly: the usual mistakes are tried out.

Wrong conventions pass the checks of the format: angles of another system or unit or in another
order, and coordinates whose axes are exchanged or reversed. Each is undone in turn and the block
adjusted again; the first that makes the contradiction go away is named.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import get_args

import numpy as np

from posstats.adjustment.block_problem import bundle_problem
from posstats.adjustment.screening import contradicting_rays, without_rays
from posstats.arrays import Bools, Floats
from posstats.block.model import Block, Orientations
from posstats.contract.notice import Notice
from posstats.errors import ConvergenceError, GeometryError, PosstatsError
from posstats.formats.block_toml import RADIANS_PER_UNIT, FileAngleSystem
from posstats.formats.block_writing import source_of
from posstats.formats.convention import Convention
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.parameters import CommonParameter

GROSS = 10.0
"""sigma0 from which mistakes are tried out: no random error is off by so much."""
_CURED = 0.2  # of sigma0: what is left by the right convention
_SYSTEMS: tuple[FileAngleSystem, ...] = get_args(FileAngleSystem)


class MistakenDataError(PosstatsError):
    """Measurements that contradict each other because of the `mistake`."""

    def __init__(self, mistake: Notice) -> None:
        self.mistake = mistake
        super().__init__(f"the measurements contradict each other: {mistake.code}")


def likely_mistake(
    block: Block,
    parameters: tuple[CommonParameter, ...],
    control: Bools,
    sigma0: float,
) -> Notice | None:
    """The first mistake that, undone, brings sigma0 down to a fifth; None without.

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
        (said for said, other in _undone(block) if _sigma0(other, parameters, control) < limit),
        None,
    )


def _sigma0(block: Block, parameters: tuple[CommonParameter, ...], control: Bools) -> float:
    problem = bundle_problem(block, parameters, control=control)
    if len(problem.point) == 0:
        return float("inf")
    try:
        return adjust(without_rays(problem, contradicting_rays(problem))).sigma0
    except (ConvergenceError, GeometryError):
        return float("inf")


def _undone(block: Block) -> Iterator[tuple[Notice, Block]]:
    """The block without each of the usual mistakes."""
    for said, orientations in _angles_read_otherwise(block):
        yield said, replace(block, orientations=orientations)
    pos = block.orientations
    pos = replace(pos, position_m=_exchanged(pos.position_m))
    yield Notice(code="mistaken_pos_axes"), replace(block, orientations=pos)
    ties = block.tie_points
    for said, xy in (
        (Notice(code="mistaken_image_axes"), ties.xy_px[:, ::-1] * [-1.0, -1.0]),
        (Notice(code="mistaken_image_x"), ties.xy_px * [-1.0, 1.0]),
        (Notice(code="mistaken_image_y"), ties.xy_px * [1.0, -1.0]),
    ):
        yield said, replace(block, tie_points=replace(ties, xy_px=np.ascontiguousarray(xy)))
    surveyed = block.ground_points
    if surveyed is not None:
        turned = replace(surveyed, position_m=_exchanged(surveyed.position_m))
        yield Notice(code="mistaken_ground_axes"), replace(block, ground_points=turned)


def _angles_read_otherwise(block: Block) -> Iterator[tuple[Notice, Orientations]]:
    """The numbers of the file taken for another system, another unit, or in another order.

    They are those of the file, not the block's angles: these are within half a turn.
    """
    source, stated, _ = source_of(block, Convention.of_pos)
    position = source.table[["x", "y", "z"]].to_numpy(dtype=float)[source.row]
    columns = list(source.angle_columns)
    angles = source.table[columns].to_numpy(dtype=float)[source.row]
    read = stated.ground_from_image(position, angles)
    for said, convention, order in _conventions(stated, columns):
        rotation = convention.ground_from_image(position, angles[:, order])
        # what was taken off since then (a calibration) stays off
        rotation = rotation @ np.swapaxes(read, -1, -2) @ block.orientations.ground_from_image
        yield said, _turned(block.orientations, rotation, convention)


def _conventions(
    stated: Convention, columns: Sequence[str]
) -> Iterator[tuple[Notice, Convention, list[int]]]:
    """Mistake, convention and order of the columns of every other way to read angles."""
    in_order = [0, 1, 2]
    for angles in _SYSTEMS:
        # roll, pitch and heading refer to true north, which no one knows without a crs
        if angles != stated.angles and (stated.frame.crs or angles != "roll-pitch-heading"):
            read = {"angles": angles, "stated": stated.angles}
            yield (
                Notice(code="mistaken_angles", values=read),
                replace(stated, angles=angles),
                in_order,
            )
    unit = {radians: name for name, radians in RADIANS_PER_UNIT.items()}[stated.unit_rad]
    for other, unit_rad in RADIANS_PER_UNIT.items():
        if other != unit:
            units = {"angle_unit": other, "stated_unit": unit}
            said = Notice(code="mistaken_angle_unit", values=units)
            yield said, replace(stated, unit_rad=unit_rad), in_order
    exchanged = Notice(code="mistaken_columns", values={"one": columns[0], "other": columns[1]})
    yield exchanged, stated, [1, 0, 2]


def _turned(pos: Orientations, rotation: Floats, convention: Convention) -> Orientations:
    """The cameras with other rotations (n, 3, 3), about the point to which positions refer."""
    lever = (pos.ground_from_image - rotation) @ np.array(convention.lever_arm_m)
    return replace(
        pos,
        position_m=pos.position_m + lever,
        angles_rad=convention.computing_angles(rotation),
        system=convention.system,
    )


def _exchanged(position_m: Floats) -> Floats:
    """X and y exchanged."""
    return np.ascontiguousarray(position_m[:, [1, 0, 2]])
