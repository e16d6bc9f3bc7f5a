"""Units in which values of an adjustment are shown."""

from collections.abc import Sequence

from ..document import format as fmt

_UNITS = {
    "rad/s": fmt.NANORADIAN_PER_SECOND,
    "m/s": fmt.Unit("mm/s", 1e3),
    "1/mm2": fmt.Unit("1/mm²", 1.0),
    "standard deviations": fmt.Unit("σ", 1.0),
}


def unit_of(unit: str) -> fmt.Unit:
    """The unit in which values of a unit of the results are shown; angles in degrees."""
    return fmt.DEGREE if unit == "rad" else _UNITS.get(unit, fmt.Unit(unit, 1.0))


def scaled(values: Sequence[float | None], units: Sequence[fmt.Unit]) -> list[float | None]:
    """Values in the units in which they are shown, one unit each."""
    return [unit.scaled(value) for value, unit in zip(values, units, strict=True)]
