"""Formulas that standards print: with their numbers as printed, not with better ones.

Sources: ASPRS Positional Accuracy Standards for Digital Geospatial Data, Edition 2, clause 7.11;
NSSDA, FGDC-STD-007.3-1998; GB/T 24356-2023.
"""

import math
from dataclasses import dataclass

from posstats.contract.acceptance import Grade
from posstats.statistics.samples import SampleError

NSSDA_EQUAL_FACTOR = 1.7308
NSSDA_UNEQUAL_FACTOR = 2.4477
NSSDA_VERTICAL_FACTOR = 1.9600
NSSDA_LEAST_RATIO = 0.6
"""RMSE_min / RMSE_max from which the formula for unequal components holds."""

EQUAL = "equal"
UNEQUAL = "unequal"
RATIO_BELOW_RANGE = "ratio_below_range"

GBT_FULL_SHARE = 0.3
"""Share of the limit up to which the score is 100."""
GBT_GRADES: tuple[tuple[float, Grade], ...] = ((90.0, "excellent"), (75.0, "good"), (60.0, "pass"))
GBT_FAIL: Grade = "fail"
GBT_SAMPLE_SIZES = (
    (20, 3),
    (40, 5),
    (60, 7),
    (80, 9),
    (100, 10),
    (120, 11),
    (140, 12),
    (160, 13),
    (180, 14),
    (200, 15),
)
"""(largest lot, sample size)."""
GBT_BLUNDER_FACTOR_HIGHER_ACCURACY = 2.0
GBT_BLUNDER_FACTOR_EQUAL_ACCURACY = 2.0 * math.sqrt(2.0)

ROUNDING = 1e-12
"""Relative: 0.06 / 0.10 is 0.6 and 0.7375 of a limit scores 75, whatever binary digits say."""


@dataclass(frozen=True)
class NssdaAccuracy:
    """NSSDA horizontal accuracy at 95 % confidence; None where the standard has no formula.

    Attributes
    ----------
    value
        Metres.
    method
        "equal" (1.7308 RMSE_r) or "unequal" (2.4477 * 0.5 (RMSE_x + RMSE_y)).
    ratio
        RMSE_min / RMSE_max, 1 if both are 0.
    reason
        "ratio_below_range": the ratio is below 0.6.
    """

    value: float | None
    method: str | None
    ratio: float
    reason: str | None = None


def nssda_accuracy_h(rmse_x_m: float, rmse_y_m: float) -> NssdaAccuracy:
    """NSSDA horizontal accuracy at 95 % confidence from the RMSE of both components, metres."""
    low, high = sorted((_length(rmse_x_m), _length(rmse_y_m)))
    ratio = low / high if high else 1.0
    if math.isclose(low, high, rel_tol=ROUNDING):
        return NssdaAccuracy(NSSDA_EQUAL_FACTOR * math.hypot(low, high), EQUAL, ratio)
    if ratio < NSSDA_LEAST_RATIO * (1.0 - ROUNDING):
        return NssdaAccuracy(None, None, ratio, RATIO_BELOW_RANGE)
    return NssdaAccuracy(NSSDA_UNEQUAL_FACTOR * 0.5 * (low + high), UNEQUAL, ratio)


def nssda_accuracy_v(rmse_z_m: float) -> float:
    """NSSDA vertical accuracy at 95 % confidence: 1.9600 RMSE_z, metres."""
    return NSSDA_VERTICAL_FACTOR * _length(rmse_z_m)


def asprs_product_accuracy(fit_m: float, survey_m: float) -> float:
    """ASPRS 7.11: sqrt(fit^2 + survey^2) of the RMSE at check points and of their survey."""
    return math.hypot(_length(fit_m), _length(survey_m))


def gbt_score(found: float, limit: float) -> float | None:
    """GB/T 24356 score of an accuracy m under the limit m0; None: m > m0, which fails.

    100 for m <= 0.3 m0, else 60 + 40 (m0 - m) / (0.7 m0). Both in one unit.
    """
    if _length(limit) == 0.0:
        raise SampleError("a score needs a limit above 0")
    if _length(found) > limit:
        return None
    share = found / limit
    if share <= GBT_FULL_SHARE * (1.0 + ROUNDING):
        return 100.0
    return 60.0 + 40.0 * (1.0 - share) / (1.0 - GBT_FULL_SHARE)


def gbt_grade(score: float | None) -> Grade:
    """GB/T 24356 grade of a score: "excellent", "good", "pass"; "fail" below 60 or for None."""
    if score is None:
        return GBT_FAIL
    if not 0.0 <= score <= 100.0:
        raise SampleError(f"a score lies between 0 and 100, not {score!r}")
    reached = (name for least, name in GBT_GRADES if score >= least * (1.0 - ROUNDING))
    return next(reached, GBT_FAIL)


def gbt_sample_size(lot: int) -> int:
    """GB/T 24356 sample size: that of the smallest lot of the table which holds the lot."""
    largest = GBT_SAMPLE_SIZES[-1][0]
    if not 1 <= lot <= largest or lot != int(lot):
        raise SampleError(f"the table of GB/T 24356 has lots of 1 to {largest} pieces, not {lot!r}")
    return next(size for held, size in GBT_SAMPLE_SIZES if lot <= held)


def gbt_blunder_limit(limit: float, *, check_is_better: bool) -> float:
    """GB/T 24356: 2 m0 for a check of higher accuracy, 2 sqrt(2) m0 for one of equal accuracy."""
    if check_is_better:
        return GBT_BLUNDER_FACTOR_HIGHER_ACCURACY * _length(limit)
    return GBT_BLUNDER_FACTOR_EQUAL_ACCURACY * _length(limit)


def _length(value: float) -> float:
    if not (math.isfinite(value) and value >= 0.0):
        raise SampleError(f"an accuracy is a finite number, not negative: {value!r}")
    return float(value)
