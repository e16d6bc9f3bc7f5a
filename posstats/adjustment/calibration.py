"""The usual alternative to a block that calibrates itself: boresight and lever arm of a flight.

Both are estimated once, by the bundle adjustment of a calibration block, kept in a file with their
covariance, and taken off the POS of other flights of the same camera. What the POS of those
flights has besides (shifts and drifts of their own) stays.
"""

import json
from collections.abc import Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from msgspec import Meta

from posstats.adjustment import Adjustment
from posstats.adjustment.significance import parameter_covariance
from posstats.arrays import Floats
from posstats.block.model import Block, Orientations
from posstats.block.turned import corrected
from posstats.errors import BlockFormatError, PosstatsError
from posstats.formats.hints import shown
from posstats.formats.text_table import sha256
from posstats.formats.toml_document import Conflict, open_toml
from posstats.formats.toml_types import Check
from posstats.numerics.bundle.parameters import BLOCK, BORESIGHT, LEVER_ARM
from posstats.numerics.bundle.pos_observations import antenna_positions, imu_angles
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem
from posstats.numerics.kernels.rotation import rotation_from_angles, vector_from_rotation
from posstats.version import __version__

SCHEMA: Literal["posstats-calibration/1"] = "posstats-calibration/1"
_HEAD = "# Boresight and lever arm of a POS, measured minus true: see docs/wucaps.md"
_PITCH_ROLL_YAW = np.array([1, 0, 2])  # as omega, phi, kappa of Rx(omega) Ry(phi) Rz(kappa)


@dataclass(frozen=True, eq=False)
class Calibration:
    """Boresight, and lever arm, of a POS and a camera.

    Attributes
    ----------
    boresight_rad
        (3,) roll, pitch, yaw: R_IMU = R R_B, R_B = Rx(pitch) Ry(roll) Rz(yaw).
    lever_arm_m
        (3,) u, v, w along image x, y, z: X_A = X_S + R (u, v, w); None if it was not estimated.
    covariance
        (k, k) of the boresight, then the lever arm, rad and m.
    block, camera
        Id of the calibration block, and of its camera.
    n_images
        Of that block.
    posstats_version
        Of the program that estimated it.
    """

    boresight_rad: Floats
    lever_arm_m: Floats | None
    covariance: Floats
    block: str
    camera: str
    n_images: int
    posstats_version: str = __version__

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the k parameters."""
        return BORESIGHT if self.lever_arm_m is None else (*BORESIGHT, *LEVER_ARM)


def calibrate(adjustment: Adjustment) -> Calibration:
    """The calibration that the adjustment of a calibration block gives.

    Boresight, and lever arm if it was unknown too, with a covariance scaled by sigma0.

    Raises
    ------
    PosstatsError
        If the boresight was no unknown, or the block has several cameras.
    """
    problem, adjusted = adjustment.problem, adjustment.adjusted
    covariance = parameter_covariance(problem, adjusted)
    return calibration_of(adjustment.block, problem, adjusted, covariance)


def calibration_of(
    block: Block, problem: BundleProblem, adjusted: AdjustedBundle, covariance: Floats
) -> Calibration:
    """`calibrate` of the parts of an adjustment, with a covariance (k, k) of its parameters."""
    if len(block.cameras) > 1:
        raise PosstatsError(
            "a calibration belongs to one camera; the block has "
            + ", ".join(camera.id for camera in block.cameras)
        )
    place = {(each.name, each.scope): at for at, each in enumerate(problem.parameters)}
    boresight = [place.get((name, BLOCK), -1) for name in BORESIGHT]
    if -1 in boresight:
        raise PosstatsError("the boresight was not an unknown of the adjustment: choose a drift")
    arm = [place[name, BLOCK] for name in LEVER_ARM if (name, BLOCK) in place]
    used = [*boresight, *arm]
    return Calibration(
        boresight_rad=adjusted.common[boresight],
        lever_arm_m=adjusted.common[arm] if arm else None,
        covariance=covariance[np.ix_(used, used)],
        block=block.name,
        camera=block.cameras[0].id,
        n_images=len(block.orientations),
    )


def apply_calibration(block: Block, calibration: Calibration, *, unknown: bool = False) -> Block:
    """The block with the calibration taken off its POS.

    Parameters
    ----------
    block
        With POS as recorded.
    calibration
        Of its camera.
    unknown
        Whether what follows estimates boresight and lever arm anew. If so, that unknown takes
        up the error of the calibration, and the standard deviations of the POS stay. Otherwise
        they grow by those of the calibration, which all images share: as correlated errors these
        do not average out over the block.

    Raises
    ------
    PosstatsError
        If the block has another camera.
    """
    _require_camera(block, calibration)
    if unknown:
        exact = replace(calibration, covariance=np.zeros_like(calibration.covariance))
        return apply_calibration(block, exact)
    pos = block.orientations
    turn = rotation_from_angles(calibration.boresight_rad[_PITCH_ROLL_YAW], "omega-phi-kappa")
    turned = corrected(pos, np.tile(vector_from_rotation(turn), (len(pos), 1)), "camera")
    _, _, by_boresight = imu_angles(turned.ground_from_image, calibration.boresight_rad, pos.system)
    variance = _variances(by_boresight, calibration.covariance[:3, :3])
    turned = replace(turned, sigma_angles_rad=np.sqrt(pos.sigma_angles_rad**2 + variance))
    return replace(block, orientations=_without_lever_arm(turned, calibration))


def _without_lever_arm(pos: Orientations, calibration: Calibration) -> Orientations:
    if calibration.lever_arm_m is None:
        return pos
    antenna_m, _, by_arm = antenna_positions(
        pos.ground_from_image, pos.position_m, calibration.lever_arm_m
    )
    variance = _variances(by_arm, calibration.covariance[3:, 3:])
    return replace(
        pos,
        position_m=2.0 * pos.position_m - antenna_m,
        sigma_position_m=np.sqrt(pos.sigma_position_m**2 + variance),
    )


def _variances(derivatives: Floats, covariance: Floats) -> Floats:
    """(n, 3) from derivatives (n, 3, 3) by parameters of a covariance (3, 3)."""
    variances: Floats = np.einsum("nij,jk,nik->ni", derivatives, covariance, derivatives)
    return variances


def _require_camera(block: Block, calibration: Calibration) -> None:
    strange = [each.id for each in block.cameras if each.id != calibration.camera]
    if strange:
        raise PosstatsError(
            f"the calibration (block {calibration.block}) is of camera {calibration.camera!r};"
            f" {block.name} has {', '.join(map(repr, strange))}"
        )


def calibrated(block: Block, path: Path, *, unknown: bool = False) -> Block:
    """The block with the calibration of a file taken off, the file among its inputs.

    `unknown` as for `apply_calibration`.
    """
    taken_off = apply_calibration(block, read_calibration(path), unknown=unknown)
    read = (path.name, sha256(path.read_bytes()))
    return replace(taken_off, inputs=(*block.inputs, read))


def read_calibration(path: Path) -> Calibration:
    """Read a file of `write_calibration`.

    Raises
    ------
    BlockFormatError
        With every finding.
    """
    try:
        content = path.read_bytes()
    except OSError as error:
        raise BlockFormatError([f"{path.name}: cannot be read ({error.strerror})"]) from error
    return open_toml(content, path.name).read_or_raise(_CalibrationFile).calibration


def write_calibration(calibration: Calibration, path: Path) -> None:
    """Write a calibration as TOML: lengths in m, angles in rad, numbers to the last digit."""
    arm = calibration.lever_arm_m
    values: dict[str, object] = {
        "schema": SCHEMA,
        "posstats_version": calibration.posstats_version,
        "block": calibration.block,
        "camera": calibration.camera,
        "n_images": calibration.n_images,
        "boresight_rad": calibration.boresight_rad.tolist(),
    }
    if arm is not None:
        values["lever_arm_m"] = arm.tolist()
    values |= {
        "parameters": list(calibration.names),
        "covariance": calibration.covariance.tolist(),
    }
    # Strings and lists of JSON are those of TOML, but for DEL, which TOML wants escaped.
    lines = [f"{key} = {json.dumps(value, ensure_ascii=False)}" for key, value in values.items()]
    path.write_text("\n".join([_HEAD, *lines, ""]).replace("\x7f", "\\u007f"), encoding="utf-8")


def _is_covariance(rows: tuple[tuple[float, ...], ...]) -> bool:
    if len(rows) not in (3, 6) or any(len(row) != len(rows) for row in rows):
        return False
    matrix = np.array(rows)
    is_symmetric = np.allclose(matrix, matrix.T, rtol=1e-9, atol=0.0)
    return bool(is_symmetric and (np.diagonal(matrix) > 0.0).all())


def _no_covariance(rows: tuple[tuple[float, ...], ...]) -> Iterable[str]:
    if not _is_covariance(rows):
        yield f"found {shown(rows)}, expected a covariance matrix of 3 or 6 rows"


_Name = Annotated[str, Meta(pattern=r"\S", description="a text")]
_Three = Annotated[tuple[float, float, float], Meta(description="a list of three numbers")]
_Covariance = Annotated[
    tuple[tuple[float, ...], ...],
    Meta(description="a covariance matrix of 3 or 6 rows"),
    Check(_no_covariance),
]


@dataclass(frozen=True)
class _CalibrationFile:
    """What the file holds."""

    schema: Literal["posstats-calibration/1"]
    posstats_version: _Name
    block: _Name
    camera: _Name
    n_images: Annotated[int, Meta(ge=1, description="a whole number above 0")]
    boresight_rad: _Three
    parameters: Annotated[tuple[_Name, ...], Meta(description="a list of names")]
    covariance: _Covariance
    lever_arm_m: _Three | None = None

    def conflicts(self) -> Iterable[Conflict]:
        """Values that contradict each other."""
        names = self.calibration.names
        if self.parameters != names:
            found = ", ".join(self.parameters)
            yield ("parameters",), f"found {found}, expected {', '.join(names)}"
        if len(self.covariance) != len(names):
            yield ("covariance",), f"found {len(self.covariance)} rows, expected {len(names)}"

    @property
    def calibration(self) -> Calibration:
        arm = None if self.lever_arm_m is None else np.array(self.lever_arm_m)
        return Calibration(
            boresight_rad=np.array(self.boresight_rad),
            lever_arm_m=arm,
            covariance=np.array(self.covariance),
            block=self.block,
            camera=self.camera,
            n_images=self.n_images,
            posstats_version=self.posstats_version,
        )
