"""Reading results: order of strips, means over models, names of angles, errors over time."""

from collections.abc import Iterable, Sequence
from typing import Protocol

from posstats.contract.results import ImageAngleErrors, Results
from posstats.numerics.kernels.rotation import ANGLE_NAMES, CAMERA_ANGLE_NAMES

from ..document import format as fmt

HELD = ("angles", *ANGLE_NAMES, "none")  # in the order of showing


class StripMean(Protocol):
    """Mean parallax over the models of a strip."""

    @property
    def strip(self) -> str:
        """Id of the strip."""
        ...

    @property
    def n_models(self) -> int:
        """Models with a value."""
        ...

    @property
    def mean_px(self) -> float | None:
        """Mean over the models."""
        ...

    @property
    def mean_mm(self) -> float | None:
        """The same in mm."""
        ...


def strips(results: Results) -> list[str]:
    """Strip ids in the order of flight (as the images come, then as the tables name them)."""
    named = [
        *(row.strip for row in results.images),
        *(row.strip for row in results.angle_errors),
        *(row.strip for row in results.parallax),
    ]
    return list(dict.fromkeys(named))


def strips_with_models(results: Results) -> list[str]:
    """Strip ids that form at least one stereo model."""
    present = {row.strip for row in results.models}
    present |= {row.strip for row in results.parallax if row.n_models}
    return [strip for strip in strips(results) if strip in present]


def mean_in(row: StripMean, unit: str) -> float | None:
    """Mean parallax of a strip in px or mm."""
    return row.mean_px if unit == "px" else row.mean_mm


def mean_over_models(per_strip: Iterable[StripMean | None], unit: str = "px") -> float | None:
    """Mean over the models of the block: strip means weighted by the models of their strips."""
    known = [
        (row.n_models, mean)
        for row in per_strip
        if row and (mean := mean_in(row, unit)) is not None
    ]
    weight = sum(n for n, _ in known)
    return sum(n * mean for n, mean in known) / weight if weight else None


def used_errors(results: Results, angle: str) -> list[ImageAngleErrors]:
    """Images whose error of an angle is determined."""
    return [
        row
        for row in results.angle_errors
        if row.used and not fmt.is_missing(_error_of(row, angle))
    ]


def errors_of(data: Sequence[ImageAngleErrors], angle: str) -> list[float]:
    """Errors of an angle, rad, of images where it is determined."""
    return fmt.present(_error_of(row, angle) for row in data)


def _error_of(row: ImageAngleErrors, angle: str) -> float | None:
    error: float | None = getattr(row, f"{angle}_rad")
    return error


def decided_by_strip(results: Results) -> bool:
    """Whether corrections were decided strip by strip, not for the block as a whole."""
    return results.settings.scope == "strip"


def angles(frame: str) -> tuple[str, str, str]:
    """Names of the three angles in a frame."""
    return CAMERA_ANGLE_NAMES if frame == "camera" else ANGLE_NAMES
