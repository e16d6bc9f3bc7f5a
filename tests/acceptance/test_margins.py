"""Numbers that a requirement shows: margin, interval, limit; oracles are worked out by hand."""

import math

import numpy as np
import pytest
from acceptance_evidence import evidence_of

from posstats.acceptance.assessment import assess
from posstats.acceptance.formula import Formula
from posstats.acceptance.product import Product
from posstats.acceptance.profile import Profile, Requirement
from posstats.statistics.rmse import rmse_interval

# horizontal 5, 0, 5, vertical 1, 2, 5
HAND = [[3.0, 4.0, -1.0], [0.0, 0.0, 2.0], [0.0, 5.0, 5.0]]


def finding(quantity, limit, difference_m=HAND, **changed):
    requirement = Requirement(quantity, quantity, Formula(limit), "made up")
    made = Profile("made", "1", "Made up", "none", (requirement,))
    (found,) = assess(evidence_of(difference_m, **changed), made, Product()).findings
    return found


@pytest.mark.parametrize(
    ("quantity", "limit", "margin", "judgement"),
    [
        # at most: what is left below the limit
        ("largest_residual_h", "7", 2.0, "pass"),
        ("largest_residual_h", "4", -1.0, "fail"),
        ("largest_mean_error", "3.5", 0.5, "pass"),
        # at least: what is there above it
        ("n_check_points", "2", 1.0, "pass"),
        ("n_check_points", "5", -2.0, "fail"),
        ("measured_share", "0.75", 0.25, "pass"),
        ("remaining_drift_p", "0.05", -0.01, "fail"),
        ("remaining_drift_p", "0.01", 0.03, "pass"),
    ],
)
def test_a_margin_is_what_is_left_to_the_limit_on_the_side_that_keeps_it(
    quantity, limit, margin, judgement
):
    found = finding(quantity, limit)
    assert found.margin == pytest.approx(margin)
    assert found.judgement == judgement
    assert (found.margin >= 0.0) == (judgement == "pass")


@pytest.mark.parametrize(
    ("quantity", "columns"),
    [("rmse_x", [0]), ("rmse_y", [1]), ("rmse_h", [0, 1]), ("rmse_v", [2]), ("rmse_3d", [0, 1, 2])],
)
def test_an_interval_is_that_of_its_own_components_with_its_lower_end_first(quantity, columns):
    difference = np.random.default_rng(5).normal([0.1, 0.0, -0.3], [0.05, 0.2, 0.4], (9, 3))
    found = finding(quantity, "1", difference)
    interval = rmse_interval(difference[:, columns])
    assert found.found == pytest.approx(math.sqrt(np.sum(difference[:, columns] ** 2) / 9))
    assert (found.low, found.high) == (interval.low, interval.high)
    assert found.low < found.found < found.high
