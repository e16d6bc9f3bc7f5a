"""Least squares on normal equations: solution, error propagation, variance factor.

The observations l are residual functions of the unknowns, linearised as J, of weights W that
need not be the inverse of their covariance sigma^2 D D' (D: derivatives with respect to the
independent measurements of standard deviation sigma). With prior weights P of the unknowns,

    N = J'WJ + P,   M = G'G with G = D'WJ,   covariance = N^-1 (sigma^2 M + P) N^-1,

which is right whatever W is, and (J'WJ / sigma^2 + P)^-1 if W is the inverse of D D'.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lapack

from posstats.arrays import Floats, Ints
from posstats.errors import GeometryError


@dataclass(frozen=True, eq=False)
class NormalsFactor:
    """Cholesky factor of normal equations N = L L'; `lower` (u, u) in Fortran order."""

    lower: Floats

    def solve(self, right_side: Floats) -> Floats:
        """N^-1 right_side, (u,) or (u, k)."""
        solution, _ = lapack.dpotrs(self.lower, right_side, lower=1)
        return np.asarray(solution, dtype=float)


def mirrored(matrix: Floats) -> Floats:
    """The matrix (u, u) with its upper triangle copied onto the lower one, in place."""
    for row in range(len(matrix)):
        matrix[row + 1 :, row] = matrix[row, row + 1 :]
    return matrix


def normals_factor(normals: Floats) -> NormalsFactor:
    """Factorise normal equations (u, u), of which the upper triangle is read.

    The factor takes the place of the normal equations: they are large.

    Raises
    ------
    GeometryError
        If they are singular or not finite: some unknown is not determined.
    """
    # The transpose is in LAPACK's order.
    lower, info = lapack.dpotrf(normals.T, lower=1, overwrite_a=1)
    if info != 0 or not np.all(np.isfinite(np.diagonal(lower))):
        raise GeometryError("the normal equations are singular: an unknown is not determined")
    return NormalsFactor(lower)


def inverted(normals: Floats) -> Floats:
    """N^-1 (u, u), both triangles, in place of N; of N the upper, as in `normals_factor`."""
    inverse, _ = lapack.dpotri(normals_factor(normals).lower, lower=1, overwrite_c=1)
    return mirrored(np.asarray(inverse, dtype=float).T)


@dataclass(frozen=True, eq=False)
class Propagation:
    """How measurement noise and prior errors reach the unknowns.

    Attributes
    ----------
    inverse
        (u, u) N^-1.
    prior_weights
        (u,) diagonal of P.
    noise_gain
        (u, u) N^-1 M: times N^-1 the covariance per unit of sigma^2 that the measurements cause.
    """

    inverse: Floats
    prior_weights: Floats
    noise_gain: Floats

    def variance_factor(self, weighted_square_sum: float, noise_trace: float) -> float:
        """sigma^2 from the residuals v, by the exact expectation of v'Wv.

        E[v'Wv] = sigma^2 [tr(W D D') - 2 tr(N^-1 M) + tr(N^-1 J'WJ N^-1 M)]
        + tr(N^-1 J'WJ N^-1 P), where J'WJ = N - P. NaN without redundancy.

        Parameters
        ----------
        weighted_square_sum
            v'Wv.
        noise_trace
            tr(W D D').
        """
        p = self.prior_weights
        prior_in_noise = float(p @ np.einsum("ij,ij->i", self.noise_gain, self.inverse))
        redundancy = noise_trace - float(np.trace(self.noise_gain)) - prior_in_noise
        squares = np.einsum("ij,ij,j->i", self.inverse, self.inverse, p)
        prior_part = float(p @ np.diagonal(self.inverse) - p @ squares)
        if redundancy <= 1e-9 * noise_trace:
            return float("nan")
        return max(weighted_square_sum - prior_part, 0.0) / redundancy

    def covariance(self, sigma2: float, unknowns: Ints) -> Floats:
        """Covariance (k, k) of some unknowns (indices, (k,)), the others marginal; symmetric."""
        rows = sigma2 * self.noise_gain[unknowns] + self.inverse[unknowns] * self.prior_weights
        covariance: Floats = rows @ self.inverse[:, unknowns]
        covariance += covariance.T.copy()
        return 0.5 * covariance


def propagated(normals: Floats, noise_normals: Floats, prior_weights: Floats) -> Propagation:
    """Error propagation through a solution.

    Parameters
    ----------
    normals
        (u, u) N = J'WJ + diag(prior_weights), upper triangle; overwritten.
    noise_normals
        (u, u) M = G'G, both triangles.
    prior_weights
        (u,).
    """
    inverse = inverted(normals)
    return Propagation(inverse, prior_weights, noise_gain=inverse @ noise_normals)
