"""What the check points say of the accuracy, whatever a profile asks: estimates and tests.

Measures carry their identifiers of ISO 19157 where it has one. Null hypotheses of the tests: the
mean difference is zero (Hotelling for the vector, Student for each component); the differences
of a component are normal (Shapiro-Wilk); its largest residual is the largest of a normal sample.
"""

from dataclasses import dataclass

import numpy as np

from posstats.acceptance.evidence import Evidence
from posstats.acceptance.quantities import COMPONENTS
from posstats.arrays import Floats
from posstats.statistics.mean_shift import (
    ComponentShift,
    MeanShiftTest,
    component_shifts,
    mean_shift,
)
from posstats.statistics.normality import NormalityTest, normality
from posstats.statistics.outliers import LargestResidual, largest_residuals
from posstats.statistics.percentiles import Percentile, ce_normal, le_normal, percentile_error
from posstats.statistics.rmse import RmseInterval, rmse_interval

SEED = 1
"""Of the bootstrap: the same intervals for whoever computes them again."""
ISO_19157 = {"rmse": 39, "rmse_planimetry": 47, "bias": 128, "covariance": 32,
             "LE90": 35, "LE95": 36, "CE90": 44, "CE95": 45}  # fmt: skip
_PERCENTILES = {"CE90": 0.90, "CE95": 0.95, "LE90": 0.90, "LE95": 0.95}


@dataclass(frozen=True)
class NamedPercentile:
    """A percentile of the sample, and of a normal distribution of the same second moments."""

    name: str
    sample: Percentile
    normal_m: float | None


@dataclass(frozen=True, eq=False)
class AccuracyStatement:
    """Accuracy at n check points, mean shift kept.

    Attributes
    ----------
    rmse
        By the names of `COMPONENTS`.
    percentiles
        CE90, CE95, LE90, LE95.
    covariance_m2
        (3, 3) about the mean; NaN for fewer than two points.
    shift, component_shift
        Tests of a mean difference of zero, together and of X, Y, Z.
    normality, largest
        Tests of X, Y, Z.
    """

    rmse: dict[str, RmseInterval]
    percentiles: tuple[NamedPercentile, ...]
    covariance_m2: Floats
    shift: MeanShiftTest
    component_shift: tuple[ComponentShift, ...]
    normality: tuple[NormalityTest, ...]
    largest: tuple[LargestResidual, ...]


def accuracy_statement(evidence: Evidence) -> AccuracyStatement:
    """Estimates and tests of the check points of an orientation."""
    difference = evidence.difference_m
    n = len(difference)
    return AccuracyStatement(
        rmse={name: rmse_interval(difference[:, list(c)]) for name, c in COMPONENTS.items()},
        percentiles=tuple(_percentile(name, difference) for name in _PERCENTILES),
        covariance_m2=np.cov(difference, rowvar=False) if n > 1 else np.full((3, 3), np.nan),
        shift=mean_shift(difference),
        component_shift=component_shifts(difference),
        normality=normality(difference),
        largest=largest_residuals(difference),
    )


def _percentile(name: str, difference_m: Floats) -> NamedPercentile:
    share = _PERCENTILES[name]
    part = difference_m[:, :2] if name.startswith("CE") else difference_m[:, 2:]
    sample = percentile_error(np.linalg.norm(part, axis=1), share, SEED)
    return NamedPercentile(name, sample, _normal(part, share) if len(part) else None)


def _normal(part_m: Floats, share: float) -> float:
    """Of normal differences of mean zero with the second moments found: the shift is in them."""
    moments = part_m.T @ part_m / len(part_m)
    sigma = np.sqrt(np.diagonal(moments))
    if len(sigma) == 1:
        return le_normal(float(sigma[0]), share)
    both = float(sigma[0] * sigma[1])
    rho = float(np.clip(moments[0, 1] / both, -1.0, 1.0)) if both > 0.0 else 0.0
    return ce_normal(float(sigma[0]), float(sigma[1]), rho, share)
