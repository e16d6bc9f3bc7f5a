"""Numbers of the acceptance document: one unit of length throughout, and a form per quantity."""

import re
from collections.abc import Iterable
from dataclasses import dataclass

from posstats.acceptance.quantity_names import QUANTITIES
from posstats.contract.acceptance import Acceptance, JudgedRequirement

from ..document import format as fmt

CENTIMETRE = fmt.Unit("cm", 100.0)
LARGE_LIMIT_M, LARGE_VALUE_M = 1.0, 10.0  # from which metres are read more easily
FINE_M = 0.1  # limits below which another decimal counts
MOST_DECIMALS = 6

COUNTS = {"n_check_points", "n_blunders_h", "n_blunders_v", "sample_size"}
SHARES = {"measured_share", "quadrant_share"}
PROBABILITIES = {"remaining_drift_p"}
AT_LEAST = {name for name, each in QUANTITIES.items() if each.sense == "at least"}


@dataclass(frozen=True)
class Lengths:
    """How lengths are written in one document: unit and decimals of accuracies."""

    unit: fmt.Unit
    decimals: int

    def number(self, value_m: float | None, fewer: int = 0) -> str:
        """A length without its unit, with fewer decimals if wanted."""
        return fmt.fixed(self.unit.scaled(value_m), max(0, self.decimals - fewer))

    def text(self, value_m: float | None, fewer: int = 0) -> str:
        """A length with its unit."""
        return _joined(self.number(value_m, fewer), self.unit.name)


def lengths(acceptance: Acceptance) -> Lengths:
    """Centimetres, or metres where limits or values are large."""
    rows = [row for row in acceptance.requirements if row.unit == "m"]
    product = acceptance.product
    limits = fmt.present([*(row.limit for row in rows), product.class_h_m, product.class_v_m])
    found = fmt.present(row.found for row in rows)
    found += fmt.present(row.value_m for row in acceptance.accuracy.rmse)
    fine = min((limit for limit in limits if limit > 0.0), default=1.0) < FINE_M
    large = max(limits, default=0.0) >= LARGE_LIMIT_M or max(found, default=0.0) >= LARGE_VALUE_M
    return Lengths(fmt.METRE, 4 if fine else 3) if large else Lengths(CENTIMETRE, 2 if fine else 1)


def pair(row: JudgedRequirement, unit: Lengths) -> tuple[str, str]:
    """Found value and limit of a requirement; different numbers never look the same."""
    found, limit = row.found, row.limit
    for more in range(MOST_DECIMALS):
        texts = value(row, found, unit, more), value(row, limit, unit, more)
        if found is None or limit is None or found == limit or texts[0] != texts[1]:
            break
    return texts


def value(row: JudgedRequirement, number: float | None, unit: Lengths, more: int = 0) -> str:
    """A value of a requirement's quantity with its unit.

    Parameters
    ----------
    row
        The requirement.
    number
        In the unit of the requirement.
    unit
        Of lengths.
    more
        Decimals beyond the usual.
    """
    if number is None:
        return fmt.MISSING
    if row.unit == "m":
        return Lengths(unit.unit, unit.decimals + more).text(number)
    if row.unit == "px":
        return _joined(fmt.fixed(number, 3 + more), "px")
    return _pure(row.quantity, number, more)


def limit(row: JudgedRequirement, unit: Lengths) -> str:
    """The limit of a requirement with the sign of its sense: ``≤ 10.00 cm``."""
    if row.limit is None:
        return fmt.MISSING
    return f"{'≥' if row.quantity in AT_LEAST else '≤'}\u00a0{pair(row, unit)[1]}"


def margin(row: JudgedRequirement, unit: Lengths) -> str:
    """The margin with its sign: above zero within the limit."""
    if row.margin is None:
        return fmt.MISSING
    text = next(
        (
            each
            for each in (value(row, row.margin, unit, more) for more in range(MOST_DECIMALS))
            if row.margin == 0.0 or re.search("[1-9]", each)
        ),
        value(row, row.margin, unit),
    )
    return text if row.margin <= 0.0 else f"+{text}"


def interval(row: JudgedRequirement, unit: Lengths, between: str) -> str:
    """Confidence interval of a found value, its unit once."""
    if row.low is None or row.high is None:
        return fmt.MISSING
    low, high = value(row, row.low, unit), value(row, row.high, unit)
    return f"{low.split(chr(0xA0))[0]}{between}{high}"


def decimals_for(values_m: Iterable[float | None], unit: Lengths) -> int:
    """Decimals of single differences: one fewer than of accuracies, but at least millimetres."""
    large = max((abs(each) for each in fmt.present(values_m)), default=0.0) >= LARGE_VALUE_M
    return max(1 if unit.unit is CENTIMETRE else 2, unit.decimals - 1 - large)


def _pure(quantity: str, number: float, more: int) -> str:
    if quantity in COUNTS:
        return fmt.count(number) if number == round(number) else fmt.fixed(number, 1 + more)
    if quantity in SHARES:
        return _joined(fmt.fixed(100.0 * number, more), "%")
    if quantity in PROBABILITIES:
        return fmt.p_value(number) if not more else fmt.fixed(number, 3 + more)
    return fmt.fixed(number, 2 + more)


def _joined(number: str, unit: str) -> str:
    return number if number == fmt.MISSING else f"{number}\u00a0{unit}"
