"""Data snooping after a bundle adjustment: blunders are found, named, and taken out one by one.

The observation of the largest |w| above the critical value goes, as a whole: both coordinates of
a ray, the three of a control point, of an antenna position or of a set of angles. Rays go together
if they share no point, are measured in no image that sees a point of another, and have at least
half the largest |w|: what one of them does to the w of another is far less. Images whose axes
are exchanged or reversed bend the whole block, so they are looked for first (`axes`).
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from posstats.adjustment.axes import images_with_wrong_axes
from posstats.adjustment.significance import critical_value, local_tests
from posstats.arrays import Floats, Ints
from posstats.contract.adjustment import Observed
from posstats.errors import ConvergenceError, UndeterminedError
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem

BLOCK_ALPHA = 0.05
MOST_BLUNDERS = 1000
_GROSS = 10.0  # critical values: residuals that a robust start leaves out, the rest is tested
_COMPARABLE = 0.5  # of the largest |w|: rays that may go together with that one


@dataclass(frozen=True, eq=False)
class Blunder:
    """An observation, or all rays of an image, that the others contradict.

    Attributes
    ----------
    kind, index
        ``image``: a ray; ``axes``: an image whose rays have axes exchanged or reversed; ``gnss``,
        ``imu``: an image; ``control``: a row of the control.
    w
        The standardised residual of the largest absolute value when it was taken out; NaN of
        ``axes``.
    size
        (q,) measured minus adjusted, after all were taken out, in `unit`; NaN where the others do
        not determine it. Of ``axes``, the root mean square over the rays.
    unit
        ``px``, ``m`` or ``rad``.
    """

    kind: Observed
    index: int
    w: float
    size: Floats
    unit: str


@dataclass(frozen=True, eq=False)
class Snooping:
    """Outcome of data snooping.

    Attributes
    ----------
    blunders
        In the order in which they were taken out. Of a point with two rays, only one is named,
        though it may be the other.
    held
        The observation at which snooping ended, as the block is not determined without it: it,
        or one that it is tied to, is a blunder. None: it did not end so.
    complete
        No observation is left with a |w| above the critical value.
    problem, result
        Without the blunders, and its adjustment; control points that are none are missing.
    """

    blunders: tuple[Blunder, ...]
    held: Blunder | None
    complete: bool
    problem: BundleProblem
    result: AdjustedBundle


@dataclass(frozen=True)
class _Suspect:
    """What may be taken out, in the numbering of the whole problem."""

    kind: Observed
    index: int
    w: float


def snoop(
    problem: BundleProblem, *, alpha: float = BLOCK_ALPHA, most: int = MOST_BLUNDERS
) -> Snooping:
    """Adjust, take out the worst observation, and so on until none is left.

    Parameters
    ----------
    problem
        As observed.
    alpha
        Probability that a block without blunders loses an observation: every one of the N
        components is tested to alpha / N. (At 0.001 each, a block of a million image
        coordinates would lose a thousand good ones.)
    most
        Number of blunders to stop at.

    Raises
    ------
    ConvergenceError, GeometryError, UndeterminedError
        As `adjust`, of the problem without images of wrong axes; where it does not converge, of
        the robust solution.
    """
    out = [_Suspect("axes", i, float("nan")) for i in images_with_wrong_axes(problem)]
    critical = critical_value(alpha / _n_components(_without(problem, out)))
    out, kept, result = _first_adjustment(problem, out, critical)
    held: _Suspect | None = None
    while (suspects := _suspects(problem, kept, result, critical)) and len(out) < most:
        together = _together(problem, suspects)[: most - len(out)]
        after = _first_determined(problem, [out + together, [*out, suspects[0]]])
        if after is None:
            held = suspects[0]
            break
        out, kept, result = after
    return Snooping(
        tuple(_named(problem, result, suspect) for suspect in out),
        None if held is None else _named(problem, result, held),
        not suspects,
        kept,
        result,
    )


def _first_determined(
    problem: BundleProblem, choices: list[list[_Suspect]]
) -> tuple[list[_Suspect], BundleProblem, AdjustedBundle] | None:
    """The first choice of observations that the block is determined without."""
    for out in choices:
        kept = _without(problem, out)
        try:
            return out, kept, adjust(kept)
        except UndeterminedError:
            continue
    return None


def _n_components(problem: BundleProblem) -> int:
    """Number of observations with weight."""
    rays = np.isfinite(problem.sigma_px).sum()
    observed = (problem.pos.weight > 0.0).sum()
    return int(2 * rays + observed + 3 * len(problem.control.point))


def _first_adjustment(
    problem: BundleProblem, out: list[_Suspect], critical: float
) -> tuple[list[_Suspect], BundleProblem, AdjustedBundle]:
    """Where rays are so wrong that nothing converges, those go that a robust solution rejects."""
    kept = stated = _without(problem, out)
    try:
        return out, kept, adjust(kept)
    except ConvergenceError:
        result = adjust(kept, robust=True)
    for _ in range(2):  # the second time, rays come back that least squares without them fit
        w = result.residual_px / stated.sigma_px[:, None]
        larger = w[np.arange(len(w)), np.abs(w).argmax(axis=1)]
        gross = np.flatnonzero(result.rejected & ~(np.abs(larger) <= _GROSS * critical))
        taken = out + [_Suspect("image", int(ray), float(larger[ray])) for ray in gross]
        kept = _without(problem, taken)
        result = adjust(kept)
    return taken, kept, result


def _without(problem: BundleProblem, out: list[_Suspect]) -> BundleProblem:
    """The problem with no weight of what is taken out."""
    index = {
        kind: [suspect.index for suspect in out if suspect.kind == kind]
        for kind in ("image", "axes", "gnss", "imu", "control")
    }
    sigma_px = np.where(np.isin(problem.image, index["axes"]), np.inf, problem.sigma_px)
    sigma_px[index["image"]] = np.inf
    antenna, angles = problem.pos.sigma_antenna_m.copy(), problem.pos.sigma_angles_rad.copy()
    antenna[index["gnss"]] = np.inf
    angles[index["imu"]] = np.inf
    return replace(
        problem,
        sigma_px=sigma_px,
        pos=replace(problem.pos, sigma_antenna_m=antenna, sigma_angles_rad=angles),
        control=problem.control.subset(_control_kept(problem, index["control"])),
    )


def _control_kept(problem: BundleProblem, out: list[int]) -> Ints:
    """Rows of the control that are left."""
    return np.setdiff1d(np.arange(len(problem.control.point)), out)


def _suspects(
    problem: BundleProblem,
    kept: BundleProblem,
    result: AdjustedBundle,
    critical: float,
) -> list[_Suspect]:
    """Observations above the critical value, the worst first."""
    row_of = {int(point): row for row, point in enumerate(problem.control.point)}
    found: list[_Suspect] = []
    kinds: tuple[Observed, ...] = ("image", "gnss", "imu", "control")
    tests = local_tests(kept, result)
    for kind in kinds:
        w = tests[kind].w
        size = np.nan_to_num(np.abs(w))
        for row in np.flatnonzero(size.max(axis=1, initial=0.0) > critical):
            index = row_of[int(kept.control.point[row])] if kind == "control" else int(row)
            found.append(_Suspect(kind, index, float(w[row, size[row].argmax()])))
    return sorted(found, key=lambda suspect: -abs(suspect.w))


def _together(problem: BundleProblem, suspects: list[_Suspect]) -> list[_Suspect]:
    """The worst, and if it is a ray, rays that have nothing to do with it or each other."""
    worst = suspects[0]
    if worst.kind != "image":
        return [worst]
    rays = [
        suspect
        for suspect in suspects
        if suspect.kind == "image" and abs(suspect.w) >= _COMPARABLE * abs(worst.w)
    ]
    images = _images_of_points(problem, {int(problem.point[suspect.index]) for suspect in rays})
    chosen: list[_Suspect] = []
    touched: set[int] = set()
    for suspect in rays:
        near = images[int(problem.point[suspect.index])]
        if not touched & near:
            chosen.append(suspect)
            touched |= near
    return chosen


def _images_of_points(problem: BundleProblem, points: set[int]) -> Mapping[int, set[int]]:
    images: dict[int, set[int]] = {point: set() for point in points}
    for ray in np.flatnonzero(np.isin(problem.point, list(points))):
        images[int(problem.point[ray])].add(int(problem.image[ray]))
    return images


def _determined_residuals(problem: BundleProblem, result: AdjustedBundle, rays: Ints) -> Floats:
    """Residuals (q, 2) of rays; NaN where the other rays do not determine the point."""
    there = np.isfinite(result.ground_m[problem.point[rays], :1])
    return np.where(there, result.residual_px[rays], np.nan)


def _size(problem: BundleProblem, result: AdjustedBundle, suspect: _Suspect) -> Floats:
    """Measured minus adjusted."""
    at = suspect.index
    if suspect.kind == "axes":
        residual = _determined_residuals(problem, result, np.flatnonzero(problem.image == at))
        n = np.isfinite(residual).sum(axis=0)
        square_sum = np.nansum(residual**2, axis=0)
        rms: Floats = np.sqrt(np.divide(square_sum, n, out=np.full(2, np.nan), where=n > 0))
        return rms
    if suspect.kind == "image":
        residual = _determined_residuals(problem, result, np.array([at]))[0]
    elif suspect.kind == "control":
        control = problem.control
        residual = result.ground_m[control.point[at]] - control.position_m[at]
    else:
        residual = result.residual_pos[at].reshape(2, 3)[int(suspect.kind == "imu")]
    difference: Floats = -residual
    return difference


def _named(problem: BundleProblem, result: AdjustedBundle, suspect: _Suspect) -> Blunder:
    unit = {"image": "px", "axes": "px", "imu": "rad"}.get(suspect.kind, "m")
    size = _size(problem, result, suspect)
    return Blunder(suspect.kind, suspect.index, suspect.w, size, unit)
