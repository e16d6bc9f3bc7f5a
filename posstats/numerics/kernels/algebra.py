"""Linear algebra of a few numbers, for use inside kernels.

Vectors of three are tuples or rows of arrays: tuples stay in registers, and calls of BLAS on so
few numbers cost more than the work.
"""

from typing import Any

import numpy as np

from posstats.arrays import Floats
from posstats.numerics.kernels.compiled import inner_kernel, summing_kernel

Vector = Any  # three numbers: a row of an array, or a tuple
Matrix = Any  # three such rows
Six = Any  # a tuple of six numbers, which stays in registers

# Smallest pivot of a matrix scaled to a unit diagonal that can be solved.
_SINGULAR_PIVOT = 1e-14


@inner_kernel
def dot(a: Vector, b: Vector) -> float:
    """Scalar product of two vectors of three."""
    return float(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])


@inner_kernel
def rotated(matrix: Matrix, vector: Vector) -> Vector:
    """Matrix (3, 3) times vector (3,)."""
    return dot(matrix[0], vector), dot(matrix[1], vector), dot(matrix[2], vector)


@inner_kernel
def cross(a: Vector, b: Vector) -> Vector:
    """Vector product of two vectors of three."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@summing_kernel
def sum_of_products(a: Floats, b: Floats) -> float:
    """Scalar product of two arrays, added up in any order."""
    total = 0.0
    for i in range(len(a)):
        total += a[i] * b[i]
    return total


@inner_kernel
def solve_normals(normals: Floats, gradient: Floats, damping: float, step: Floats) -> float:
    """Write the step -(N + damping diag N)^-1 g; the smallest pivot of the scaled matrix.

    Cholesky's method on the lower triangle of N (n, n), scaled to a unit diagonal. Returns 0
    and writes nothing if a pivot is too small to divide by.
    """
    n = len(gradient)
    factor, scale = np.empty((n, n)), np.empty(n)
    smallest = 1.0 + damping
    for i in range(n):
        scale[i] = np.sqrt(normals[i, i])
        for j in range(i + 1):
            value = normals[i, j] / (scale[i] * scale[j])
            value += damping if i == j else 0.0
            value -= sum_of_products(factor[i, :j], factor[j, :j])
            if i == j:
                if not value > _SINGULAR_PIVOT:
                    return 0.0
                smallest = min(smallest, value)
                factor[i, i] = np.sqrt(value)
            else:
                factor[i, j] = value / factor[j, j]
    _substitute(factor, scale, gradient, step)
    return smallest


@inner_kernel
def _substitute(factor: Floats, scale: Floats, gradient: Floats, step: Floats) -> None:
    """Write -S^-1 (L L')^-1 S^-1 g, with L the lower triangle `factor` and S the scale."""
    n = len(gradient)
    for i in range(n):
        step[i] = -gradient[i] / scale[i] - sum_of_products(factor[i, :i], step[:i])
        step[i] /= factor[i, i]
    for i in range(n - 1, -1, -1):
        for j in range(i + 1, n):
            step[i] -= factor[j, i] * step[j]
        step[i] /= factor[i, i]
    for i in range(n):
        step[i] /= scale[i]


@inner_kernel
def six(row: Floats, first: int) -> Six:
    """Six numbers of a row, from `first` on."""
    return (
        row[first], row[first + 1], row[first + 2], row[first + 3], row[first + 4], row[first + 5]
    )  # fmt: skip


@inner_kernel
def _plus(c: Six, f: float, w: Six) -> Six:
    return (
        c[0] + f * w[0], c[1] + f * w[1], c[2] + f * w[2],
        c[3] + f * w[3], c[4] + f * w[4], c[5] + f * w[5],
    )  # fmt: skip


@inner_kernel
def add_products(rows: Floats, n: int, width: int, matrix: Floats, sign: float) -> None:
    """Blocks of 6 x 6 on and above the diagonal of matrix += sign rows' rows.

    rows: (n, width) leading part. Two rows of a block at a time are summed in registers.
    """
    zero = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    for first in range(0, width, 6):
        for second in range(first, width, 6):
            for i in range(first, first + 6, 2):
                upper, lower = zero, zero
                for r in range(n):
                    row = six(rows[r], second)
                    upper = _plus(upper, rows[r, i], row)
                    lower = _plus(lower, rows[r, i + 1], row)
                for j in range(6):
                    matrix[i, second + j] += sign * upper[j]
                    matrix[i + 1, second + j] += sign * lower[j]
