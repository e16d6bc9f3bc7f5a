"""What a user can choose, and what holds if nobody says: once for library, files and command line.

Types and values only, for the command line to start fast: dataclasses take milliseconds to build.
"""

from typing import Literal

RuleSetName = Literal["paper", "strict"]
"""Rule sets that come with posstats."""
ScenarioName = Literal["area1", "area1-small", "area2", "area3", "wucaps-flat", "wucaps-mountain"]
"""Scenarios that come with posstats."""
Scope = Literal["block", "strip"]
AngleErrorSource = Literal["coplanarity", "bundle", "adjusted"]
Frame = Literal["ground", "camera"]
FrameChoice = Literal[Frame, "auto"]
Form = Literal["none", "constant", "linear"]
FitKind = Literal["ols", "gls"]

ControlSubset = Literal["none", "centre", "corners", "all"]
NamedControl = Literal["roles", ControlSubset]
ControlChoice = NamedControl | tuple[str, ...]
DriftScope = Literal["none", Scope]
SelfCalibration = Literal["none", "bauer", "brown"]

TerrainKind = Literal["flat", "mountain"]
JudgedOrientation = Literal["bundle", "adjusted", "selected", "pos"]
"""What an acceptance can judge: the first that the results hold, unless one is named."""
Language = Literal["en", "zh"]
"""Of documents."""

DEFAULT_RULES: RuleSetName = "paper"
DEFAULT_SCOPE: Scope = "block"
DEFAULT_ERRORS: AngleErrorSource = "coplanarity"
DEFAULT_FRAME: FrameChoice = "ground"
DEFAULT_DRIFT: DriftScope = "block"
DEFAULT_CALIBRATION_DRIFT: Scope = "strip"
"""Of the flight that calibrates: its own shifts are kept out of the boresight."""
DEFAULT_SELF_CALIBRATION: SelfCalibration = "none"
DEFAULT_ROBUST = True
DEFAULT_LANGUAGE: Language = "en"
PAPER_SEED = 1
"""Of the simulations that repeat a paper's experiment."""
