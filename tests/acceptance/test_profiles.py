"""Profiles hold the standards' numbers.

Oracle: the verified numbers of the standards.
"""

import pytest
from finding_parts import assert_finding

from posstats.acceptance.product import Product
from posstats.acceptance.profile_files import (
    load_profile,
    profile_names,
)
from posstats.acceptance.profile_values import PLACEHOLDERS
from posstats.acceptance.quantity_names import COUNTED_BEYOND, QUANTITIES

# Quoted from the standards, with their blanks as __.
ASPRS_TESTED = (
    "This data set was tested to meet ASPRS Positional Accuracy Standards for Digital "
    "Geospatial Data, Edition 2, Version 2 (2024) for a __(cm) RMSE_H Horizontal Positional "
    "Accuracy Class. The tested horizontal positional accuracy was found to be "
    "RMSE_H = __(cm)."
)
ASPRS_WITH_FEWER_POINTS = (
    " was tested as required by ",
    "Although the Standards call for a minimum of thirty (30) checkpoints, this test was "
    "performed using ONLY __ checkpoints",
)
ASPRS_PRODUCED = " was produced to meet "
NSSDA_TESTED = "Tested __ meters horizontal accuracy at 95% confidence level"


def limits(name, **product):
    """Limit, and threshold if there is one, of every requirement that applies to a product."""
    stated = Product(**product)
    profile = load_profile(name)
    assert profile.product_findings(stated) == ()
    return {
        each.id: each.limit.evaluate(stated)
        if each.threshold is None
        else (each.limit.evaluate(stated), each.threshold.evaluate(stated))
        for each in profile.requirements_for(stated)
    }


def test_the_profiles_are_known_by_name():
    assert profile_names() == ("asprs-2024", "gbt-24356", "jrc", "nssda", "orthophoto-scale")


@pytest.mark.parametrize("name", profile_names())
def test_a_profile_cites_every_number(name):
    profile = load_profile(name)
    assert profile.name == name
    assert all((profile.edition, profile.title, profile.source, profile.notes, profile.needs))
    assert (profile.changed, profile.added, profile.omitted) == ((), (), ())
    (file,) = profile.files
    tables = file.content.decode().split("[[requirement]]")[1:]
    assert len(tables) == len(profile.requirements)
    assert all('\nsource = "' in table for table in tables)
    for each in profile.requirements:
        assert each.measured is QUANTITIES[each.quantity]
        assert (each.threshold is not None) == (each.quantity in COUNTED_BEYOND)


def test_asprs_demands_what_edition_2_says():
    found = limits("asprs-2024", class_h_m=0.1, class_v_m=0.2)
    assert found == {
        "product_rmse_h": 0.1,
        "product_rmse_v": 0.2,
        "mean_error_h": 0.025,
        "mean_error_v": 0.05,
        "n_check_points": 30.0,
        "survey_h": 0.05,
        "survey_v": 0.1,
        "n_blunders_h": pytest.approx((0.0, 0.3)),
        "n_blunders_v": pytest.approx((0.0, 0.6)),
    }
    profile = load_profile("asprs-2024")
    by_id = {each.id: each for each in profile.requirements}
    assert by_id["product_rmse_h"].clause == "7.11"
    assert by_id["mean_error_v"].clause == "7.2"
    investigated = {each.id for each in profile.requirements if each.exceeding == "investigate"}
    assert investigated == {
        *("mean_error_h", "mean_error_v", "n_check_points", "n_blunders_h", "n_blunders_v")
    }
    optional = {each.id for each in profile.requirements if not each.mandatory}
    assert optional == {"mean_error_h", "mean_error_v", "n_check_points"}


def test_asprs_judges_a_horizontal_product_by_its_horizontal_class_alone():
    found = limits("asprs-2024", class_h_m=0.1)
    assert set(found) == {
        *("product_rmse_h", "mean_error_h", "n_check_points", "survey_h", "n_blunders_h")
    }
    (finding,) = load_profile("asprs-2024").product_findings(Product(gsd_m=0.1))
    assert finding.startswith("profile asprs-2024 needs class_h or class_v ")


def test_the_statement_of_asprs_is_the_quoted_one():
    """Oracle: 7.16 as quoted, with its blanks as __."""
    profile = load_profile("asprs-2024")
    statement = profile.statement("horizontal")
    blank = statement.tested.format(class_cm="__", found_cm="__")
    assert blank.replace(" (cm)", "(cm)") == ASPRS_TESTED
    assert statement.least_points == 30
    fewer = statement.tested_with_fewer.format(n_points="__", found_cm="__")
    assert all(part in fewer for part in ASPRS_WITH_FEWER_POINTS)
    assert ASPRS_PRODUCED in statement.produced
    vertical = profile.statement("vertical", "zh")  # no Chinese wording: the English one
    turned = vertical.tested.replace("RMSE_V", "RMSE_H").replace("ertical", "orizontal")
    assert turned.replace("Vorizontal", "Horizontal").replace("vorizontal", "horizontal") == (
        statement.tested
    )


@pytest.mark.parametrize("name", profile_names())
def test_statements_can_be_filled_in(name):
    numbers = dict.fromkeys(PLACEHOLDERS, "7")
    for each in load_profile(name).statements:
        for text in (each.tested, each.tested_with_fewer, each.produced):
            assert "{" not in text.format(**numbers)
            assert "_ " not in text


def test_nssda_needs_20_points_and_states_at_95_per_cent():
    found = limits("nssda", class_h_m=1.0, class_v_m=0.5)
    assert found == {"accuracy_h_95": 1.0, "accuracy_v_95": 0.5, "n_check_points": 20.0}
    profile = load_profile("nssda")
    statement = profile.statement("horizontal").tested
    assert statement.format(found_m="__") == NSSDA_TESTED
    assert "sets no threshold" in profile.requirements[0].source
    assert profile.requirements[2].mandatory


def test_gbt_scores_what_is_limited_and_counts_beyond_twice_the_limit():
    found = limits("gbt-24356", class_h_m=0.5, class_v_m=0.3, lot_size=60)
    assert found == {
        "rmse_h": 0.5,
        "rmse_v": 0.3,
        "n_blunders_h": (0.0, 1.0),
        "n_blunders_v": (0.0, 0.6),
        "sample_size": 7.0,
    }
    profile = load_profile("gbt-24356")
    scored = {each.id for each in profile.requirements if each.basis_of_score}
    assert scored == {"rmse_h", "rmse_v"}
    assert profile.product_findings(Product(class_h_m=0.5)) == ()  # no lot: not assessed


def test_orthophotos_are_judged_by_scale_and_terrain():
    """Oracle: the table of 1:2000, 1:5000, 1:10000, flat and mountain, exact."""
    table = {2000: (1.00, 1.50), 5000: (2.50, 3.75), 10000: (5.00, 7.50)}
    for scale, (flat, mountain) in table.items():
        assert limits("orthophoto-scale", map_scale=scale, terrain="flat") == {"rmse_h_flat": flat}
        found = limits("orthophoto-scale", map_scale=scale, terrain="mountain")
        assert found == {"rmse_h_mountain": mountain}
    profile = load_profile("orthophoto-scale")
    terrain, scale = profile.product_findings(Product(map_scale=1000.0))
    assert terrain.startswith("profile orthophoto-scale needs ")
    assert_finding(scale, "profile orthophoto-scale", "map_scale 1000", "one of 2000, 5000, 10000")
    assert "secondary" in profile.source


def test_jrc_limits_pixels_residuals_and_the_gsd():
    assert limits("jrc", gsd_m=0.2) == {
        "image_rms_px": 0.5,
        "largest_residual_h_over_rmse": 3.0,
        "rmse_h": 0.2,
    }
