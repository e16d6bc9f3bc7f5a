"""Blocks of known truth, simulated from scenarios."""

from posstats.synthetic.scenario import Scenario, load_scenario, shipped_scenario
from posstats.synthetic.simulation import simulate

__all__ = ["Scenario", "load_scenario", "shipped_scenario", "simulate"]
