"""The ground of a simulated block: terrain, tie points, check and control points."""

from dataclasses import dataclass

import numpy as np

from posstats.arrays import Floats, Ids
from posstats.block.frames import GroundFrame
from posstats.errors import GeometryError
from posstats.synthetic.flight_plan import FlightPlan, footprint_m
from posstats.synthetic.scenario import PointSpec, Scenario
from posstats.synthetic.streams import Streams

_TERRAIN_WAVES = 24
_MAX_TIE_POINTS = 5_000_000


def to_computing(frame: GroundFrame, position_m: Floats) -> Floats:
    """Positions (n, 3) from map into computing coordinates, all of them inside the crs."""
    computing = frame.to_computing(position_m)
    if not np.isfinite(computing).all():
        raise GeometryError(f"the block reaches beyond the area of {frame.crs}")
    return computing


@dataclass(frozen=True, eq=False)
class Surface:
    """Sum of plane waves of random direction and phase about a mean height."""

    mean_height_m: float
    amplitude_m: float
    wave_number: Floats  # (waves, 2), rad/m
    phase_rad: Floats  # (waves,)

    @classmethod
    def random(cls, scenario: Scenario, rng: np.random.Generator) -> "Surface":
        """The scenario's terrain; wavelengths of 0.5 to 1.5 of the given one."""
        terrain = scenario.terrain
        azimuth = rng.uniform(0.0, 2.0 * np.pi, _TERRAIN_WAVES)
        length = terrain.wavelength_m * rng.uniform(0.5, 1.5, _TERRAIN_WAVES)
        direction = np.column_stack([np.cos(azimuth), np.sin(azimuth)])
        return cls(
            mean_height_m=terrain.mean_height_m,
            amplitude_m=terrain.relief_m / np.sqrt(_TERRAIN_WAVES),
            wave_number=direction * (2.0 * np.pi / length)[:, None],
            phase_rad=rng.uniform(0.0, 2.0 * np.pi, _TERRAIN_WAVES),
        )

    @property
    def lowest_m(self) -> float:
        """A height below all of the surface."""
        return self.mean_height_m - self.amplitude_m * len(self.phase_rad)

    def points(self, xy_m: Floats) -> Floats:
        """Points (n, 3) of the surface at (n, 2) map coordinates."""
        waves = xy_m @ self.wave_number.T
        waves += self.phase_rad
        height = self.mean_height_m + self.amplitude_m * np.cos(waves, out=waves).sum(axis=1)
        return np.column_stack([xy_m, height])


@dataclass(frozen=True, eq=False)
class TruePoints:
    """True ground points of all kinds in the computing frame, sorted by id."""

    id: Ids
    position_m: Floats
    kind: Ids  # "check", "control", "tie"
    image_sigma_px: Floats
    survey_sigma_m: Floats

    def __len__(self) -> int:
        return len(self.id)


def true_points(
    scenario: Scenario,
    plan: FlightPlan,
    surface: Surface,
    frame: GroundFrame,
    streams: Streams,
) -> TruePoints:
    """All points of the block at their true places, those of the survey first.

    Raises
    ------
    GeometryError
        Where terrain and flight meet, a point is outside the crs, or there are millions of them.
    """
    checks = _spread(scenario.check_points, plan, scenario, streams["check points"])
    controls = _spread(scenario.control_points, plan, scenario, streams["control points"])
    ties = _tie_grid(scenario, plan, streams["tie points"])
    counts = (len(checks), len(controls), len(ties))
    specs = (scenario.check_points, scenario.control_points)
    position = surface.points(np.concatenate([checks, controls, ties]))
    if position[:, 2].max() >= plan.position_m[:, 2].min():
        raise GeometryError("the terrain rises above the flight: lower relief_m or fly higher")
    return TruePoints(
        # Text order is the order of the kinds: C(heck), G(round control), T(ie).
        id=np.concatenate([_ids(kind, n) for kind, n in zip("CGT", counts, strict=True)]),
        position_m=to_computing(frame, position),
        kind=np.repeat(np.array(["check", "control", "tie"], dtype=object), counts),
        image_sigma_px=np.repeat([s.image_px for s in specs] + [scenario.errors.image_px], counts),
        survey_sigma_m=np.repeat([s.ground_m for s in specs] + [0.0], counts),
    )


def _ids(letter: str, n: int) -> Ids:
    digits = len(str(n))
    return np.array([f"{letter}{i:0{digits}d}" for i in range(1, n + 1)], dtype=object)


def _tie_grid(scenario: Scenario, plan: FlightPlan, rng: np.random.Generator) -> Floats:
    """Map coordinates (n, 2): one point at random in every cell of a grid under the block."""
    along, across = footprint_m(scenario)
    model_area = along * across * scenario.flight.forward_overlap
    cell = np.sqrt(model_area / scenario.tie_points.per_model)
    margin = 0.75 * np.hypot(along, across)
    low = plan.position_m[:, :2].min(axis=0) - margin
    size = plan.position_m[:, :2].max(axis=0) + margin - low
    if np.prod(size) / cell**2 > _MAX_TIE_POINTS:
        raise GeometryError(
            f"the block would have {np.prod(size) / cell**2:.2g} tie points; at most "
            f"{_MAX_TIE_POINTS:.0e} can be simulated: lower [tie_points] per_model"
        )
    columns, rows = np.ceil(size / cell).astype(int)
    index = np.stack(np.meshgrid(np.arange(columns), np.arange(rows)), axis=-1).reshape(-1, 2)
    grid: Floats = low + cell * (index + rng.uniform(size=index.shape))
    return grid


def _spread(
    spec: PointSpec, plan: FlightPlan, scenario: Scenario, rng: np.random.Generator
) -> Floats:
    """Map coordinates (n, 2) of surveyed points over the projection centres' rectangle."""
    along, across = footprint_m(scenario)
    axes, low, high = plan.rectangle(least_size_m=0.5 * np.array([along, across]))
    if spec.distribution == "random":
        share = rng.uniform(size=(spec.n, 2))
    else:
        share = _even_shares(spec, high - low, plan.n_parallel_strips)
    spread: Floats = (low + share * (high - low)) @ axes
    return spread


def _even_shares(spec: PointSpec, size_m: Floats, n_strips: int) -> Floats:
    """Even spread (n, 2) over a unit square that stands for a rectangle of `size_m`."""
    if spec.n == 0:
        return np.empty((0, 2))
    lines = _lines(spec, size_m, n_strips)
    per_line = [len(part) for part in np.array_split(np.arange(spec.n), len(lines))]
    spaced = _edge_to_edge if spec.distribution == "corners" else _cell_centres
    return np.array(
        [(u, v) for v, m in zip(lines, per_line, strict=True) for u in spaced(m)],
    )


def _lines(spec: PointSpec, size_m: Floats, n_strips: int) -> Floats:
    """Places (lines,) across the flight of lines of points along it."""
    if spec.distribution == "side-overlap":
        overlaps = max(n_strips - 1, 1)
        used = np.floor(_cell_centres(min(spec.n, overlaps)) * overlaps)
        return np.asarray((used + 0.5) / overlaps)
    square = min(max(1, round(np.sqrt(spec.n * size_m[1] / size_m[0]))), spec.n)
    if spec.distribution == "grid":
        return _cell_centres(square)
    return _edge_to_edge(min(max(2, square), spec.n // 2) if spec.n >= 4 else square)


def _cell_centres(n: int) -> Floats:
    return (np.arange(n) + 0.5) / n


def _edge_to_edge(n: int) -> Floats:
    return np.linspace(0.0, 1.0, n) if n > 1 else np.array([0.5])
