"""What one simulated area shows, in numbers, and which of the paper's findings it bears out."""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Protocol, TypeVar

from posstats.contract.check_points import CheckPointStatistics
from posstats.contract.results import Regression, Results
from posstats.geometry.stereo.parallax import NOTICEABLE
from posstats.numerics.kernels.rotation import ANGLE_NAMES
from posstats.papers.drift.areas import TrueCauses
from posstats.synthetic import Scenario

STRIP = "1"
"""Strip of area 1 that stands for Table 3, whose numbers imply one strip of 60 images."""

ALPHA = 0.05
LINEAR_R_SQUARED = 0.95
HARDLY = 1.0 / 3.0
"""Share of the parallax of the angles, noise apart, below which positions make hardly any."""
HORIZONTAL_GAIN, VERTICAL_GAIN = (0.5, 1.0), (1.0, 2.0)
"""By how many times the paper's text says that check points improve."""
NEAR_RELATIVE = 1.6
"""Corrected parallax at most this many times what relative orientation leaves."""


@dataclass(frozen=True)
class AreaFindings:
    """Measured values of one area.

    Attributes
    ----------
    pos_mm, independent_mm, dependent_mm
        Mean RMS y-parallax of all models, at image scale.
    angles_mm, positions_mm
        The same with only the angles, or only the positions, of the POS in error.
    held_angles_mm, held_omega_mm, held_phi_mm, held_kappa_mm
        The same after relative orientation with POS angles of the right image held.
    corrected_omega_mm, corrected_phi_mm, corrected_kappa_mm
        The same after taking the line of one angle off.
    strip_omega_r_squared, strip_phi_p, strip_kappa_p
        OLS over strip `STRIP`.
    corrected_angles
        Angles that the rules chose, joined by "+"; empty if none.
    pos_horizontal_m, pos_vertical_m, corrected_horizontal_m, corrected_vertical_m
        RMSE of the check points, mean difference removed, from POS and with the omega line taken
        off (Table 4).
    ols_covers, gls_covers
        Share of the three angles whose 95 % interval of the slope over strip `STRIP` holds the
        simulated drift.
    """

    area: int
    pos_mm: float
    independent_mm: float
    dependent_mm: float
    angles_mm: float
    positions_mm: float
    held_angles_mm: float
    held_omega_mm: float
    held_phi_mm: float
    held_kappa_mm: float
    corrected_omega_mm: float
    corrected_phi_mm: float
    corrected_kappa_mm: float
    strip_omega_r_squared: float
    strip_phi_p: float
    strip_kappa_p: float
    corrected_angles: str
    pos_horizontal_m: float
    pos_vertical_m: float
    corrected_horizontal_m: float
    corrected_vertical_m: float
    ols_covers: float
    gls_covers: float

    @property
    def angles_dominate(self) -> bool:
        """POS angles alone make the parallax of the POS, POS positions alone hardly any.

        The paper's own test, that independent and dependent orientation leave the same, cannot
        tell the two apart: both span the same five dimensions.
        """
        by_angles, by_positions = (
            math.sqrt(max(alone**2 - self.independent_mm**2, 0.0))
            for alone in (self.angles_mm, self.positions_mm)
        )
        return (
            abs(self.angles_mm - self.pos_mm) < NOTICEABLE * self.pos_mm
            and by_positions < HARDLY * by_angles
        )

    @property
    def kept_by(self) -> dict[str, float]:
        """Parallax that holding one angle keeps, as a share of what holding all three keeps."""
        kept: dict[str, float] = {angle: getattr(self, f"held_{angle}_mm") for angle in ANGLE_NAMES}
        all_three = self.held_angles_mm - self.dependent_mm
        return {angle: (value - self.dependent_mm) / all_three for angle, value in kept.items()}

    @property
    def omega_is_the_source(self) -> bool:
        """Holding omega keeps what holding all keeps; holding phi or kappa keeps little."""
        kept = self.kept_by
        return (
            self.held_angles_mm > (1.0 + NOTICEABLE) * self.dependent_mm
            and kept["omega"] > 1.0 - NOTICEABLE
            and max(kept["phi"], kept["kappa"]) < NOTICEABLE
        )

    @property
    def only_omega_is_linear(self) -> bool:
        """Table 3: omega follows time almost without scatter, phi and kappa do not follow it."""
        return (
            self.strip_omega_r_squared > LINEAR_R_SQUARED
            and self.strip_phi_p > ALPHA
            and self.strip_kappa_p > ALPHA
        )

    @property
    def omega_alone_is_chosen(self) -> bool:
        """The paper's rules correct omega and nothing else."""
        return self.corrected_angles == "omega"

    @property
    def only_omega_helps(self) -> bool:
        """Figure 3: the omega line brings the parallax near relative orientation's, others none."""
        unchanged = (1.0 - NOTICEABLE) * self.pos_mm
        return (
            self.corrected_omega_mm < unchanged
            and self.corrected_omega_mm <= NEAR_RELATIVE * self.independent_mm
            and min(self.corrected_phi_mm, self.corrected_kappa_mm) > unchanged
        )

    @property
    def check_points_improve(self) -> bool:
        """Table 4: the RMSE falls, horizontally and vertically."""
        return (
            self.corrected_horizontal_m < self.pos_horizontal_m
            and self.corrected_vertical_m < self.pos_vertical_m
        )

    @property
    def gain(self) -> tuple[float, float]:
        """RMSE before over after, minus 1, horizontal and vertical."""
        return (
            self.pos_horizontal_m / self.corrected_horizontal_m - 1.0,
            self.pos_vertical_m / self.corrected_vertical_m - 1.0,
        )

    @property
    def gains_as_published(self) -> bool:
        """Check points improve by the factors that the paper's text names."""
        ranges = (HORIZONTAL_GAIN, VERTICAL_GAIN)
        return all(low <= gain <= high for gain, (low, high) in zip(self.gain, ranges, strict=True))

    @property
    def over_relative(self) -> float:
        """Parallax with omega corrected over what relative orientation leaves."""
        return self.corrected_omega_mm / self.independent_mm


CRITERIA = (
    "angles_dominate",
    "omega_is_the_source",
    "only_omega_is_linear",
    "omega_alone_is_chosen",
    "only_omega_helps",
    "check_points_improve",
    "gains_as_published",
)
"""Names of the yes-or-no properties of `AreaFindings`."""


def find(area: int, results: Results, scenario: Scenario, causes: TrueCauses) -> AreaFindings:
    """The findings of one area.

    Parameters
    ----------
    area
        1, 2 or 3.
    results
        Of the area, analysed by the paper's rules in the ground frame.
    scenario
        What was simulated: the true drifts.
    causes
        What the errors of the POS make alone.
    """
    verdict = results.verdict
    points = {name: _check_points(results, name) for name in ("pos", "omega")}
    line = {angle: _line(results, angle) for angle in ANGLE_NAMES}
    return AreaFindings(
        area=area,
        pos_mm=known(verdict.raw_mm),
        independent_mm=known(verdict.relative_mm),
        dependent_mm=_mean_mm(results.parallax, method="dependent"),
        angles_mm=causes.angles_mm,
        positions_mm=causes.positions_mm,
        **{
            f"held_{name}_mm": _mean_mm(results.error_sources, fixed=name)
            for name in ("angles", *ANGLE_NAMES)
        },
        **{
            f"corrected_{name}_mm": _mean_mm(results.corrected_parallax, corrected=name)
            for name in ANGLE_NAMES
        },
        strip_omega_r_squared=known(line["omega"].r_squared),
        strip_phi_p=known(line["phi"].p_value),
        strip_kappa_p=known(line["kappa"].p_value),
        corrected_angles="+".join(verdict.corrected_angles),
        pos_horizontal_m=known(points["pos"].rmse_horizontal_m),
        pos_vertical_m=known(points["pos"].rmse_vertical_m),
        corrected_horizontal_m=known(points["omega"].rmse_horizontal_m),
        corrected_vertical_m=known(points["omega"].rmse_vertical_m),
        ols_covers=_coverage({a: row.slope_ci95 for a, row in line.items()}, scenario),
        gls_covers=_coverage({a: row.gls_slope_ci95 for a, row in line.items()}, scenario),
    )


def _line(results: Results, angle: str) -> Regression:
    """Regression of one angle over strip `STRIP`."""
    return only_row(results.regression, angle=angle, scope=STRIP, frame="ground")


def _coverage(
    intervals: Mapping[str, tuple[float | None, float | None] | None], scenario: Scenario
) -> float:
    """Share of the intervals of slopes that hold the simulated drift."""
    inside = []
    for angle, interval in intervals.items():
        low, high = known(interval)
        true: float = getattr(scenario.errors, angle).drift_rad_per_s
        inside.append(known(low) <= true <= known(high))
    return sum(inside) / len(inside)


def _check_points(results: Results, orientation: str) -> CheckPointStatistics:
    return only_row(results.check_points, orientation=orientation, translation_removed=True)


class _StripMean(Protocol):
    @property
    def n_models(self) -> int: ...

    @property
    def mean_mm(self) -> float | None: ...


def _mean_mm(strips: Iterable[_StripMean], **conditions: object) -> float:
    """Mean over all models: strip means weighted by the models of their strips."""
    chosen = list(_rows(strips, conditions))
    n_models = sum(row.n_models for row in chosen)
    total = sum(row.n_models * known(row.mean_mm) for row in chosen)
    return float(total / n_models)


T = TypeVar("T")


def known(value: T | None) -> T:
    """A value that the results of a simulated area hold.

    Raises
    ------
    ValueError
        If they lack it.
    """
    if value is None:
        raise ValueError("the results of the area lack a value")
    return value


def only_row(listed: Iterable[T], **conditions: object) -> T:
    """The one row of a list of the results whose values equal the conditions."""
    (row,) = _rows(listed, conditions)
    return row


def _rows(listed: Iterable[T], conditions: Mapping[str, object]) -> Iterator[T]:
    for row in listed:
        if all(getattr(row, name) == value for name, value in conditions.items()):
            yield row
