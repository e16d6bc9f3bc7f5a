"""From a block to its bundle block adjustment: control, weights, blunders, tests, check points."""

from posstats.adjustment.control import ControlChoice
from posstats.adjustment.settings import AdjustmentSettings, DriftPriors
from posstats.adjustment.steps import Adjustment, adjust_block

__all__ = ["Adjustment", "AdjustmentSettings", "ControlChoice", "DriftPriors", "adjust_block"]
