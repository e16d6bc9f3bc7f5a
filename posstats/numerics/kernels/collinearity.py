"""The projection of ground points into images, its exact derivatives, and its inverse by rays.

With u = R^T (X - S), R the rotation ground_from_image, S the projection centre and c the
principal distance in px,

    x = -c ux / uz,   y = -c uy / uz                                                    [px],

the collinearity equations (equation 1 of the second source paper). Arrays only, compiled.
"""

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.numerics.kernels.compiled import inner_kernel, kernel

_Vector = tuple[float, float, float]

INTERSECTED, FEW_RAYS, PARALLEL, BEHIND_CAMERA, NOT_CONVERGED = range(5)

# Rays that meet at less put the point 10,000 bases away: one pixel of a common camera decides.
_MIN_ANGLE_RAD = 1e-4
_MAX_STEPS = 50
_CONVERGED = 1e-10  # last step over the distance of the point


@inner_kernel
def _transposed_times(r: Floats, x: float, y: float, z: float) -> _Vector:
    """R^T (x, y, z)."""
    return (
        r[0, 0] * x + r[1, 0] * y + r[2, 0] * z,
        r[0, 1] * x + r[1, 1] * y + r[2, 1] * z,
        r[0, 2] * x + r[1, 2] * y + r[2, 2] * z,
    )


@inner_kernel
def _from_centre(ground: Floats, centre: Floats, ground_from_image: Floats) -> _Vector:
    """The point in the camera, u = R^T (X - S)."""
    return _transposed_times(
        ground_from_image, ground[0] - centre[0], ground[1] - centre[1], ground[2] - centre[2]
    )


@inner_kernel
def _projection_gradient(
    ground_from_image: Floats, u: _Vector, distance: float, out: Floats
) -> None:
    """d(x, y) / d(X, Y, Z), written to out (2, 3); u is the point in the camera."""
    scale = -distance / u[2]
    for axis in range(2):
        for j in range(3):
            out[axis, j] = scale * (
                ground_from_image[j, axis] - u[axis] / u[2] * ground_from_image[j, 2]
            )


@kernel
def project(
    ground_m: Floats,
    point: Ints,
    image: Ints,
    ground_from_image: Floats,
    position_m: Floats,
    distance_px: Floats,
) -> Floats:
    """Image coordinates (m, 2) x, y in px of ground points, NaN where behind the camera.

    Parameters
    ----------
    ground_m
        (p, 3) ground points.
    point, image
        (m,) which point is projected into which image.
    ground_from_image
        (n, 3, 3) rotations.
    position_m
        (n, 3) projection centres.
    distance_px
        (n,) principal distance of every image.
    """
    xy = np.full((len(point), 2), np.nan)
    for k in range(len(point)):
        i = image[k]
        u = _from_centre(ground_m[point[k]], position_m[i], ground_from_image[i])
        if u[2] < 0.0:
            xy[k, 0] = -distance_px[i] * u[0] / u[2]
            xy[k, 1] = -distance_px[i] * u[1] / u[2]
    return xy


@kernel
def project_derivatives(
    ground_m: Floats,
    point: Ints,
    image: Ints,
    ground_from_image: Floats,
    rotation_derivatives: Floats,
    position_m: Floats,
    distance_px: Floats,
) -> tuple[Floats, Floats, Floats]:
    """Image coordinates and their derivatives, NaN where a point is behind the camera.

    Parameters are those of `project`, with

    rotation_derivatives
        (n, 3, 3, 3) derivatives of ground_from_image with respect to the three angles.

    Returns
    -------
    xy
        (m, 2) px.
    by_angles
        (m, 2, 3) px/rad.
    by_ground
        (m, 2, 3) px/m with respect to X, Y, Z of the point; those with respect to the
        projection centre are their negatives.
    """
    m = len(point)
    xy = np.full((m, 2), np.nan)
    by_angles, by_ground = np.full((m, 2, 3), np.nan), np.full((m, 2, 3), np.nan)
    for k in range(m):
        i = image[k]
        u = _from_centre(ground_m[point[k]], position_m[i], ground_from_image[i])
        if u[2] >= 0.0:
            continue
        _projection_gradient(ground_from_image[i], u, distance_px[i], by_ground[k])
        scale = -distance_px[i] / u[2]
        for axis in range(2):
            xy[k, axis] = scale * u[axis]
        for angle in range(3):
            du = _from_centre(ground_m[point[k]], position_m[i], rotation_derivatives[i, angle])
            for axis in range(2):
                by_angles[k, axis, angle] = scale * (du[axis] - u[axis] / u[2] * du[2])
    return xy, by_angles, by_ground


@inner_kernel
def _solved(matrix: Floats, right: Floats, out: Floats) -> None:
    """Solve the symmetric 3 x 3 system by Cholesky's decomposition; NaN if not positive."""
    a, b, c = matrix[0, 0], matrix[0, 1], matrix[0, 2]
    l11 = np.sqrt(a)
    l21, l31 = b / l11, c / l11
    l22 = np.sqrt(matrix[1, 1] - l21 * l21)
    l32 = (matrix[1, 2] - l31 * l21) / l22
    l33 = np.sqrt(matrix[2, 2] - l31 * l31 - l32 * l32)
    y1 = right[0] / l11
    y2 = (right[1] - l21 * y1) / l22
    y3 = (right[2] - l31 * y1 - l32 * y2) / l33
    out[2] = y3 / l33
    out[1] = (y2 - l32 * out[2]) / l22
    out[0] = (y1 - l21 * out[1] - l31 * out[2]) / l11


@inner_kernel
def _direction(ground_from_image: Floats, vector: Floats) -> _Vector:
    """Unit direction of a ray in the ground frame."""
    r, x, y, z = ground_from_image, vector[0], vector[1], vector[2]
    norm = np.sqrt(x * x + y * y + z * z)
    return (
        (r[0, 0] * x + r[0, 1] * y + r[0, 2] * z) / norm,
        (r[1, 0] * x + r[1, 1] * y + r[1, 2] * z) / norm,
        (r[2, 0] * x + r[2, 1] * y + r[2, 2] * z) / norm,
    )


@inner_kernel
def _are_parallel(
    first: int, last: int, vectors: Floats, image: Ints, ground_from_image: Floats
) -> bool:
    """Whether no two of the rays meet at an angle of at least `_MIN_ANGLE_RAD`."""
    for k in range(first, last):
        a = _direction(ground_from_image[image[k]], vectors[k])
        for j in range(first, k):
            b = _direction(ground_from_image[image[j]], vectors[j])
            x = a[1] * b[2] - a[2] * b[1]
            y = a[2] * b[0] - a[0] * b[2]
            z = a[0] * b[1] - a[1] * b[0]
            if x * x + y * y + z * z >= _MIN_ANGLE_RAD**2:
                return False
    return True


@inner_kernel
def _nearest_to_rays(
    first: int,
    last: int,
    vectors: Floats,
    image: Ints,
    ground_from_image: Floats,
    position_m: Floats,
    out: Floats,
) -> None:
    """The point of least squared distances to the rays: sum (I - d d^T) (X - S) = 0.

    Relative to the first ray's projection centre, as in all that follows.
    """
    normals, right = np.zeros((3, 3)), np.zeros(3)
    origin = position_m[image[first]]
    for k in range(first, last):
        d = _direction(ground_from_image[image[k]], vectors[k])
        for i in range(3):
            for j in range(3):
                element = (1.0 if i == j else 0.0) - d[i] * d[j]
                normals[i, j] += element
                right[i] += element * (position_m[image[k], j] - origin[j])
    _solved(normals, right, out)


@inner_kernel
def _image_step(
    ground: Floats,
    first: int,
    last: int,
    vectors: Floats,
    image: Ints,
    ground_from_image: Floats,
    position_m: Floats,
    step: Floats,
) -> bool:
    """Write a Gauss-Newton step on the image residuals; false if the point is behind a camera."""
    normals, right, gradient = np.zeros((3, 3)), np.zeros(3), np.empty((2, 3))
    origin = position_m[image[first]]
    for k in range(first, last):
        rotation, centre = ground_from_image[image[k]], position_m[image[k]]
        u = _transposed_times(
            rotation,
            ground[0] - (centre[0] - origin[0]),
            ground[1] - (centre[1] - origin[1]),
            ground[2] - (centre[2] - origin[2]),
        )
        if not u[2] < 0.0:
            return False
        distance = -vectors[k, 2]
        _projection_gradient(rotation, u, distance, gradient)
        for axis in range(2):
            residual = vectors[k, axis] + distance * u[axis] / u[2]
            for i in range(3):
                right[i] += gradient[axis, i] * residual
                for j in range(3):
                    normals[i, j] += gradient[axis, i] * gradient[axis, j]
    _solved(normals, right, step)
    return True


@inner_kernel
def _refined(
    ground: Floats,
    first: int,
    last: int,
    vectors: Floats,
    image: Ints,
    ground_from_image: Floats,
    position_m: Floats,
) -> int:
    """Gauss-Newton from `ground` (changed in place); returns the point's status."""
    step = np.empty(3)
    for _ in range(_MAX_STEPS):
        if not _image_step(
            ground, first, last, vectors, image, ground_from_image, position_m, step
        ):
            return BEHIND_CAMERA
        moved, distance = 0.0, 0.0
        for i in range(3):
            ground[i] += step[i]
            moved += step[i] ** 2
            distance += ground[i] ** 2
        if not np.isfinite(moved):
            return NOT_CONVERGED
        if moved <= _CONVERGED**2 * distance:
            return INTERSECTED
    return NOT_CONVERGED


@kernel
def intersect_rays(
    vectors: Floats,
    image: Ints,
    first: Ints,
    last: Ints,
    ground_from_image: Floats,
    position_m: Floats,
) -> tuple[Floats, Ints]:
    """Forward intersection of k points, least squares of the image residuals.

    Gauss-Newton from the point nearest to the rays, in coordinates relative to the first
    projection centre (map coordinates of millions of metres lose no digits).

    Parameters
    ----------
    vectors
        (m, 3) image vectors (x, y, -c), px.
    image
        (m,) image of every ray.
    first, last
        (k,) the rays of point i are first[i] ... last[i] - 1.
    ground_from_image
        (n, 3, 3) rotations.
    position_m
        (n, 3) projection centres.

    Returns
    -------
    ground_m
        (k, 3), NaN where the status is not `INTERSECTED`.
    status
        (k,) INTERSECTED, FEW_RAYS, PARALLEL, BEHIND_CAMERA or NOT_CONVERGED.
    """
    ground_m = np.full((len(first), 3), np.nan)
    status = np.full(len(first), FEW_RAYS)
    point = np.empty(3)
    for k in range(len(first)):
        start, stop = first[k], last[k]
        if stop - start < 2:
            continue
        if _are_parallel(start, stop, vectors, image, ground_from_image):
            status[k] = PARALLEL
            continue
        _nearest_to_rays(start, stop, vectors, image, ground_from_image, position_m, point)
        status[k] = _refined(point, start, stop, vectors, image, ground_from_image, position_m)
        if status[k] == INTERSECTED:
            for i in range(3):
                ground_m[k, i] = point[i] + position_m[image[start], i]
    return ground_m, status


@inner_kernel
def _inverse_normals(first: int, last: int, by_ground: Floats, out: Floats) -> None:
    """(J'J)^-1 of one point's rays, J = by_ground[first:last], written to out (3, 3)."""
    normals, unit = np.zeros((3, 3)), np.zeros(3)
    for k in range(first, last):
        for axis in range(2):
            for i in range(3):
                for j in range(3):
                    normals[i, j] += by_ground[k, axis, i] * by_ground[k, axis, j]
    for i in range(3):
        unit[i] = 1.0
        _solved(normals, unit, out[i])
        unit[i] = 0.0


@inner_kernel
def _add_variance(cofactors: Floats, by_ground: Floats, dx: float, dy: float, out: Floats) -> None:
    """Add the covariance of a point whose ray is shifted in the image by dx, dy (one sigma)."""
    x, y, z = (
        by_ground[0, 0] * dx + by_ground[1, 0] * dy,
        by_ground[0, 1] * dx + by_ground[1, 1] * dy,
        by_ground[0, 2] * dx + by_ground[1, 2] * dy,
    )
    shift = _transposed_times(cofactors, x, y, z)  # cofactors are symmetric
    for i in range(3):
        for j in range(3):
            out[i, j] += shift[i] * shift[j]


@kernel
def intersection_precision(
    by_angles: Floats,
    by_ground: Floats,
    offsets: Ints,
    image: Ints,
    sigma_angles_rad: Floats,
    sigma_position_m: Floats,
) -> tuple[Floats, Floats]:
    """Cofactors of k intersected points, and what the orientations' errors add.

    With J = d(image)/d(ground), B = d(image)/d(orientation), and second derivatives times
    residuals left out, the implicit function theorem gives dX = -(J'J)^-1 J'B d(orientation).

    Parameters
    ----------
    by_angles, by_ground
        (m, 2, 3) derivatives of the m rays as from `project_derivatives`, point after point.
    offsets
        (k + 1,) first ray of every point, and m.
    image
        (m,) image of every ray.
    sigma_angles_rad, sigma_position_m
        (n, 3) standard deviations of the orientations, independent.

    Returns
    -------
    cofactors
        (k, 3, 3) m2/px2: covariance for image coordinates of unit variance.
    from_orientations
        (k, 3, 3) m2.
    """
    cofactors = np.empty((len(offsets) - 1, 3, 3))
    from_orientations = np.zeros((len(offsets) - 1, 3, 3))
    for k in range(len(offsets) - 1):
        _inverse_normals(offsets[k], offsets[k + 1], by_ground, cofactors[k])
        for ray in range(offsets[k], offsets[k + 1]):
            gradient, turned = by_ground[ray], by_angles[ray]
            for i in range(3):
                angle = sigma_angles_rad[image[ray], i]
                centre = sigma_position_m[image[ray], i]
                _add_variance(
                    cofactors[k],
                    gradient,
                    turned[0, i] * angle,
                    turned[1, i] * angle,
                    from_orientations[k],
                )
                _add_variance(
                    cofactors[k],
                    gradient,
                    gradient[0, i] * centre,
                    gradient[1, i] * centre,
                    from_orientations[k],
                )
    return cofactors, from_orientations
