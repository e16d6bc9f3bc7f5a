"""Where and when a simulated block exposes: strips, headings, overlaps, times, tilts."""

from dataclasses import dataclass

import numpy as np

from posstats.arrays import Bools, Floats, Ids, Ints
from posstats.numerics.kernels.rotation import rotation_from_angles
from posstats.synthetic.scenario import Scenario

_PARALLEL_DEG = 1e-6


@dataclass(frozen=True, eq=False)
class FlightPlan:
    """Exposures of n images in map coordinates, in order of time.

    Attributes
    ----------
    image, strip
        (n,) ids.
    time_s
        (n,) exposure times.
    planned_xy_m
        (n, 2) easting and northing without jitter.
    position_m
        (n, 3) true projection centres: easting, northing, height.
    map_from_image
        (n, 3, 3) true rotations into the local grid axes.
    heading_rad
        (n,) flight direction, clockwise from grid north.
    """

    image: Ids
    strip: Ids
    time_s: Floats
    planned_xy_m: Floats
    position_m: Floats
    map_from_image: Floats
    heading_rad: Floats

    @property
    def _parallel_to_first(self) -> Bools:
        return np.asarray(np.abs(np.sin(self.heading_rad - self.heading_rad[0])) < 1e-6)

    @property
    def n_parallel_strips(self) -> int:
        """Number of strips parallel to the first, with it."""
        return len(set(self.strip[self._parallel_to_first]))

    def rectangle(self, least_size_m: Floats) -> tuple[Floats, Floats, Floats]:
        """Rectangle over the planned exposures of the strips parallel to the first.

        Parameters
        ----------
        least_size_m
            (2,) smallest size along and across the flight, for blocks of one strip or image.

        Returns
        -------
        axes (2, 2) unit vectors along and across; lower and upper corner (2,) in these axes.
        """
        axes = np.stack([_forward(self.heading_rad[0]), _right(self.heading_rad[0])])
        plane = self.planned_xy_m[self._parallel_to_first] @ axes.T
        low, high = plane.min(axis=0), plane.max(axis=0)
        lacking = 0.5 * np.maximum(least_size_m - (high - low), 0.0)
        return axes, low - lacking, high + lacking


def footprint_m(scenario: Scenario) -> tuple[float, float]:
    """Size of a vertical image on the mean terrain, along and across the flight."""
    camera = scenario.camera.camera
    scale = scenario.height_m / camera.principal_distance_px
    return camera.height_px * scale, camera.width_px * scale


def fly(scenario: Scenario, rng: np.random.Generator) -> FlightPlan:
    """The flight of a scenario, with jitter of the positions and tilts drawn from `rng`."""
    flight = scenario.flight
    counts = np.array(flight.image_counts)
    n = int(counts.sum())
    strip = np.repeat(np.arange(len(counts)), counts)
    in_strip = np.arange(n) - np.repeat(np.cumsum(counts) - counts, counts)
    headings = np.radians(np.resize(np.array(flight.headings_deg), len(counts)))
    along, across = footprint_m(scenario)
    base = along * (1.0 - flight.forward_overlap)
    start = _strip_middles(headings, across * (1.0 - flight.side_overlap))
    advance = (in_strip - 0.5 * (counts[strip] - 1)) * base
    planned = scenario.block.origin_m + start[strip] + advance[:, None] * _forward(headings[strip])
    height = scenario.terrain.mean_height_m + scenario.height_m
    jitter = flight.position_jitter_m * rng.normal(size=(n, 3))
    return FlightPlan(
        image=_image_ids(strip, in_strip),
        strip=_strip_ids(strip),
        time_s=_times(counts, strip, in_strip, base, scenario),
        planned_xy_m=planned,
        position_m=np.column_stack([planned, np.full(n, height)]) + jitter,
        map_from_image=_attitudes(headings[strip], flight.tilt_rad * rng.normal(size=(n, 3))),
        heading_rad=headings[strip],
    )


def _forward(heading_rad: Floats) -> Floats:
    """Unit vectors (..., 2), east and north, of headings clockwise from north."""
    return np.stack([np.sin(heading_rad), np.cos(heading_rad)], axis=-1)


def _right(heading_rad: Floats) -> Floats:
    return np.stack([np.cos(heading_rad), -np.sin(heading_rad)], axis=-1)


def _strip_middles(headings_rad: Floats, spacing_m: float) -> Floats:
    """Middles (strips, 2) about the origin; parallel strips side by side, each axis centred."""
    axis = np.round(np.degrees(headings_rad) / _PARALLEL_DEG).astype(np.int64)
    axis %= round(180.0 / _PARALLEL_DEG)
    middles = np.empty((len(axis), 2))
    for one in np.unique(axis):
        members = np.flatnonzero(axis == one)
        offset = (np.arange(len(members)) - 0.5 * (len(members) - 1)) * spacing_m
        # Strips flown back share the side of the strips flown forth.
        middles[members] = offset[:, None] * _right(np.radians(one * _PARALLEL_DEG))
    return middles


def _times(
    counts: Ints,
    strip: Ints,
    in_strip: Ints,
    base_m: float,
    scenario: Scenario,
) -> Floats:
    """Exposure times (n,): constant speed in the strips, a turn between them."""
    flight = scenario.flight
    interval = base_m / flight.speed_m_per_s
    duration = (counts - 1) * interval + flight.turn_s
    begin = flight.start_time_s + np.cumsum(duration) - duration
    time: Floats = begin[strip] + in_strip * interval
    return time


def _attitudes(heading_rad: Floats, tilt_rad: Floats) -> Floats:
    """Rotations (n, 3, 3) map_from_image: image y forward, turned by (n, 3) tilts."""
    angles = tilt_rad.copy()
    angles[:, 2] -= heading_rad
    return rotation_from_angles(angles, "omega-phi-kappa")


def _strip_ids(strip: Ints) -> Ids:
    """Numbers from 1, of equal length so that text order is order of flight."""
    digits = len(str(strip.max() + 1))
    return np.array([f"{s + 1:0{digits}d}" for s in strip], dtype=object)


def _image_ids(strip: Ints, in_strip: Ints) -> Ids:
    digits = len(str(in_strip.max() + 1))
    numbers = [f"{i + 1:0{digits}d}" for i in in_strip]
    return np.array(
        [f"{s}-{i}" for s, i in zip(_strip_ids(strip), numbers, strict=True)], dtype=object
    )
