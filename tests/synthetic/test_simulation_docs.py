"""docs/simulation.md: its example can be flown, and every key of a scenario is described."""

import re
import tomllib
from dataclasses import fields

import numpy as np
import pytest
from helpers import ROOT

from posstats.block.image_pairs import stereo_models
from posstats.synthetic import simulate
from posstats.synthetic.scenario import Scenario, load_scenario

TEXT = (ROOT / "docs" / "simulation.md").read_text(encoding="utf-8")


def test_the_example_can_be_flown():
    (example,) = re.findall(r"```toml\n(.*?)```", TEXT, re.DOTALL)
    block = simulate(load_scenario(tomllib.loads(example)))
    assert len(stereo_models(block)) == 14
    assert block.check_points.sum() == 6
    assert block.notices == ()
    # 0.018 rad of pitch on base and format of this camera: about 14.7 mm of parallax per radian
    q = stereo_models(block).y_parallax_px() * 0.012
    assert np.sqrt(np.mean(q**2)) == pytest.approx(14.7 * 0.018, rel=0.05)


def test_every_table_and_key_is_described():
    described = set(re.findall(r"`([\w.]+)`", TEXT))
    scenario = load_scenario("area1")
    for table in fields(Scenario):
        assert table.name in described
        for key in fields(getattr(scenario, table.name)):
            assert {key.name, f"{table.name}.{key.name}"} & described, key.name
    for error in ("omega", "position"):
        for key in fields(getattr(scenario.errors, error)):
            assert key.name in described
