"""The tangent frame against PROJ's own topocentric conversion, and its inverse."""

import struct

import numpy as np
import pytest
from perfect_block import MIDDLE
from pyproj import CRS, Proj, Transformer

from posstats.block.frames import GroundFrame, require_map_grid
from posstats.errors import GeometryError

GRIDS = {
    **MIDDLE,
    "EPSG:2193": (1_750_000.0, 5_950_000.0),  # New Zealand, axes listed north, east
    "EPSG:2056": (2_700_000.0, 1_200_000.0),  # Switzerland, oblique Mercator
    "EPSG:27572": (600_000.0, 2_400_000.0),  # Paris meridian, grads
    "EPSG:3035": (4_000_000.0, 3_000_000.0),  # equal area, not conformal
    "EPSG:5514": (-500_000.0, -1_100_000.0),  # Krovak East North
    "+proj=utm +zone=19 +south +ellps=GRS80": (300_000.0, 6_000_000.0),
}


def around(crs: str, n: int = 7) -> np.ndarray:
    rng = np.random.default_rng(5)
    return np.column_stack([GRIDS[crs] + rng.uniform(-2e4, 2e4, (n, 2)), rng.uniform(0, 9e3, n)])


def test_the_default_frame_is_an_identity() -> None:
    position = np.arange(6.0).reshape(2, 3)
    frame = GroundFrame()
    assert np.array_equal(frame.to_computing(position), position)
    assert np.array_equal(frame.to_crs(position), position)
    assert np.array_equal(frame.computing_from_crs_axes(position), [np.eye(3), np.eye(3)])


# PROJ's own inverse of the European equal-area grid is good to 0.3 mm only.
@pytest.mark.parametrize("crs", [crs for crs in GRIDS if crs != "EPSG:3035"])
def test_positions_come_back(crs: str) -> None:
    position = around(crs)
    frame = GroundFrame.tangent(crs, position)
    assert np.allclose(frame.to_crs(frame.to_computing(position)), position, atol=2e-6, rtol=0)


@pytest.mark.parametrize("crs", GRIDS)
def test_positions_agree_with_the_topocentric_conversion_of_proj(crs: str) -> None:
    """Oracle: PROJ's transformation to geographic coordinates, cart and topocentric."""
    position = around(crs)
    frame = GroundFrame.tangent(crs, position)
    system = CRS(crs)
    a, b = system.ellipsoid.semi_major_metre, system.ellipsoid.semi_minor_metre
    lon0, lat0 = frame.origin_deg
    pipeline = Transformer.from_pipeline(
        "+proj=pipeline +step +proj=unitconvert +xy_in=deg +xy_out=rad"
        f" +step +proj=cart +a={a!r} +b={b!r}"
        f" +step +proj=topocentric +a={a!r} +b={b!r} +lon_0={lon0!r} +lat_0={lat0!r} +h_0=0"
    )
    lon, lat = Proj(system)(position[:, 0], position[:, 1], inverse=True)
    east, north, up = pipeline.transform(lon, lat, position[:, 2])
    gamma = frame.convergence_rad(np.array([Proj(system)(lon0, lat0)]))
    x = np.cos(gamma) * east - np.sin(gamma) * north
    y = np.sin(gamma) * east + np.cos(gamma) * north
    assert np.allclose(frame.to_computing(position), np.column_stack([x, y, up]), atol=1e-6, rtol=0)


@pytest.mark.parametrize(
    "crs", ["EPSG:32631", "EPSG:2154", "EPSG:32733", "EPSG:2193", "EPSG:27572"]
)
def test_grid_axes_are_the_directions_of_small_steps_in_the_grid(crs: str) -> None:
    """Oracle: numerical derivative of the mapping (conformal grids, both hemispheres).

    On the ellipsoid: at flying height the two main curvatures turn the direction by some 1e-7.
    """
    position = around(crs) * (1.0, 1.0, 0.0)
    frame = GroundFrame.tangent(crs, position)
    axes = frame.computing_from_crs_axes(position)
    for axis in range(3):
        step = 100.0 * np.eye(3)[axis]
        d = frame.to_computing(position + step) - frame.to_computing(position - step)
        d /= np.linalg.norm(d, axis=1, keepdims=True)
        assert np.allclose(axes[:, :, axis], d, atol=1e-8)


@pytest.mark.parametrize("crs", ["EPSG:32631", "EPSG:32733", "EPSG:2154", "EPSG:2193"])
def test_convergence_is_the_azimuth_of_grid_north(crs: str) -> None:
    """Oracle: geodesic azimuth of a step along the grid's y axis."""
    position = around(crs)
    proj = Proj(crs)
    lon, lat = proj(position[:, 0], position[:, 1] - 50.0, inverse=True)
    lon2, lat2 = proj(position[:, 0], position[:, 1] + 50.0, inverse=True)
    azimuth, back, _ = CRS(crs).get_geod().inv(lon, lat, lon2, lat2)
    middle = 0.5 * (azimuth + (back + 180.0 + 180.0) % 360.0 - 180.0)
    convergence = np.degrees(GroundFrame(crs).convergence_rad(position))
    assert np.abs(convergence).max() > 0.1
    assert np.allclose(convergence, middle, atol=1e-6)


def test_what_lies_outside_the_grid_becomes_nan_and_missing_stays_missing() -> None:
    frame = GroundFrame.tangent("EPSG:32631", [(5e5, 5e6, 0.0)])
    result = frame.to_computing([(1e30, 5e6, 0.0), (np.nan, 5e6, 0.0), (5e5, 5e6, 1.0)])
    assert np.isnan(result[:2]).all()
    assert np.isfinite(result[2]).all()


@pytest.mark.parametrize(
    ("crs", "reason"),
    [
        ("EPSG:999999", "does not know"),
        ("nonsense", "does not know"),
        ("EPSG:4326", "no map grid"),
        ("EPSG:4978", "no map grid"),
        ("EPSG:2277", "foot"),
        ("EPSG:2154+5720", "height system"),
    ],
)
def test_only_map_grids_in_metres_are_taken(crs: str, reason: str) -> None:
    with pytest.raises(GeometryError, match=reason):
        require_map_grid(crs)


def test_a_grid_that_counts_south_and_west_is_refused() -> None:
    with pytest.raises(GeometryError, match="east and north"):
        GroundFrame.tangent("EPSG:2048", [(50_000.0, 3_700_000.0, 0.0)])


def gtx(path, undulation_m: float, slope_per_degree: float = 0.0):
    """A geoid grid of 5 x 5 nodes, degrees 1 to 5 east and 47 to 51 north (NOAA GTX, binary)."""
    rows = undulation_m + slope_per_degree * np.arange(5.0)[:, None] + np.zeros((5, 5))
    path.write_bytes(struct.pack(">4d2i", 47.0, 1.0, 1.0, 1.0, 5, 5) + rows.astype(">f4").tobytes())
    return path


def test_geoid_heights_are_added_to_orthometric_heights(tmp_path) -> None:
    grid = gtx(tmp_path / "geoid model.gtx", 45.0, 2.0)
    position = np.array([(500_000.0, 5_400_000.0, 100.0), (510_000.0, 5_410_000.0, 700.0)])
    orthometric = GroundFrame.tangent("EPSG:32631", position, grid)
    ellipsoidal = GroundFrame.tangent("EPSG:32631", position)
    _, latitude = Proj("EPSG:32631")(position[:, 0], position[:, 1], inverse=True)
    shifted = position + np.outer(45.0 + 2.0 * (latitude - 47.0), [0, 0, 1])
    assert np.allclose(
        orthometric.to_computing(position), ellipsoidal.to_computing(shifted), atol=1e-4
    )
    back = orthometric.to_crs(orthometric.to_computing(position))
    assert np.allclose(back, position, atol=2e-6, rtol=0)


def test_a_geoid_grid_that_is_none_is_refused(tmp_path) -> None:
    broken = tmp_path / "broken.gtx"
    broken.write_bytes(b"not a grid")
    with pytest.raises(GeometryError, match=r"geoid grid broken\.gtx"):
        GroundFrame.tangent("EPSG:32631", [(5e5, 5e6, 0.0)], broken)


def test_no_positions_have_no_mapping_but_break_nothing() -> None:
    """A block without check points asks for the axes at none."""
    frame = GroundFrame.tangent("EPSG:2154", [(700_000.0, 6_600_000.0, 0.0)])
    none = np.empty((0, 3))
    assert frame.to_computing(none).shape == frame.to_crs(none).shape == (0, 3)
    assert frame.computing_from_crs_axes(none).shape == (0, 3, 3)
    assert frame.convergence_rad(none).shape == (0,)
