"""Printed formulas give the printed numbers."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from posstats.acceptance.published import (
    GBT_SAMPLE_SIZES,
    asprs_product_accuracy,
    gbt_blunder_limit,
    gbt_grade,
    gbt_sample_size,
    gbt_score,
    nssda_accuracy_h,
    nssda_accuracy_v,
)
from posstats.errors import PosstatsError
from posstats.statistics.percentiles import ce_normal, le_normal
from posstats.statistics.samples import SampleError


@pytest.mark.parametrize(
    ("fit_cm", "product_cm"), [(1.00, 2.24), (2.50, 3.20), (5.00, 5.39), (10.00, 10.20)]
)
def test_asprs_product_accuracy_has_the_rows_of_the_standard(fit_cm, product_cm):
    assert round(100 * asprs_product_accuracy(fit_cm / 100, 0.02), 2) == product_cm


def test_nssda_factors_are_the_printed_ones():
    equal, unequal = nssda_accuracy_h(1.0, 1.0), nssda_accuracy_h(0.8, 1.0)
    assert (equal.method, equal.value, equal.ratio) == ("equal", 1.7308 * math.sqrt(2.0), 1.0)
    assert (unequal.method, unequal.value) == ("unequal", 2.4477 * 0.5 * 1.8)
    assert nssda_accuracy_v(1.0) == 1.9600


@pytest.mark.parametrize("ratio", [0.6, 0.7, 0.9, 0.999])
@pytest.mark.parametrize("larger", [0.1, 0.35, 1.0, 7.3])
def test_nssda_holds_from_a_ratio_of_six_tenths_in_either_order(larger, ratio):
    found = nssda_accuracy_h(ratio * larger, larger)
    assert found == nssda_accuracy_h(larger, ratio * larger)
    assert found.method == "unequal"
    assert found.value == pytest.approx(2.4477 * larger * (1.0 + ratio) / 2.0)


def test_six_hundredths_over_a_tenth_is_within_nssdas_range():
    assert nssda_accuracy_h(0.06, 0.10).reason is None


@pytest.mark.parametrize("pair", [(0.599, 1.0), (0.0, 1.0), (1.0, 0.3)])
def test_nssda_has_no_formula_below_that(pair):
    found = nssda_accuracy_h(*pair)
    assert (found.value, found.method, found.reason) == (None, None, "ratio_below_range")
    assert found.ratio == min(pair)


def test_nssda_of_no_error_is_zero():
    assert nssda_accuracy_h(0.0, 0.0).value == 0.0


def test_nssda_factors_are_those_of_normal_errors():
    assert nssda_accuracy_h(1.0, 1.0).value == pytest.approx(ce_normal(1, 1, 0, 0.95), abs=5e-5)
    assert nssda_accuracy_v(1.0) == pytest.approx(le_normal(1, 0.95), abs=5e-5)


def test_nssdas_mean_of_unequal_components_falls_short_of_the_exact_circle():
    """By 5.9 % at the ratio 0.6, where the standard's range ends."""
    short = [nssda_accuracy_h(r, 1.0).value / ce_normal(r, 1, 0, 0.95) - 1 for r in (0.6, 0.8)]
    assert short == [pytest.approx(-0.059, abs=5e-4), pytest.approx(-0.012, abs=5e-4)]


@pytest.mark.parametrize(
    ("share", "score", "grade"),
    [
        (0.0, 100.0, "excellent"),
        (0.3, 100.0, "excellent"),
        (0.475, 90.0, "excellent"),
        (0.4751, 89.994, "good"),
        (0.65, 80.0, "good"),
        (0.7375, 75.0, "good"),
        (0.7376, 74.994, "pass"),
        (1.0, 60.0, "pass"),
    ],
)
@pytest.mark.parametrize("limit", [1.0, 0.1, 0.35, 2.5])
def test_gbt_score_and_grade_at_the_boundaries(share, score, grade, limit):
    found = gbt_score(share * limit, limit)
    assert found == pytest.approx(score, abs=1e-3)
    assert gbt_grade(found) == grade


def test_gbt_fails_just_beyond_the_limit():
    assert gbt_score(math.nextafter(0.1, 1.0), 0.1) is None
    assert gbt_score(0.1, 0.1) == 60.0
    assert gbt_grade(None) == "fail"


@pytest.mark.parametrize(
    ("score", "grade"),
    [
        (90.0, "excellent"),
        (89.99, "good"),
        (75.0, "good"),
        (60.0, "pass"),
        (59.99, "fail"),
        (0.0, "fail"),
    ],
)
def test_gbt_grades_begin_at_their_score(score, grade):
    assert gbt_grade(score) == grade


@given(st.floats(0.0, 1.0), st.floats(0.0, 1.0), st.floats(1e-3, 1e3))
def test_a_smaller_error_never_scores_less(one, other, limit):
    low, high = sorted((one, other))
    better, worse = gbt_score(low * limit, limit), gbt_score(high * limit, limit)
    assert worse is None or 60.0 <= worse <= better <= 100.0


def test_gbt_sample_sizes_are_those_of_the_table():
    expected = {20: 3, 40: 5, 60: 7, 80: 9, 100: 10, 120: 11, 140: 12, 160: 13, 180: 14, 200: 15}
    assert dict(GBT_SAMPLE_SIZES) == expected
    assert {lot: gbt_sample_size(lot) for lot in expected} == expected
    assert [gbt_sample_size(lot) for lot in (1, 19, 21, 81, 101, 181)] == [3, 3, 5, 10, 11, 15]


@pytest.mark.parametrize("lot", [0, -5, 201, 10**9, 20.5, math.nan, math.inf])
def test_a_lot_outside_gbts_table_is_refused_with_its_range(lot):
    with pytest.raises(PosstatsError, match="1 to 200") as refused:
        gbt_sample_size(lot)
    assert isinstance(refused.value, ValueError)


def test_gbt_blunders_begin_at_twice_the_limit_times_the_root_of_two_for_equal_accuracy():
    assert gbt_blunder_limit(0.5, check_is_better=True) == 1.0
    assert gbt_blunder_limit(0.5, check_is_better=False) == pytest.approx(math.sqrt(2.0))


@pytest.mark.parametrize(
    "call",
    [
        lambda: asprs_product_accuracy(-0.1, 0.02),
        lambda: nssda_accuracy_h(math.nan, 1.0),
        lambda: nssda_accuracy_v(math.inf),
        lambda: gbt_score(0.1, 0.0),
        lambda: gbt_score(math.nan, 1.0),
        lambda: gbt_grade(101.0),
        lambda: gbt_blunder_limit(-1.0, check_is_better=True),
    ],
)
def test_numbers_that_are_no_accuracies_are_refused(call):
    with pytest.raises(SampleError):
        call()
