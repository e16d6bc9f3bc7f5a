"""Numbers become text here and nowhere below: significant digits, units, typographic signs."""

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass

MISSING = "–"
MINUS = "−"
NARROW_SPACE = "\u202f"  # no-break, so that a number never breaks over lines
SMALLEST_P = 0.001

_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def is_missing(value: float | None) -> bool:
    """Whether a value is not available (None, NaN or infinite)."""
    return value is None or not math.isfinite(value)


def present(values: Iterable[float | None]) -> list[float]:
    """The values that are available."""
    return [value for value in values if value is not None and math.isfinite(value)]


def exponent(value: float, digits: int = 3) -> int:
    """Decimal exponent of a value after rounding it to `digits` significant digits."""
    return int(f"{value:.{digits - 1}e}".split("e")[1]) if value else 0


def fixed(value: float | None, decimals: int) -> str:
    """A number with a fixed count of decimals, thousands set apart from 10 000 on."""
    if value is None or not math.isfinite(value):
        return MISSING
    rounded = round(value, decimals) + 0.0  # + 0.0 turns -0.0 into 0.0
    grouping = "," if abs(rounded) >= 10_000 else ""
    text = f"{rounded:{grouping}.{decimals}f}"
    return text.replace(",", NARROW_SPACE).replace("-", MINUS)


def power_of_ten(power: int) -> str:
    """``10⁻⁷`` for -7."""
    return f"10{str(power).translate(_SUPERSCRIPT)}"


def scientific(value: float | None, digits: int = 3) -> str:
    """``4.68 × 10⁻⁷``."""
    if value is None or not math.isfinite(value):
        return MISSING
    mantissa, power = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa.replace('-', MINUS)}\u00a0×\u00a0{power_of_ten(int(power))}"


def as_printed(value: float) -> str:
    """A number with exactly the digits that it was typed with: ``7.857 × 10⁻⁶``, ``−0.459``."""
    mantissa, _, power = repr(value).replace("-", MINUS).partition("e")
    if not power:
        return mantissa
    return f"{mantissa}\u00a0×\u00a0{power_of_ten(int(power.replace(MINUS, '-')))}"


def as_chosen(value: float) -> str:
    """A number that somebody chose, without digits that nobody chose: ``18``, ``0.25``."""
    return f"{value:.10g}".replace("-", MINUS)


def number(value: float | None, digits: int = 3) -> str:
    """A number with `digits` significant digits, in powers of ten where zeros would not be read."""
    if value is None or not math.isfinite(value):
        return MISSING
    if value == 0:
        return "0"
    power = exponent(value, digits)
    if power < -4 or power > 6:
        return scientific(value, digits)
    return fixed(value, max(0, digits - 1 - power))


def count(value: float | None) -> str:
    """A whole number."""
    return fixed(value, 0)


def shared_decimals(values: Iterable[float | None], digits: int = 3) -> int:
    """Decimals that give the median magnitude of a column `digits` significant digits."""
    magnitudes = sorted(abs(value) for value in present(values) if value)
    if not magnitudes:
        return 0
    return max(0, digits - 1 - exponent(magnitudes[len(magnitudes) // 2], digits))


def with_unit(value: float | None, unit: str, digits: int = 3) -> str:
    """A number and its unit, never parted at the end of a line."""
    space = "" if unit.startswith("°") else "\u00a0"
    return MISSING if is_missing(value) else f"{number(value, digits)}{space}{unit}"


def p_value(value: float | None) -> str:
    """A p-value for a table: three decimals, or below 0.001."""
    if value is None or not math.isfinite(value):
        return MISSING
    return f"< {SMALLEST_P}" if value < SMALLEST_P else fixed(value, 3)


def p_phrase(value: float | None) -> str:
    """A p-value for a sentence: ``p = 0.367`` or ``p < 0.001``."""
    text = p_value(value)
    return f"p {text}" if text.startswith("<") else f"p = {text}"


def prose(text: str) -> str:
    """A sentence of the analysis with its numbers and signs as this report writes them."""
    powers = re.sub(
        r"(\d)e([+-]\d+)",
        lambda match: f"{match[1]}\u00a0×\u00a0{power_of_ten(int(match[2]))}",
        text,
    )
    signs = re.sub(r"(?<![\w-])-(?=\d)", MINUS, powers)
    return re.sub(r"\bR2\b", "R²", signs)


def shortened(text: str, length: int = 18) -> str:
    """A long id with its middle left out."""
    half = (length - 1) // 2
    return text if len(text) <= length else f"{text[:half]}…{text[-half:]}"


@dataclass(frozen=True)
class Unit:
    """A unit for showing: its name and how many of it one SI unit is."""

    name: str
    per_si: float

    def scaled(self, value: float | None) -> float | None:
        """The value in this unit; None stays None."""
        return None if value is None else value * self.per_si


DEGREE = Unit("°", math.degrees(1.0))
MILLIRADIAN = Unit("mrad", 1e3)
MICRORADIAN = Unit("µrad", 1e6)
NANORADIAN_PER_SECOND = Unit("nrad/s", 1e9)
METRE = Unit("m", 1.0)


def angle_unit(values_rad: Iterable[float | None]) -> Unit:
    """The unit in which the largest of the angles is read most easily."""
    largest = max((abs(value) for value in present(values_rad)), default=1e-3)
    if largest >= 0.05:
        return DEGREE
    return MILLIRADIAN if largest >= 5e-4 else MICRORADIAN


def angle(value_rad: float | None, digits: int = 3) -> str:
    """An angle in milliradians with degrees in brackets: ``18.5 mrad (1.06°)``."""
    if value_rad is None or not math.isfinite(value_rad):
        return MISSING
    unit = angle_unit([value_rad])
    shown = with_unit(unit.scaled(value_rad), unit.name, digits)
    if unit is DEGREE:
        return shown
    return f"{shown} ({with_unit(DEGREE.scaled(value_rad), DEGREE.name, digits)})"


def rate_unit(rates_rad_per_s: Iterable[float | None]) -> Unit:
    """A power of ten of rad/s in which the largest rate is between 1 and 10."""
    largest = max((abs(value) for value in present(rates_rad_per_s)), default=0.0)
    power = exponent(largest) if largest else 0
    name = f"{power_of_ten(power)}\u00a0rad/s" if power else "rad/s"
    return Unit(name, 10.0**-power)


def rate(value_rad_per_s: float | None) -> str:
    """A drift as the field reads it: ``4.68 × 10⁻⁷ rad/s (0.0965°/h)``."""
    if value_rad_per_s is None or not math.isfinite(value_rad_per_s):
        return MISSING
    per_hour = number(math.degrees(value_rad_per_s) * 3600.0)
    return f"{scientific(value_rad_per_s)}\u00a0rad/s ({per_hour}°/h)"


def by_name(
    name: str, value: object, join: Callable[[Iterable[str]], str], *, plain: bool = False
) -> str:
    """A value of a notice as text: its unit is the suffix of its name.

    Parameters
    ----------
    name
        Such as ``slope_rad_per_s``, ``parallax_px``, ``p_value``.
    value
        A number, a text, several texts, or None.
    join
        Makes an enumeration of texts.
    plain
        Leave counts, and numbers of `_DIGITS`, as Python prints them.
    """
    if isinstance(value, str):
        return value
    if isinstance(value, tuple | list):
        return join(by_name(name, each, join, plain=plain) for each in value)
    if value is None or not isinstance(value, int | float):
        return MISSING
    if name in _DIGITS:
        return _DIGITS[name](value) if plain else prose(_DIGITS[name](value))
    for suffix, write in _WRITTEN.items():
        if name.endswith(suffix):
            return write(value)
    if isinstance(value, int):
        return str(value) if plain else count(value)
    return number(value)


def _short_p_phrase(value: float) -> str:
    return f"p < {SMALLEST_P}" if value < SMALLEST_P else f"p = {value:.2g}"


# Names whose numbers have digits of their own; their unit stands in the sentence.
_DIGITS: dict[str, Callable[[float], str]] = {
    "slope_rad_per_s": "{:.2e}".format,
    "slope_se_rad_per_s": "{:.1e}".format,
    "constant_rad": "{:.2e}".format,
    "constant_se_rad": "{:.1e}".format,
    "r_squared": "{:.3f}".format,
    "min_r_squared": "{:g}".format,
    "p": _short_p_phrase,
    "alpha": "{:g}".format,
    "change_share": "{:.1%}".format,
    "min_gain_share": "{:.0%}".format,
    "prior_fraction": "{:g}".format,
    "n_sigmas": "{:g}".format,
}

_WRITTEN: dict[str, Callable[[float], str]] = {
    "_rad_per_s": rate,
    "_rad": angle,
    "_px": lambda value: with_unit(value, "px"),
    "_mm": lambda value: with_unit(value, "mm"),
    "_m": lambda value: with_unit(value, "m"),
    "_s": lambda value: with_unit(value, "s"),
    "_share": lambda value: with_unit(100.0 * value, "%"),
    "p_value": p_value,
}
