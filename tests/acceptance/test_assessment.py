"""Requirements held against evidence: every quantity by hand, verdicts, statements."""

import math
from dataclasses import replace

import numpy as np
import pytest
from acceptance_evidence import (
    evidence_of,
    regression_rows,
    residual_rows,
    results_of,
    selection_rows,
)
from hypothesis import given
from hypothesis import strategies as st

from posstats.acceptance.assessment import assess
from posstats.acceptance.evidence import best_orientation, evidence
from posstats.acceptance.formula import Formula
from posstats.acceptance.product import Product
from posstats.acceptance.profile import Profile, Requirement
from posstats.acceptance.profile_files import load_profile
from posstats.acceptance.quantities import FINDERS, Question, find
from posstats.acceptance.quantity_names import QUANTITIES
from posstats.acceptance.reasons import Unavailable
from posstats.contract.results import Bundle
from posstats.errors import PosstatsError

# horizontal 5, 0, 5, vertical 1, 2, 5, means 1, 3, 2
HAND = [[3.0, 4.0, -1.0], [0.0, 0.0, 2.0], [0.0, 5.0, 5.0]]
BUNDLE = Bundle(sigma0=1.1, dof=40, p_value=0.3, image_rms_px=0.21, sigma_image_px=0.2,
                n_rays=400, n_rejected_rays=0, n_control_points=0)  # fmt: skip
TEN_CM = Product(class_h_m=0.10, class_v_m=0.10)


def found(name, difference_m=HAND, product=None, threshold=None, **changed):
    product = product or Product()
    question = Question(evidence_of(difference_m, product, **changed), product, threshold)
    return find(name, question).value


def requirement(name="rmse_h", limit="1", **changed):
    return Requirement(name, name, Formula(limit), "made up", **changed)


def profile(*requirements):
    return Profile("made", "1", "Made up", "none", requirements)


def normal(n, sigma_m=(0.03, 0.03, 0.05), seed=3):
    """Differences whose components have these root mean squares exactly, and mean zero."""
    raw = np.random.default_rng(seed).normal(size=(n, 3))
    raw -= raw.mean(axis=0)
    return raw / np.sqrt((raw**2).mean(axis=0)) * sigma_m


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("rmse_x", math.sqrt(9 / 3)),
        ("rmse_y", math.sqrt(41 / 3)),
        ("rmse_h", math.sqrt(50 / 3)),
        ("rmse_v", math.sqrt(30 / 3)),
        ("rmse_3d", math.sqrt(80 / 3)),
        # the survey is 1 cm in X and in Y and 2 cm in Z
        ("product_rmse_h", math.sqrt(50 / 3 + 2e-4)),
        ("product_rmse_v", math.sqrt(10 + 4e-4)),
        ("product_rmse_3d", math.sqrt(80 / 3 + 6e-4)),
        ("survey_h", 0.01 * math.sqrt(2)),
        ("survey_v", 0.02),
        ("accuracy_v_95", 1.96 * math.sqrt(10)),
        ("mean_error_h", math.hypot(1, 3)),
        ("mean_error_v", 2.0),
        ("largest_mean_error", 3.0),
        ("largest_residual_h", 5.0),
        ("largest_residual_v", 5.0),
        ("largest_residual_h_over_rmse", 5 / math.sqrt(50 / 3)),
        ("largest_residual_v_over_rmse", 5 / math.sqrt(10)),
        ("n_check_points", 3.0),
        ("measured_share", 1.0),
        ("parallax_rms_px", math.sqrt((0.3**2 + 0.4**2) / 2)),
        ("parallax_largest_px", 0.4),
        ("remaining_drift_p", 0.04),
    ],
)
def test_quantities_of_a_case_computed_by_hand(name, value):
    assert found(name) == pytest.approx(value, rel=1e-12)


def test_horizontal_nssda_accuracy_of_components_that_are_alike():
    rmse = math.sqrt(2 / 3)
    assert found("accuracy_h_95", [[1, -1, 0], [1, 1, 0], [0, 0, 0]]) == pytest.approx(
        1.7308 * math.sqrt(2) * rmse
    )
    with pytest.raises(Unavailable) as refused:
        found("accuracy_h_95", [[1, 0.1, 0], [1, 0.1, 0], [-1, 0.1, 0]])
    assert refused.value.reason.code == "nssda ratio"
    assert refused.value.reason.values["ratio"] == pytest.approx(0.1)


def test_residuals_beyond_a_threshold_are_counted_and_those_on_it_are_not():
    assert found("n_blunders_h", threshold=5.0) == 0.0
    assert found("n_blunders_h", threshold=4.99) == 2.0
    assert found("n_blunders_v", threshold=1.5) == 2.0


def test_the_poorest_quadrant_counts():
    assert found("quadrant_share", np.zeros((8, 3))) == 0.25
    # three points cannot be in four quadrants
    assert found("quadrant_share") == 0.0


def test_values_of_the_bundle_belong_to_the_orientation_of_the_bundle():
    bundle = {"bundle": BUNDLE}
    orientations = ("pos", "selected", "bundle")
    asked = {"orientations": orientations, **bundle}
    assert found("sigma0", orientation="bundle", **asked) == 1.1
    assert found("image_rms_px", orientation="bundle", **asked) == 0.21
    assert found("parallax_largest_px", orientation="bundle", **asked) == 0.25
    for name in ("sigma0", "image_rms_px"):
        with pytest.raises(Unavailable, match="quantity not available"):
            found(name, **asked)


def test_drifts_that_were_taken_off_are_not_tested_and_holm_counts_the_others():
    assert found("remaining_drift_p", orientation="pos") == pytest.approx(3e-6)
    everything = selection_rows(dict.fromkeys(("omega", "phi", "kappa"), "linear"))
    assert found("remaining_drift_p", selection=everything) == 1.0
    # without a covariance of the errors there is no GLS, and OLS is all there is
    ols = regression_rows({"omega": None, "phi": None, "kappa": None})
    assert found("remaining_drift_p", regression=ols) == pytest.approx(2e-9)
    with pytest.raises(Unavailable):
        found("remaining_drift_p", regression=())


def test_the_survey_of_the_contract_stands_in_where_the_block_states_none():
    first, *others = residual_rows(HAND, sigma_xy_m=None, sigma_z_m=None)
    rows = (replace(first, survey_sigma_xy_m=0.03), *others)
    with pytest.raises(Unavailable, match="accuracy not stated"):
        found("survey_h", check_point_residuals=rows)
    stated = Product(survey_sigma_h_m=0.01, survey_sigma_v_m=0.05)
    # the larger of both counts
    value = found("survey_h", product=stated, check_point_residuals=rows)
    assert value == pytest.approx(math.sqrt((2 * 0.03**2 + 2 * 0.01**2) / 3))
    assert found("survey_v", product=stated, check_point_residuals=rows) == pytest.approx(0.05)


def test_points_that_could_not_be_measured_count_in_their_share_alone():
    first, *others = residual_rows(HAND)
    lost = replace(first, status="fewer than two rays", dx_m=None, dy_m=None, dz_m=None)
    rows = (lost, *others)
    assert found("measured_share", check_point_residuals=rows) == pytest.approx(2 / 3)
    assert found("mean_error_v", check_point_residuals=rows) == pytest.approx(3.5)


@pytest.mark.parametrize("name", sorted(QUANTITIES))
def test_without_check_points_no_quantity_of_them_is_made_up(name):
    known_without = {
        "n_check_points", "parallax_rms_px", "parallax_largest_px", "remaining_drift_p",
    }  # fmt: skip
    none = np.empty((0, 3))
    if name in known_without:
        assert np.isfinite(found(name, none))
        return
    with pytest.raises(
        Unavailable, match=r"no check points|quantity not available|product value missing"
    ):
        found(name, none, threshold=1.0)


def test_every_quantity_that_a_profile_may_name_can_be_found():
    assert set(FINDERS) == set(QUANTITIES)


def test_the_orientation_is_the_best_that_the_results_hold_whatever_its_outcome():
    rows = residual_rows(HAND, "pos") + residual_rows(1e3 * np.array(HAND), "bundle")
    worse = results_of(HAND, ("pos", "selected", "bundle"), check_point_residuals=rows)
    assert best_orientation(worse) == "bundle"
    assert best_orientation(results_of(HAND)) == "selected"
    with pytest.raises(PosstatsError, match="one of selected"):
        evidence(results_of(HAND, ("selected",)), "adjusted", Product())


def verdict_of(*requirements, difference_m=HAND, product=None):
    product = product or Product()
    return assess(evidence_of(difference_m, product), profile(*requirements), product)


def test_a_limit_that_is_reached_is_kept():
    exact = requirement("largest_residual_h", "5")
    assert verdict_of(exact).verdict == "accepted"
    assert verdict_of(replace(exact, limit=Formula("4.999999"))).verdict == "rejected"
    assert verdict_of(requirement("n_check_points", "3")).verdict == "accepted"
    assert verdict_of(requirement("n_check_points", "4")).verdict == "rejected"


@pytest.mark.parametrize(
    ("requirements", "verdict"),
    [
        ((), "not assessable"),
        ((requirement(limit="9"),), "accepted"),
        ((requirement(limit="9"), requirement("sigma0")), "not assessable"),
        ((requirement(limit="9"), requirement("sigma0", mandatory=False)), "accepted"),
        ((requirement(limit="1"), requirement("sigma0")), "rejected"),
        ((requirement(limit="1", exceeding="investigate"),), "not assessable"),
        ((requirement(limit="1", exceeding="investigate", mandatory=False),), "accepted"),
        ((requirement(limit="class_h"),), "not assessable"),
    ],
)
def test_one_failure_rejects_else_one_open_mandatory_requirement_is_not_assessable(
    requirements, verdict
):
    assert verdict_of(*requirements).verdict == verdict


def test_a_requirement_says_why_it_is_open():
    reasons = {
        each.requirement.id: each.reason
        for each in verdict_of(
            requirement("sigma0"),
            requirement("rmse_v", "class_v"),
            requirement("rmse_h", "1", exceeding="investigate"),
        ).findings
    }
    assert reasons["sigma0"].code == "quantity not available"
    assert reasons["rmse_v"].code == "product value missing"
    assert reasons["rmse_v"].values == {"name": "class_v"}
    assert reasons["rmse_h"].code == "investigate"


@given(
    st.lists(st.tuples(*[st.floats(-1, 1, allow_subnormal=False)] * 3), min_size=3, max_size=8),
    st.floats(1e-3, 2.0),
)
def test_margin_and_judgement_always_agree(difference_m, limit):
    (finding,) = verdict_of(requirement(limit=repr(limit)), difference_m=difference_m).findings
    assert (finding.margin >= 0.0) == (finding.judgement == "pass")
    assert finding.found + finding.margin == pytest.approx(limit)


def test_a_borderline_case_says_how_many_points_would_decide():
    (finding,) = verdict_of(
        requirement("rmse_v", "0.053"), difference_m=normal(20), product=TEN_CM
    ).findings
    assert finding.judgement == "pass"
    assert finding.low < 0.053 < finding.high
    # one component: chi-square with n degrees of freedom, (1 - 1.96 / sqrt(2 n)) 0.053 = 0.050
    assert finding.n_to_decide == pytest.approx(
        0.5 * (1.96 / math.log(0.053 / 0.050)) ** 2, rel=0.1
    )
    (clear,) = verdict_of(requirement("rmse_v", "0.2"), difference_m=normal(20)).findings
    assert clear.n_to_decide is None


def test_more_points_make_the_fit_surer_and_not_the_survey():
    # fit 4 cm, survey 3 cm: product 5 cm; of a limit of 5.2 cm the survey leaves 4.247 cm
    rows = residual_rows(normal(20, (0.02, 0.02, 0.04)), sigma_z_m=0.03)
    found_ = evidence_of(HAND, check_point_residuals=rows)
    judged = assess(found_, profile(requirement("product_rmse_v", "0.052")), Product())
    (finding,) = judged.findings
    assert finding.found == pytest.approx(0.05)
    expected = 0.5 * (1.96 / math.log(math.sqrt(0.052**2 - 0.03**2) / 0.04)) ** 2
    assert finding.n_to_decide == pytest.approx(expected, rel=0.12)


def test_fewer_points_than_an_interval_takes_judge_nothing():
    judged = assess(evidence_of(HAND[:2]), load_profile("asprs-2024"), Product(class_h_m=99.0))
    reasons = {each.requirement.id: each.reason for each in judged.findings}
    assert reasons["product_rmse_h"].code == "too few points"
    assert reasons["product_rmse_h"].values == {"n": 2, "needed": 3}
    assert judged.verdict == "not assessable"


def test_asprs_says_tested_with_thirty_points_and_names_the_number_with_fewer():
    asprs = load_profile("asprs-2024")
    thirty = assess(evidence_of(normal(30)), asprs, TEN_CM)
    assert thirty.verdict == "accepted"
    assert [each.kind for each in thirty.statements] == ["tested", "tested"]
    assert thirty.statements[0].found_m == pytest.approx(
        math.hypot(0.03 * math.sqrt(2), 0.01 * math.sqrt(2))
    )
    fewer = assess(evidence_of(normal(29)), asprs, TEN_CM)
    assert fewer.verdict == "accepted"
    assert {each.kind for each in fewer.statements} == {"tested_with_fewer"}
    none = assess(evidence_of(np.empty((0, 3))), asprs, TEN_CM)
    assert none.verdict == "not assessable"
    assert {each.kind for each in none.statements} == {"produced"}


def test_the_standards_words_are_not_said_of_a_component_that_fails():
    bad = assess(evidence_of(normal(30, (0.03, 0.03, 0.3))), load_profile("asprs-2024"), TEN_CM)
    assert bad.verdict == "rejected"
    assert bad.statements == ()


def test_a_mean_error_beyond_a_quarter_of_the_class_is_to_be_investigated_and_no_failure():
    shifted = normal(30) + np.array([0.03, 0.0, 0.0])
    found_ = assess(evidence_of(shifted), load_profile("asprs-2024"), TEN_CM)
    mean = next(each for each in found_.findings if each.requirement.id == "mean_error_h")
    assert (mean.judgement, mean.reason.code) == ("not assessed", "investigate")
    assert mean.found == pytest.approx(0.03)
    assert found_.verdict == "accepted"


def test_the_survey_can_take_a_product_over_its_class():
    # the fit meets 5 cm, the product with a survey of 2 cm (1.4 cm in each axis) does not
    rows = residual_rows(normal(30, (0.033, 0.033, 0.02)), sigma_xy_m=0.02 / math.sqrt(2))
    found_ = evidence_of(normal(30), check_point_residuals=rows)
    judged = assess(found_, load_profile("asprs-2024"), Product(class_h_m=0.05))
    fit = 0.033 * math.sqrt(2)
    assert fit < 0.05 < math.hypot(fit, 0.02)
    assert judged.verdict == "rejected"


def test_grade_of_gbt_is_that_of_the_worst_quality_and_a_failure_has_none():
    gbt = load_profile("gbt-24356")
    # 4.24 and 5 cm of 10 cm
    good = assess(evidence_of(normal(30)), gbt, TEN_CM)
    assert good.score == pytest.approx(60 + 40 * (0.1 - 0.05) / 0.07)
    assert good.grade == "good"
    bad = assess(evidence_of(normal(30)), gbt, Product(class_h_m=0.1, class_v_m=0.04))
    assert (bad.verdict, bad.score, bad.grade) == ("rejected", None, "fail")


def test_a_product_that_the_profile_is_not_for_is_an_error():
    with pytest.raises(PosstatsError, match="needs class_h or class_v"):
        assess(evidence_of(HAND), load_profile("asprs-2024"), Product())
    with pytest.raises(PosstatsError, match="expected one of 2000, 5000, 10000"):
        assess(
            evidence_of(HAND),
            load_profile("orthophoto-scale"),
            Product(map_scale=1000.0, terrain="flat"),
        )
