"""Y-parallaxes of a block linearised in orientations and positions, free of the points' noise.

The condition is f(x, l - e) = 0 in unknowns x and measured image points l of noise e. Its
derivatives J and D are taken at l - e (rigorous Gauss-Helmert form). Taken at l they would hold
the noise of q, which is D e to first order: J(l) = J + e dJ/dl, so that the gradient J'Wq has the
expectation sigma^2 tr(D'W dJ/dl), not zero. It grows with the number of points, and what
opposes it in a direction without parallax, such as the tilt of the block, are only the priors.
"""

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.geometry.coplanarity.normals import Observed
from posstats.geometry.coplanarity.point_pairs import PointPairs
from posstats.numerics.kernels.compiled import kernel
from posstats.numerics.kernels.coplanarity import y_parallax_derivatives
from posstats.numerics.kernels.rotation import (
    AngleSystem,
    rotation_derivatives,
    rotation_from_angles,
)


@kernel
def refer_to_measurements(
    q: Floats,
    by_base: Floats,
    by_image: Floats,
    image_noise: Floats,
    left_ray: Ints,
    right_ray: Ints,
    pair: Ints,
    frames: Floats,
) -> Floats:
    """Carry q (N,) from image points freed of noise to the measured ones, in place.

    `by_base` (N, 3) is turned from the base frames, `frames` (p, 3, 3) base_from_ground, into the
    ground frame, in place. `image_noise` (m, 2) belongs to the rays. Returns diag(D D') (N,).
    """
    variance = np.empty(len(q))
    for k in range(len(q)):
        left, right, d = image_noise[left_ray[k]], image_noise[right_ray[k]], by_image[k]
        q[k] += d[0] * left[0] + d[1] * left[1] + d[2] * right[0] + d[3] * right[1]
        variance[k] = d[0] * d[0] + d[1] * d[1] + d[2] * d[2] + d[3] * d[3]
        frame, (x, y, z) = frames[pair[k]], by_base[k]
        for axis in range(3):
            by_base[k, axis] = x * frame[0, axis] + y * frame[1, axis] + z * frame[2, axis]
    return variance


def linearised(
    pairs: PointPairs,
    unknowns: Floats,
    image_noise: Floats,
    frames: Floats,
    system: AngleSystem,
) -> Observed:
    """Y-parallaxes and derivatives at `unknowns` (n, 6) and at image points freed of noise.

    q is that of the measured image points to first order in `image_noise` (m, 2), the derivatives
    are those at the points without it. The parallax is measured in `frames` (p, 3, 3),
    base_from_ground, which stay those of the POS bases: so the derivatives are exact, also where
    q is not yet zero.
    """
    vectors = pairs.ray_vectors.copy()
    vectors[:, :2] -= image_noise
    rotation = rotation_from_angles(unknowns[:, :3], system)
    derivative = rotation_derivatives(unknowns[:, :3], system)
    base = unknowns[pairs.right, 3:] - unknowns[pairs.left, 3:]
    q, by_left, by_right, by_base, by_image = y_parallax_derivatives(
        vectors,
        pairs.left_ray,
        pairs.right_ray,
        pairs.pair,
        frames @ rotation[pairs.left],
        frames @ rotation[pairs.right],
        frames[:, None] @ derivative[pairs.left],
        frames[:, None] @ derivative[pairs.right],
        np.einsum("pij,pj->pi", frames, base),
    )
    variance = refer_to_measurements(
        q, by_base, by_image, image_noise, pairs.left_ray, pairs.right_ray, pairs.pair, frames
    )
    return Observed(q, by_left, by_right, by_base, by_image, variance)
