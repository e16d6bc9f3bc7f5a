"""Settings: what is chosen from is what comes with the package, and what else is refused."""

from importlib.resources import files
from pathlib import Path
from typing import get_args

import pytest

from posstats.contract.choices import RuleSetName, ScenarioName
from posstats.errors import PosstatsError
from posstats.settings import AdjustmentSettings, Settings


@pytest.mark.parametrize(
    ("names", "package", "folder"),
    [
        (RuleSetName, "posstats.analysis", "rule_sets"),
        (ScenarioName, "posstats.synthetic", "scenarios"),
    ],
)
def test_named_files_are_those_that_come_with_the_package(names, package, folder):
    shipped = {Path(file.name).stem for file in (files(package) / folder).iterdir()}
    assert set(get_args(names)) == shipped


@pytest.mark.parametrize(
    ("kind", "name"),
    [
        (Settings, "scope"),
        (Settings, "errors"),
        (Settings, "frame"),
        (AdjustmentSettings, "control"),
        (AdjustmentSettings, "drift"),
        (AdjustmentSettings, "self_calibration"),
    ],
)
def test_a_value_that_is_no_choice_is_refused_by_name(kind, name):
    with pytest.raises(PosstatsError, match=f"setting {name} is 'nonsense'"):
        kind(**{name: "nonsense"})


def test_control_points_can_be_ids():
    assert AdjustmentSettings(control=("P1", "P2")).control == ("P1", "P2")
