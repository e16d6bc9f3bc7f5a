"""Least-squares adjustment of a whole block by coplanarity, without object points; on arrays.

Unknown are three angles and three coordinates of every image. Observations are the y-parallaxes
q of point pairs; positions and, weakly, angles are observed as well (priors).

A point seen in n images makes up to n(n-1)/2 pairs but has 2n - 3 degrees of freedom; how its
observations are weighted, and why the covariance is still right, stands in `coplanarity_normals`.
"""

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from posstats.arrays import Bools, Floats, Ints
from posstats.errors import ConvergenceError, GeometryError
from posstats.geometry.coplanarity.linearised import linearised
from posstats.geometry.coplanarity.normals import (
    Observed,
    PointRays,
    accumulate_normals,
    matrix_of_parts,
    precision,
)
from posstats.geometry.coplanarity.point_pairs import PointPairs
from posstats.numerics.kernels.coplanarity import base_frames
from posstats.numerics.kernels.rotation import AngleSystem
from posstats.numerics.solvers.dense import Propagation, mirrored, normals_factor, propagated
from posstats.numerics.solvers.robust import (
    SMALLEST_SCALE,
    huber_weights,
    kept_weights,
    median_scale,
)

MAX_IMAGES = 1500  # some five dense matrices of (6 n)^2 numbers at once: 3.2 GB
MAX_ITERATIONS = 60
_LARGEST_STEP_RAD = 0.2
_Phase = Literal["reweight", "plain", "fixed"]
_NEXT: dict[_Phase, _Phase] = {"reweight": "plain", "plain": "fixed", "fixed": "fixed"}
# A phase has settled when the mean square step, in standard errors, falls below:
_SETTLED: dict[_Phase, float] = {"reweight": 0.1, "plain": 1e-2, "fixed": 1e-9}


@dataclass(frozen=True, eq=False)
class Priors:
    """What is known beforehand of n images.

    Attributes
    ----------
    angles_rad, position_m
        (n, 3) POS angles and projection centres, ground frame.
    sigma_angles_rad, sigma_position_m
        (n, 3) standard deviations.
    system
        Of the angles.
    image_px
        Stated standard deviation of an image coordinate; sets the smallest noise believed.
    """

    angles_rad: Floats
    position_m: Floats
    sigma_angles_rad: Floats
    sigma_position_m: Floats
    system: AngleSystem
    image_px: float

    @property
    def values(self) -> Floats:
        """(6 n,) unknowns, per image three angles and three coordinates."""
        return np.concatenate([self.angles_rad, self.position_m], axis=1).ravel()

    @property
    def weights(self) -> Floats:
        """(6 n,)."""
        sigma = np.concatenate([self.sigma_angles_rad, self.sigma_position_m], axis=1)
        return (1.0 / sigma**2).ravel()


@dataclass(frozen=True, eq=False)
class CoplanarityAdjustment:
    """Result of the adjustment of n images.

    Attributes
    ----------
    angles_rad, position_m
        (n, 3) estimates.
    covariance_rad2
        (n, 3, n, 3) of the angles, marginal over the positions.
    sigma_px
        Standard deviation of an image coordinate, from the residuals; NaN without redundancy.
    rejected
        (N,) point pairs taken out as blunders.
    n_iterations
        Number of linearisations.
    """

    angles_rad: Floats
    position_m: Floats
    covariance_rad2: Floats
    sigma_px: float
    rejected: Bools
    n_iterations: int


def adjust_coplanarity(
    pairs: PointPairs,
    priors: Priors,
    *,
    robust: bool = True,
    progress: Callable[[int, int], object] | None = None,
) -> CoplanarityAdjustment:
    """Adjust the block: Gauss-Newton from the priors.

    The robust solution reweights after Huber until it settles, then takes out pairs beyond
    3.5 standard deviations (median absolute deviation), fixes that choice and converges as
    least squares, so that its covariance is that of least squares of the pairs kept.

    Raises
    ------
    ConvergenceError
        If it does not settle in `MAX_ITERATIONS` steps, or parallaxes become infinite.
    GeometryError
        If the block has more than `MAX_IMAGES` images.
    """
    n_images = len(priors.angles_rad)
    if n_images > MAX_IMAGES:
        raise GeometryError(
            f"the coplanarity adjustment takes at most {MAX_IMAGES} images at once, the block has"
            f" {n_images}: divide it, or take the errors from a bundle adjustment or an adjusted"
            " orientation"
        )
    frames = base_frames(priors.position_m[pairs.right] - priors.position_m[pairs.left])
    weighting = _Weighting("reweight" if robust else "plain", robust, np.ones(len(pairs.pair)))
    state = _State(priors.values, np.zeros((len(pairs.ray_image), 2)), weighting)
    for count in range(1, MAX_ITERATIONS + 1):
        state, decrement = _improved(pairs, priors, frames, state)
        if progress is not None:
            progress(count, MAX_ITERATIONS)
        if state.weighting.phase == "fixed" and decrement < _SETTLED["fixed"]:
            return _result(pairs, priors, frames, state, count)
        state = replace(state, weighting=state.weighting.advanced(decrement))
    raise ConvergenceError(
        f"the coplanarity adjustment did not settle in {MAX_ITERATIONS} steps (y-parallax still"
        f" {state.weighting.scale_px:.3g} px): check the angles, their system and the strips (a"
        " strip without a neighbour, flown with a coarse POS, leaves its roll open)"
    )


@dataclass(frozen=True, eq=False)
class _Weighting:
    """Robust weights (N,) and scale of the standardised parallaxes in a phase of the iteration."""

    phase: _Phase
    robust: bool
    robust_weight: Floats
    scale_px: float = float("nan")

    def updated(self, observed: Observed, smallest_px: float) -> "_Weighting":
        """Weights for the residuals at hand; unchanged in the phase ``fixed``."""
        if self.phase == "fixed":
            return self
        standardised = np.abs(observed.q) / np.sqrt(observed.variance)
        spread = median_scale(standardised, smallest_px)
        if self.phase == "reweight":
            weight = huber_weights(standardised, spread)
            return replace(self, robust_weight=weight, scale_px=spread)
        weight = np.ones_like(standardised)
        if self.robust:
            weight = kept_weights(standardised, spread)
        scale = float(np.sqrt(np.average(standardised**2, weights=weight)))
        return replace(self, robust_weight=weight, scale_px=max(scale, smallest_px))

    def advanced(self, decrement: float) -> "_Weighting":
        """The next phase, if this one has settled."""
        if decrement > _SETTLED[self.phase]:
            return self
        return replace(self, phase=_NEXT[self.phase])


@dataclass(frozen=True, eq=False)
class _State:
    """Where the iteration stands: unknowns (6 n,), noise of the image points (m, 2), weights."""

    unknowns: Floats
    image_noise: Floats
    weighting: _Weighting


@dataclass(frozen=True, eq=False)
class _Normals:
    """Parts of J'WJ, J'Wq, parts of M, D'Wq in px, v'Wv, tr(W D D')."""

    normals: Floats
    right_side: Floats
    noise_normals: Floats
    image_noise: Floats
    square_sum: float
    noise_trace: float

    def matrix(self, common: Ints, prior_weights: Floats) -> Floats:
        """N = J'WJ + P (6 n, 6 n), upper triangle."""
        matrix = matrix_of_parts(self.normals, common)
        matrix[np.diag_indices(len(matrix))] += prior_weights
        return matrix


def _improved(
    pairs: PointPairs, priors: Priors, frames: Floats, state: _State
) -> tuple[_State, float]:
    """The state after a Gauss-Newton step, and the step's mean square in standard errors."""
    weighting, equations = _equations(pairs, priors, frames, state)
    prior_side = priors.weights * (state.unknowns - priors.values)
    normals = equations.matrix(pairs.common, priors.weights)
    step, decrement = _step(normals, -(equations.right_side + prior_side))
    return _State(state.unknowns + step, equations.image_noise, weighting), decrement


def _equations(
    pairs: PointPairs,
    priors: Priors,
    frames: Floats,
    state: _State,
    *,
    with_noise: bool = False,
) -> tuple[_Weighting, _Normals]:
    """Weights and normal equations at a state; the derivatives, by far larger, end here."""
    observed = _linearised(pairs, priors, frames, state)
    weighting = state.weighting.updated(observed, SMALLEST_SCALE * priors.image_px)
    return weighting, _normal_equations(pairs, observed, weighting, with_noise=with_noise)


def _linearised(pairs: PointPairs, priors: Priors, frames: Floats, state: _State) -> Observed:
    unknowns = state.unknowns.reshape(-1, 6)
    observed = linearised(pairs, unknowns, state.image_noise, frames, priors.system)
    if not np.all(np.isfinite(observed.q)):
        raise ConvergenceError(
            "the coplanarity adjustment left the geometry of vertical photographs (infinite"
            " y-parallax): check the angles, their system and the positions"
        )
    return observed


def _normal_equations(
    pairs: PointPairs, observed: Observed, weighting: _Weighting, *, with_noise: bool
) -> _Normals:
    n_common = int(pairs.common.max()) + 1
    image_noise = np.zeros((len(pairs.ray_image), 2))
    pair_precision = precision(observed.variance, weighting.robust_weight)

    def accumulated(points: slice) -> tuple[Floats, Floats, Floats, float, float]:
        normals, right_side = np.zeros((n_common, 6, 6)), np.zeros(6 * len(pairs.common))
        noise_normals = np.zeros((n_common if with_noise else 0, 6, 6))
        square_sum, noise_trace = accumulate_normals(
            observed,
            pair_precision,
            PointRays(
                pairs.left_ray,
                pairs.right_ray,
                pairs.point_offsets[points.start : points.stop + 1],
                pairs.first_ray[points],
                pairs.n_rays[points],
                pairs.ray_image,
            ),
            pairs.common,
            normals,
            right_side,
            noise_normals,
            image_noise,
        )
        return normals, right_side, noise_normals, square_sum, noise_trace

    with ThreadPoolExecutor() as threads:
        first, *others = threads.map(accumulated, _parts(pairs))
    normals, right_side, noise_normals, square_sum, noise_trace = first
    for other in others:
        normals += other[0]
        right_side += other[1]
        noise_normals += other[2]
        square_sum += other[3]
        noise_trace += other[4]
    weight = 1.0 / weighting.scale_px**2
    return _Normals(
        normals=weight * normals,
        right_side=weight * right_side,
        noise_normals=weight**2 * noise_normals,
        image_noise=image_noise,
        square_sum=weight * square_sum,
        noise_trace=weight * noise_trace,
    )


def _parts(pairs: PointPairs) -> list[slice]:
    """Points in two parts of equal numbers of pairs: the same sums on every machine."""
    n_points = len(pairs.first_ray)
    middle = int(np.searchsorted(pairs.point_offsets, len(pairs.pair) // 2))
    return [part for part in (slice(0, middle), slice(middle, n_points)) if part.start < part.stop]


def _step(normals: Floats, right_side: Floats) -> tuple[Floats, float]:
    """Gauss-Newton step (6 n,), no angle turned too far, and its mean square in standard errors."""
    step = normals_factor(normals).solve(right_side)
    decrement = float(step @ right_side) / step.size
    largest = float(np.abs(step.reshape(-1, 6)[:, :3]).max())
    return step * min(1.0, _LARGEST_STEP_RAD / max(largest, 1e-300)), decrement


def _result(
    pairs: PointPairs, priors: Priors, frames: Floats, state: _State, count: int
) -> CoplanarityAdjustment:
    propagation, sigma2 = _propagated(pairs, priors, frames, state)
    n = len(priors.angles_rad)
    angles = (6 * np.arange(n)[:, None] + np.arange(3)).ravel()
    believed = priors.image_px**2 if np.isnan(sigma2) else sigma2
    estimate = state.unknowns.reshape(n, 6)
    return CoplanarityAdjustment(
        angles_rad=estimate[:, :3],
        position_m=estimate[:, 3:],
        covariance_rad2=propagation.covariance(believed, angles).reshape(n, 3, n, 3),
        sigma_px=float(np.sqrt(sigma2)),
        rejected=state.weighting.robust_weight == 0.0,
        n_iterations=count,
    )


def _propagated(
    pairs: PointPairs, priors: Priors, frames: Floats, state: _State
) -> tuple[Propagation, float]:
    """Error propagation at the solution, and sigma^2 of an image coordinate."""
    _, equations = _equations(pairs, priors, frames, state, with_noise=True)
    normals = equations.matrix(pairs.common, priors.weights)
    noise_normals = mirrored(matrix_of_parts(equations.noise_normals, pairs.common))
    propagation = propagated(normals, noise_normals, priors.weights)
    return propagation, propagation.variance_factor(equations.square_sum, equations.noise_trace)
