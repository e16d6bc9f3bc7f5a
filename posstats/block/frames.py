"""Ground frames: the map grid of the files and the Cartesian frame of the computation.

A map grid is not Cartesian: the earth is curved, the grid's scale varies and heights are counted
along the local vertical. With a crs, everything is therefore computed in a frame tangent to the
ellipsoid at the block's middle, and results are given back in the crs.
"""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Self

import numpy as np
from numpy.typing import ArrayLike
from pyproj import CRS, Proj, Transformer
from pyproj.exceptions import CRSError, ProjError

from posstats.arrays import Floats
from posstats.errors import GeometryError

_AXIS_TEST_M = 50.0
_AXIS_TOLERANCE_RAD = 0.02  # lets grids that are not conformal pass, not turned axes


@dataclass(frozen=True)
class GroundFrame:
    """The mapping between the coordinates of the files and the computing frame.

    Without `origin_deg` (no crs, or ``frame = "grid"``) the coordinates are Cartesian as they
    are and every mapping is an identity. With it, the computing frame has its origin on the
    ellipsoid at `origin_deg`, z along the normal there, and x and y along the grid's axes there,
    so that in the block's middle positions and angles differ from the files' by a shift only.

    Attributes
    ----------
    crs
        Any pyproj string of a map grid in metres, or None.
    origin_deg
        Longitude and latitude of the tangent point, degrees, or None.
    geoid
        Grid of geoid heights that PROJ can read (GTX, GeoTIFF); the heights of the files are then
        orthometric, H = h - N. None: ellipsoidal.
    """

    crs: str | None = None
    origin_deg: tuple[float, float] | None = None
    geoid: Path | None = None

    @classmethod
    def tangent(cls, crs: str, position_crs: ArrayLike, geoid: Path | None = None) -> Self:
        """The frame tangent at the middle (of the extremes) of positions (n, 3) in the crs.

        Raises
        ------
        GeometryError
            If the crs is unknown, no map grid in metres with axes east and north, or does not
            cover the positions; if the geoid grid cannot be read.
        """
        require_map_grid(crs)
        xy = np.asarray(position_crs, dtype=float)[..., :2].reshape(-1, 2)
        x, y = 0.5 * (xy.min(axis=0) + xy.max(axis=0))
        longitude, latitude = _projection(crs)(x, y, inverse=True)
        if not np.isfinite([longitude, latitude]).all():
            raise GeometryError(f"the middle of the block, {x:.0f} {y:.0f}, is outside {crs}")
        origin_deg = float(longitude), float(latitude)
        cls(crs, origin_deg)._require_east_north_axes(x, y)
        if geoid is not None:
            _geoid_shift(geoid)
        return cls(crs, origin_deg, geoid)

    @property
    def is_tangent(self) -> bool:
        """Whether the computing frame differs from the coordinates of the files."""
        return self.origin_deg is not None

    def to_computing(self, position_crs: ArrayLike) -> Floats:
        """Positions (n, 3) in the computing frame, m, from x, y, z in the crs; NaN outside it."""
        position = np.array(position_crs, dtype=float)
        if not self.is_tangent:
            return position
        longitude, latitude = self._geographic(position)
        height = position[..., 2]
        if self.geoid is not None:
            _, _, height = _geoid_shift(self.geoid).transform(longitude, latitude, height)
        geocentric = self._geocentric(longitude, latitude, height)
        offset = geocentric - self._geocentric(*self._origin, 0.0)
        computing: Floats = offset @ self._geocentric_from_computing
        return computing

    def to_crs(self, position: ArrayLike) -> Floats:
        """Positions (n, 3) x, y, z in the crs from the computing frame; inverse of the above."""
        computing = np.array(position, dtype=float)
        if not self.is_tangent:
            return computing
        geocentric = computing @ self._geocentric_from_computing.T
        geocentric += self._geocentric(*self._origin, 0.0)
        cartesian = _geocentric_from_geographic(self._crs)
        longitude, latitude, height = cartesian.transform(
            geocentric[..., 0], geocentric[..., 1], geocentric[..., 2], direction="INVERSE"
        )
        if self.geoid is not None:
            shift = _geoid_shift(self.geoid)
            _, _, height = shift.transform(longitude, latitude, height, direction="INVERSE")
        x, y = _projection(self._crs)(longitude, latitude)
        return np.stack([_finite_or_nan(values) for values in (x, y, height)], axis=-1)

    def computing_from_crs_axes(self, position_crs: ArrayLike) -> Floats:
        """Rotations (n, 3, 3) of vectors along the local grid axes into the computing frame.

        The local axes at a point are grid east, grid north and the ellipsoid's normal there: the
        axes to which the angles and the coordinate differences of the files refer.
        """
        position = np.asarray(position_crs, dtype=float)
        if not self.is_tangent:
            return np.broadcast_to(np.eye(3), (*position.shape[:-1], 3, 3)).copy()
        longitude, latitude = self._geographic(position)
        local = _geocentric_from_east_north_up(longitude, latitude)
        grid = _east_north_up_from_grid(self._convergence(longitude, latitude))
        return self._geocentric_from_computing.T @ local @ grid

    def convergence_rad(self, position_crs: ArrayLike) -> Floats:
        """Meridian convergence (n,): azimuth of grid north, clockwise from true north, rad."""
        return self._convergence(*self._geographic(np.asarray(position_crs, dtype=float)))

    @property
    def _crs(self) -> str:
        if self.crs is None:
            raise GeometryError("without a crs there are no geographic coordinates")
        return self.crs

    @property
    def _origin(self) -> tuple[float, float]:
        if self.origin_deg is None:
            raise GeometryError("the frame has no tangent point")
        return self.origin_deg

    @property
    def _geocentric_from_computing(self) -> Floats:
        longitude, latitude = (np.float64(angle) for angle in self._origin)
        grid = _east_north_up_from_grid(self._convergence(longitude, latitude))
        return _geocentric_from_east_north_up(longitude, latitude) @ grid

    def _geographic(self, position_crs: Floats) -> tuple[Floats, Floats]:
        """Longitude and latitude, degrees."""
        longitude, latitude = _projection(self._crs)(
            position_crs[..., 0], position_crs[..., 1], inverse=True
        )
        return _finite_or_nan(longitude), _finite_or_nan(latitude)

    def _convergence(self, longitude_deg: ArrayLike, latitude_deg: ArrayLike) -> Floats:
        # PROJ's factors, unlike its projections, count longitude from the crs's own meridian.
        longitude = np.asarray(longitude_deg) - _prime_meridian_deg(self._crs)
        if longitude.size == 0:  # which PROJ's factors refuse
            return np.zeros(longitude.shape)
        factors = _projection(self._crs).get_factors(longitude, latitude_deg)
        return np.radians(_finite_or_nan(factors.meridian_convergence))

    def _geocentric(
        self, longitude_deg: ArrayLike, latitude_deg: ArrayLike, h: ArrayLike
    ) -> Floats:
        transformer = _geocentric_from_geographic(self._crs)
        xyz = transformer.transform(longitude_deg, latitude_deg, h)
        return np.stack([_finite_or_nan(values) for values in xyz], axis=-1)

    def _require_east_north_axes(self, x: float, y: float) -> None:
        """Refuse grids that count west or south, where the convergence is another angle."""
        axes = self.computing_from_crs_axes(np.array([x, y, 0.0]))[:2, :2]
        for axis in range(2):
            step = _AXIS_TEST_M * np.eye(3)[axis]
            middle = np.array([x, y, 0.0])
            before, after = self.to_computing(np.stack([middle - step, middle + step]))
            direction = (after - before)[:2] / np.linalg.norm(after - before)
            if not np.linalg.norm(direction - axes[:, axis]) < _AXIS_TOLERANCE_RAD:
                raise GeometryError(f"the axes of {self.crs} do not count east and north")


def require_map_grid(crs: str) -> None:
    """Refuse what is not a map grid in metres.

    Raises
    ------
    GeometryError
        With what the crs is instead.
    """
    try:
        system = CRS.from_user_input(crs)
    except CRSError as error:
        raise GeometryError(f"PROJ does not know the crs {crs!r}") from error
    if system.is_compound:
        raise GeometryError(f"{crs} ({system.name}) holds a height system; name the map grid alone")
    if not system.is_projected:
        raise GeometryError(f"{crs} ({system.name}) is no map grid (a projected crs in metres)")
    units = {axis.unit_name for axis in system.axis_info if axis.unit_conversion_factor != 1.0}
    if units:
        raise GeometryError(
            f"{crs} ({system.name}) counts in {', '.join(sorted(units))}, not metres"
        )


@lru_cache(maxsize=32)
def _projection(crs: str) -> Proj:
    return Proj(CRS.from_user_input(crs))


@lru_cache(maxsize=32)
def _prime_meridian_deg(crs: str) -> float:
    """Longitude of the crs's prime meridian from Greenwich."""
    meridian = CRS.from_user_input(crs).prime_meridian
    return (
        0.0
        if meridian is None
        else np.degrees(float(meridian.longitude) * float(meridian.unit_conversion_factor))
    )


@lru_cache(maxsize=32)
def _geocentric_from_geographic(crs: str) -> Transformer:
    """Degrees and metres to geocentric metres on the ellipsoid of the crs: no datum change."""
    ellipsoid = CRS.from_user_input(crs).get_geod()
    if ellipsoid is None:
        raise GeometryError(f"{crs} has no ellipsoid")
    return Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad"
        f" +step +proj=cart +a={ellipsoid.a!r} +b={ellipsoid.b!r}"
    )


@lru_cache(maxsize=8)
def _geoid_shift(grid: Path) -> Transformer:
    """Orthometric to ellipsoidal heights, h = H + N, at longitudes and latitudes in degrees."""
    try:
        return Transformer.from_pipeline(
            "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad"
            f' +step +proj=vgridshift +grids="{grid.resolve()}" +multiplier=1'
            " +step +proj=unitconvert +xy_in=rad +xy_out=deg"
        )
    except ProjError as error:
        raise GeometryError(f"PROJ cannot read the geoid grid {grid.name}") from error


def _geocentric_from_east_north_up(longitude_deg: ArrayLike, latitude_deg: ArrayLike) -> Floats:
    """Rotations (..., 3, 3) whose columns are east, north and up at a point of the ellipsoid."""
    lam, phi = np.radians(longitude_deg), np.radians(latitude_deg)
    east = np.stack([-np.sin(lam), np.cos(lam), np.zeros_like(lam)], axis=-1)
    up = np.stack([np.cos(phi) * np.cos(lam), np.cos(phi) * np.sin(lam), np.sin(phi)], axis=-1)
    return np.stack([east, np.cross(up, east), up], axis=-1)


def _east_north_up_from_grid(convergence_rad: Floats) -> Floats:
    """Rotations (..., 3, 3) of grid vectors; grid north has the azimuth `convergence_rad`."""
    cosine, sine = np.cos(convergence_rad), np.sin(convergence_rad)
    rotation = np.zeros((*np.shape(convergence_rad), 3, 3))
    rotation[..., 0, 0] = rotation[..., 1, 1] = cosine
    rotation[..., 0, 1], rotation[..., 1, 0] = sine, -sine
    rotation[..., 2, 2] = 1.0
    return rotation


def _finite_or_nan(values: ArrayLike) -> Floats:
    """PROJ marks what it cannot transform with infinity."""
    return np.where(np.isfinite(values), values, np.nan)
