"""How the report on the second paper calls its situations, methods and control points."""

from posstats.contract.choices import ControlSubset
from posstats.papers.wucaps.experiment import Method
from posstats.papers.wucaps.situations import Situation

from ...document.format import NARROW_SPACE

TERRAIN: dict[Situation, str] = {"flat": "flat", "mountain": "mountainous"}
SITUATIONS: dict[Situation, str] = {
    "flat": "flat, 1:2500",
    "mountain": f"mountainous, 1:32{NARROW_SPACE}000",
}
BLOCKS: dict[Situation, str] = {
    "flat": "the flat block at 1:2500",
    "mountain": f"the mountainous block at 1:32{NARROW_SPACE}000",
}
METHODS: dict[Method, str] = {
    "pos": "POS as recorded",
    "calibrated": "POS, calibrated",
    "regression": "POS, regression on time",
    "strip_lines": "POS, line of every strip",
    "bundle": "bundle",
    "bundle_calibrated": "bundle, POS calibrated",
    "weighted": "bundle, drifts weighted",
    "weighted_calibrated": "bundle, drifts weighted, POS calibrated",
    "free": "bundle, drifts free",
    "reference": "bundle, no systematic errors",
}
CONTROL: dict[ControlSubset, str] = {
    "none": "none",
    "centre": "one, centre",
    "corners": "four, corners",
    "all": "all",
}
METHOD_NOTES = (
    "Calibrated: boresight of another flight taken off. Regression on time: the first paper's, by "
    "its rules. Line of every strip: OLS line of every angle and strip taken off, whatever the "
    "rules say. Bundle: no unknowns of the POS. Drifts: boresight, and shifts and drifts of GNSS "
    "and IMU by strip, as weighted or as free unknowns.",
)
