"""Simulated blocks of known truth: flight, terrain, points, image measurements, POS errors.

Everything is laid out in map coordinates (the crs, or Cartesian without one), mapped into the
computing frame, and imaged there through the exact central projection; occlusions are ignored.
"""

from dataclasses import replace

import numpy as np

from posstats.arrays import Floats, Ints
from posstats.block.frames import GroundFrame, require_map_grid
from posstats.block.model import Accuracy, Block, GroundPoints, Orientations
from posstats.formats.block_notices import block_notices
from posstats.numerics.kernels.rotation import (
    angles_from_rotation,
    rotation_from_angles,
    rotation_from_vector,
    wrapped,
)
from posstats.synthetic.flight_plan import FlightPlan, fly
from posstats.synthetic.ground import Surface, TruePoints, to_computing, true_points
from posstats.synthetic.images import imaged, measured, reach_m
from posstats.synthetic.scenario import AngleError, Scenario
from posstats.synthetic.streams import Streams, random_streams


def simulate(scenario: Scenario, seed: int | None = None) -> Block:
    """Simulate a block.

    Parameters
    ----------
    scenario
        What is flown and what errs; see `posstats.synthetic.scenario.load_scenario`.
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
    streams = random_streams(scenario.block.seed if seed is None else seed)
    plan = fly(scenario, streams["flight"])
    frame = _ground_frame(scenario, plan)
    truth = _true_orientations(scenario, plan, frame)
    surface = Surface.random(scenario, streams["terrain"])
    points = true_points(scenario, plan, surface, frame, streams)
    camera = scenario.camera.camera
    rays = imaged(points, truth, camera, reach_m(camera, plan, surface))
    block = Block(
        name=scenario.block.name,
        cameras=(camera,),
        orientations=_pos(scenario, truth, streams),
        tie_points=measured(rays, points, camera, scenario, streams),
        frame=frame,
        accuracy=_stated_accuracy(scenario),
        ground_points=_surveyed(points, streams["survey"]),
        adjusted=truth,
        simulated=True,
    )
    return replace(block, notices=block_notices(block))


def _ground_frame(scenario: Scenario, plan: FlightPlan) -> GroundFrame:
    block = scenario.block
    if block.crs is None:
        return GroundFrame()
    require_map_grid(block.crs)
    if block.frame == "grid":
        return GroundFrame(block.crs)
    return GroundFrame.tangent(block.crs, plan.position_m)


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
        position_m=to_computing(frame, plan.position_m),
        angles_rad=angles_from_rotation(rotation, scenario.block.angles),
        camera=np.zeros(len(plan.image), dtype=np.intp),
        sigma_position_m=np.full(shape, accuracy.position_m),
        sigma_angles_rad=np.full(shape, accuracy.angle_rad),
        system=scenario.block.angles,
    )


def _pos(scenario: Scenario, truth: Orientations, streams: Streams) -> Orientations:
    errors = scenario.errors
    ground = _angle_errors(truth, (errors.omega, errors.phi, errors.kappa), streams)
    camera = _angle_errors(truth, (errors.pitch, errors.roll, errors.yaw), streams)
    angles = truth.angles_rad + ground
    if camera.any():
        turned = rotation_from_angles(angles, truth.system) @ rotation_from_vector(camera)
        angles = angles_from_rotation(turned, truth.system)
    antenna = truth.ground_from_image @ np.array(errors.position.lever_arm_m)
    position = truth.position_m + antenna + _position_errors(scenario, truth, streams["position"])
    return replace(truth, position_m=position, angles_rad=wrapped(angles))


def _angle_errors(truth: Orientations, models: tuple[AngleError, ...], streams: Streams) -> Floats:
    """Errors (n, 3), rad: constant + drift (t - t first), the same of each strip, white noise."""
    strip = _strip_index(truth)
    n_strips = len(truth.strips)
    since_s = truth.time_s - truth.time_s[0]
    of_strip = streams["attitude"].normal(size=(n_strips, 3))[strip]
    white = streams["attitude"].normal(size=(len(truth), 3))
    drift = streams["attitude drift"].normal(size=(n_strips, 3))[strip]
    drift *= _since_first_of_strip(truth)[:, None]
    return np.column_stack(
        [
            model.constant_rad
            + model.drift_rad_per_s * since_s
            + model.strip_rad * of_strip[:, i]
            + model.strip_drift_rad_per_s * drift[:, i]
            + model.noise_rad * white[:, i]
            for i, model in enumerate(models)
        ]
    )


def _position_errors(scenario: Scenario, truth: Orientations, rng: np.random.Generator) -> Floats:
    """Errors (n, 3), m: shift and drift of each strip, and white noise."""
    model = scenario.errors.position
    strip, n_strips = _strip_index(truth), len(truth.strips)
    shift = rng.normal(size=(n_strips, 3))[strip]
    drift = rng.normal(size=(n_strips, 3))[strip] * _since_first_of_strip(truth)[:, None]
    white = rng.normal(size=(len(truth), 3))
    total: Floats = (
        model.strip_shift_m * shift + model.strip_drift_m_per_s * drift + model.noise_m * white
    )
    return total


def _since_first_of_strip(truth: Orientations) -> Floats:
    """(n,) seconds since the first exposure of the image's strip."""
    strip = _strip_index(truth)
    first_s = np.array([truth.time_s[strip == s].min() for s in range(len(truth.strips))])
    since_s: Floats = truth.time_s - first_s[strip]
    return since_s


def _strip_index(truth: Orientations) -> Ints:
    number = {strip: i for i, strip in enumerate(truth.strips)}
    return np.array([number[strip] for strip in truth.strip], dtype=np.intp)


def _surveyed(points: TruePoints, rng: np.random.Generator) -> GroundPoints | None:
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
