"""From a block to its bundle block adjustment: control, weights, blunders, tests, check points."""

from posstats.adjustment.steps import Adjustment, adjust_block
from posstats.contract.choices import ControlChoice
from posstats.settings import AdjustmentSettings, DriftPriors

__all__ = ["Adjustment", "AdjustmentSettings", "ControlChoice", "DriftPriors", "adjust_block"]
