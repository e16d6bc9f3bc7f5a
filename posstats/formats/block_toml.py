"""block.toml: the settings of a block folder, read and checked."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from msgspec import Meta

from posstats.block.camera import Camera, Distortion, DistortionModel
from posstats.block.frames import require_map_grid
from posstats.block.model import Accuracy
from posstats.errors import GeometryError
from posstats.formats.hints import nearest
from posstats.formats.toml_document import Conflict, TomlDocument, open_toml
from posstats.formats.toml_types import ONE_OR_MORE, Number, Positive
from posstats.numerics.kernels.rotation import ANGLE_NAMES

FILE = "block.toml"
FileAngleSystem = Literal["omega-phi-kappa", "phi-omega-kappa", "roll-pitch-heading"]
AngleUnit = Literal["deg", "rad", "gon"]

RADIANS_PER_UNIT: dict[AngleUnit, float] = {
    "deg": np.pi / 180.0,
    "rad": 1.0,
    "gon": np.pi / 200.0,
}

DISTORTION_COEFFICIENTS: dict[DistortionModel, tuple[str, ...]] = {
    "none": (),
    "radial": ("k1", "k2"),
    "brown": ("k1", "k2", "k3", "p1", "p2"),
}
_Text = Annotated[str, Meta(min_length=1)]
_Pair = Annotated[tuple[Number, Number], Meta(description="2 finite numbers in brackets")]
_Triple = Annotated[tuple[Number, Number, Number], Meta(description="3 finite numbers in brackets")]


@dataclass(frozen=True)
class _BlockTable:
    """``[block]``."""

    angles: FileAngleSystem
    angle_unit: AngleUnit
    image_coordinates: Literal["px", "mm"]
    name: _Text | None = None
    crs: _Text | None = None
    frame: Literal["tangent", "grid"] | None = None
    heights: Literal["ellipsoidal", "orthometric"] = "ellipsoidal"
    geoid: _Text | None = None
    simulated: bool = False

    def conflicts(self) -> Iterable[Conflict]:
        """What each key may be only in view of another."""
        if self.crs is not None:
            try:
                require_map_grid(self.crs)
            except GeometryError as error:
                yield ("crs",), str(error)
        elif self.angles == "roll-pitch-heading":
            yield ("angles",), "found roll-pitch-heading without crs, expected a crs beside it"
        if self.crs is None and self.frame == "tangent":
            yield ("frame",), "found tangent without crs, expected a crs beside it"
        if self.geoid is not None and not (self.heights == "orthometric" and self.crs):
            expected = 'expected it with crs and heights "orthometric"'
            yield ("geoid",), f"found a geoid grid, {expected}"


@dataclass(frozen=True)
class _DistortionTable:
    """``camera.distortion``."""

    model: DistortionModel
    k1: Number | None = None
    k2: Number | None = None
    k3: Number | None = None
    p1: Number | None = None
    p2: Number | None = None

    def conflicts(self) -> Iterable[Conflict]:
        """Coefficients that the model does not have."""
        known = DISTORTION_COEFFICIENTS[self.model]
        for name in DISTORTION_COEFFICIENTS["brown"]:
            if getattr(self, name) is not None and name not in known:
                yield (name,), f"found an unknown key{nearest(name, ('model', *known))}"

    @property
    def distortion(self) -> Distortion:
        names = DISTORTION_COEFFICIENTS[self.model]
        return Distortion(self.model, **{name: getattr(self, name) or 0.0 for name in names})


@dataclass(frozen=True)
class _CameraTable:
    """``[camera]``, or one of several ``[[camera]]``."""

    width_px: Positive
    height_px: Positive
    id: _Text | None = None
    name: _Text | None = None
    pixel_size_mm: Positive | None = None
    principal_distance_mm: Positive | None = None
    principal_distance_px: Positive | None = None
    principal_point_px: _Pair | None = None
    distortion: _DistortionTable | None = None

    def conflicts(self) -> Iterable[Conflict]:
        """What each key may be only in view of another."""
        in_px, in_mm = self.principal_distance_px, self.principal_distance_mm
        if in_px is not None and in_mm is not None:
            yield ("principal_distance_mm",), "found also principal_distance_px, expected one"
        elif in_px is None and in_mm is None:
            yield ("principal_distance_mm",), "found nothing, expected a positive number"
        elif in_mm is not None and self.pixel_size_mm is None:
            yield ("pixel_size_mm",), "found nothing, expected it with principal_distance_mm"

    @property
    def camera(self) -> Camera:
        middle = (0.5 * self.width_px, 0.5 * self.height_px)
        return Camera(
            id=self.id or "",
            name=self.name or self.id or "camera",
            width_px=self.width_px,
            height_px=self.height_px,
            principal_distance_px=self._distance_px,
            principal_point_px=self.principal_point_px or middle,
            pixel_size_mm=self.pixel_size_mm,
            distortion=Distortion() if self.distortion is None else self.distortion.distortion,
        )

    @property
    def _distance_px(self) -> float:
        if self.principal_distance_px is not None:
            return self.principal_distance_px
        return (self.principal_distance_mm or np.nan) / (self.pixel_size_mm or np.nan)


@dataclass(frozen=True)
class _PosTable:
    """``[pos]``."""

    lever_arm_m: _Triple = (0.0, 0.0, 0.0)
    boresight_deg: _Triple = (0.0, 0.0, 0.0)
    mounting_deg: Number = 0.0


@dataclass(frozen=True)
class _AccuracyTable:
    """``[accuracy]``; None where a default is to be taken."""

    position_m: Positive | None = None
    angle_deg: Positive | None = None
    image_px: Positive | None = None

    @property
    def accuracy(self) -> Accuracy:
        default = Accuracy()
        angle = self.angle_deg
        return Accuracy(
            position_m=self.position_m or default.position_m,
            angle_rad=default.angle_rad if angle is None else float(np.radians(angle)),
            image_px=self.image_px or default.image_px,
        )

    @property
    def assumed(self) -> tuple[str, ...]:
        """The keys for which a default is taken."""
        return tuple(name for name, value in vars(self).items() if value is None)


@dataclass(frozen=True)
class _BlockFile:
    """The whole file."""

    block: _BlockTable
    camera: Annotated[
        tuple[_CameraTable, ...],
        Meta(min_length=1, description="a table, or tables that begin with [[camera]]"),
        ONE_OR_MORE,
    ]
    pos: _PosTable = _PosTable()
    accuracy: _AccuracyTable = _AccuracyTable()

    def conflicts(self) -> Iterable[Conflict]:
        """What each key may be only in view of one of another table."""
        angles = self.block.angles
        if self.pos.mounting_deg != 0.0 and angles != "roll-pitch-heading":
            yield ("pos", "mounting_deg"), f"found it with {angles}, expected roll-pitch-heading"
        ids = [camera.id for camera in self.camera]
        for k, camera in enumerate(self.camera):
            if camera.id is None and len(ids) > 1:
                found = "found a camera without id"
                yield ("camera", k, "id"), f"{found}, expected one for each of several cameras"
            elif camera.id in ids[:k]:
                yield ("camera", k, "id"), f"found camera {camera.id!r} twice, expected once"
            if self.block.image_coordinates == "mm" and camera.pixel_size_mm is None:
                found = f"found mm, but camera {camera.id or ''!r} has no pixel_size_mm"
                yield ("block", "image_coordinates"), f"{found}, expected one"


@dataclass(frozen=True)
class BlockSettings:
    """What block.toml says; units as in the names, angles of the tables in `angle_unit`."""

    name: str
    crs: str | None
    tangent: bool
    orthometric: bool
    geoid: str | None
    angles: FileAngleSystem
    angle_unit: AngleUnit
    image_unit: Literal["px", "mm"]
    simulated: bool
    cameras: tuple[Camera, ...]
    lever_arm_m: _Triple
    boresight_rad: _Triple
    mounting_rad: float
    accuracy: Accuracy
    assumed_accuracy: tuple[str, ...]
    raw: Mapping[str, Any]

    @property
    def angle_columns(self) -> tuple[str, str, str]:
        """Names of the angle columns, in the order in which angles are kept."""
        if self.angles == "roll-pitch-heading":
            return ("roll", "pitch", "heading")
        return ANGLE_NAMES


def parse_settings(content: bytes, folder_name: str, findings: list[str]) -> BlockSettings | None:
    """The settings in `content`; None, and what is wrong added to `findings`, if there is any."""
    if not content.strip():
        findings.append(f"{FILE}: found an empty file, expected the settings of the block")
        return None
    return _settings(open_toml(content, FILE), folder_name, findings)


def settings_from(
    raw: Mapping[str, Any], folder_name: str, findings: list[str]
) -> BlockSettings | None:
    """The settings in parsed TOML."""
    return _settings(TomlDocument(FILE, raw), folder_name, findings)


def _settings(
    document: TomlDocument, folder_name: str, findings: list[str]
) -> BlockSettings | None:
    file = document.read(_BlockFile)
    findings += document.findings
    if file is None or document.findings:
        return None
    block, pos = file.block, file.pos
    roll, pitch, yaw = np.radians(pos.boresight_deg)
    return BlockSettings(
        name=block.name or folder_name,
        crs=block.crs,
        tangent=block.crs is not None and block.frame != "grid",
        orthometric=block.heights == "orthometric",
        geoid=block.geoid,
        angles=block.angles,
        angle_unit=block.angle_unit,
        image_unit=block.image_coordinates,
        simulated=block.simulated,
        cameras=tuple(table.camera for table in file.camera),
        lever_arm_m=pos.lever_arm_m,
        boresight_rad=(float(roll), float(pitch), float(yaw)),
        mounting_rad=float(np.radians(pos.mounting_deg)),
        accuracy=file.accuracy.accuracy,
        assumed_accuracy=file.accuracy.assumed,
        raw=document.values,
    )
