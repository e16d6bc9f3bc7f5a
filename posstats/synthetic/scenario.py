"""Scenarios: what a simulated block consists of, read from TOML and checked like a block.

Every table of the file is a frozen dataclass below; a field's annotation carries the rule its
value must obey, so that the class is the documentation, the reader and the check.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from importlib.resources import files
from importlib.resources.abc import Traversable
from pathlib import Path
from typing import Annotated, Any, Literal

from msgspec import Meta

from posstats.block.camera import Camera, Distortion, DistortionModel
from posstats.errors import BlockFormatError
from posstats.formats.toml_document import Conflict, TomlDocument, open_toml
from posstats.formats.toml_types import ONE_OR_MORE
from posstats.numerics.kernels.rotation import AngleSystem

_MAX_IMAGES = 100_000

_Text = Annotated[str, Meta(pattern=r"\S", description="a text")]
_Number = Annotated[float, Meta(description="a number")]
_Positive = Annotated[float, Meta(gt=0, description="a number above 0")]
_NotNegative = Annotated[float, Meta(ge=0, description="a number of at least 0")]
_Share = Annotated[float, Meta(ge=0, lt=1, description="a share from 0 to below 1")]
_Overlap = Annotated[float, Meta(gt=0, lt=1, description="a share above 0 and below 1")]
_SideOverlap = Annotated[
    float, Meta(gt=-1, lt=1, description="a share above -1 and below 1 (negative: a gap)")
]
_SmallAngle = Annotated[float, Meta(ge=0, le=0.5, description="an angle in radians from 0 to 0.5")]
_ErrorAngle = Annotated[float, Meta(ge=-0.5, le=0.5, description="an angle in radians within ±0.5")]
_Count = Annotated[int, Meta(ge=0, description="a whole number of at least 0")]
_PointCount = Annotated[int, Meta(ge=0, le=100_000, description="a whole number from 0 to 100000")]
_StripCount = Annotated[int, Meta(ge=1, le=10_000, description="a whole number from 1 to 10000")]
_StripCounts = Annotated[
    tuple[_StripCount, ...],
    Meta(min_length=1, description="a whole number from 1 to 10000, or a list of them"),
    ONE_OR_MORE,
]
_Numbers = Annotated[
    tuple[float, ...], Meta(min_length=1, description="a number or a list of them"), ONE_OR_MORE
]
_Pair = Annotated[tuple[float, float], Meta(description="a list of two numbers")]
_Triple = Annotated[tuple[float, float, float], Meta(description="a list of three numbers")]


@dataclass(frozen=True)
class BlockSpec:
    """``[block]``: name, seed, frame. Keys as in block.toml, and `origin_m`, the block's middle.

    `origin_m` is easting and northing in the crs (or in the Cartesian frame without a crs).
    """

    name: _Text
    seed: _Count = 0
    angles: AngleSystem = "omega-phi-kappa"
    crs: _Text | None = None
    frame: Literal["tangent", "grid"] = "tangent"
    origin_m: _Pair = (0.0, 0.0)

    def conflicts(self) -> Iterable[Conflict]:
        """Values that contradict each other."""
        if self.crs is not None and self.origin_m == (0.0, 0.0):
            yield (), "crs needs origin_m, the easting and northing of the block's middle"


@dataclass(frozen=True)
class DistortionSpec:
    """``[camera.distortion]``, as in block.toml."""

    model: DistortionModel = "none"
    k1: _Number = 0.0
    k2: _Number = 0.0
    k3: _Number = 0.0
    p1: _Number = 0.0
    p2: _Number = 0.0

    def conflicts(self) -> Iterable[Conflict]:
        """Values that contradict each other."""
        if self.model == "none" and any((self.k1, self.k2, self.k3, self.p1, self.p2)):
            yield (), 'has coefficients, but its model is "none"'
        if self.model == "radial" and any((self.k3, self.p1, self.p2)):
            yield (), 'has k3, p1 or p2, which the model "radial" does not use'


@dataclass(frozen=True)
class CameraSpec:
    """``[camera]``, as in block.toml; image y points forward, x to the right of the flight."""

    width_px: _Positive
    height_px: _Positive
    name: _Text = "camera"
    pixel_size_mm: _Positive | None = None
    principal_distance_mm: _Positive | None = None
    principal_distance_px: _Positive | None = None
    principal_point_px: _Pair | None = None
    distortion: DistortionSpec = DistortionSpec()

    def conflicts(self) -> Iterable[Conflict]:
        """Values that contradict each other."""
        if (self.principal_distance_mm is None) == (self.principal_distance_px is None):
            yield (), "needs either principal_distance_mm or principal_distance_px"
        elif self.principal_distance_mm is not None and self.pixel_size_mm is None:
            yield (), "principal_distance_mm needs pixel_size_mm"

    @property
    def camera(self) -> Camera:
        """The camera that images the block."""
        if self.principal_distance_px is not None:
            distance_px = self.principal_distance_px
        elif self.principal_distance_mm is not None and self.pixel_size_mm is not None:
            distance_px = self.principal_distance_mm / self.pixel_size_mm
        else:
            raise BlockFormatError([f"camera: {what}" for _, what in self.conflicts()])
        d = self.distortion
        return Camera(
            id=self.name,
            name=self.name,
            width_px=self.width_px,
            height_px=self.height_px,
            principal_distance_px=distance_px,
            principal_point_px=self.principal_point_px or (self.width_px / 2, self.height_px / 2),
            pixel_size_mm=self.pixel_size_mm,
            distortion=Distortion(d.model, d.k1, d.k2, d.k3, d.p1, d.p2),
        )


@dataclass(frozen=True)
class Flight:
    """``[flight]``: how the block is flown.

    `images_per_strip` is one number for `n_strips` strips or a list; `headings_deg` (clockwise
    from grid north) is repeated over the strips, so [0, 180] flies them alternately. Strips of
    parallel headings lie side by side, in that order; other directions cross them in the middle.
    The turn is the time from a strip's last exposure to the next strip's first.
    """

    forward_overlap: _Overlap
    side_overlap: _SideOverlap
    images_per_strip: _StripCounts
    n_strips: _StripCount | None = None
    scale_denominator: _Positive | None = None
    height_m: _Positive | None = None
    headings_deg: _Numbers = (0.0, 180.0)
    speed_m_per_s: _Positive = 100.0
    turn_s: _Positive = 300.0
    start_time_s: _Number = 0.0
    tilt_rad: _SmallAngle = 0.01
    position_jitter_m: _NotNegative = 0.0

    def conflicts(self) -> Iterable[Conflict]:
        """Values that contradict each other."""
        if (self.scale_denominator is None) == (self.height_m is None):
            yield (), "needs either scale_denominator or height_m (above the mean terrain)"
        if self.n_strips is not None and len(self.images_per_strip) not in (1, self.n_strips):
            n = len(self.images_per_strip)
            yield ("images_per_strip",), f"found {n} strips, expected n_strips, {self.n_strips}"
        if sum(self.image_counts) > _MAX_IMAGES:
            yield (), f"found {sum(self.image_counts)} images, expected at most {_MAX_IMAGES}"

    @property
    def image_counts(self) -> tuple[int, ...]:
        """Number of images of every strip."""
        if self.n_strips is not None and len(self.images_per_strip) == 1:
            return self.images_per_strip * self.n_strips
        return self.images_per_strip


@dataclass(frozen=True)
class Terrain:
    """``[terrain]``: a smooth random surface; `relief_m` is the amplitude of a single wave.

    Its standard deviation is `relief_m` / sqrt(2), like that of a sine of this amplitude.
    """

    mean_height_m: _Number = 0.0
    relief_m: _NotNegative = 0.0
    wavelength_m: _Positive = 10_000.0


@dataclass(frozen=True)
class TiePointSpec:
    """``[tie_points]``: about how many a stereo model has, evenly spread on the ground."""

    per_model: _Positive = 100.0


@dataclass(frozen=True)
class AngleError:
    """``[errors.omega]`` ...: error = constant + drift (t - t of the first exposure) + noise.

    `strip_rad` and `strip_drift_rad_per_s` are the standard deviations of a random constant and
    of a random drift (from its first exposure) of each strip, `noise_rad` that of the white noise.
    """

    constant_rad: _ErrorAngle = 0.0
    drift_rad_per_s: _Number = 0.0
    strip_rad: _SmallAngle = 0.0
    strip_drift_rad_per_s: _NotNegative = 0.0
    noise_rad: _SmallAngle = 0.0


@dataclass(frozen=True)
class PositionError:
    """``[errors.position]``: standard deviations, alike in the three axes, and a lever arm.

    White noise, and a random shift and drift (from its first exposure) of each strip.
    `lever_arm_m` (u, v, w along image x, y, z) is what the POS leaves of the way from the
    projection centre to the antenna: X_pos = X + R (u, v, w).
    """

    noise_m: _NotNegative = 0.0
    strip_shift_m: _NotNegative = 0.0
    strip_drift_m_per_s: _NotNegative = 0.0
    lever_arm_m: _Triple = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Errors:
    """``[errors]``: of the image measurements and of the POS.

    The errors of omega, phi, kappa are added to the angles of the block's system in the ground
    frame; those of pitch, roll, yaw (e about image x, y, z, a boresight) turn the camera:
    R_pos = R exp([e]x). `blunder_px` is the length of a blunder of random direction.
    """

    image_px: _NotNegative = 0.0
    blunder_share: _Share = 0.0
    blunder_px: _Positive = 20.0
    position: PositionError = PositionError()
    omega: AngleError = AngleError()
    phi: AngleError = AngleError()
    kappa: AngleError = AngleError()
    pitch: AngleError = AngleError()
    roll: AngleError = AngleError()
    yaw: AngleError = AngleError()


@dataclass(frozen=True)
class PointSpec:
    """``[check_points]`` and ``[control_points]``.

    Attributes
    ----------
    n
        Number of points.
    distribution
        ``grid``: the centres of a grid of cells over the projection centres; ``corners``: a grid
        that reaches the corners (1 is the middle, 4 the corners); ``side-overlap``: in the
        middle of the overlaps of neighbouring strips, where most images see them; ``random``.
    image_px, ground_m
        Standard deviation of their image measurements and of their survey.
    """

    n: _PointCount = 0
    distribution: Literal["grid", "corners", "side-overlap", "random"] = "grid"
    image_px: _NotNegative = 0.0
    ground_m: _NotNegative = 0.0


@dataclass(frozen=True)
class AccuracySpec:
    """``[accuracy]``, as in block.toml: what the block states, whatever the errors are."""

    position_m: _Positive = 0.05
    angle_deg: _Positive = 0.005
    image_px: _Positive = 0.2


@dataclass(frozen=True)
class Scenario:
    """A block to be simulated: one attribute per table of the scenario file."""

    block: BlockSpec
    camera: CameraSpec
    flight: Flight
    terrain: Terrain = Terrain()
    tie_points: TiePointSpec = TiePointSpec()
    errors: Errors = Errors()
    check_points: PointSpec = PointSpec()
    control_points: PointSpec = field(default_factory=lambda: PointSpec(distribution="corners"))
    accuracy: AccuracySpec = AccuracySpec()

    def conflicts(self) -> Iterable[Conflict]:
        """Values that contradict each other."""
        if self.flight.scale_denominator is not None and self.camera.pixel_size_mm is None:
            yield (), "flight.scale_denominator needs camera.pixel_size_mm (or give height_m)"
        if 2.0 * self.errors.blunder_px >= min(self.camera.width_px, self.camera.height_px):
            found = f"found {self.errors.blunder_px:g}"
            yield ("errors", "blunder_px"), f"{found}, expected less than half the image format"

    @property
    def height_m(self) -> float:
        """Flying height above the mean terrain."""
        if self.flight.height_m is not None:
            return self.flight.height_m
        if self.flight.scale_denominator is None or self.camera.pixel_size_mm is None:
            raise BlockFormatError(["flight: needs either scale_denominator or height_m"])
        distance_mm = self.camera.camera.principal_distance_px * self.camera.pixel_size_mm
        return self.flight.scale_denominator * distance_mm / 1000.0


def load_scenario(source: str | Path | Mapping[str, Any]) -> Scenario:
    """Read and check a scenario.

    Parameters
    ----------
    source
        A TOML file, the name of a scenario that comes with posstats (``area1``), or the tables
        as a mapping.

    Raises
    ------
    BlockFormatError
        With every finding: unknown keys (with the nearest known one), missing keys, values of
        the wrong type or size, contradictions, a file that is not there or not TOML.
    """
    if isinstance(source, Mapping):
        return TomlDocument("scenario", source).read_or_raise(Scenario)
    path = Path(source)
    if path.name == str(source) and not path.is_file() and _shipped(path.name).is_file():
        return shipped_scenario(path.name)
    try:
        content = path.read_bytes()
    except OSError as error:
        raise BlockFormatError([f"{path.name}: cannot be read ({error.strerror})"]) from error
    return open_toml(content, path.name).read_or_raise(Scenario)


def shipped_scenario(name: str) -> Scenario:
    """A scenario that comes with posstats, whatever lies in the working directory."""
    return open_toml(_shipped(name).read_bytes(), name).read_or_raise(Scenario)


def _shipped(name: str) -> Traversable:
    return files("posstats.synthetic") / "scenarios" / f"{name}.toml"
