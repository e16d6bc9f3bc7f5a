"""The y-parallax of a pair of image rays, and its exact derivatives; arrays only, compiled.

With a = R1 x1, b = R2 x2 in a frame whose X axis lies along the horizontal projection of the
base (BX, BY, BZ), and image vectors x = (x, y, -c) in px,

    N1 = (BX bz - BZ bx) / (ax bz - bx az),   N2 = (BX az - BZ ax) / (ax bz - bx az),
    q  = (N1 ay - N2 by - BY) / N2                                         [px at image scale],

which, with u = BX bz - BZ bx, v = BX az - BZ ax, w = ax bz - bx az, is

    q = (u ay - w BY) / v - by.

q is zero when the two rays and the base are coplanar. The derivatives are those of this form,
term by term; the linearised equation (1) of the first source paper holds to a few per cent only.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from posstats.compiled import inner_kernel, kernel, summing_kernel

_Floats = NDArray[np.float64]
_Ints = NDArray[np.intp]
_Vector = Any  # three numbers: a row of an array, or a tuple, which stays in registers
_Matrix = Any  # three such rows


@inner_kernel
def _dot(a: _Vector, b: _Vector) -> float:
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@inner_kernel
def _rotated(matrix: _Matrix, vector: _Vector) -> _Vector:
    return _dot(matrix[0], vector), _dot(matrix[1], vector), _dot(matrix[2], vector)


@inner_kernel
def _cross(a: _Vector, b: _Vector) -> _Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@inner_kernel
def _parallax(a: _Vector, b: _Vector, base: _Vector) -> float:
    u = base[0] * b[2] - base[2] * b[0]
    v = base[0] * a[2] - base[2] * a[0]
    w = a[0] * b[2] - b[0] * a[2]
    return float((u * a[1] - w * base[1]) / v - b[1])


@inner_kernel
def _parallax_gradients(
    a: _Vector, b: _Vector, base: _Vector
) -> tuple[float, _Vector, _Vector, _Vector]:
    """q, and its gradients with respect to a, b and the base."""
    u = base[0] * b[2] - base[2] * b[0]
    v = base[0] * a[2] - base[2] * a[0]
    w = a[0] * b[2] - b[0] * a[2]
    by_v = 1.0 / v
    ratio = (u * a[1] - w * base[1]) * by_v
    dq_du, dq_dv, dq_dw = a[1] * by_v, -ratio * by_v, -base[1] * by_v
    da = (-dq_dv * base[2] + dq_dw * b[2], u * by_v, dq_dv * base[0] - dq_dw * b[0])
    db = (-dq_du * base[2] - dq_dw * a[2], -1.0, dq_du * base[0] + dq_dw * a[0])
    dbase = (dq_du * b[2] + dq_dv * a[2], -w * by_v, -dq_du * b[0] - dq_dv * a[0])
    return ratio - b[1], da, db, dbase


def base_frames(base_m: _Floats) -> _Floats:
    """Rotations (..., 3, 3) base_from_ground about Z that turn the base's X-Y direction onto +X.

    Parameters
    ----------
    base_m
        (..., 3) base vectors, right minus left projection centre, ground frame, metres.
    """
    horizontal = np.hypot(base_m[..., 0], base_m[..., 1])
    safe = np.where(horizontal > 0.0, horizontal, 1.0)
    cosine = np.where(horizontal > 0.0, base_m[..., 0] / safe, 1.0)
    sine = np.where(horizontal > 0.0, base_m[..., 1] / safe, 0.0)
    frames = np.zeros((*base_m.shape[:-1], 3, 3))
    frames[..., 0, 0] = frames[..., 1, 1] = cosine
    frames[..., 0, 1], frames[..., 1, 0] = sine, -sine
    frames[..., 2, 2] = 1.0
    return frames


@kernel
def y_parallax(
    left_vectors: _Floats,
    right_vectors: _Floats,
    offsets: _Ints,
    base_from_left: _Floats,
    base_from_right: _Floats,
    base: _Floats,
) -> _Floats:
    """y-parallax of every point pair, px at image scale.

    Parameters
    ----------
    left_vectors, right_vectors
        (N, 3) image vectors (x, y, -c) in px, pair after pair.
    offsets
        (P + 1,) first point of each pair, and N.
    base_from_left, base_from_right
        (P, 3, 3) rotations from the image frames into the pair's base frame.
    base
        (P, 3) base in that frame (any unit of length).
    """
    q = np.empty(left_vectors.shape[0])
    for pair in range(offsets.shape[0] - 1):
        for k in range(offsets[pair], offsets[pair + 1]):
            a = _rotated(base_from_left[pair], left_vectors[k])
            b = _rotated(base_from_right[pair], right_vectors[k])
            q[k] = _parallax(a, b, base[pair])
    return q


@kernel
def y_parallax_derivatives(
    left_vectors: _Floats,
    right_vectors: _Floats,
    offsets: _Ints,
    base_from_left: _Floats,
    base_from_right: _Floats,
    left_derivatives: _Floats,
    right_derivatives: _Floats,
    base: _Floats,
) -> tuple[_Floats, _Floats, _Floats, _Floats, _Floats]:
    """y-parallax and its derivatives for every point pair.

    Parameters are those of `y_parallax`, with

    left_derivatives, right_derivatives
        (P, 3, 3, 3) derivatives of base_from_left and base_from_right with respect to the
        three angles of the image.

    Returns
    -------
    q
        (N,) px.
    by_left_angles, by_right_angles
        (N, 3) px/rad.
    by_base
        (N, 3) px per unit of the base, in the base frame held fixed.
    by_image
        (N, 4) with respect to x, y of the left and x, y of the right image point.
    """
    n = left_vectors.shape[0]
    q = np.empty(n)
    by_left, by_right, by_base = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3))
    by_image = np.empty((n, 4))
    for pair in range(offsets.shape[0] - 1):
        left, right = base_from_left[pair], base_from_right[pair]
        for k in range(offsets[pair], offsets[pair + 1]):
            a, b = _rotated(left, left_vectors[k]), _rotated(right, right_vectors[k])
            q[k], da, db, dbase = _parallax_gradients(a, b, base[pair])
            for angle in range(3):
                by_base[k, angle] = dbase[angle]
                turned_left = _rotated(left_derivatives[pair, angle], left_vectors[k])
                turned_right = _rotated(right_derivatives[pair, angle], right_vectors[k])
                by_left[k, angle] = _dot(da, turned_left)
                by_right[k, angle] = _dot(db, turned_right)
            for axis in range(2):
                by_image[k, axis] = _dot(da, left[:, axis])
                by_image[k, axis + 2] = _dot(db, right[:, axis])
    return q, by_left, by_right, by_base, by_image


# --- Least squares on q, one pair of images at a time ---------------------------------------
#
# The rotation of an image is base_from_image = frame R(omega, phi, kappa), with a frame that
# stays: the identity for elements of the base frame, base_from_ground for angles of the ground
# frame. The state of a pair is omega, phi, kappa left, omega, phi, kappa right, BY / BX, BZ / BX.

CONVERGED, NOT_CONVERGED, RANK_DEFICIENT = 0, 1, 2

_N_STATE = 8
_LANES = 64  # points worked on at once
_MAX_ITERATIONS = 100
_LAST_STEP_PX = 1e-8  # RMS change of q; of the angles about 1e-12 rad
_LAST_DECREASE = 1e-14  # share of the sum of squares, for large residuals
_ROUNDING_PX = 3e-12  # of q, and so of the sum of squares
_FIRST_DAMPING, _LEAST_DAMPING, _MOST_DAMPING = 1e-3, 1e-4, 1e10
_POOR_GAIN = 0.25  # share of the expected decrease
# Smallest pivots of normals scaled to a unit diagonal that can be solved, and that determine
# the elements (below the second, 0.2 px of noise turn an image by ten degrees and more).
_SINGULAR_PIVOT, _RANK_PIVOT = 1e-14, 3e-7

_HUBER_ROUNDS, _MAX_ROUNDS, _ROUND_STEP_PX = 10, 40, 1e-1
_HUBER = 0.3  # of the scale: nearly least absolute values, which blunders bend little
_TUKEY = 4.685  # 95 % efficiency on normal errors
_SCALE_FLOOR_PX = 0.01  # no point is measured better: smaller residuals are no blunders
_WEIGHT_CHANGE = 1e-2


class _Pair(NamedTuple):
    """The point pairs of two images and what stays constant in their orientation.

    `blocks` holds the points, _LANES at a time, in the order that vector instructions want: x, y,
    z left, x, y, z right and the roots of the weights, _LANES numbers each; the last block is
    filled up with points of weight 0.
    """

    blocks: _Floats
    weights: _Floats
    frames: _Floats
    phi_first: bool
    free: _Ints


@inner_kernel
def _packed(left_vectors: _Floats, right_vectors: _Floats) -> _Floats:
    n = len(left_vectors)
    blocks = np.empty(((n + _LANES - 1) // _LANES, 7 * _LANES))
    for first in range(len(blocks)):
        block = blocks[first]
        for k in range(_LANES):
            point = min(first * _LANES + k, n - 1)
            for axis in range(3):
                block[axis * _LANES + k] = left_vectors[point, axis]
                block[(axis + 3) * _LANES + k] = right_vectors[point, axis]
            block[6 * _LANES + k] = 0.0
    return blocks


@inner_kernel
def _weigh(pair: _Pair) -> None:
    for k in range(len(pair.weights)):
        pair.blocks[k // _LANES, 6 * _LANES + k % _LANES] = np.sqrt(pair.weights[k])


@inner_kernel
def _ray(block: _Floats, image: int, k: int) -> _Vector:
    first = 3 * _LANES * image + k
    return block[first], block[first + _LANES], block[first + 2 * _LANES]


@inner_kernel
def _turns(pair: _Pair, state: _Floats, elements: _Floats) -> _Floats:
    """Rotations base_from_image (2, 3, 3) of the left and the right image.

    The axes of the turns by omega, phi and kappa go to the columns of the image's 3 x 3 block
    on the diagonal of `elements` (8, 8).
    """
    rotation = np.empty((2, 3, 3))
    for image in range(2):
        k = 3 * image
        so, sp, sk = np.sin(state[k]), np.sin(state[k + 1]), np.sin(state[k + 2])
        co, cp, ck = np.cos(state[k]), np.cos(state[k + 1]), np.cos(state[k + 2])
        if pair.phi_first:
            first = (cp * ck - sp * so * sk, co * sk, sp * ck + cp * so * sk)
            second = (-cp * sk - sp * so * ck, co * ck, cp * so * ck - sp * sk)
            third = (-sp * co, -so, cp * co)
            omega_axis, phi_axis = (cp, 0.0, sp), (0.0, -1.0, 0.0)
        else:
            first = (cp * ck, co * sk + so * sp * ck, so * sk - co * sp * ck)
            second = (-cp * sk, co * ck - so * sp * sk, so * ck + co * sp * sk)
            third = (sp, -so * cp, co * cp)
            omega_axis, phi_axis = (1.0, 0.0, 0.0), (0.0, co, so)
        for i in range(3):
            row = pair.frames[image, i]
            rotation[image, i, 0] = _dot(row, first)
            rotation[image, i, 1] = _dot(row, second)
            rotation[image, i, 2] = elements[k + i, k + 2] = _dot(row, third)
            elements[k + i, k] = _dot(row, omega_axis)
            elements[k + i, k + 1] = _dot(row, phi_axis)
    return rotation


@inner_kernel
def _base(state: _Floats) -> _Vector:
    return (1.0, state[6], state[7])


@inner_kernel
def _in_registers(matrix: _Floats) -> _Matrix:
    return (
        (matrix[0, 0], matrix[0, 1], matrix[0, 2]),
        (matrix[1, 0], matrix[1, 1], matrix[1, 2]),
        (matrix[2, 0], matrix[2, 1], matrix[2, 2]),
    )


@inner_kernel
def _design(block: _Floats, rotation: _Floats, base: _Vector, design: _Floats) -> None:
    """Write the weighted derivatives and, last, the weighted q of the points of a block.

    The derivatives are by small turns of either image about the axes of the base frame, by BY
    and by BZ. `design` is (9 * _LANES,).
    """
    left, right = _in_registers(rotation[0]), _in_registers(rotation[1])
    for k in range(_LANES):
        a, b = _rotated(left, _ray(block, 0, k)), _rotated(right, _ray(block, 1, k))
        q, da, db, dbase = _parallax_gradients(a, b, base)
        by_left, by_right = _cross(a, da), _cross(b, db)
        root = block[6 * _LANES + k]
        design[k] = root * by_left[0]
        design[1 * _LANES + k] = root * by_left[1]
        design[2 * _LANES + k] = root * by_left[2]
        design[3 * _LANES + k] = root * by_right[0]
        design[4 * _LANES + k] = root * by_right[1]
        design[5 * _LANES + k] = root * by_right[2]
        design[6 * _LANES + k] = root * dbase[1]
        design[7 * _LANES + k] = root * dbase[2]
        design[8 * _LANES + k] = root * q


@summing_kernel
def _sum_of_products(a: _Floats, b: _Floats) -> float:
    total = 0.0
    for i in range(len(a)):
        total += a[i] * b[i]
    return total


@inner_kernel
def _normals(pair: _Pair, state: _Floats, normals: _Floats, gradient: _Floats) -> float:
    """Sum of weighted q^2, with the normals and the gradient of the free elements."""
    elements = np.zeros((_N_STATE, _N_STATE))  # columns: elements; rows: turns, BY, BZ
    elements[6, 6] = elements[7, 7] = 1.0
    rotation = _turns(pair, state, elements)
    products = np.zeros((_N_STATE + 1, _N_STATE + 1))
    design = np.empty((_N_STATE + 1) * _LANES)
    for block in range(len(pair.blocks)):
        _design(pair.blocks[block], rotation, _base(state), design)
        for i in range(_N_STATE + 1):
            row = design[i * _LANES : (i + 1) * _LANES]
            for j in range(i + 1):
                other = design[j * _LANES : (j + 1) * _LANES]
                products[i, j] += _sum_of_products(row, other)
    for i in range(_N_STATE):
        for j in range(i):
            products[j, i] = products[i, j]
    for i in range(len(pair.free)):
        column = elements[:, pair.free[i]]
        gradient[i] = _sum_of_products(column, products[_N_STATE])
        for j in range(len(pair.free)):
            other = elements[:, pair.free[j]]
            normals[i, j] = 0.0
            for k in range(_N_STATE):
                normals[i, j] += column[k] * _sum_of_products(other, products[k])
    return float(products[_N_STATE, _N_STATE])


@inner_kernel
def _solved(normals: _Floats, gradient: _Floats, damping: float, step: _Floats) -> float:
    """Write the step -(N + damping diag N)^-1 g; the smallest pivot of the scaled normals."""
    n = len(gradient)
    factor = np.empty((n, n))
    scale = np.empty(n)
    smallest = 1.0
    for i in range(n):
        scale[i] = np.sqrt(normals[i, i])
        for j in range(i + 1):
            value = normals[i, j] / (scale[i] * scale[j])
            value += damping if i == j else 0.0
            value -= _sum_of_products(factor[i, :j], factor[j, :j])
            if i == j:
                if not value > _SINGULAR_PIVOT:
                    return 0.0
                smallest = min(smallest, value)
                factor[i, i] = np.sqrt(value)
            else:
                factor[i, j] = value / factor[j, j]
    for i in range(n):
        step[i] = -gradient[i] / scale[i] - _sum_of_products(factor[i, :i], step[:i])
        step[i] /= factor[i, i]
    for i in range(n - 1, -1, -1):
        step[i] -= _sum_of_products(factor[i + 1 :, i], step[i + 1 :])
        step[i] /= factor[i, i]
    for i in range(n):
        step[i] /= scale[i]
    return smallest


@inner_kernel
def _moved(state: _Floats, free: _Ints, step: _Floats) -> _Floats:
    moved = state.copy()
    for i in range(len(free)):
        moved[free[i]] += step[i]
    return moved


@inner_kernel
def _copy(source: _Floats, target: _Floats) -> None:
    for i in range(len(source)):
        target[i] = source[i]


@inner_kernel
def _least_squares(pair: _Pair, state: _Floats, last_step_px: float) -> tuple[int, int]:
    """Minimise the weighted sum of q^2 over the free elements of `state` (in place).

    Gauss-Newton, damped as by Levenberg and Marquardt where a step does not lower the sum; the
    last step changes q by an RMS below `last_step_px`. Returns CONVERGED, NOT_CONVERGED or
    RANK_DEFICIENT and the number of iterations.
    """
    n = len(pair.free)
    normals, gradient, step = np.empty((n, n)), np.empty(n), np.empty(n)
    trial_normals, trial_gradient = np.empty((n, n)), np.empty(n)
    cost = _normals(pair, state, normals, gradient)
    n_points = len(pair.weights)
    damping, growth = 0.0, 2.0  # as Nielsen (1999) proposes
    iteration, status = 0, NOT_CONVERGED
    while iteration < _MAX_ITERATIONS and damping < _MOST_DAMPING:
        iteration += 1
        if _solved(normals, gradient, 0.0, step) == 0.0:
            _solved(normals, gradient, _FIRST_DAMPING, step)
            damping = max(damping, _FIRST_DAMPING)
        trial = _moved(state, pair.free, step)
        last_decrease = max(last_step_px * last_step_px * n_points, _LAST_DECREASE * cost)
        if -_sum_of_products(gradient, step) <= last_decrease:
            _copy(trial, state)
            status = CONVERGED
            break
        if damping > 0.0:
            _solved(normals, gradient, damping, step)
            trial = _moved(state, pair.free, step)
        expected = -_sum_of_products(gradient, step)
        trial_cost = _normals(pair, trial, trial_normals, trial_gradient)
        rounding = _ROUNDING_PX * (np.sqrt(cost) + _ROUNDING_PX * n_points)
        gain = (cost - trial_cost + rounding) / expected
        if gain > 0.0:
            damping *= max(1.0 / 3.0, 1.0 - (2.0 * gain - 1.0) ** 3)
            damping = damping if damping > _LEAST_DAMPING else 0.0
            growth = 2.0
        else:
            damping *= growth
            growth *= 2.0
        if not gain > _POOR_GAIN:
            damping = max(damping, _FIRST_DAMPING)
        if gain > 0.0:
            _copy(trial, state)
            cost = trial_cost
            normals, trial_normals = trial_normals, normals
            gradient, trial_gradient = trial_gradient, gradient
    if not _solved(normals, gradient, 0.0, step) > _RANK_PIVOT:
        status = RANK_DEFICIENT
    return status, iteration


@inner_kernel
def _residuals(pair: _Pair, state: _Floats) -> _Floats:
    rotation = _turns(pair, state, np.empty((_N_STATE, _N_STATE)))
    left, right = _in_registers(rotation[0]), _in_registers(rotation[1])
    base = _base(state)
    q = np.empty((len(pair.blocks), _LANES))
    for i in range(len(q)):
        block, row = pair.blocks[i], q[i]
        for k in range(_LANES):
            a, b = _rotated(left, _ray(block, 0, k)), _rotated(right, _ray(block, 1, k))
            row[k] = _parallax(a, b, base)
    return q.reshape(-1)[: len(pair.weights)]


@inner_kernel
def _median_size(q: _Floats, n_elements: int) -> float:
    """Median of |q|, the `n_elements` smallest left out: a robust fit makes as many zero.

    Hoare's selection, as `np.median` takes long to compile.
    """
    size = np.empty(len(q))
    for i in range(len(q)):
        size[i] = abs(q[i])
    first, last, middle = 0, len(q) - 1, min((len(q) + n_elements) // 2, len(q) - 1)
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
def _reweighted(pair: _Pair, state: _Floats, tukey: bool) -> float:
    """Write the weights of Huber or Tukey at `state`; their largest change.

    The scale is the median absolute residual, corrected for the few points of small models
    (Rousseeuw and Leroy 1987: 1 + 5 / (n - u)).
    """
    q = _residuals(pair, state)
    redundancy = max(len(q) - len(pair.free), 1)
    scale = 1.4826 * (1.0 + 5.0 / redundancy) * _median_size(q, len(pair.free))
    scale = max(scale, _SCALE_FLOOR_PX)
    change = 0.0
    for k in range(len(q)):
        size = abs(q[k]) / scale
        if tukey:
            ratio = min(size / _TUKEY, 1.0)
            weight = (1.0 - ratio * ratio) * (1.0 - ratio * ratio)
        else:
            weight = min(1.0, _HUBER / size)
        change = max(change, abs(weight - pair.weights[k]))
        pair.weights[k] = weight
    _weigh(pair)
    return change


@inner_kernel
def _rms_of_kept(pair: _Pair, state: _Floats) -> float:
    q = _residuals(pair, state)
    total, count = 0.0, 0
    for k in range(len(q)):
        if pair.weights[k] > 0.0:
            total += q[k] * q[k]
            count += 1
    return float(np.sqrt(total / count))


@inner_kernel
def _find_blunders(pair: _Pair, state: _Floats) -> None:
    """Write robust weights: Huber's from any start, then Tukey's, which reject."""
    for iteration in range(_MAX_ROUNDS):
        tukey = iteration >= _HUBER_ROUNDS
        change = _reweighted(pair, state, tukey)
        _least_squares(pair, state, _ROUND_STEP_PX)
        if tukey and change < _WEIGHT_CHANGE:
            break


@kernel
def adjust_pairs(
    left_vectors: _Floats,
    right_vectors: _Floats,
    weights: _Floats,
    offsets: _Ints,
    frames: _Floats,
    phi_first: bool,
    free: _Ints,
    robust: bool,
    pairs: _Ints,
    state: _Floats,
    rms: _Floats,
    status: _Ints,
    iterations: _Ints,
) -> None:
    """Relative orientation of some pairs of images by least squares on q.

    Parameters
    ----------
    left_vectors, right_vectors
        (N, 3) image vectors (x, y, -c) in px, pair after pair.
    weights
        (N,) weights of the points; overwritten if `robust` (0: rejected).
    offsets
        (P + 1,) first point of each pair, and N.
    frames
        (P, 2, 3, 3) constant rotations from the frame of the angles to the base frame, of the
        left and of the right image.
    phi_first
        Angle system: true for ``phi-omega-kappa``, false for ``omega-phi-kappa``.
    free
        Numbers of the elements to solve for, in the order of `state`.
    robust
        Find blunders and set their weights.
    pairs
        Numbers of the pairs to adjust (so that threads can share the work).
    state
        (P, 8) omega, phi, kappa of the left, then of the right image, radians, and BY / BX,
        BZ / BX: start values, overwritten by the solution.
    rms
        (P,) root mean square of q over the points of positive weight, px; written.
    status, iterations
        (P,) CONVERGED, NOT_CONVERGED or RANK_DEFICIENT; iterations of the last adjustment.
    """
    for p in pairs:
        points = slice(offsets[p], offsets[p + 1])
        pair = _Pair(
            _packed(left_vectors[points], right_vectors[points]),
            weights[points],
            frames[p],
            phi_first,
            free,
        )
        _weigh(pair)
        if robust:
            _find_blunders(pair, state[p])
        status[p], iterations[p] = _least_squares(pair, state[p], _LAST_STEP_PX)
        rms[p] = _rms_of_kept(pair, state[p])
