"""block.toml: the settings of a block folder, read and checked."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal, cast

import numpy as np

from posstats.block.camera import Camera, Distortion, DistortionModel
from posstats.block.frames import require_map_grid
from posstats.block.model import Accuracy
from posstats.errors import GeometryError
from posstats.formats.toml_section import FILE, TomlSection, line_of_section, nearest

FileAngleSystem = Literal["omega-phi-kappa", "phi-omega-kappa", "roll-pitch-heading"]
AngleUnit = Literal["deg", "rad", "gon"]

RADIANS_PER_UNIT: dict[AngleUnit, float] = {
    "deg": np.pi / 180.0,
    "rad": 1.0,
    "gon": np.pi / 200.0,
}

_KEYS = {
    "block": (
        "name", "crs", "frame", "heights", "geoid", "angles", "angle_unit", "image_coordinates",
        "simulated",
    ),
    "camera": (
        "id", "name", "width_px", "height_px", "pixel_size_mm", "principal_distance_mm",
        "principal_distance_px", "principal_point_px", "distortion",
    ),
    "pos": ("lever_arm_m", "boresight_deg", "mounting_deg"),
    "accuracy": ("position_m", "angle_deg", "image_px"),
}  # fmt: skip
DISTORTION_COEFFICIENTS: dict[DistortionModel, tuple[str, ...]] = {
    "none": (),
    "radial": ("k1", "k2"),
    "brown": ("k1", "k2", "k3", "p1", "p2"),
}
_Triple = tuple[float, float, float]


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
        return ("omega", "phi", "kappa")


def parse_settings(content: bytes, folder_name: str, findings: list[str]) -> BlockSettings | None:
    """The settings in `content`; None, and what is wrong added to `findings`, if there is any."""
    text = _text(content, findings)
    if text is None:
        return None
    try:
        raw = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        findings.append(f"{FILE}: found no valid TOML: {error}")
        return None
    return settings_from(raw, folder_name, findings, text)


def settings_from(
    raw: Mapping[str, Any], folder_name: str, findings: list[str], text: str = ""
) -> BlockSettings | None:
    """The settings in parsed TOML; `text` is where lines are looked up for findings."""
    before = len(findings)
    _refuse_unknown(raw, text, findings)
    settings = _settings(raw, text, folder_name, findings)
    return settings if len(findings) == before else None


def _text(content: bytes, findings: list[str]) -> str | None:
    if not content.strip():
        findings.append(f"{FILE}: found an empty file, expected the settings of the block")
        return None
    try:
        return content.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        findings.append(f"{FILE}:{line}: found a file that is not UTF-8 text")
        return None


def _settings(
    raw: Mapping[str, Any], text: str, folder_name: str, findings: list[str]
) -> BlockSettings:
    block = TomlSection(raw.get("block", {}), "block", text, findings)
    if "block" not in raw:
        findings.append(f"{FILE}: found no [block] section, expected one")
    pos = TomlSection(raw.get("pos", {}), "pos", text, findings)
    cameras = _cameras(raw, text, findings)
    accuracy, assumed = _accuracy(TomlSection(raw.get("accuracy", {}), "accuracy", text, findings))
    roll, pitch, yaw = np.radians(pos.numbers("boresight_deg", 3, (0.0, 0.0, 0.0)))
    settings = BlockSettings(
        name=block.text("name") or folder_name,
        crs=block.text("crs"),
        tangent=block.choice("frame", ("tangent", "grid"), "tangent") == "tangent"
        and "crs" in block.values,
        orthometric=block.choice("heights", ("ellipsoidal", "orthometric"), "ellipsoidal")
        == "orthometric",
        geoid=block.text("geoid"),
        angles=cast(
            FileAngleSystem,
            block.choice("angles", ("omega-phi-kappa", "phi-omega-kappa", "roll-pitch-heading")),
        ),
        angle_unit=cast(AngleUnit, block.choice("angle_unit", tuple(RADIANS_PER_UNIT))),
        image_unit=cast(Literal["px", "mm"], block.choice("image_coordinates", ("px", "mm"))),
        simulated=block.flag("simulated"),
        cameras=cameras,
        lever_arm_m=cast(_Triple, pos.numbers("lever_arm_m", 3, (0.0, 0.0, 0.0))),
        boresight_rad=(float(roll), float(pitch), float(yaw)),
        mounting_rad=float(np.radians(pos.number("mounting_deg") or 0.0)),
        accuracy=accuracy,
        assumed_accuracy=assumed,
        raw=raw,
    )
    _check_together(settings, block, pos)
    return settings


def _check_together(settings: BlockSettings, block: TomlSection, pos: TomlSection) -> None:
    """What each key may be only in view of another."""
    if settings.crs is not None:
        try:
            require_map_grid(settings.crs)
        except GeometryError as error:
            block.refuse("crs", str(error))
    elif settings.angles == "roll-pitch-heading":
        block.refuse("angles", "found roll-pitch-heading without crs, expected a crs beside it")
    if settings.crs is None and block.values.get("frame") == "tangent":
        block.refuse("frame", "found tangent without crs, expected a crs beside it")
    if settings.geoid is not None and not (settings.orthometric and settings.crs):
        block.refuse("geoid", 'found a geoid grid, expected it with crs and heights "orthometric"')
    if settings.mounting_rad != 0.0 and settings.angles != "roll-pitch-heading":
        pos.refuse("mounting_deg", f"found it with {settings.angles}, expected roll-pitch-heading")
    if settings.image_unit == "mm":
        for camera in settings.cameras:
            if camera.pixel_size_mm is None:
                block.refuse(
                    "image_coordinates",
                    f"found mm, but camera {camera.id!r} has no pixel_size_mm, expected one",
                )


def _refuse_unknown(raw: Mapping[str, Any], text: str, findings: list[str]) -> None:
    for name, value in raw.items():
        if name not in _KEYS:
            line = line_of_section(text, name)
            findings.append(
                f"{FILE}{line}, {name}: found an unknown section or key{nearest(name, _KEYS)}"
            )
            continue
        for number, table in enumerate(value if isinstance(value, list) else [value]):
            if isinstance(table, dict):
                TomlSection(table, name, text, findings, number).refuse_unknown(_KEYS[name])


def _cameras(raw: Mapping[str, Any], text: str, findings: list[str]) -> tuple[Camera, ...]:
    tables = raw.get("camera")
    if tables is None or tables == []:
        findings.append(f"{FILE}: found no [camera] section, expected one")
        return ()
    several = isinstance(tables, list)
    sections = [
        TomlSection(table, "camera", text, findings, number)
        for number, table in enumerate(tables if several else [tables])
    ]
    cameras = [_camera(section, required_id=several and len(sections) > 1) for section in sections]
    for number, section in enumerate(sections):
        if cameras[number].id in [camera.id for camera in cameras[:number]]:
            section.refuse("id", f"found camera {cameras[number].id!r} twice, expected once")
    return tuple(cameras)


def _camera(section: TomlSection, required_id: bool) -> Camera:
    identity = section.text("id")
    if identity is None and required_id:
        section.refuse("id", "found a camera without id, expected one for each of several cameras")
    name = section.text("name") or identity or "camera"
    width = section.positive("width_px", required=True) or 1.0
    height = section.positive("height_px", required=True) or 1.0
    pixel_size = section.positive("pixel_size_mm")
    column, row = section.numbers("principal_point_px", 2, (0.5 * width, 0.5 * height))
    return Camera(
        id=identity or "",
        name=name,
        width_px=width,
        height_px=height,
        principal_distance_px=_principal_distance_px(section, pixel_size),
        principal_point_px=(column, row),
        pixel_size_mm=pixel_size,
        distortion=_distortion(section),
    )


def _principal_distance_px(section: TomlSection, pixel_size_mm: float | None) -> float:
    in_px = section.positive("principal_distance_px")
    in_mm = section.positive("principal_distance_mm")
    if in_px is not None and in_mm is not None:
        section.refuse("principal_distance_mm", "found also principal_distance_px, expected one")
    elif in_px is None and in_mm is None:
        if not {"principal_distance_px", "principal_distance_mm"} & set(section.values):
            section.refuse("principal_distance_mm", "found nothing, expected a positive number")
    elif in_mm is not None and pixel_size_mm is None:
        section.refuse("pixel_size_mm", "found nothing, expected it with principal_distance_mm")
    if in_px is not None:
        return in_px
    return (in_mm or 1.0) / (pixel_size_mm or 1.0)


def _distortion(camera: TomlSection) -> Distortion:
    table = camera.values.get("distortion")
    if table is None:
        return Distortion()
    if not isinstance(table, dict):
        camera.refuse("distortion", f'found {table!r}, expected {{ model = "radial", k1 = ... }}')
        return Distortion()
    section = TomlSection(
        table, "camera", camera.source, camera.findings, camera.occurrence, "distortion"
    )
    model = cast(DistortionModel, section.choice("model", tuple(DISTORTION_COEFFICIENTS)))
    coefficients = DISTORTION_COEFFICIENTS[model]
    section.refuse_unknown(("model", *coefficients))
    return Distortion(model, **{name: section.number(name) or 0.0 for name in coefficients})


def _accuracy(section: TomlSection) -> tuple[Accuracy, tuple[str, ...]]:
    """The accuracy, and the keys for which a default had to be taken."""
    default = Accuracy()
    position = section.positive("position_m")
    angle = section.positive("angle_deg")
    image = section.positive("image_px")
    accuracy = Accuracy(
        position_m=default.position_m if position is None else position,
        angle_rad=default.angle_rad if angle is None else float(np.radians(angle)),
        image_px=default.image_px if image is None else image,
    )
    return accuracy, tuple(key for key in _KEYS["accuracy"] if key not in section.values)
