"""Reading the results dictionary (``results.json``): selections of rows, order of strips, words."""

from collections.abc import Iterable, Mapping
from typing import Any

from ..document import format as fmt

Results = Mapping[str, Any]
Row = Mapping[str, Any]

GROUND_ANGLES = ("omega", "phi", "kappa")
CAMERA_ANGLES = ("pitch", "roll", "yaw")
METHODS = {
    "pos": "POS as delivered",
    "independent": "Independent orientation",
    "dependent": "Dependent orientation",
}
FIXED = {
    "angles": "all three angles held",
    "omega": "omega held",
    "phi": "phi held",
    "kappa": "kappa held",
    "none": "none held",
}


def rows(results: Results, key: str, **conditions: object) -> list[Row]:
    """Rows of one list of the results whose values equal the conditions."""
    return [
        row
        for row in results.get(key) or ()
        if all(row.get(name) == value for name, value in conditions.items())
    ]


def first(results: Results, key: str, **conditions: object) -> Row:
    """The first row that meets the conditions, or an empty row."""
    return next(iter(rows(results, key, **conditions)), {})


def strips(results: Results) -> list[str]:
    """Strip ids in the order of flight (as the images come, then as the tables name them)."""
    named = [
        row["strip"] for key in ("images", "angle_errors", "parallax") for row in rows(results, key)
    ]
    return list(dict.fromkeys(named))


def strips_with_models(results: Results) -> list[str]:
    """Strip ids that form at least one stereo model."""
    present = {row["strip"] for row in rows(results, "models")}
    present |= {row["strip"] for row in rows(results, "parallax") if row.get("n_models")}
    return [strip for strip in strips(results) if strip in present]


def mean_over_models(per_strip: Iterable[Row], key: str = "mean_px") -> float | None:
    """Mean over the models of the block: strip means weighted by the models of their strips."""
    known = [row for row in per_strip if not fmt.is_missing(row.get(key))]
    weight = sum(row["n_models"] for row in known)
    return sum(row["n_models"] * row[key] for row in known) / weight if weight else None


def setting(results: Results, name: str, default: str = "") -> str:
    """One setting of the analysis as text."""
    return str((results.get("settings") or {}).get(name) or default)


def decided_by_strip(results: Results) -> bool:
    """Whether corrections were decided strip by strip, not for the block as a whole."""
    return setting(results, "scope", "block") == "strip"


def verdict(results: Results) -> Row:
    """The block's verdict in numbers."""
    return results.get("verdict") or {}


def has_mm(results: Results) -> bool:
    """Whether the pixel size is known, so that parallax can be given in millimetres."""
    return bool((results.get("units") or {}).get("mm"))


def frames(results: Results) -> list[str]:
    """Frames in which angle errors were regressed, ground first."""
    return list(dict.fromkeys(row["frame"] for row in rows(results, "regression")))


def angles(frame: str) -> tuple[str, str, str]:
    """Names of the three angles in a frame."""
    return CAMERA_ANGLES if frame == "camera" else GROUND_ANGLES


def orientation_label(results: Results, orientation: str) -> str:
    """An orientation or correction in words."""
    chosen = verdict(results).get("corrected_angles") or []
    words = {
        "pos": "POS as delivered",
        "selected": f"selected ({' + '.join(chosen)})" if chosen else "selected (none)",
        "adjusted": "adjusted orientation",
        "bundle": "bundle block adjustment",
    }
    return words.get(orientation, f"{orientation} corrected")


def scope_label(scope: str) -> str:
    """``block``, or the strip in words."""
    return "block" if scope == "block" else f"strip {scope}"
