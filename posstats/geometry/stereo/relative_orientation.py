"""Relative orientation of all stereo models at once, by least squares on the y-parallax.

The general model (equation 1 of the first source paper) has seven elements in the base frame:
phi1 and kappa1 of the left image, BY and BZ of the base (BX gives the scale), phi2, omega2 and
kappa2 of the right image. At most five of them can be solved for. The derivatives of q are
exact; the paper's linearised coefficients are not used.
"""

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Literal, get_args

import numpy as np

from posstats.arrays import Bools, Floats, Ids, Ints
from posstats.block.image_pairs import MIN_MODEL_POINTS, StereoModels
from posstats.errors import GeometryError
from posstats.geometry.stereo.pair_adjustment import (
    CONVERGED,
    NOT_CONVERGED,
    RANK_DEFICIENT,
    adjust_pairs,
)
from posstats.geometry.stereo.pair_blunders import weigh_pairs
from posstats.numerics.kernels.coplanarity import base_frames
from posstats.numerics.kernels.rotation import (
    ANGLE_NAMES,
    AngleSystem,
    angles_from_rotation,
    rotation_from_angles,
)

Method = Literal["independent", "dependent", "angles", "omega", "phi", "kappa"]

ELEMENTS = ("phi1", "kappa1", "BY", "BZ", "phi2", "omega2", "kappa2")
INDEPENDENT = ("phi1", "kappa1", "phi2", "omega2", "kappa2")
DEPENDENT = ("BY", "BZ", "phi2", "omega2", "kappa2")

# A rotation of the whole model about Z or Y of the base frame makes no parallax: of the three
# elements that it moves, one must stay.
_UNSOLVABLE = (
    ({"kappa1", "kappa2", "BY"}, "vertical"),
    ({"phi1", "phi2", "BZ"}, "horizontal"),
)
_STATE = ("omega1", "phi1", "kappa1", "omega2", "phi2", "kappa2", "BY", "BZ")
_HELD = {"dependent": (), "angles": ("omega2", "phi2", "kappa2")} | {
    angle: (f"{angle}2",) for angle in ANGLE_NAMES
}
_STATUS = {
    CONVERGED: "ok",
    NOT_CONVERGED: "not converged",
    RANK_DEFICIENT: "degenerate: the points do not determine the elements",
}
_LARGEST_TURN_RAD = float(np.radians(60.0))
_TOO_FAR = "degenerate: the images turn by more than 60 degrees"
_MIN_BASE_M = 1e-6
_MIN_HORIZONTAL_SHARE = 1e-6
_POINTS_PER_THREAD = 10_000


@dataclass(frozen=True, eq=False)
class RelativeOrientation:
    """Relative orientation of p stereo models with N point pairs.

    Attributes
    ----------
    y_parallax_rms_px, y_parallax_rms_mm
        (p,) root mean square of the remaining y-parallax, at image scale, of all points, or of
        the kept ones if robust; NaN without a solution, mm also NaN without a pixel size.
    n_points, n_rejected
        (p,) numbers of point pairs, and of those rejected as blunders.
    converged
        (p,) true where there is a solution.
    status
        (p,) "ok", or why there is no solution.
    weights
        (N,) final weights, 0 where rejected; NaN in models without a solution.
    ground_from_left, ground_from_right
        (p, 3, 3) rotations of the oriented images; NaN without a solution.
    base_m
        (p, 3) base of the oriented model, right minus left, ground frame; NaN without one.
    n_iterations
        (p,) iterations of the (last) adjustment.
    """

    y_parallax_rms_px: Floats
    y_parallax_rms_mm: Floats
    n_points: Ints
    n_rejected: Ints
    converged: Bools
    status: Ids
    weights: Floats
    ground_from_left: Floats
    ground_from_right: Floats
    base_m: Floats
    n_iterations: Ints


@dataclass(frozen=True, eq=False)
class _Start:
    """Start values of p models: angles (p, 2, 3) radians about constant frames (p, 2, 3, 3)."""

    frames: Floats
    angles_rad: Floats
    base: Floats
    base_from_ground: Floats
    weights: Floats
    status: Ids


def orient(
    models: StereoModels,
    method: Method = "independent",
    *,
    robust: bool = False,
    independent: RelativeOrientation | None = None,
) -> RelativeOrientation:
    """Relative orientation of every model, starting from its orientations.

    Parameters
    ----------
    models
        The stereo models; their orientations (the POS) give the start and what is held.
    method
        ``independent``: phi1, kappa1, phi2, omega2, kappa2 free, base as given (single-pair
        method). ``dependent``: the left image as the independent solution left it; BY, BZ and
        the three angles of the right image free (continuous method). ``angles``, ``omega``,
        ``phi``, ``kappa``: dependent, with all or one of the right image's angles of the
        block's own system *in the ground frame* held (fixed-element method, Figure 1).
    robust
        Reject blunders (Huber's, then Tukey's weights on q, scale by the median absolute
        residual of each model). They are found in the independent solution; the other methods
        use its weights, so that all are compared over the same points.

    independent
        The independent solution of the same models, if it is already known: the other methods
        start from it, and `robust` then has no say.

    Raises
    ------
    GeometryError
        For an unknown method.

    Examples
    --------
    What relative orientation leaves of the parallax of a block with 0.2 px of image noise:

    >>> import posstats
    >>> models = posstats.stereo_models(posstats.read_block("block"))
    >>> left = posstats.orient(models, "independent")
    >>> print(f"{left.y_parallax_rms_px.mean():.2f} px")
    0.27 px
    """
    if method not in get_args(Method):
        raise GeometryError(
            f"unknown relative orientation {method!r}: choose one of {', '.join(get_args(Method))}"
        )
    if independent is None:
        independent = _adjusted(models, _base_frame_start(models), INDEPENDENT, robust)
    if method == "independent":
        return independent
    free = [element for element in DEPENDENT if element not in _HELD[method]]
    return _adjusted(models, _dependent_start(models, independent), free, robust=False)


def orient_elements(
    models: StereoModels, free: Iterable[str], *, robust: bool = False
) -> RelativeOrientation:
    """Relative orientation with any solvable choice of the seven elements of the base frame.

    Parameters
    ----------
    models
        The stereo models; their orientations give the start and the values of what is held.
    free
        Elements to solve for, of `ELEMENTS`.
    robust
        As in `orient`: points are rejected by the independent solution.

    Raises
    ------
    GeometryError
        If the elements cannot be solved for together, are unknown, or none is named.
    """
    chosen = set(free)
    check_solvable(chosen)
    start = _base_frame_start(models)
    if robust:
        start = _weighted_as(start, _adjusted(models, start, INDEPENDENT, robust))
    return _adjusted(models, start, chosen, robust=False)


def check_solvable(elements: Iterable[str]) -> None:
    """Raise GeometryError unless the elements of `ELEMENTS` can be solved for together."""
    chosen = set(elements)
    unknown = sorted(chosen.difference(ELEMENTS))
    if unknown:
        raise GeometryError(
            f"unknown elements {', '.join(unknown)}: the elements are {', '.join(ELEMENTS)}"
        )
    if not chosen:
        raise GeometryError("relative orientation needs at least one free element")
    for triple, axis in _UNSOLVABLE:
        if triple <= chosen:
            named = ", ".join(element for element in ELEMENTS if element in triple)
            raise GeometryError(
                f"{named} cannot be solved for together: a common turn about the {axis} axis "
                "changes all three and makes no parallax; hold one of them"
            )


def _base_frame_start(models: StereoModels) -> _Start:
    """The models as given, angles in the base frame."""
    base_from_ground = base_frames(models.base_m)
    images = np.stack([models.pairs.left, models.pairs.right], axis=1)
    rotation = base_from_ground[:, None] @ models.orientations.ground_from_image[images]
    return _Start(
        frames=np.broadcast_to(np.eye(3), rotation.shape).copy(),
        angles_rad=angles_from_rotation(rotation, models.orientations.system),
        base=np.einsum("pij,pj->pi", base_from_ground, models.base_m),
        base_from_ground=base_from_ground,
        weights=np.ones(len(models.left_vectors)),
        status=_usable(models),
    )


def _dependent_start(models: StereoModels, independent: RelativeOrientation) -> _Start:
    """Left image as the independent solution left it, right image by its own ground angles."""
    start = _weighted_as(_base_frame_start(models), independent)
    left = start.base_from_ground @ independent.ground_from_left
    start.angles_rad[:, 0] = angles_from_rotation(left, models.orientations.system)
    start.angles_rad[:, 1] = models.orientations.angles_rad[models.pairs.right]
    start.frames[:, 1] = start.base_from_ground
    return start


def _weighted_as(start: _Start, solution: RelativeOrientation) -> _Start:
    """The start with the weights and the failures of an earlier solution."""
    return replace(start, weights=solution.weights.copy(), status=solution.status)


def _usable(models: StereoModels) -> Ids:
    """(p,) "ok", or why a model cannot be oriented at all."""
    orientations = models.orientations
    images = np.stack([models.pairs.left, models.pairs.right], axis=1)
    known = np.isfinite(np.hstack([orientations.position_m, orientations.angles_rad]))
    length = np.linalg.norm(models.base_m, axis=1)
    horizontal = np.hypot(models.base_m[:, 0], models.base_m[:, 1])
    status = np.full(len(models), "ok", dtype=object)
    status[horizontal <= _MIN_HORIZONTAL_SHARE * length] = (
        "degenerate: base without horizontal extent"
    )
    status[length <= _MIN_BASE_M] = "degenerate: zero base"
    status[models.pairs.n_points < MIN_MODEL_POINTS] = "fewer than 6 points"
    status[~known[images].all(axis=(1, 2))] = "no orientation"
    return status


def _adjusted(
    models: StereoModels, start: _Start, free: Iterable[str], robust: bool
) -> RelativeOrientation:
    """Solve all models for the free elements and gather the result."""
    numbers = np.array(sorted(_STATE.index(element) for element in free), dtype=np.intp)
    p = len(models)
    usable = np.equal(start.status, "ok").astype(bool)
    base = np.where(usable[:, None], start.base, [1.0, 0.0, 0.0])
    state = np.column_stack([start.angles_rad.reshape(p, 6), base[:, 1:] / base[:, :1]])
    rms, code, iterations = np.full(p, np.nan), np.zeros(p, np.intp), np.zeros(p, np.intp)
    weights = start.weights.copy()

    equations = (
        models.left_vectors,
        models.right_vectors,
        weights,
        models.pairs.offsets,
        start.frames,
        models.orientations.system == "phi-omega-kappa",
        numbers,
    )

    def solve(pairs: Ints) -> None:
        if robust:
            weigh_pairs(*equations, pairs, state)
        adjust_pairs(*equations, pairs, state, rms, code, iterations)

    _in_threads(solve, np.flatnonzero(usable), models.pairs.n_points)
    status = start.status.copy()
    status[usable] = [_STATUS[c] for c in code[usable]]
    return _result(models, start, state, rms, status, weights, iterations)


def _in_threads(solve: Callable[[Ints], None], pairs: Ints, n_points: Ints) -> None:
    """Run `solve` on shares of the pairs with about the same numbers of points."""
    total = np.cumsum(n_points[pairs])
    n_threads = min(os.cpu_count() or 1, int(total[-1:].sum()) // _POINTS_PER_THREAD)
    if n_threads < 2:
        solve(pairs)
        return
    cuts = np.searchsorted(total, total[-1] * np.arange(1, n_threads) / n_threads)
    with ThreadPoolExecutor(n_threads) as pool:
        list(pool.map(solve, np.split(pairs, cuts)))


def _turned_rad(start: _Start, turn: Floats, system: AngleSystem) -> Floats:
    """(p,) the larger of the angles by which the two images were turned from the start."""
    given = rotation_from_angles(start.angles_rad, system)
    cosine = 0.5 * (np.einsum("pkij,pkij->pk", given, turn) - 1.0)
    turned: Floats = np.arccos(np.clip(cosine, -1.0, 1.0)).max(axis=1)
    return turned


def _result(
    models: StereoModels,
    start: _Start,
    state: Floats,
    rms_px: Floats,
    status: Ids,
    weights: Floats,
    iterations: Ints,
) -> RelativeOrientation:
    n_points = models.pairs.n_points
    pair_of_point = models.pairs.pair_of_point
    n_kept = np.bincount(pair_of_point[weights > 0.0], minlength=len(models))
    status[np.equal(status, "ok").astype(bool) & (n_kept < MIN_MODEL_POINTS)] = (
        "fewer than 6 points after rejection"
    )
    angles = state[:, :6].reshape(-1, 2, 3)
    turn = rotation_from_angles(angles, models.orientations.system)
    far = _turned_rad(start, turn, models.orientations.system) > _LARGEST_TURN_RAD
    status[np.equal(status, "ok").astype(bool) & far] = _TOO_FAR
    converged = np.equal(status, "ok").astype(bool)
    turn = np.where(converged[:, None, None, None], turn, np.nan)
    ground_from_base = np.swapaxes(start.base_from_ground, 1, 2)
    rotation = ground_from_base[:, None] @ start.frames @ turn
    relative = np.column_stack([np.ones(len(models)), state[:, 6:]])
    base = np.einsum("pij,pj->pi", ground_from_base, relative * start.base[:, :1])
    rms_px = np.where(converged, rms_px, np.nan)
    return RelativeOrientation(
        y_parallax_rms_px=rms_px,
        y_parallax_rms_mm=rms_px * models.pixel_size_mm,
        n_points=n_points,
        n_rejected=np.where(converged, n_points - n_kept, 0),
        converged=converged,
        status=status,
        weights=np.where(converged[pair_of_point], weights, np.nan),
        ground_from_left=rotation[:, 0],
        ground_from_right=rotation[:, 1],
        base_m=np.where(converged[:, None], base, np.nan),
        n_iterations=iterations,
    )
