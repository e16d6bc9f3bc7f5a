"""Additional parameters of a bundle adjustment: what they are called, and what they act on."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from posstats.arrays import Bools, Floats, Ids, Ints
from posstats.errors import GeometryError
from posstats.numerics.bundle.rays import CAMERA_PARAMETERS
from posstats.numerics.kernels.rotation import ANGLE_NAMES

BLOCK = "block"
GNSS_SHIFTS, GNSS_DRIFTS = (
    tuple(f"gnss_{axis}_{kind}" for axis in "xyz") for kind in ("shift", "drift")
)
IMU_SHIFTS, IMU_DRIFTS = (
    tuple(f"imu_{angle}_{kind}" for angle in ANGLE_NAMES) for kind in ("shift", "drift")
)
LEVER_ARM = ("lever_arm_u", "lever_arm_v", "lever_arm_w")
BORESIGHT = ("boresight_roll", "boresight_pitch", "boresight_yaw")
UNITS = (
    dict.fromkeys(GNSS_SHIFTS, "m")
    | dict.fromkeys(GNSS_DRIFTS, "m/s")
    | dict.fromkeys(IMU_SHIFTS, "rad")
    | dict.fromkeys(IMU_DRIFTS, "rad/s")
    | dict.fromkeys(LEVER_ARM, "m")
    | dict.fromkeys(BORESIGHT, "rad")
    | dict.fromkeys(CAMERA_PARAMETERS, "")
    | dict.fromkeys(("camera_c", "camera_x0", "camera_y0"), "px")
    | {"bauer_s1": "1/mm2"}
)
"""Units of all parameters; values are measured minus true, shifts those at t0."""


@dataclass(frozen=True)
class CommonParameter:
    """One unknown that many observations share.

    Attributes
    ----------
    name
        One of `UNITS`.
    scope
        `BLOCK`; or a strip's id, for shifts and drifts; or a camera's id, for its parameters.
    sigma
        Standard deviation of `value` as an observation; None: free.
    value
        What is known beforehand, and the start of the iteration.
    """

    name: str
    scope: str = BLOCK
    sigma: float | None = None
    value: float = 0.0

    @property
    def weight(self) -> float:
        """Of the prior observation."""
        return 0.0 if self.sigma is None else 1.0 / self.sigma**2


def drift_parameters(
    names: Sequence[str], scopes: Sequence[str], sigma: float | None = None
) -> tuple[CommonParameter, ...]:
    """The parameters of these names for every scope, all with one prior."""
    return tuple(CommonParameter(name, scope, sigma) for scope in scopes for name in names)


@dataclass(frozen=True, eq=False)
class Exposures:
    """To what parameters refer: n images of strips and c cameras.

    Attributes
    ----------
    time_s
        (n,).
    strip
        (n,) ids.
    camera
        (n,) index.
    camera_id
        (c,).
    """

    time_s: Floats
    strip: Ids
    camera: Ints
    camera_id: tuple[str, ...]

    def within(self, scope: str) -> Bools:
        """(n,) images of a scope.

        Raises
        ------
        GeometryError
            If there is no such strip.
        """
        inside = np.full(len(self.time_s), scope == BLOCK)
        inside |= np.asarray(self.strip == scope, dtype=bool)
        if not inside.any():
            raise GeometryError(f"there is no strip {scope}")
        return inside


@dataclass(frozen=True, eq=False)
class ParameterEffects:
    """How k parameters enter the observations.

    Attributes
    ----------
    gnss, imu
        (n, 3, k) derivatives of antenna positions and of angles by shifts and drifts.
    lever_arm, boresight
        (3,) index of the three parameters; -1: not unknown.
    camera_column
        (c, 11) index into `camera` of every camera's parameters; -1: not unknown.
    camera
        (r,) indices of the camera parameters among the k.
    """

    gnss: Floats
    imu: Floats
    lever_arm: Ints
    boresight: Ints
    camera_column: Ints
    camera: Ints


def parameter_effects(
    parameters: Sequence[CommonParameter], exposures: Exposures
) -> ParameterEffects:
    """Equations 7 and 8 of the second source paper, and where the other parameters belong.

    Raises
    ------
    GeometryError
        If a name or scope is not known, or two parameters are the same.
    """
    n, k = len(exposures.time_s), len(parameters)
    gnss, imu = np.zeros((n, 3, k)), np.zeros((n, 3, k))
    lever_arm, boresight = np.full(3, -1), np.full(3, -1)
    camera_column = np.full((len(exposures.camera_id), len(CAMERA_PARAMETERS)), -1)
    camera: list[int] = []
    if len({(parameter.name, parameter.scope) for parameter in parameters}) < k:
        raise GeometryError("an additional parameter is given twice")
    for at, parameter in enumerate(parameters):
        name = parameter.name
        if name in (*GNSS_SHIFTS, *GNSS_DRIFTS):
            gnss[:, (*GNSS_SHIFTS, *GNSS_DRIFTS).index(name) % 3, at] = _trend(parameter, exposures)
        elif name in (*IMU_SHIFTS, *IMU_DRIFTS):
            imu[:, (*IMU_SHIFTS, *IMU_DRIFTS).index(name) % 3, at] = _trend(parameter, exposures)
        elif name in LEVER_ARM and parameter.scope == BLOCK:
            lever_arm[LEVER_ARM.index(name)] = at
        elif name in BORESIGHT and parameter.scope == BLOCK:
            boresight[BORESIGHT.index(name)] = at
        elif name in CAMERA_PARAMETERS and parameter.scope in (BLOCK, *exposures.camera_id):
            rows = [parameter.scope in (BLOCK, each) for each in exposures.camera_id]
            camera_column[rows, CAMERA_PARAMETERS.index(name)] = len(camera)
            camera.append(at)
        else:
            raise GeometryError(f"{name} of {parameter.scope} is no additional parameter")
    return ParameterEffects(
        gnss, imu, lever_arm, boresight, camera_column, np.array(camera, dtype=np.intp)
    )


def _trend(parameter: CommonParameter, exposures: Exposures) -> Floats:
    """(n,) 1 for a shift, t - t0 for a drift, 0 outside its scope; t0 its first exposure."""
    inside = exposures.within(parameter.scope)
    since_s = exposures.time_s - exposures.time_s[inside].min()
    return np.where(inside, 1.0 if parameter.name.endswith("shift") else since_s, 0.0)
