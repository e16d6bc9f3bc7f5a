"""Simulated blocks of known truth: flight, terrain, points, image measurements, POS errors.

Everything is laid out in map coordinates (the crs, or Cartesian without one), mapped into the
computing frame, and imaged there through the exact central projection; occlusions are ignored.
Every purpose draws from a random stream of its own, so that changing one kind of noise leaves
the other draws, and the truth, as they were.
"""

from dataclasses import dataclass, replace
from itertools import count
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from posstats.block import Accuracy, Block, GroundPoints, Orientations, TiePoints
from posstats.camera import Camera
from posstats.errors import GeometryError
from posstats.flight_plan import FlightPlan, fly, footprint_m
from posstats.frames import GroundFrame, require_map_grid
from posstats.rotation import (
    angles_from_rotation,
    rotation_from_angles,
    rotation_from_vector,
    wrapped,
)
from posstats.scenario import AngleError, PointSpec, Scenario

_Floats = NDArray[np.float64]
_Ints = NDArray[np.intp]
_Ids = NDArray[np.object_]
_Bools = NDArray[np.bool_]

# New purposes go to the end: a stream is known by its place.
_PURPOSES = (
    "flight",
    "terrain",
    "tie points",
    "check points",
    "control points",
    "image",
    "blunders",
    "survey",
    "position",
    "attitude",
)
_TERRAIN_WAVES = 24
_MAX_TIE_POINTS = 5_000_000
_STEEPEST_RAY_RAD = np.radians(80.0)


def simulate(scenario: Scenario, seed: int | None = None) -> Block:
    """Simulate a block.

    Parameters
    ----------
    scenario
        What is flown and what errs; see `posstats.scenario.load_scenario`.
    seed
        Of the random numbers; the scenario's own where None. Equal seeds give equal blocks.

    Returns
    -------
    Block in the computing frame: `orientations` are the erroneous POS, `adjusted` is the truth,
    `simulated` is true. Ground points are given as surveyed (truth plus survey error).

    Raises
    ------
    GeometryError
        Where the scenario cannot be flown: terrain above the flight, images that look at the
        horizon, a crs that does not cover the block, millions of tie points.
    """
    streams = _streams(scenario.block.seed if seed is None else seed)
    plan = fly(scenario, streams["flight"])
    frame = _ground_frame(scenario, plan)
    truth = _true_orientations(scenario, plan, frame)
    surface = _Surface.random(scenario, streams["terrain"])
    points = _ground_points(scenario, plan, surface, frame, streams)
    camera = scenario.camera.camera
    reach_m = _reach_m(camera, plan, surface)
    tie_points = _measured(
        _imaged(points, truth, camera, reach_m), points, camera, scenario, streams
    )
    return Block(
        name=scenario.block.name,
        cameras=(camera,),
        orientations=_pos(scenario, truth, streams),
        tie_points=tie_points,
        frame=frame,
        accuracy=_stated_accuracy(scenario),
        ground_points=_surveyed(points, streams["survey"]),
        adjusted=truth,
        simulated=True,
        warnings=(*_short_strips(scenario), *_unseen(points, tie_points)),
    )


def _streams(seed: int) -> dict[str, np.random.Generator]:
    children = np.random.SeedSequence(seed).spawn(len(_PURPOSES))
    return {
        purpose: np.random.Generator(np.random.PCG64(child))
        for purpose, child in zip(_PURPOSES, children, strict=True)
    }


def _ground_frame(scenario: Scenario, plan: FlightPlan) -> GroundFrame:
    block = scenario.block
    if block.crs is None:
        return GroundFrame()
    require_map_grid(block.crs)
    if block.frame == "grid":
        return GroundFrame(block.crs)
    return GroundFrame.tangent(block.crs, plan.position_m)


def _to_computing(frame: GroundFrame, position_m: _Floats) -> _Floats:
    """Positions (n, 3) from map into computing coordinates, all of them inside the crs."""
    computing = frame.to_computing(position_m)
    if not np.isfinite(computing).all():
        raise GeometryError(f"the block reaches beyond the area of {frame.crs}")
    return computing


def _stated_accuracy(scenario: Scenario) -> Accuracy:
    stated = scenario.accuracy
    return Accuracy(stated.position_m, float(np.radians(stated.angle_deg)), stated.image_px)


def _true_orientations(scenario: Scenario, plan: FlightPlan, frame: GroundFrame) -> Orientations:
    rotation = frame.computing_from_crs_axes(plan.position_m) @ plan.map_from_image
    accuracy = _stated_accuracy(scenario)
    shape = plan.position_m.shape
    return Orientations(
        image=plan.image,
        strip=plan.strip,
        time_s=plan.time_s,
        position_m=_to_computing(frame, plan.position_m),
        angles_rad=angles_from_rotation(rotation, scenario.block.angles),
        camera=np.zeros(len(plan.image), dtype=np.intp),
        sigma_position_m=np.full(shape, accuracy.position_m),
        sigma_angles_rad=np.full(shape, accuracy.angle_rad),
        system=scenario.block.angles,
    )


# --- terrain and points -------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Surface:
    """Sum of plane waves of random direction and phase about a mean height."""

    mean_height_m: float
    amplitude_m: float
    wave_number: _Floats  # (waves, 2), rad/m
    phase_rad: _Floats  # (waves,)

    @classmethod
    def random(cls, scenario: Scenario, rng: np.random.Generator) -> "_Surface":
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

    def points(self, xy_m: _Floats) -> _Floats:
        """Points (n, 3) of the surface at (n, 2) map coordinates."""
        waves = np.cos(xy_m @ self.wave_number.T + self.phase_rad).sum(axis=1)
        return np.column_stack([xy_m, self.mean_height_m + self.amplitude_m * waves])


@dataclass(frozen=True, eq=False)
class _Points:
    """True ground points of all kinds in the computing frame, sorted by id."""

    id: _Ids
    position_m: _Floats
    kind: _Ids  # "check", "control", "tie"
    image_sigma_px: _Floats
    survey_sigma_m: _Floats

    def __len__(self) -> int:
        return len(self.id)


def _ground_points(
    scenario: Scenario,
    plan: FlightPlan,
    surface: _Surface,
    frame: GroundFrame,
    streams: dict[str, np.random.Generator],
) -> _Points:
    checks = _spread(scenario.check_points, plan, scenario, streams["check points"])
    controls = _spread(scenario.control_points, plan, scenario, streams["control points"])
    ties = _tie_grid(scenario, plan, streams["tie points"])
    counts = (len(checks), len(controls), len(ties))
    specs = (scenario.check_points, scenario.control_points)
    position = surface.points(np.concatenate([checks, controls, ties]))
    if position[:, 2].max() >= plan.position_m[:, 2].min():
        raise GeometryError("the terrain rises above the flight: lower relief_m or fly higher")
    return _Points(
        # Text order is the order of the kinds: C(heck), G(round control), T(ie).
        id=np.concatenate([_ids(kind, n) for kind, n in zip("CGT", counts, strict=True)]),
        position_m=_to_computing(frame, position),
        kind=np.repeat(np.array(["check", "control", "tie"], dtype=object), counts),
        image_sigma_px=np.repeat([s.image_px for s in specs] + [scenario.errors.image_px], counts),
        survey_sigma_m=np.repeat([s.ground_m for s in specs] + [0.0], counts),
    )


def _ids(letter: str, n: int) -> _Ids:
    digits = len(str(n))
    return np.array([f"{letter}{i:0{digits}d}" for i in range(1, n + 1)], dtype=object)


def _tie_grid(scenario: Scenario, plan: FlightPlan, rng: np.random.Generator) -> _Floats:
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
    grid: _Floats = low + cell * (index + rng.uniform(size=index.shape))
    return grid


def _spread(
    spec: PointSpec, plan: FlightPlan, scenario: Scenario, rng: np.random.Generator
) -> _Floats:
    """Map coordinates (n, 2) of surveyed points over the projection centres' rectangle."""
    along, across = footprint_m(scenario)
    axes, low, high = plan.rectangle(least_size_m=0.5 * np.array([along, across]))
    if spec.distribution == "random":
        share = rng.uniform(size=(spec.n, 2))
    else:
        share = _even_shares(spec.n, high - low, spec.distribution)
    spread: _Floats = (low + share * (high - low)) @ axes
    return spread


def _even_shares(n: int, size_m: _Floats, distribution: Literal["grid", "corners"]) -> _Floats:
    """Even spread (n, 2) over a unit square that stands for a rectangle of `size_m`."""
    if n == 0:
        return np.empty((0, 2))
    lines = min(max(1, round(np.sqrt(n * size_m[1] / size_m[0]))), n)
    if distribution == "corners" and n >= 4:
        lines = min(max(2, lines), n // 2)
    per_line = [len(part) for part in np.array_split(np.arange(n), lines)]
    across = _even(lines, distribution)
    return np.array(
        [(u, v) for v, m in zip(across, per_line, strict=True) for u in _even(m, distribution)]
    )


def _even(n: int, distribution: Literal["grid", "corners"]) -> _Floats:
    if distribution == "corners" and n > 1:
        return np.linspace(0.0, 1.0, n)
    return (np.arange(n) + 0.5) / n


# --- imaging ------------------------------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Rays:
    """Which point lies in which image, and where: ideal x, y in px; sorted by point, image."""

    point: _Ints
    image: _Ints
    xy_px: _Floats


def _reach_m(camera: Camera, plan: FlightPlan, surface: _Surface) -> _Floats:
    """Upper bound (n,) of the slant distance from an image to anything it shows."""
    rays = np.column_stack([_format_corners(camera), np.full(4, -camera.principal_distance_px)])
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    cosine = (-(plan.map_from_image @ rays.T)[:, 2]).min(axis=1)
    if (cosine < np.cos(_STEEPEST_RAY_RAD)).any():
        raise GeometryError("the tilts turn image corners towards the horizon: lower tilt_rad")
    above = plan.position_m[:, 2] - surface.lowest_m
    reach: _Floats = 1.02 * above / cosine
    return reach


def _imaged(points: _Points, truth: Orientations, camera: Camera, reach_m: _Floats) -> _Rays:
    """Points inside the image format; tie points in two images or more."""
    near = cKDTree(points.position_m).query_ball_point(truth.position_m, reach_m)
    image = np.repeat(np.arange(len(truth)), [len(found) for found in near])
    point = np.fromiter((p for found in near for p in found), dtype=np.intp, count=len(image))
    xy, inside = _projected(points.position_m[point], truth, image, camera)
    point, image, xy = point[inside], image[inside], xy[inside]
    n_rays = np.bincount(point, minlength=len(points))
    wanted = ((points.kind != "tie") | (n_rays >= 2))[point]
    order = np.flatnonzero(wanted)[np.lexsort((image[wanted], point[wanted]))]
    return _Rays(point[order], image[order], xy[order])


def _projected(
    position_m: _Floats, truth: Orientations, image: _Ints, camera: Camera
) -> tuple[_Floats, _Bools]:
    """Ideal (m, 2) image coordinates, px, and (m,) whether they are inside the format."""
    ray = position_m - truth.position_m[image]
    vector = np.einsum("mij,mi->mj", truth.ground_from_image[image], ray)
    in_front = vector[:, 2] < 0.0
    depth = np.where(in_front, -vector[:, 2], np.inf)
    xy = vector[:, :2] * (camera.principal_distance_px / depth)[:, None]
    # Beyond the corners a distortion polynomial may fold back into the image.
    farthest = np.hypot(*_format_corners(camera).T).max()
    possible = in_front & (np.hypot(*xy.T) <= farthest)
    return xy, np.asarray(possible & _in_format(camera.measured_from_ideal(xy), camera).all(axis=1))


def _in_format(measured_px: _Floats, camera: Camera) -> _Bools:
    """Whether columns and rows (m, 2) are inside the image, each for itself."""
    return (measured_px >= 0.0) & (measured_px <= [camera.width_px, camera.height_px])


def _format_corners(camera: Camera) -> _Floats:
    """Ideal (4, 2) coordinates of the image's corners, px."""
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    return camera.ideal_from_measured(corners * [camera.width_px, camera.height_px])


def _measured(
    rays: _Rays,
    points: _Points,
    camera: Camera,
    scenario: Scenario,
    streams: dict[str, np.random.Generator],
) -> TiePoints:
    """The image measurements, with noise and blunders as they arise: in measured pixels."""
    true_px = camera.measured_from_ideal(rays.xy_px)
    noise = points.image_sigma_px[rays.point][:, None] * streams["image"].normal(size=true_px.shape)
    shift = noise + _blunders(rays, points, camera, scenario, streams["blunders"])
    xy = rays.xy_px.copy()
    moved = shift.any(axis=1)
    xy[moved] = camera.ideal_from_measured(true_px[moved] + shift[moved])
    used, point = np.unique(rays.point, return_inverse=True)
    if not (points.kind[used] == "tie").any():
        raise GeometryError("no tie point lies in two images: more images, overlap or per_model")
    return TiePoints(points.id[used], point.astype(np.intp), rays.image, xy)


def _blunders(
    rays: _Rays, points: _Points, camera: Camera, scenario: Scenario, rng: np.random.Generator
) -> _Floats:
    """Shifts (m, 2), px, of the tie-point measurements that are blunders, 0 elsewhere."""
    errors = scenario.errors
    chosen = (rng.uniform(size=len(rays.point)) < errors.blunder_share) & (
        points.kind[rays.point] == "tie"
    )
    direction = rng.uniform(0.0, 2.0 * np.pi, len(rays.point))
    shift = errors.blunder_px * np.column_stack([np.cos(direction), np.sin(direction)])
    # A measurement stays in its image: shifts that lead out of it are reversed.
    stays = _in_format(camera.measured_from_ideal(rays.xy_px) + shift, camera)
    return np.where(chosen[:, None], np.where(stays, shift, -shift), 0.0)


# --- POS errors, survey -------------------------------------------------------------------------


def _pos(
    scenario: Scenario, truth: Orientations, streams: dict[str, np.random.Generator]
) -> Orientations:
    errors = scenario.errors
    ground = _angle_errors(truth, (errors.omega, errors.phi, errors.kappa), streams["attitude"])
    camera = _angle_errors(truth, (errors.pitch, errors.roll, errors.yaw), streams["attitude"])
    angles = truth.angles_rad + ground
    if camera.any():
        turned = rotation_from_angles(angles, truth.system) @ rotation_from_vector(camera)
        angles = angles_from_rotation(turned, truth.system)
    position = truth.position_m + _position_errors(scenario, truth, streams["position"])
    return replace(truth, position_m=position, angles_rad=wrapped(angles))


def _angle_errors(
    truth: Orientations, models: tuple[AngleError, ...], rng: np.random.Generator
) -> _Floats:
    """Errors (n, 3), rad: constant + drift (t - t first) + strip constant + white noise."""
    strip = _strip_index(truth)
    since_s = truth.time_s - truth.time_s[0]
    of_strip = rng.normal(size=(len(truth.strips), 3))[strip]
    white = rng.normal(size=(len(truth), 3))
    return np.column_stack(
        [
            model.constant_rad
            + model.drift_rad_per_s * since_s
            + model.strip_rad * of_strip[:, i]
            + model.noise_rad * white[:, i]
            for i, model in enumerate(models)
        ]
    )


def _position_errors(scenario: Scenario, truth: Orientations, rng: np.random.Generator) -> _Floats:
    """Errors (n, 3), m: shift and drift of each strip, and white noise."""
    model = scenario.errors.position
    strip = _strip_index(truth)
    first_s = np.array([truth.time_s[strip == s].min() for s in range(len(truth.strips))])
    shift = rng.normal(size=(len(first_s), 3))[strip]
    drift = rng.normal(size=(len(first_s), 3))[strip] * (truth.time_s - first_s[strip])[:, None]
    white = rng.normal(size=(len(truth), 3))
    total: _Floats = (
        model.strip_shift_m * shift + model.strip_drift_m_per_s * drift + model.noise_m * white
    )
    return total


def _strip_index(truth: Orientations) -> _Ints:
    number = dict(zip(truth.strips, count(), strict=False))
    return np.array([number[strip] for strip in truth.strip], dtype=np.intp)


def _surveyed(points: _Points, rng: np.random.Generator) -> GroundPoints | None:
    ground = np.flatnonzero(points.kind != "tie")
    if len(ground) == 0:
        return None
    sigma = points.survey_sigma_m[ground]
    stated = np.where(sigma > 0.0, sigma, np.nan)
    return GroundPoints(
        point=points.id[ground],
        position_m=points.position_m[ground] + sigma[:, None] * rng.normal(size=(len(ground), 3)),
        is_check=points.kind[ground] == "check",
        sigma_xy_m=stated,
        sigma_z_m=stated.copy(),
    )


# --- notes --------------------------------------------------------------------------------------


def _short_strips(scenario: Scenario) -> tuple[str, ...]:
    short = sum(n == 1 for n in scenario.flight.image_counts)
    return (f"{short} strips of one image: no stereo models there",) if short else ()


def _unseen(points: _Points, tie_points: TiePoints) -> tuple[str, ...]:
    """Surveyed points that cannot be intersected."""
    rays = dict(
        zip(
            tie_points.point_id,
            np.bincount(tie_points.point, minlength=len(tie_points.point_id)),
            strict=True,
        )
    )
    ground = points.id[points.kind != "tie"]
    unseen = [point for point in ground if rays.get(point, 0) < 2]
    if not unseen:
        return ()
    return (f"ground points seen in fewer than two images: {', '.join(unseen)}",)
