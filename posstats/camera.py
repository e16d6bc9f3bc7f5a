"""The camera: interior orientation and distortion."""

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from posstats.errors import GeometryError

DistortionModel = Literal["none", "radial", "brown"]
_INVERSION_STEPS = 50


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

    def distorted(self, uv: NDArray[np.float64]) -> NDArray[np.float64]:
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

    def undistorted(self, uv: NDArray[np.float64]) -> NDArray[np.float64]:
        """Ideal from measured coordinates, by fixed-point iteration to 1e-14.

        Raises
        ------
        GeometryError
            Where the distortion cannot be inverted (coefficients far too large for the format).
        """
        if self.model == "none":
            return uv
        ideal = uv.copy()
        for _ in range(_INVERSION_STEPS):
            with np.errstate(over="ignore", invalid="ignore"):  # divergence is caught below
                step = uv - self.distorted(ideal)
            ideal += step
            if not np.all(np.isfinite(step)):
                break
            if np.abs(step).max(initial=0.0) < 1e-14:
                return ideal
        raise GeometryError("the lens distortion cannot be inverted over the image format")


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

    def ideal_from_measured(self, column_row_px: ArrayLike) -> NDArray[np.float64]:
        """Ideal (..., 2) x, y in px from measured (..., 2) column, row in px."""
        measured = np.asarray(column_row_px, dtype=float)
        uv = (measured - self.principal_point_px) / self.principal_distance_px
        return self.distortion.undistorted(uv) * [
            self.principal_distance_px,
            -self.principal_distance_px,
        ]

    def measured_from_ideal(self, xy_px: ArrayLike) -> NDArray[np.float64]:
        """Measured (..., 2) column, row in px from ideal (..., 2) x, y in px."""
        uv = np.asarray(xy_px, dtype=float) * [1.0, -1.0] / self.principal_distance_px
        return self.distortion.distorted(uv) * self.principal_distance_px + self.principal_point_px
