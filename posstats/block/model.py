"""The block: what was flown and measured, as frozen arrays in one Cartesian computing frame."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Self

import numpy as np
import pandas as pd

from posstats.arrays import Bools, Floats, Ids, Ints
from posstats.block.camera import Camera
from posstats.block.frames import GroundFrame
from posstats.contract.notice import Notice
from posstats.numerics.kernels.rotation import AngleSystem, rotation_from_angles

BLOCK_SCOPE = "block"
"""Scope of what concerns all strips, where else a strip's id stands; no strip has this id."""


@dataclass(frozen=True, eq=False)
class Orientations:
    """Exterior orientations of n images, in the computing frame, sorted by time.

    Attributes
    ----------
    image, strip
        (n,) ids, text.
    time_s
        (n,) exposure times, seconds of any origin.
    position_m
        (n, 3) projection centres.
    angles_rad
        (n, 3) omega, phi, kappa of `system`.
    camera
        (n,) index into the block's cameras.
    sigma_position_m, sigma_angles_rad
        (n, 3) stated standard deviations.
    """

    image: Ids
    strip: Ids
    time_s: Floats
    position_m: Floats
    angles_rad: Floats
    camera: Ints
    sigma_position_m: Floats
    sigma_angles_rad: Floats
    system: AngleSystem = "omega-phi-kappa"

    def __len__(self) -> int:
        return len(self.image)

    @property
    def ground_from_image(self) -> Floats:
        """(n, 3, 3) rotations."""
        return rotation_from_angles(self.angles_rad, self.system)

    @property
    def strips(self) -> tuple[str, ...]:
        """Ids of the strips in order of flight."""
        return tuple(dict.fromkeys(self.strip))

    def with_angles(self, angles_rad: Floats) -> Self:
        """The same images turned otherwise; angles_rad (n, 3)."""
        return replace(self, angles_rad=angles_rad)


@dataclass(frozen=True, eq=False)
class TiePoints:
    """Image measurements of m rays to p points, sorted by point, then image.

    Attributes
    ----------
    point_id
        (p,) ids, text.
    point, image
        (m,) indices into `point_id` and into the block's orientations.
    xy_px
        (m, 2) ideal image coordinates: x right, y up, from the principal point, no distortion.
    """

    point_id: Ids
    point: Ints
    image: Ints
    xy_px: Floats

    def __len__(self) -> int:
        return len(self.point)

    def subset(self, keep: Bools) -> Self:
        """The measurements where `keep` (m,) is true; the points keep their numbers."""
        return replace(self, point=self.point[keep], image=self.image[keep], xy_px=self.xy_px[keep])


@dataclass(frozen=True, eq=False)
class GroundPoints:
    """Surveyed points in the computing frame.

    Attributes
    ----------
    point
        (g,) ids, as in the tie points.
    position_m
        (g, 3).
    is_check
        (g,) true for check points, false for control.
    sigma_xy_m, sigma_z_m
        (g,) survey standard deviations, NaN where not stated.
    """

    point: Ids
    position_m: Floats
    is_check: Bools
    sigma_xy_m: Floats
    sigma_z_m: Floats

    @classmethod
    def none(cls) -> Self:
        """No points at all."""
        empty = np.empty(0)
        return cls(empty.astype(object), np.empty((0, 3)), empty.astype(bool), empty, empty)

    def __len__(self) -> int:
        return len(self.point)

    def subset(self, which: Bools | Ints) -> Self:
        """The points where `which` (g,) is true, or of these numbers."""
        return replace(self, **{name: values[which] for name, values in vars(self).items()})


@dataclass(frozen=True)
class Accuracy:
    """A-priori standard deviations of the block, used as weights."""

    position_m: float = 0.05
    angle_rad: float = float(np.radians(0.005))
    image_px: float = 0.2


@dataclass(frozen=True, eq=False)
class OrientationTable:
    """orientations.csv as it was read, so that corrected orientations are written alike.

    Attributes
    ----------
    table
        All columns as text, in the order of the file.
    row
        (n,) row of each image of the block's (sorted) orientations.
    angle_columns
        The three angle columns' names.
    """

    table: pd.DataFrame
    row: Ints
    angle_columns: tuple[str, str, str]


@dataclass(frozen=True, eq=False)
class Block:
    """A photogrammetric block, complete and checked.

    `settings` is block.toml as read; `inputs` lists (file name, SHA-256) of what was read;
    `notices` say what is odd about it.
    """

    name: str
    cameras: tuple[Camera, ...]
    orientations: Orientations
    tie_points: TiePoints
    frame: GroundFrame
    accuracy: Accuracy = Accuracy()
    ground_points: GroundPoints | None = None
    adjusted: Orientations | None = None
    simulated: bool = False
    settings: Mapping[str, Any] = field(default_factory=dict)
    source: OrientationTable | None = None
    folder: Path | None = None
    inputs: tuple[tuple[str, str], ...] = ()
    notices: tuple[Notice, ...] = ()

    @property
    def check_points(self) -> Bools:
        """(p,) true for the tie points' `point_id` that are check points."""
        if self.ground_points is None:
            return np.zeros(len(self.tie_points.point_id), dtype=bool)
        checks = set(self.ground_points.point[self.ground_points.is_check])
        return np.fromiter(
            (point in checks for point in self.tie_points.point_id),
            dtype=bool,
            count=len(self.tie_points.point_id),
        )

    def with_angles(self, angles_rad: Floats) -> Self:
        """The same block with other POS angles (n, 3), radians, computing frame."""
        return replace(self, orientations=self.orientations.with_angles(angles_rad))
