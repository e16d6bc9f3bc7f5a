"""Simulated blocks and their adjustment, made once for all tests of this folder."""

import pytest
from small_scenario import GOOD_POINTS, small_block

from posstats.adjustment import Adjustment, AdjustmentSettings, adjust_block


@pytest.fixture(scope="session")
def block():
    return small_block(check_points=GOOD_POINTS)


@pytest.fixture(scope="session")
def tiny():
    return small_block(
        flight={"n_strips": 3, "images_per_strip": 5},
        tie_points={"per_model": 30},
        check_points=GOOD_POINTS,
    )


@pytest.fixture(scope="session")
def corners(block) -> Adjustment:
    return adjust_block(block, AdjustmentSettings(control="corners"))
