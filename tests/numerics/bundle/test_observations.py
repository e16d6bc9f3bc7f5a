"""POS observations: definitions written out, and differences."""

import numpy as np
import pytest

from posstats.errors import GeometryError
from posstats.numerics.bundle.parameters import (
    BORESIGHT,
    GNSS_DRIFTS,
    GNSS_SHIFTS,
    IMU_DRIFTS,
    IMU_SHIFTS,
    LEVER_ARM,
    CommonParameter,
    Exposures,
    drift_parameters,
    parameter_effects,
)
from posstats.numerics.bundle.pos_observations import PosObservations, linearised_pos
from posstats.numerics.kernels.rotation import (
    axis_rotation,
    rotation_from_angles,
    rotation_from_vector,
)

N = 6
EXPOSURES = Exposures(
    np.array([100.0, 105.0, 110.0, 400.0, 405.0, 410.0]),
    np.array(["a", "a", "a", "b", "b", "b"], dtype=object),
    np.array([0, 1, 0, 1, 0, 1]),
    ("left", "right"),
)
PARAMETERS = (
    *drift_parameters((*GNSS_SHIFTS, *GNSS_DRIFTS), ("a", "b"), 0.3),
    *drift_parameters(IMU_SHIFTS, ("block",), 1e-3),
    *drift_parameters(IMU_DRIFTS, ("a", "b")),
    *(CommonParameter(name) for name in (*LEVER_ARM, *BORESIGHT)),
)


def observed(system):
    rng = np.random.default_rng(1)
    angles = rng.uniform([-0.5, -0.5, 1.5], [0.5, 0.5, 2.5], (N, 3))
    return PosObservations(
        rng.uniform(0.0, 1e4, (N, 3)), np.full((N, 3), 0.1), angles, np.full((N, 3), 1e-4), system
    )


def state(seed, system):
    rng = np.random.default_rng(seed)
    obs = observed(system)
    rotation = rotation_from_angles(obs.angles_rad + 0.01 * rng.standard_normal((N, 3)), system)
    position = obs.antenna_m + rng.standard_normal((N, 3))
    scale = [1e-3 if "drift" in p.name or "imu" in p.name else 0.05 for p in PARAMETERS]
    return rotation, position, scale * rng.standard_normal(len(PARAMETERS))


@pytest.mark.parametrize("system", ["omega-phi-kappa", "phi-omega-kappa"])
def test_residuals_are_those_of_equations_3_5_7_and_8(system):
    obs = observed(system)
    rotation, position, common = state(2, system)
    value = {(p.name, p.scope): c for p, c in zip(PARAMETERS, common, strict=True)}
    result = linearised_pos(
        obs, rotation, position, parameter_effects(PARAMETERS, EXPOSURES), common
    )
    roll, pitch, yaw = (value[name, "block"] for name in BORESIGHT)
    turn = (
        axis_rotation(0, np.float64(pitch))
        @ axis_rotation(1, np.float64(roll))
        @ axis_rotation(2, np.float64(yaw))
    )
    lever = np.array([value[name, "block"] for name in LEVER_ARM])
    for i in range(N):
        strip = EXPOSURES.strip[i]
        since = EXPOSURES.time_s[i] - {"a": 100.0, "b": 400.0}[strip]
        shift = np.array([value[name, strip] for name in GNSS_SHIFTS])
        drift = np.array([value[name, strip] for name in GNSS_DRIFTS])
        antenna = position[i] + rotation[i] @ lever + shift + since * drift
        np.testing.assert_allclose(result.residual[i, :3], antenna - obs.antenna_m[i], atol=1e-9)
        angles = obs.angles_rad[i] + result.residual[i, 3:]
        angles = angles - [value[name, "block"] for name in IMU_SHIFTS]
        angles = angles - since * np.array([value[name, strip] for name in IMU_DRIFTS])
        np.testing.assert_allclose(
            rotation_from_angles(angles, system), rotation[i] @ turn, rtol=0, atol=1e-12
        )


@pytest.mark.parametrize("system", ["omega-phi-kappa", "phi-omega-kappa"])
def test_derivatives_agree_with_central_differences(system):
    obs = observed(system)
    rotation, position, common = state(3, system)
    effects = parameter_effects(PARAMETERS, EXPOSURES)

    def at(turn=0.0, move=0.0, change=0.0):
        turned = rotation_from_vector(np.broadcast_to(turn, (N, 3))) @ rotation
        return linearised_pos(obs, turned, position + move, effects, common + change)

    def close(derivative, plus, minus, step):
        difference = (plus.residual - minus.residual) / (2.0 * step)
        scale = np.abs(difference).max()
        np.testing.assert_allclose(derivative, difference, rtol=1e-7, atol=1e-7 * scale)

    by = at()
    for axis in range(3):
        unit = np.eye(3)[axis]
        close(by.by_pose[:, :, axis], at(turn=1e-4 * unit), at(turn=-1e-4 * unit), 1e-4)
        close(by.by_pose[:, :, 3 + axis], at(move=unit), at(move=-unit), 1.0)
    for k in range(len(PARAMETERS)):
        step = 1e-4 * np.eye(len(PARAMETERS))[k]
        close(by.by_common[:, :, k], at(change=step), at(change=-step), 1e-4)


def test_camera_parameters_belong_to_their_cameras():
    parameters = (
        CommonParameter("camera_c", "left"),
        CommonParameter("gnss_x_shift"),
        CommonParameter("camera_c", "right"),
        CommonParameter("bauer_s1"),
    )
    effects = parameter_effects(parameters, EXPOSURES)
    np.testing.assert_array_equal(effects.camera, [0, 2, 3])
    np.testing.assert_array_equal(effects.camera_column[:, [0, 1, 3]], [[0, -1, 2], [1, -1, 2]])


@pytest.mark.parametrize(
    ("parameters", "words"),
    [
        ((CommonParameter("gnss_x_shift", "c"),), "no strip c"),
        ((CommonParameter("boresight_roll", "a"),), "boresight_roll of a"),
        ((CommonParameter("tilt"),), "tilt of block"),
        (2 * (CommonParameter("camera_c"),), "twice"),
    ],
)
def test_parameters_without_effect_are_refused(parameters, words):
    with pytest.raises(GeometryError, match=words):
        parameter_effects(parameters, EXPOSURES)
