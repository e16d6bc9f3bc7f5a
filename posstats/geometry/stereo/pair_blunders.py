"""Robust weights of the points of pairs of images, against blunders; compiled.

Huber's weights first, nearly of least absolute values, which come near the solution from any
start; then Tukey's, which reject. Where blunders may have bent Huber's solution, random samples
of points (Rousseeuw and Leroy 1987) give Tukey's weights their start.
"""

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.geometry.stereo.pair_adjustment import least_squares, moved
from posstats.geometry.stereo.pair_equations import (
    Pair,
    linearised,
    packed,
    residuals,
    take_weights,
)
from posstats.numerics.kernels.algebra import solve_normals, sum_of_products
from posstats.numerics.kernels.compiled import inner_kernel, kernel
from posstats.numerics.solvers.robust import TUKEY

_HUBER_ROUNDS, _MAX_ROUNDS, _ROUND_STEP_PX = 10, 40, 1e-1
_HUBER = 0.3  # of the scale: nearly least absolute values, which blunders bend little
# The scale is that of the smallest two fifths of the residuals, the elements' own left out:
# three fifths may be blunders.
_SCALE_SHARE, _NORMAL_FACTOR = 0.4, 1.9069
_SCALE_FLOOR_PX = 0.01  # no point is measured better: smaller residuals are no blunders
_WEIGHT_CHANGE = 1e-2
_FEW_POINTS, _MANY_FAR = 200, 0.1  # share of the points, beyond the limit of rejection
_N_SAMPLES = 200  # one of five points is free of blunders with 99.8 %, if half of them all are
_BETTER_SCALE = 0.7  # share of the scale at which a sample is believed


@kernel
def weigh_pairs(
    left_vectors: Floats,
    right_vectors: Floats,
    weights: Floats,
    offsets: Ints,
    frames: Floats,
    phi_first: bool,
    free: Ints,
    pairs: Ints,
    state: Floats,
) -> None:
    """Write robust weights (0: rejected), and the state that they belong to.

    The parameters are those of `posstats.geometry.stereo.pair_adjustment.adjust_pairs`.
    """
    for p in pairs:
        points = slice(offsets[p], offsets[p + 1])
        blocks = packed(left_vectors[points], right_vectors[points])
        pair = Pair(blocks, weights[points], frames[p], phi_first, free)
        solution = _find_blunders(pair, state[p])
        for k in range(len(solution)):
            state[p, k] = solution[k]


@inner_kernel
def _find_blunders(pair: Pair, start: Floats) -> Floats:
    """Write robust weights: Huber's from any start, then Tukey's, which reject; the new state.

    Few blunders of a small model, or many of a large one, bend Huber's solution. Then Tukey's
    weights begin at the best of random samples of points.
    """
    state = start
    for iteration in range(_MAX_ROUNDS):
        tukey = iteration >= _HUBER_ROUNDS
        if iteration == _HUBER_ROUNDS and _is_doubtful(pair):
            state = _closer(pair, _best_sample(pair, start), state)
        change = _reweighted(pair, state, tukey)
        if tukey and change < _WEIGHT_CHANGE:
            break
        state = least_squares(pair, state, _ROUND_STEP_PX)[0]
    return state


@inner_kernel
def _is_doubtful(pair: Pair) -> bool:
    """Whether Huber's weights may come from a solution that blunders have bent."""
    n_far = 0
    for weight in pair.weights:
        if weight < _HUBER / TUKEY:
            n_far += 1
    return len(pair.weights) < _FEW_POINTS or n_far > _MANY_FAR * len(pair.weights)


@inner_kernel
def _closer(pair: Pair, sampled: Floats, state: Floats) -> Floats:
    """The sampled state if the points lie much closer to it."""
    u = len(pair.free)
    scale, sampled_scale = (
        _scale_px(residuals(pair, state), u),
        _scale_px(residuals(pair, sampled), u),
    )
    return sampled if sampled_scale < _BETTER_SCALE * scale else state


@inner_kernel
def _best_sample(pair: Pair, state: Floats) -> Floats:
    """Of the states that fit as many random points as elements, that with the least scale of q.

    Rousseeuw and Leroy (1987), with q linearised at `state`, to which the POS is near enough.
    """
    for k in range(len(pair.weights)):
        pair.weights[k] = 1.0
    take_weights(pair)
    equations, u = linearised(pair, state), len(pair.free)
    q, step, best = np.empty(len(equations)), np.empty(u), np.zeros(u)
    order, random, least = np.arange(len(q)), 1, np.inf
    for _ in range(_N_SAMPLES):
        random = _shuffle(order, u, random)
        if _solve_sample(equations, order[:u], step) > 0.0:
            for k in range(len(q)):
                q[k] = equations[k, u] + sum_of_products(equations[k, :u], step)
            scale = _scale_px(q, u)
            if scale < least:
                least, step, best = scale, best, step
    return moved(state, pair.free, best)


@inner_kernel
def _shuffle(order: Ints, n: int, random: int) -> int:
    """Put random numbers first in the order, n of them; the state of the generator.

    The generator is that of Park and Miller (1988): results must not change from run to run.
    """
    for i in range(n):
        random = random * 48271 % 2147483647
        j = i + random % (len(order) - i)
        order[i], order[j] = order[j], order[i]
    return random


@inner_kernel
def _solve_sample(equations: Floats, sample: Ints, step: Floats) -> float:
    """Write the step that makes q of the sampled points zero; 0 where there is none."""
    u = len(step)
    normals, gradient = np.zeros((u, u)), np.zeros(u)
    for point in sample:
        row = equations[point]
        for i in range(u):
            gradient[i] += row[i] * row[u]
            for j in range(i + 1):
                normals[i, j] += row[i] * row[j]
    return solve_normals(normals, gradient, 0.0, step)


@inner_kernel
def _median_size(q: Floats, n_elements: int) -> float:
    """Median of |q|, the `n_elements` smallest left out: a robust fit makes as many zero.

    Hoare's selection, as `np.median` takes long to compile.
    """
    size = np.empty(len(q))
    for i in range(len(q)):
        size[i] = abs(q[i])
    first, last = 0, len(q) - 1
    middle = min(n_elements + int(_SCALE_SHARE * (len(q) - n_elements)), last)
    while first < last:
        pivot, i, j = size[middle], first, last
        while i <= j:
            while size[i] < pivot:
                i += 1
            while pivot < size[j]:
                j -= 1
            if i <= j:
                size[i], size[j] = size[j], size[i]
                i, j = i + 1, j - 1
        if j < middle:
            first = i
        if middle < i:
            last = j
    return float(size[middle])


@inner_kernel
def _scale_px(q: Floats, n_elements: int) -> float:
    """Robust standard deviation of q: the median size, corrected for few points.

    The factor 1 + 5 / (n - u) is that of Rousseeuw and Leroy (1987).
    """
    redundancy = max(len(q) - n_elements, 1)
    scale = _NORMAL_FACTOR * (1.0 + 5.0 / redundancy) * _median_size(q, n_elements)
    return max(scale, _SCALE_FLOOR_PX)


@inner_kernel
def _reweighted(pair: Pair, state: Floats, tukey: bool) -> float:
    """Write the weights of Huber or Tukey at `state`; their largest change."""
    q = residuals(pair, state)
    scale = _scale_px(q, len(pair.free))
    change = 0.0
    for k in range(len(q)):
        size = abs(q[k]) / scale
        if tukey:
            ratio = min(size / TUKEY, 1.0)
            weight = (1.0 - ratio * ratio) * (1.0 - ratio * ratio)
        else:
            weight = min(1.0, _HUBER / size)
        change = max(change, abs(weight - pair.weights[k]))
        pair.weights[k] = weight
    take_weights(pair)
    return change
