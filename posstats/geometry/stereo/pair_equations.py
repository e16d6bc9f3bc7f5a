"""The y-parallaxes of one pair of images and their normal equations; for use inside kernels.

The rotation of an image is base_from_image = frame R(omega, phi, kappa), with a frame that
stays: the identity for elements of the base frame, base_from_ground for angles of the ground
frame. The state of a pair is omega, phi, kappa left, omega, phi, kappa right, radians, and the
ratios BY / BX and BZ / BX of the base.
"""

from typing import NamedTuple

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.numerics.kernels.algebra import Matrix, Vector, cross, dot, rotated, sum_of_products
from posstats.numerics.kernels.compiled import inner_kernel
from posstats.numerics.kernels.coplanarity import parallax, parallax_gradients

_N_STATE = 8
_LANES = 64  # points worked on at once


class Pair(NamedTuple):
    """The point pairs of two images and what stays constant in their orientation.

    `blocks` holds the points, _LANES at a time, in the order that vector instructions want: x, y,
    z left, x, y, z right and the roots of the weights, _LANES numbers each; the last block is
    filled up with points of weight 0.
    """

    blocks: Floats
    weights: Floats
    frames: Floats
    phi_first: bool
    free: Ints


@inner_kernel
def packed(left_vectors: Floats, right_vectors: Floats) -> Floats:
    """The `blocks` of a `Pair`, without weights, of image vectors (n, 3)."""
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
def take_weights(pair: Pair) -> None:
    """Bring the weights of the pair into its blocks."""
    for k in range(len(pair.weights)):
        pair.blocks[k // _LANES, 6 * _LANES + k % _LANES] = np.sqrt(pair.weights[k])


@inner_kernel
def residuals(pair: Pair, state: Floats) -> Floats:
    """The y-parallaxes q (n,) of the points, px."""
    rotation = _turns(pair, state, np.empty((_N_STATE, _N_STATE)))
    left, right, base = _in_registers(rotation[0]), _in_registers(rotation[1]), _base(state)
    q = np.empty((len(pair.blocks), _LANES))
    for i in range(len(q)):
        block, row = pair.blocks[i], q[i]
        for k in range(_LANES):
            a, b = rotated(left, _ray(block, 0, k)), rotated(right, _ray(block, 1, k))
            row[k] = parallax(a, b, base)
    return q.reshape(-1)[: len(pair.weights)]


@inner_kernel
def normal_equations(pair: Pair, state: Floats) -> tuple[float, Floats, Floats]:
    """Sum of weighted q^2, and the normals (u, u) and gradient (u,) of the u free elements."""
    elements = np.zeros((_N_STATE, _N_STATE))
    products = _products(pair, state, elements)
    u = len(pair.free)
    normals, gradient = np.empty((u, u)), np.empty(u)
    for i in range(u):
        first = elements[pair.free[i]]
        gradient[i] = sum_of_products(first, products[_N_STATE, :_N_STATE])
        for j in range(u):
            second = elements[pair.free[j]]
            normals[i, j] = 0.0
            for k in range(_N_STATE):
                normals[i, j] += first[k] * sum_of_products(second, products[k, :_N_STATE])
    return float(products[_N_STATE, _N_STATE]), normals, gradient


@inner_kernel
def linearised(pair: Pair, state: Floats) -> Floats:
    """Derivatives of q by the u free elements and, last, q: (n, u + 1), without weights."""
    elements = np.zeros((_N_STATE, _N_STATE))
    rotation = _turns(pair, state, elements)
    design, u = np.empty((_N_STATE + 1) * _LANES), len(pair.free)
    equations = np.zeros((len(pair.weights), u + 1))
    for point in range(len(equations)):
        k = point % _LANES
        if k == 0:
            _write_design(pair.blocks[point // _LANES], rotation, _base(state), design)
        equations[point, u] = design[_N_STATE * _LANES + k]
        for i in range(u):
            for turn in range(_N_STATE):
                equations[point, i] += elements[pair.free[i], turn] * design[turn * _LANES + k]
    return equations


@inner_kernel
def _products(pair: Pair, state: Floats, elements: Floats) -> Floats:
    """Products (9, 9) of the columns of `_write_design`, and the `elements` of `_turns`."""
    rotation = _turns(pair, state, elements)
    products = np.zeros((_N_STATE + 1, _N_STATE + 1))
    design = np.empty((_N_STATE + 1) * _LANES)
    for block in range(len(pair.blocks)):
        _write_design(pair.blocks[block], rotation, _base(state), design)
        for i in range(_N_STATE + 1):
            row = design[i * _LANES : (i + 1) * _LANES]
            for j in range(i + 1):
                other = design[j * _LANES : (j + 1) * _LANES]
                products[i, j] += sum_of_products(row, other)
    for i in range(_N_STATE):
        for j in range(i):
            products[j, i] = products[i, j]
    return products


@inner_kernel
def _write_design(block: Floats, rotation: Floats, base: Vector, design: Floats) -> None:
    """Write the weighted derivatives and, last, the weighted q of the points of a block.

    The derivatives are by small turns of either image about the axes of the base frame, by BY
    and by BZ. `design` is (9 * _LANES,).
    """
    left, right = _in_registers(rotation[0]), _in_registers(rotation[1])
    for k in range(_LANES):
        a, b = rotated(left, _ray(block, 0, k)), rotated(right, _ray(block, 1, k))
        q, da, db, dbase = parallax_gradients(a, b, base)
        by_left, by_right = cross(a, da), cross(b, db)
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


@inner_kernel
def _turns(pair: Pair, state: Floats, elements: Floats) -> Floats:
    """Rotations base_from_image (2, 3, 3) of the left and the right image.

    The rows of `elements` (8, 8), all zero before, become the effects of the elements of the
    state on the turns of `_write_design`: an angle turns its image about its axis.
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
            rotation[image, i, 0] = dot(row, first)
            rotation[image, i, 1] = dot(row, second)
            rotation[image, i, 2] = elements[k + 2, k + i] = dot(row, third)
            elements[k, k + i] = dot(row, omega_axis)
            elements[k + 1, k + i] = dot(row, phi_axis)
    elements[6, 6] = elements[7, 7] = 1.0
    return rotation


@inner_kernel
def _ray(block: Floats, image: int, k: int) -> Vector:
    first = 3 * _LANES * image + k
    return block[first], block[first + _LANES], block[first + 2 * _LANES]


@inner_kernel
def _base(state: Floats) -> Vector:
    return (1.0, state[6], state[7])


@inner_kernel
def _in_registers(matrix: Floats) -> Matrix:
    return (
        (matrix[0, 0], matrix[0, 1], matrix[0, 2]),
        (matrix[1, 0], matrix[1, 1], matrix[1, 2]),
        (matrix[2, 0], matrix[2, 1], matrix[2, 2]),
    )
