"""The camera: interior orientation and distortion."""

from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from posstats.arrays import Floats
from posstats.errors import GeometryError

DistortionModel = Literal["none", "radial", "brown"]
_INVERSION_STEPS = 20
_CONVERGED = 1e-10  # of a Newton step: the next one would be of the order of its square
_RADII = 1000


@dataclass(frozen=True)
class Distortion:
    """Lens distortion, ideal -> measured, in the convention of OpenCV and COLMAP.

    With u = x / c right and v = -y / c down, r2 = u^2 + v^2:
    u' = u (1 + k1 r2 + k2 r2^2 + k3 r2^3) + 2 p1 u v + p2 (r2 + 2 u^2), and
    v' = v (1 + k1 r2 + k2 r2^2 + k3 r2^3) + p1 (r2 + 2 v^2) + 2 p2 u v.
    """

    model: DistortionModel = "none"
    k1: float = 0.0
    k2: float = 0.0
    k3: float = 0.0
    p1: float = 0.0
    p2: float = 0.0

    def distorted(self, uv: Floats) -> Floats:
        """Measured (..., 2) from ideal (..., 2) coordinates, in units of the principal distance."""
        u, v = uv[..., 0], uv[..., 1]
        r2 = u * u + v * v
        radial = 1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3))
        return np.stack(
            [
                u * radial + 2.0 * self.p1 * u * v + self.p2 * (r2 + 2.0 * u * u),
                v * radial + self.p1 * (r2 + 2.0 * v * v) + 2.0 * self.p2 * u * v,
            ],
            axis=-1,
        )

    def jacobian(self, uv: Floats) -> Floats:
        """Derivatives (..., 2, 2) of the measured u', v' (rows) by the ideal u, v (columns)."""
        u, v = uv[..., 0], uv[..., 1]
        r2 = u * u + v * v
        radial = 1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3))
        growth = 2.0 * (self.k1 + r2 * (2.0 * self.k2 + r2 * 3.0 * self.k3))
        jacobian = np.empty((*uv.shape, 2))
        jacobian[..., 0, 0] = radial + growth * u * u + 2.0 * self.p1 * v + 6.0 * self.p2 * u
        jacobian[..., 1, 1] = radial + growth * v * v + 6.0 * self.p1 * v + 2.0 * self.p2 * u
        jacobian[..., 0, 1] = growth * u * v + 2.0 * self.p1 * u + 2.0 * self.p2 * v
        jacobian[..., 1, 0] = jacobian[..., 0, 1]
        return jacobian

    def undistorted(self, uv: Floats) -> Floats:
        """Ideal from measured coordinates, by Newton's method to rounding.

        Of several ideal points that are imaged alike, it is the one that is met first on the way
        out from the principal point.

        Raises
        ------
        GeometryError
            Where there is none: outwards of where the image folds back on itself, because the
            coefficients do not hold there.
        """
        if self.model == "none":
            return uv
        with np.errstate(all="ignore"):  # what is not finite never converges, and is refused
            ideal = self._radially_undistorted(uv)
            for _ in range(_INVERSION_STEPS):
                step, determinant = self._newton_step(uv, ideal)
                ideal = ideal + step
                if np.all(np.abs(step) < _CONVERGED) and np.all(determinant > 0.0):
                    return ideal
        raise GeometryError("the lens distortion cannot be inverted over the image format")

    def _newton_step(self, uv: Floats, ideal: Floats) -> tuple[Floats, Floats]:
        """The step (..., 2) towards the ideal point of `uv`, and the Jacobian's determinant."""
        j = self.jacobian(ideal)
        missing = uv - self.distorted(ideal)
        determinant = j[..., 0, 0] * j[..., 1, 1] - j[..., 0, 1] * j[..., 1, 0]
        cofactors = np.stack(
            [
                j[..., 1, 1] * missing[..., 0] - j[..., 0, 1] * missing[..., 1],
                j[..., 0, 0] * missing[..., 1] - j[..., 1, 0] * missing[..., 0],
            ],
            axis=-1,
        )
        return cofactors / determinant[..., None], determinant

    def _radially_undistorted(self, uv: Floats) -> Floats:
        """A start within Newton's reach: the radial part alone, by a table up to its fold."""
        measured = np.linalg.norm(uv, axis=-1)
        reach = self._fold_radius()
        if np.isinf(reach):
            reach = 2.0 * measured.max(initial=0.0)
            while self._radially_distorted(reach) < measured.max(initial=0.0):
                reach *= 2.0
        radii = np.linspace(0.0, reach, _RADII)
        ideal = np.interp(measured, self._radially_distorted(radii), radii)
        scale = np.divide(ideal, measured, out=np.ones_like(measured), where=measured > 0.0)
        start: Floats = uv * scale[..., None]
        return start

    def _radially_distorted(self, radius: Any) -> Any:
        r2 = radius * radius
        return radius * (1.0 + r2 * (self.k1 + r2 * (self.k2 + r2 * self.k3)))

    def _fold_radius(self) -> float:
        """Radius from which on the radial part no longer grows; infinite if it always does."""
        roots = np.roots([7.0 * self.k3, 5.0 * self.k2, 3.0 * self.k1, 1.0])  # in r squared
        r2 = roots.real[(np.abs(roots.imag) <= 1e-9 * np.abs(roots)) & (roots.real > 0.0)]
        return float(np.sqrt(r2.min(initial=np.inf)))


@dataclass(frozen=True)
class Camera:
    """Interior orientation of one camera.

    Image coordinates inside posstats are *ideal*: x right, y up, from the principal point,
    distortion removed, in px. Files hold measured columns and rows or millimetres.
    """

    id: str
    name: str
    width_px: float
    height_px: float
    principal_distance_px: float
    principal_point_px: tuple[float, float]
    pixel_size_mm: float | None = None
    distortion: Distortion = Distortion()

    def ideal_from_measured(self, column_row_px: ArrayLike) -> Floats:
        """Ideal (..., 2) x, y in px from measured (..., 2) column, row in px."""
        measured = np.asarray(column_row_px, dtype=float)
        uv = (measured - self.principal_point_px) / self.principal_distance_px
        return self.distortion.undistorted(uv) * [
            self.principal_distance_px,
            -self.principal_distance_px,
        ]

    def measured_from_ideal(self, xy_px: ArrayLike) -> Floats:
        """Measured (..., 2) column, row in px from ideal (..., 2) x, y in px."""
        uv = np.asarray(xy_px, dtype=float) * [1.0, -1.0] / self.principal_distance_px
        return self.distortion.distorted(uv) * self.principal_distance_px + self.principal_point_px
