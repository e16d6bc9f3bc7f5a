"""Numbers as text; oracle: written out by hand, as a careful author would print them."""

import pytest

from posstats.reports.document import format as fmt


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (22.6123, "22.6"),
        (0.28049, "0.280"),
        (9.996, "10.0"),
        (-0.5, "−0.500"),
        (0.0, "0"),
        (4.68e-7, "4.68 × 10⁻⁷"),
        (114504.0, "114\u202f504"),
        (None, "–"),
        (float("nan"), "–"),
        (float("inf"), "–"),
    ],
)
def test_three_significant_digits(value, text):
    assert fmt.number(value).replace("\u00a0", " ") == text


def test_a_negative_value_that_rounds_to_zero_has_no_sign():
    assert fmt.fixed(-0.0004, 2) == "0.00"


def test_decimals_of_a_column_are_shared():
    assert fmt.shared_decimals([0.00336, 0.00331, None, 0.271]) == 5
    assert fmt.shared_decimals([None]) == 0


@pytest.mark.parametrize(("p", "text"), [(1e-240, "< 0.001"), (0.3671, "0.367"), (None, "–")])
def test_p_values(p, text):
    assert fmt.p_value(p) == text


def test_angles_take_the_unit_they_are_read_in():
    assert fmt.angle_unit([0.0185]) is fmt.MILLIRADIAN
    assert fmt.angle_unit([2e-5]) is fmt.MICRORADIAN
    assert fmt.angle_unit([0.2, None]) is fmt.DEGREE
    assert fmt.angle(0.0185).replace("\u00a0", " ") == "18.5 mrad (1.06°)"


def test_no_space_parts_degrees_from_their_number():
    assert fmt.with_unit(0.005, "°") == "0.00500°"
    assert fmt.with_unit(0.005, "°/100 s") == "0.00500°/100 s"
    assert fmt.with_unit(0.005, "m") == "0.00500\u00a0m"


def test_a_rate_is_told_per_second_and_per_hour():
    # 4.68e-7 rad/s * 3600 s/h * 57.29578 deg/rad
    assert "0.0965°/h" in fmt.rate(4.68e-7)
    assert fmt.rate_unit([4.68e-7, 1e-9]).name == "10⁻⁷\u00a0rad/s"


def test_numbers_of_the_analysis_are_set_like_those_of_the_report():
    assert fmt.prose("drift 4.68e-07 rad/s, R2 = 0.98").replace("\u00a0", " ") == (
        "drift 4.68 × 10⁻⁷ rad/s, R² = 0.98"
    )
