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

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.numerics.kernels.algebra import Vector, dot, rotated
from posstats.numerics.kernels.compiled import inner_kernel, kernel


@inner_kernel
def parallax(a: Vector, b: Vector, base: Vector) -> float:
    """The y-parallax q of the rays a and b, px at image scale."""
    u = base[0] * b[2] - base[2] * b[0]
    v = base[0] * a[2] - base[2] * a[0]
    w = a[0] * b[2] - b[0] * a[2]
    return float((u * a[1] - w * base[1]) / v - b[1])


@inner_kernel
def parallax_gradients(a: Vector, b: Vector, base: Vector) -> tuple[float, Vector, Vector, Vector]:
    """The y-parallax q, and its gradients with respect to a, b and the base (3,)."""
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


def base_frames(base_m: Floats) -> Floats:
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
    left_vectors: Floats,
    right_vectors: Floats,
    offsets: Ints,
    base_from_left: Floats,
    base_from_right: Floats,
    base: Floats,
) -> Floats:
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
            a = rotated(base_from_left[pair], left_vectors[k])
            b = rotated(base_from_right[pair], right_vectors[k])
            q[k] = parallax(a, b, base[pair])
    return q


@kernel
def y_parallax_derivatives(
    vectors: Floats,
    left_ray: Ints,
    right_ray: Ints,
    pair: Ints,
    base_from_left: Floats,
    base_from_right: Floats,
    left_derivatives: Floats,
    right_derivatives: Floats,
    base: Floats,
) -> tuple[Floats, Floats, Floats, Floats, Floats]:
    """y-parallax and its derivatives for every point pair.

    Parameters
    ----------
    vectors
        (m, 3) image vectors (x, y, -c) in px of the rays.
    left_ray, right_ray, pair
        (N,) the rays and the pair of images of every point pair, in any order.
    base_from_left, base_from_right, base
        As in `y_parallax`.
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
    n = len(pair)
    q = np.empty(n)
    by_left, by_right, by_base = np.empty((n, 3)), np.empty((n, 3)), np.empty((n, 3))
    by_image = np.empty((n, 4))
    for k in range(n):
        p, left_vector, right_vector = pair[k], vectors[left_ray[k]], vectors[right_ray[k]]
        left, right = base_from_left[p], base_from_right[p]
        a, b = rotated(left, left_vector), rotated(right, right_vector)
        q[k], da, db, dbase = parallax_gradients(a, b, base[p])
        for angle in range(3):
            by_base[k, angle] = dbase[angle]
            by_left[k, angle] = dot(da, rotated(left_derivatives[p, angle], left_vector))
            by_right[k, angle] = dot(db, rotated(right_derivatives[p, angle], right_vector))
        for axis in range(2):
            by_image[k, axis] = dot(da, left[:, axis])
            by_image[k, axis + 2] = dot(db, right[:, axis])
    return q, by_left, by_right, by_base, by_image
