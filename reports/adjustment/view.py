"""Reading the results of an adjustment (``adjustment.json``): names and units in words."""

import math
from collections.abc import Mapping
from typing import Any

from ..document import format as fmt

Results = Mapping[str, Any]
Row = Mapping[str, Any]

_AXES = {"x": "X", "y": "Y", "z": "Z"}
GROUPS = {
    "image": "image coordinates",
    "gnss": "GNSS positions",
    "imu": "IMU angles",
    "control": "control points",
    "parameters": "prior values of parameters",
}
KINDS = {
    "image": "image ray",
    "axes": "image with wrong axes",
    "gnss": "GNSS position",
    "imu": "IMU angles",
    "control": "control point",
}
SEVERAL = {"axes": "the axes", "gnss": "GNSS positions", "imu": "IMU angles"}
_UNITS: Mapping[str, fmt.Unit] = {
    "rad": fmt.DEGREE,
    "rad/s": fmt.NANORADIAN_PER_SECOND,
    "m/s": fmt.Unit("mm/s", 1e3),
    "1/mm2": fmt.Unit("1/mm²", 1.0),
}
DRIFTS = {"none": "no POS parameters", "block": "for the block", "strip": "for every strip"}
CONTROL = {
    "roles": "as the ground points say",
    "none": "none",
    "centre": "one point near the middle",
    "corners": "four points near the corners",
    "all": "all ground points",
}
DEFORMATION = {"none": "none", "bauer": "after Bauer", "brown": "after Brown"}


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


def parameter_words(name: str) -> str:
    """A parameter as it is called in a sentence: ``omega drift``, ``GNSS X shift``."""
    source, _, rest = name.partition("_")
    if source == "gnss":
        axis, kind = rest.split("_")
        return f"GNSS {_AXES[axis]} {kind}"
    if source == "imu":
        return rest.replace("_", " ")
    if source == "boresight":
        return f"boresight {rest}"
    if source == "lever":
        return f"lever arm {rest.rpartition('_')[2]}"
    if source == "camera":
        return "principal distance" if rest == "c" else f"principal point {rest}"
    return f"{source.capitalize()} {rest}"


def shown_unit(unit: str) -> fmt.Unit:
    """The unit in which values of a unit of the results are shown."""
    return _UNITS.get(unit, fmt.Unit(unit, 1.0))


def value_words(row: Row, key: str = "value") -> str:
    """A parameter's value with its unit; drifts of angles in rad/s and degrees per hour."""
    value = row.get(key)
    if row["unit"] == "rad/s":
        return fmt.rate(value)
    unit = shown_unit(row["unit"])
    return fmt.with_unit(unit.scaled(value), unit.name)


def group(results: Results, name: str) -> Row:
    """One group of observations."""
    return next(iter(rows(results, "groups", group=name)), {})


def predicted_rmse(results: Results) -> tuple[float, float] | None:
    """RMSE H and V of check points that their covariances predict; None without check points."""
    points = rows(results, "check_point_residuals", orientation="bundle", status="ok")
    sigma = [[row[f"sigma_{axis}_m"] for axis in "xyz"] for row in points]
    if not sigma or any(fmt.is_missing(value) for row in sigma for value in row):
        return None
    n = len(sigma)
    horizontal = math.sqrt(sum(x * x + y * y for x, y, _ in sigma) / n)
    return horizontal, math.sqrt(sum(z * z for *_, z in sigma) / n)
