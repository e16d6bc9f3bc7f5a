"""Numbers of acceptance.json against a case that is worked out by hand."""

import math
from dataclasses import replace

import numpy as np
import pytest
from acceptance_evidence import residual_rows, results_of
from scipy import stats

from posstats.acceptance.assessment import assess
from posstats.acceptance.evidence import evidence
from posstats.acceptance.formula import Formula
from posstats.acceptance.product import Product
from posstats.acceptance.profile import Contract, Profile, Requirement
from posstats.acceptance.values import Occasion, acceptance_values
from posstats.contract.files import as_values
from posstats.contract.notice import Notice
from posstats.statistics.percentiles import sample_percentile

SURVEY_XY_M, SURVEY_Z_M = 0.02, 0.05
DIFFERENCE_M = np.array(
    [[0.03, 0.04, -0.01], [0.30, -0.40, 0.02], [0.00, 0.05, 0.60], [-0.06, 0.08, 0.03]]
)


def requirement(quantity, limit, threshold=None):
    return Requirement(quantity, quantity, Formula(limit), "made up",
                       threshold=None if threshold is None else Formula(threshold))  # fmt: skip


@pytest.fixture(scope="module")
def assessment():
    (none,) = residual_rows([[0.0, 0.0, 0.0]])
    lost = replace(
        none, point="lost", status="behind the camera", dx_m=None, dy_m=None, dz_m=None
    )  # fmt: skip
    rows = residual_rows(DIFFERENCE_M, "selected", SURVEY_XY_M, SURVEY_Z_M)
    results = results_of([], check_point_residuals=(*rows, lost))
    profile = Profile("made", "1", "Made up", "none", (
        requirement("rmse_v", "0.4"),
        requirement("n_blunders_h", "0", "0.45"),
        requirement("n_blunders_v", "2", "0.55"),
        requirement("n_check_points", "3"),
    ))  # fmt: skip
    found = evidence(results, "selected", Product())
    return assess(found, profile, Product()), results


@pytest.fixture(scope="module")
def values(assessment):
    occasion = Occasion(Notice(code="asked"), Contract(), "en", "2026-01-05", "0" * 64)
    return as_values(acceptance_values(*assessment, occasion))


def by(rows, key="component"):
    return {row[key]: row for row in rows}


def test_rmse_and_products_are_those_of_their_components(values):
    rows = by(values["accuracy"]["rmse"])
    survey = {"h": math.sqrt(2.0) * SURVEY_XY_M, "v": SURVEY_Z_M}
    survey["3d"] = math.hypot(survey["h"], survey["v"])
    for name, columns in {"x": [0], "y": [1], "h": [0, 1], "v": [2], "3d": [0, 1, 2]}.items():
        rmse = math.sqrt((DIFFERENCE_M[:, columns] ** 2).sum() / 4)
        assert rows[name]["value_m"] == pytest.approx(rmse)
        assert rows[name]["low_m"] < rmse < rows[name]["high_m"]
        if name in survey:
            assert rows[name]["product_m"] == pytest.approx(math.hypot(rmse, survey[name]))
        else:
            assert rows[name]["product_m"] is None


def test_percentiles_are_of_the_lengths_in_plan_and_height(values):
    rows = by(values["accuracy"]["percentiles"], "name")
    lengths = {"CE": np.hypot(*DIFFERENCE_M[:, :2].T), "LE": np.abs(DIFFERENCE_M[:, 2])}
    for name, row in rows.items():
        expected = sample_percentile(lengths[name[:2]], float(name[2:]) / 100)
        assert row["value_m"] == pytest.approx(expected)


def test_mean_errors_have_students_test_of_their_axis(values):
    for column, axis in enumerate("xyz"):
        row = by(values["accuracy"]["mean_error"])[axis]
        peer = stats.ttest_1samp(DIFFERENCE_M[:, column], 0.0)
        assert row["value_m"] == pytest.approx(DIFFERENCE_M[:, column].mean())
        assert row["se_m"] == pytest.approx(DIFFERENCE_M[:, column].std(ddof=1) / 2.0)
        assert row["p"] == pytest.approx(peer.pvalue)


def test_a_covariance_is_that_about_the_mean(values):
    expected = np.cov(DIFFERENCE_M.T)
    np.testing.assert_allclose(values["accuracy"]["covariance_m2"], expected, rtol=1e-12)


def test_requirements_say_what_was_found_of_them(values, assessment):
    for row, finding in zip(values["requirements"], assessment[0].findings, strict=True):
        for key in ("found", "limit", "threshold", "low", "high", "margin", "n_to_decide"):
            assert row[key] == getattr(finding, key)
    rmse = by(values["requirements"], "id")["rmse_v"]
    assert rmse["low"] < rmse["found"] < rmse["high"]


def test_a_blunder_is_one_in_plan_or_height_by_its_own_limit(values):
    """0.5 m in plan of point 1 and 0.6 m in height of point 2; the limits are 0.45 and 0.55."""
    rows = values["check_points"]
    assert [row["blunder"] for row in rows] == [False, True, True, False, False]
    expected = [*np.hypot(*DIFFERENCE_M[:, :2].T), None]
    assert [row["dh_m"] for row in rows] == pytest.approx(expected)
    found = by(values["requirements"], "id")
    assert found["n_blunders_h"]["found"] == 1.0
    assert found["n_blunders_v"]["found"] == 1.0


def test_a_height_that_is_a_length_in_plan_is_no_blunder_there():
    rows = residual_rows([[0.0, 0.0, 0.5], [0.5, 0.0, 0.0], [0.1, 0.0, 0.1]])
    results = results_of([], check_point_residuals=rows)
    profile = Profile("made", "1", "Made up", "none", (
        requirement("n_blunders_h", "3", "0.4"), requirement("n_blunders_v", "3", "0.6"),
    ))  # fmt: skip
    assessed = assess(evidence(results, "selected", Product()), profile, Product())
    occasion = Occasion(Notice(code="asked"), Contract(), "en", "2026-01-05", "0" * 64)
    found = acceptance_values(assessed, results, occasion).check_points
    assert [row.blunder for row in found] == [False, True, False]
