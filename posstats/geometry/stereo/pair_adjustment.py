"""Relative orientation of pairs of images by damped least squares on the y-parallax; compiled."""

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.geometry.stereo.pair_equations import (
    Pair,
    normal_equations,
    packed,
    residuals,
    take_weights,
)
from posstats.numerics.kernels.algebra import solve_normals, sum_of_products
from posstats.numerics.kernels.compiled import inner_kernel, kernel

CONVERGED, NOT_CONVERGED, RANK_DEFICIENT = 0, 1, 2

_MAX_ITERATIONS = 100
_LAST_STEP_PX = 1e-8  # RMS change of q; of the angles about 1e-12 rad
_LAST_DECREASE = 1e-12  # share of the sum of squares, for large residuals
_ROUNDING_PX = 1e-10  # of q, at most; a step need not lower the sum of squares by less
_FIRST_DAMPING, _LAST_DAMPING = 10.0, 1e-3  # of the smallest pivot
_LEAST_DAMPING, _MOST_DAMPING = 1e-9, 1e10
_POOR_GAIN = 0.25  # share of the expected decrease
# Smallest pivot of normals scaled to a unit diagonal that determines the elements (below it,
# 0.2 px of noise turn an image by ten degrees and more).
_RANK_PIVOT = 3e-7


@inner_kernel
def least_squares(pair: Pair, state: Floats, last_step_px: float) -> tuple[Floats, int, int]:
    """Minimise the weighted sum of q^2 over the free elements, from `state`.

    Gauss-Newton, damped as by Levenberg and Marquardt where a step does not lower the sum; the
    last step changes q by an RMS below `last_step_px`. Returns the state, CONVERGED,
    NOT_CONVERGED or RANK_DEFICIENT, and the number of iterations.
    """
    n_points, step = len(pair.weights), np.empty(len(pair.free))
    cost, normals, gradient = normal_equations(pair, state)
    damping, growth = 0.0, 2.0
    iteration, status, pivot = 0, NOT_CONVERGED, 0.0
    while iteration < _MAX_ITERATIONS and damping < _MOST_DAMPING:
        iteration += 1
        pivot = solve_normals(normals, gradient, 0.0, step)
        if pivot == 0.0:
            damping = max(damping, _LEAST_DAMPING)
            if solve_normals(normals, gradient, damping, step) == 0.0:
                break
        expected = -sum_of_products(gradient, step)
        if expected <= max(last_step_px * last_step_px * n_points, _LAST_DECREASE * cost):
            state, status = moved(state, pair.free, step), CONVERGED
            break
        if damping > 0.0:
            solve_normals(normals, gradient, damping, step)
            expected = -sum_of_products(gradient, step)
        trial = moved(state, pair.free, step)
        trial_cost, trial_normals, trial_gradient = normal_equations(pair, trial)
        rounding = _ROUNDING_PX * (2.0 * np.sqrt(cost * n_points) + _ROUNDING_PX * n_points)
        gain = (cost - trial_cost + rounding) / expected
        damping, growth = _next_damping(damping, growth, gain, pivot)
        if gain > 0.0:
            state, cost, normals, gradient = trial, trial_cost, trial_normals, trial_gradient
    return state, status if pivot > _RANK_PIVOT else RANK_DEFICIENT, iteration


@inner_kernel
def _next_damping(damping: float, growth: float, gain: float, pivot: float) -> tuple[float, float]:
    """Damping and its growth after a step with a share `gain` of the expected decrease.

    Nielsen (1999, IMM-REP-1999-05). Damping begins near the smallest pivot, where it shortens the
    step of the worst determined elements alone, and ends far below it.
    """
    if gain > 0.0:
        growth = 2.0
        damping *= max(1.0 / 3.0, 1.0 - (2.0 * gain - 1.0) ** 3)
        damping = damping if damping > _LAST_DAMPING * pivot else 0.0
    else:
        damping *= growth
        growth *= 2.0
    if not gain > _POOR_GAIN:
        damping = max(damping, _FIRST_DAMPING * pivot, _LEAST_DAMPING)
    return damping, growth


@inner_kernel
def moved(state: Floats, free: Ints, step: Floats) -> Floats:
    """The state with its free elements changed by the step."""
    moved = state.copy()
    for i in range(len(free)):
        moved[free[i]] += step[i]
    return moved


@inner_kernel
def _rms_of_kept(pair: Pair, state: Floats) -> float:
    q = residuals(pair, state)
    total, count = 0.0, 0
    for k in range(len(q)):
        if pair.weights[k] > 0.0:
            total += q[k] * q[k]
            count += 1
    return float(np.sqrt(total / count))


@kernel
def adjust_pairs(
    left_vectors: Floats,
    right_vectors: Floats,
    weights: Floats,
    offsets: Ints,
    frames: Floats,
    phi_first: bool,
    free: Ints,
    pairs: Ints,
    state: Floats,
    rms: Floats,
    status: Ints,
    iterations: Ints,
) -> None:
    """Relative orientation of some pairs of images by least squares on q.

    Parameters
    ----------
    left_vectors, right_vectors
        (N, 3) image vectors (x, y, -c) in px, pair after pair.
    weights
        (N,) weights of the points, 0: rejected.
    offsets
        (P + 1,) first point of each pair, and N.
    frames
        (P, 2, 3, 3) constant rotations from the frame of the angles to the base frame, of the
        left and of the right image.
    phi_first
        Angle system: true for ``phi-omega-kappa``, false for ``omega-phi-kappa``.
    free
        Numbers of the elements to solve for, in the order of `state`.
    pairs
        Numbers of the pairs to adjust (so that threads can share the work).
    state
        (P, 8) omega, phi, kappa of the left, then of the right image, radians, and BY / BX,
        BZ / BX: start values, overwritten by the solution.
    rms
        (P,) root mean square of q over the points of positive weight, px; written.
    status, iterations
        (P,) CONVERGED, NOT_CONVERGED or RANK_DEFICIENT, and the number of iterations; written.
    """
    for p in pairs:
        points = slice(offsets[p], offsets[p + 1])
        blocks = packed(left_vectors[points], right_vectors[points])
        pair = Pair(blocks, weights[points], frames[p], phi_first, free)
        take_weights(pair)
        solution, status[p], iterations[p] = least_squares(pair, state[p], _LAST_STEP_PX)
        rms[p] = _rms_of_kept(pair, solution)
        for k in range(len(solution)):
            state[p, k] = solution[k]
