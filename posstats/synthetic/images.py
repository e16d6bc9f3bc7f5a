"""The images of a simulated block: which points they show, and how they are measured."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from posstats.arrays import Bools, Floats, Ints
from posstats.block.camera import Camera
from posstats.block.model import Orientations, TiePoints
from posstats.errors import GeometryError
from posstats.synthetic.flight_plan import FlightPlan
from posstats.synthetic.ground import Surface, TruePoints
from posstats.synthetic.scenario import Scenario
from posstats.synthetic.streams import Streams

_STEEPEST_RAY_RAD = np.radians(80.0)


@dataclass(frozen=True, eq=False)
class Rays:
    """Which point lies in which image, and where: ideal x, y in px; sorted by point, image."""

    point: Ints
    image: Ints
    xy_px: Floats


def reach_m(camera: Camera, plan: FlightPlan, surface: Surface) -> Floats:
    """Upper bound (n,) of the slant distance from an image to anything it shows."""
    rays = np.column_stack([_format_corners(camera), np.full(4, -camera.principal_distance_px)])
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    cosine = (-(plan.map_from_image @ rays.T)[:, 2]).min(axis=1)
    if (cosine < np.cos(_STEEPEST_RAY_RAD)).any():
        raise GeometryError("the tilts turn image corners towards the horizon: lower tilt_rad")
    above = plan.position_m[:, 2] - surface.lowest_m
    # 2 % for the curvature and the scale of map grids.
    reach: Floats = 1.02 * above / cosine
    return reach


def imaged(points: TruePoints, truth: Orientations, camera: Camera, reach_m: Floats) -> Rays:
    """Points inside the image format; tie points in two images or more."""
    tree, rotation = cKDTree(points.position_m), truth.ground_from_image
    seen = []
    for centre_m, ground_from_image, radius_m in zip(
        truth.position_m, rotation, reach_m, strict=True
    ):
        near = np.array(tree.query_ball_point(centre_m, radius_m), dtype=np.intp)
        vector = np.einsum("ij,mi->mj", ground_from_image, points.position_m[near] - centre_m)
        xy_px, inside = _projected(vector, camera)
        seen.append((near[inside], xy_px[inside]))
    image = np.repeat(np.arange(len(truth)), [len(numbers) for numbers, _ in seen])
    point, xy = (np.concatenate(parts) for parts in zip(*seen, strict=True))
    n_rays = np.bincount(point, minlength=len(points))
    wanted = ((points.kind != "tie") | (n_rays >= 2))[point]
    order = np.flatnonzero(wanted)[np.lexsort((image[wanted], point[wanted]))]
    return Rays(point[order], image[order], xy[order])


def _projected(vector: Floats, camera: Camera) -> tuple[Floats, Bools]:
    """Ideal (m, 2) image coordinates, px, and (m,) whether they are inside the format.

    `vector` (m, 3) leads from the projection centre to the points, in the axes of the image.
    """
    in_front = vector[:, 2] < 0.0
    depth = np.where(in_front, -vector[:, 2], np.inf)
    xy = vector[:, :2] * (camera.principal_distance_px / depth)[:, None]
    # Beyond the corners a distortion polynomial may fold back into the image.
    farthest = np.hypot(*_format_corners(camera).T).max()
    possible = in_front & (np.hypot(*xy.T) <= farthest)
    return xy, np.asarray(possible & _in_format(camera.measured_from_ideal(xy), camera).all(axis=1))


def _in_format(measured_px: Floats, camera: Camera) -> Bools:
    """Whether columns and rows (m, 2) are inside the image, each for itself."""
    return (measured_px >= 0.0) & (measured_px <= [camera.width_px, camera.height_px])


def _format_corners(camera: Camera) -> Floats:
    """Ideal (4, 2) coordinates of the image's corners, px."""
    corners = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]])
    return camera.ideal_from_measured(corners * [camera.width_px, camera.height_px])


def measured(
    rays: Rays,
    points: TruePoints,
    camera: Camera,
    scenario: Scenario,
    streams: Streams,
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
    rays: Rays, points: TruePoints, camera: Camera, scenario: Scenario, rng: np.random.Generator
) -> Floats:
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
