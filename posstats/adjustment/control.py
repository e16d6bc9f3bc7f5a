"""Which ground points are control: by their roles, by their place in the block, or by their ids."""

from difflib import get_close_matches
from pathlib import Path

import numpy as np
from scipy.optimize import linear_sum_assignment

from posstats.arrays import Bools, Floats, Ints
from posstats.block.model import Block, GroundPoints
from posstats.contract.choices import ControlChoice
from posstats.errors import PosstatsError


def chosen_control(block: Block, choice: ControlChoice) -> Bools:
    """(g,) which of the block's ground points are control; the others are check points.

    Parameters
    ----------
    block
        Its ground points take part if at least two images show them.
    choice
        ``roles``: as the block says; ``none``; ``centre``: the point nearest the middle of the
        projection centres; ``corners``: the four nearest the corners of their rectangle along
        the direction of flight, no point twice; ``all``; or ids.

    Raises
    ------
    PosstatsError
        If there are too few measured points, or an id is unknown or not measured.
    """
    surveyed = block.ground_points
    if surveyed is None or len(surveyed) == 0:
        return _without_points(choice)
    measured = measured_points(block, surveyed)
    if choice == "roles":
        return measured & ~surveyed.is_check
    chosen = np.zeros(len(surveyed), dtype=bool)
    if isinstance(choice, tuple):
        chosen[_numbers(surveyed, measured, choice)] = True
    elif choice == "all":
        chosen = measured
    elif choice in ("centre", "corners"):
        chosen[_nearest(block, surveyed, np.flatnonzero(measured), choice)] = True
    return chosen


def read_ids(path: Path) -> tuple[str, ...]:
    """Ids of a text file, one on a line; empty lines and what follows a # do not count.

    Raises
    ------
    PosstatsError
        If there is no id, or the file is no text.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise PosstatsError(
            f"{path}: found no text in UTF-8, expected ids, one on a line"
        ) from error
    ids = tuple(filter(None, (line.partition("#")[0].strip() for line in lines)))
    if not ids:
        raise PosstatsError(f"{path}: found no id, expected ids of control points, one on a line")
    return ids


def _without_points(choice: ControlChoice) -> Bools:
    if choice not in ("roles", "none", "all"):
        raise PosstatsError("the block has no ground_points.csv to choose control points from")
    return np.empty(0, dtype=bool)


def measured_points(block: Block, surveyed: GroundPoints) -> Bools:
    """(g,) which ground points at least two images show."""
    n_rays = np.bincount(block.tie_points.point, minlength=len(block.tie_points.point_id))
    shown = {block.tie_points.point_id[k] for k in np.flatnonzero(n_rays >= 2)}
    return np.array([point in shown for point in surveyed.point], dtype=bool)


def _numbers(surveyed: GroundPoints, measured: Bools, ids: tuple[str, ...]) -> list[int]:
    """Indices of ids."""
    number = {str(point): k for k, point in enumerate(surveyed.point)}
    findings = []
    for each in dict.fromkeys(ids):
        if each not in number:
            like = get_close_matches(each, number, n=1, cutoff=0.0)
            findings.append(f"there is no ground point {each!r}; the nearest id is {like[0]!r}")
        elif not measured[number[each]]:
            findings.append(f"ground point {each!r} is not measured in two images")
    if findings:
        raise PosstatsError("control points: " + "; ".join(findings))
    return [number[each] for each in ids]


def _nearest(block: Block, surveyed: GroundPoints, candidates: Ints, choice: str) -> (
    Ints
):  # fmt: skip
    """The points nearest the middle, or the corners, of the rectangle of projection centres."""
    turned = _along_flight(block)
    centres = block.orientations.position_m[:, :2] @ turned
    low, high = centres.min(axis=0), centres.max(axis=0)
    places = np.array([0.5 * (low + high)])
    if choice == "corners":
        places = np.array([[x, y] for x in (low[0], high[0]) for y in (low[1], high[1])])
    if len(candidates) < len(places):
        raise PosstatsError(
            f"control {choice} needs {len(places)} ground points measured in two or more images;"
            f" the block has {len(candidates)}"
        )
    positions = surveyed.position_m[candidates, :2] @ turned
    distance = np.linalg.norm(places[:, None] - positions, axis=2)
    _, nearest = linear_sum_assignment(distance)
    return candidates[nearest]


def _along_flight(block: Block) -> Floats:
    """Rotation (2, 2): columns along and across the mean direction of the strips.

    Opposite headings count as one: directions are averaged at twice their angle.
    """
    base = np.diff(block.orientations.position_m[:, :2], axis=0)
    base = base[block.orientations.strip[1:] == block.orientations.strip[:-1]]
    doubled = np.sum((base[:, 0] + 1j * base[:, 1]) ** 2)
    angle = 0.5 * np.angle(doubled)
    return np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
