"""Formulas of limits: what they are worth, and that nothing else gets through.

Oracle: arithmetic by hand; the sample sizes of GB/T 24356-2023.
"""

import copy
import math
import pickle

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from posstats.acceptance.formula import Formula, FormulaError, MissingProductValue, limit_formula
from posstats.acceptance.product import Product
from posstats.errors import PosstatsError

PRODUCT = Product(class_h_m=0.1, class_v_m=0.2, gsd_m=0.05, map_scale=2000.0, lot_size=60)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.1", 0.1),
        ("class_h", 0.1),
        ("0.25 * class_h", 0.025),
        ("0.0005 * scale", 1.0),
        ("0.00075*scale", 1.5),
        ("2/3", 2 / 3),
        ("max(0.05, 2 * gsd, class_v)", 0.2),
        ("min(class_h, class_v)", 0.1),
        ("2 * sqrt(2) * class_h", 2 * math.sqrt(2) * 0.1),
        ("sqrt(class_h * class_h + class_v * class_v)", math.hypot(0.1, 0.2)),
        ("-(1 - 3)", 2.0),
        ("+.5e-1 * 2.", 0.1),
        ("\tlot - 10 ", 50.0),
        ("-0.0", 0.0),
        ("1 + 2 * 3", 7.0),
        ("(1 + 2) * 3", 9.0),
        ("8 / 2 / 2", 2.0),
    ],
)
def test_a_formula_is_worth_what_arithmetic_says(text, value):
    found = Formula(text).evaluate(PRODUCT)
    assert found == pytest.approx(value, rel=1e-15)
    assert math.copysign(1.0, found) == 1.0


def test_a_formula_knows_what_it_needs():
    assert Formula("max(scale, lot) * class_h").names == ("class_h", "scale", "lot")
    assert Formula("2/3").names == ()
    assert Formula("2/4").constant == 0.5
    assert Formula("gsd").constant is None


def test_a_value_that_is_not_stated_is_named():
    with pytest.raises(MissingProductValue, match=r"states no gsd \(gsd_m\)") as caught:
        Formula("2 * gsd").evaluate(Product(class_h_m=0.1))
    assert caught.value.name == "gsd"


def test_formulas_are_values():
    formula = Formula("2 * gsd")
    assert formula == Formula("2 * gsd")
    assert len({formula, Formula("2 * gsd")}) == 1
    assert pickle.loads(pickle.dumps(formula)) == copy.deepcopy(formula)  # noqa: S301


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("", "not a formula"),
        (" \t", "not a formula"),
        ("__import__('os')", "read at \"'os')\""),
        ("__import__(1)", "unknown function '__import__'"),
        ("class_h.real", "read at 'class_h.real'"),
        ("(class_h).real", "read at '.real'"),
        ("scale[0]", "read at '[0]'"),
        ("().__class__.__bases__", "read at '.__class__._"),
        ("2 ** 3", "more than numbers"),
        ("10**10**10", "more than numbers"),
        ("7 // 2", "more than numbers"),
        ("7 % 2", "read at '% 2'"),
        ("class_h if gsd else lot", "more than numbers"),
        ("class_h or gsd", "more than numbers"),
        ("not gsd", "more than numbers"),
        ("lambda: 1", "read at ': 1'"),
        ("gsd := 1", "read at ':= 1'"),
        ("1, 2", "more than numbers"),
        ("()", "more than numbers"),
        ("True", "more than numbers"),
        ("None", "more than numbers"),
        ("1j", "read at '1j'"),
        ("0x10", "read at '0x10'"),
        ("1_000", "read at '1_000'"),
        ("1or 2", "read at '1or 2'"),
        ("007", "not a formula"),
        ("'a' * 9", "read at \"'a' * 9\""),
        ("1 # note", "read at '# note'"),
        ("1\n+ 2", "read at '\\n+ 2'"),
        ("1 \x00", "read at '\\x00'"),
        ("２", "read at '２'"),
        ("cｌass_h", "read at 'cｌass_h'"),
        ("class_h +", "not a formula"),
        ("2 class_h", "not a formula"),
        ("clas_h", "'clas_h', expected class_h?"),
        ("rmse", "unknown name 'rmse'"),
        ("nan", "unknown name 'nan'"),
        ("inf", "unknown name 'inf'"),
        ("1e999", "a number above 1e+09"),
        ("99999999999999999999999999", "a number above 1e+09"),
        ("abs(gsd)", "unknown function 'abs'"),
        ("squrt(gsd)", "'squrt', expected sqrt?"),
        ("sqrt", "function sqrt without ( )"),
        ("min(gsd)", "min() has 1 arguments, expected 2"),
        ("sqrt(1, 2)", "sqrt() has 2 arguments, expected 1"),
        ("sqrt()", "sqrt() has 0 arguments, expected 1"),
        ("max(*gsd)", "max() has 1 arguments"),
        ("max(*gsd, 1)", "more than numbers"),
        ("sqrt(gsd)(1)", "more than numbers"),
        ("-1", "is -1, expected"),
        ("1/0", "divides by zero"),
        ("sqrt(-1)", "a negative number"),
        ("*".join([f"({'*'.join(['1e9'] * 9)})"] * 4), "too large"),
        ("1+" * 99 + "1", "more than 20 deep"),
        ("-" * 150 + "1", "more than 20 deep"),
        ("(" * 199 + "1", "not a formula"),
        ("1" * 201, "has 201 characters"),
    ],
)
def test_anything_else_is_refused(text, reason):
    with pytest.raises(FormulaError) as caught:
        Formula(text)
    assert reason in caught.value.reason
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("1 / (class_h - 0.1)", "divides by zero"),
        ("class_h - class_v", "is -0.1, expected"),
        ("sqrt(class_h - class_v)", "a negative number"),
    ],
)
def test_a_formula_without_a_usable_value_says_why(text, reason):
    formula = Formula(text)
    with pytest.raises(FormulaError, match=r"^found '") as caught:
        formula.evaluate(PRODUCT)
    assert reason in caught.value.reason


@settings(max_examples=300, deadline=None)
@given(st.text(alphabet="0123.e+-*/(), _abclmnqrst\t", max_size=40))
def test_any_text_is_a_finite_value_or_an_error_of_ours(text):
    """Refuse or evaluate, and never raise anything else."""
    try:
        value = Formula(text).evaluate(PRODUCT)
    except PosstatsError:
        return
    assert 0.0 <= value < math.inf


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (0.1, "m", "0.1"),
        (30, "1", "30"),
        (0, "1", "0"),
        ("0.1 m", "m", "0.1"),
        (" 0.5px ", "px", "0.5"),
        ("gsd", "m", "gsd"),
        ("2/3", "px", "2/3"),
    ],
)
def test_a_limit_is_a_number_a_number_with_its_unit_or_a_formula(value, unit, text):
    assert limit_formula(value, unit).text == text


@pytest.mark.parametrize(
    ("value", "unit", "message"),
    [
        ("10 cm", "m", "'10 cm': is in cm"),
        ("30 m", "1", "'30 m': is in m"),
        ("50 %", "1", "'50 %': is in %"),
        (-0.1, "m", "found -0.1: expected"),
        (math.nan, "m", "found nan: expected"),
        (math.inf, "m", "found inf: expected"),
        (10**400, "m", "found 1000"),
        (True, "1", "found True: expected"),
        ([0.1], "m", "found [0.1]: expected"),
        ({}, "m", "found {}: expected"),
        (None, "m", "found None: expected"),
    ],
)
def test_a_limit_in_another_unit_or_of_another_kind_is_refused(value, unit, message):
    with pytest.raises(FormulaError) as caught:
        limit_formula(value, unit)
    assert str(caught.value).removeprefix("found ").startswith(message.removeprefix("found "))


def test_sizes_beyond_measure_are_refused_without_being_worked_on():
    with pytest.raises(FormulaError, match="thousands of digits"):
        limit_formula(16**5000, "m")
    with pytest.raises(FormulaError, match="has 4000001 characters"):
        Formula("1 + " * 1_000_000 + "1")


def test_sample_sizes_are_those_of_the_standard():
    """Oracle: GB/T 24356-2023, sample size by lot."""
    published = {20: 3, 40: 5, 60: 7, 80: 9, 100: 10, 120: 11, 140: 12, 160: 13, 180: 14, 200: 15}
    formula = Formula("sample_size(lot)")
    found = {lot: formula.evaluate(Product(lot_size=lot)) for lot in published}
    assert found == published
    for lot, reason in ((201, "lots of 1 to 200"), (0.5, "whole number")):
        with pytest.raises(FormulaError, match=reason):
            formula.evaluate(Product(lot_size=lot))
