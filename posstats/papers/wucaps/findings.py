"""What a simulated situation shows, in numbers, and which of the paper's findings it bears out."""

from dataclasses import dataclass

from posstats.contract.choices import ControlSubset
from posstats.geometry.stereo.parallax import NOTICEABLE
from posstats.papers.wucaps.adjustments import CONTROLS
from posstats.papers.wucaps.experiment import SituationRun
from posstats.papers.wucaps.situations import Situation

RECOMMENDED: dict[Situation, ControlSubset] = {"flat": "corners", "mountain": "centre"}
"""The control points that the paper recommends."""
LESS: dict[Situation, ControlSubset] = {"flat": "centre", "mountain": "none"}
"""The next smaller choice."""

MOST_HORIZONTAL = 2.0
MOST_VERTICAL = 2.2
"""RMSE of check points, over that without systematic errors, at which these count as removed."""


@dataclass(frozen=True)
class SituationFindings:
    """Measured values of one situation.

    Attributes
    ----------
    *_horizontal_m, *_vertical_m
        RMSE of the check points: reference (no systematic errors, all control points); POS as
        recorded (`pos`), calibrated, and with the lines of all strips and angles taken off
        (`lines`), without control; bundle without unknowns of the POS (`bundle`), with weighted
        ones (`weighted`), with these on the calibrated POS (`both`), with free ones (`free`,
        central point). Of control, `weighted` has what its name says, `bundle` and `both` have
        the recommended.
    *_predicted_*_m
        The same from the covariance.
    relative_mm, pos_mm, calibrated_mm, lines_mm, bundle_mm, weighted_mm
        Mean RMS y-parallax of the models after relative orientation, and from these orientations;
        `bundle` and `weighted` with the recommended control.
    free_undetermined
        Names of the free parameters that one central point does not determine, joined by "+".
    """

    situation: Situation
    reference_horizontal_m: float
    reference_vertical_m: float
    reference_predicted_horizontal_m: float
    reference_predicted_vertical_m: float
    pos_horizontal_m: float
    pos_vertical_m: float
    calibrated_horizontal_m: float
    calibrated_vertical_m: float
    lines_horizontal_m: float
    lines_vertical_m: float
    bundle_horizontal_m: float
    bundle_vertical_m: float
    weighted_none_horizontal_m: float
    weighted_none_vertical_m: float
    weighted_none_predicted_horizontal_m: float
    weighted_none_predicted_vertical_m: float
    weighted_centre_horizontal_m: float
    weighted_centre_vertical_m: float
    weighted_centre_predicted_horizontal_m: float
    weighted_centre_predicted_vertical_m: float
    weighted_corners_horizontal_m: float
    weighted_corners_vertical_m: float
    weighted_corners_predicted_horizontal_m: float
    weighted_corners_predicted_vertical_m: float
    weighted_all_horizontal_m: float
    weighted_all_vertical_m: float
    weighted_all_predicted_horizontal_m: float
    weighted_all_predicted_vertical_m: float
    both_horizontal_m: float
    both_vertical_m: float
    free_horizontal_m: float
    free_vertical_m: float
    relative_mm: float
    pos_mm: float
    calibrated_mm: float
    lines_mm: float
    bundle_mm: float
    weighted_mm: float
    free_undetermined: str

    def ratios(self, name: str) -> tuple[float, float]:
        """RMSE over the reference's, horizontal and vertical: ``ratios("weighted_centre")``."""
        horizontal: float = getattr(self, f"{name}_horizontal_m")
        vertical: float = getattr(self, f"{name}_vertical_m")
        return horizontal / self.reference_horizontal_m, vertical / self.reference_vertical_m

    def _as_if_without_errors(self, name: str) -> bool:
        horizontal, vertical = self.ratios(name)
        return horizontal <= MOST_HORIZONTAL and vertical <= MOST_VERTICAL

    @property
    def recommended(self) -> str:
        """Name of the weighted adjustment with the recommended control."""
        return f"weighted_{RECOMMENDED[self.situation]}"

    @property
    def calibration_is_not_enough(self) -> bool:
        """Calibrated POS alone: heights and parallax are far from the best."""
        return (
            self.ratios("calibrated")[1] > MOST_VERTICAL
            and self.calibrated_mm > 2.0 * self.relative_mm
        )

    @property
    def unknowns_are_needed(self) -> bool:
        """The bundle without unknowns of the POS keeps systematic errors."""
        return not self._as_if_without_errors("bundle")

    @property
    def errors_are_removed(self) -> bool:
        """The weighted adjustment with the recommended control comes near the best."""
        return self._as_if_without_errors(self.recommended)

    @property
    def less_control_is_not_enough(self) -> bool:
        """The next smaller choice of control does not."""
        return not self._as_if_without_errors(f"weighted_{LESS[self.situation]}")

    @property
    def calibration_is_dispensable(self) -> bool:
        """The weighted adjustment is no more accurate if the POS was calibrated before."""
        horizontal, vertical = self.ratios(self.recommended)
        calibrated = self.ratios("both")
        most = 1.0 + NOTICEABLE
        return horizontal <= most * calibrated[0] and vertical <= most * calibrated[1]

    @property
    def parallax_is_removed(self) -> bool:
        """The weighted adjustment leaves no more parallax than relative orientation."""
        return self.weighted_mm <= (1.0 + NOTICEABLE) * self.relative_mm

    @property
    def one_point_leaves_free_unknowns_open(self) -> bool:
        """Free shifts and drifts of every strip are not determined by one central point."""
        return self.free_undetermined != ""


CRITERIA = (
    "calibration_is_not_enough",
    "unknowns_are_needed",
    "errors_are_removed",
    "less_control_is_not_enough",
    "calibration_is_dispensable",
    "parallax_is_removed",
    "one_point_leaves_free_unknowns_open",
)
"""Names of the yes-or-no properties of `SituationFindings`."""


def find(run: SituationRun) -> SituationFindings:
    """The findings of one situation."""
    control = RECOMMENDED[run.situation]
    reference = run.measures("reference", "all")
    direct = {"pos": run.measures("pos"), "calibrated": run.measures("calibrated"),
              "lines": run.measures("strip_lines")}  # fmt: skip
    bundles = {
        "bundle": run.measures("bundle", control),
        "both": run.measures("weighted_calibrated", control),
        "free": run.measures("free", "centre"),
    }
    weighted = {f"weighted_{each}": run.measures("weighted", each) for each in CONTROLS}
    values: dict[str, float] = {}
    for name, each in (direct | bundles | weighted | {"reference": reference}).items():
        values[f"{name}_horizontal_m"] = each.horizontal_m
        values[f"{name}_vertical_m"] = each.vertical_m
    for name, each in (weighted | {"reference": reference}).items():
        values[f"{name}_predicted_horizontal_m"] = each.predicted_horizontal_m
        values[f"{name}_predicted_vertical_m"] = each.predicted_vertical_m
    for name, each in direct.items():
        values[f"{name}_mm"] = each.parallax_mm
    return SituationFindings(
        situation=run.situation,
        relative_mm=run.relative_mm,
        bundle_mm=bundles["bundle"].parallax_mm,
        weighted_mm=weighted[f"weighted_{control}"].parallax_mm,
        free_undetermined="+".join(run.row("free", "centre").undetermined),
        **values,
    )
