"""Every cell and vector of an acceptance against the values that it comes from."""

import acceptance_values as values
import numpy as np
import pytest
from shown_values import arrows, assert_cell, assert_column, on_ground, per_si, svgs_of, tables_of

from posstats.contract.files import as_values
from posstats.reports.acceptance.document import build
from posstats.reports.figures import style

RESULTS = values.results()
FEW, MANY = 20, values.FULL


@pytest.fixture(scope="module")
def few():
    return values.acceptance(FEW, sigma_m=0.06, mean_m=0.02)


@pytest.fixture(scope="module")
def document():
    return build(values.acceptance(MANY, sigma_m=0.085, seed=3), RESULTS)


@pytest.fixture(scope="module")
def made():
    """The values of acceptance.json."""
    return as_values(values.acceptance(MANY, sigma_m=0.085, seed=3))


@pytest.fixture(scope="module")
def tables(document):
    return tables_of(document)


def assert_intervals(column, rows):
    for cell, row in zip(column.cells, rows, strict=True):
        assert_cell(cell, row["low_m"], row["high_m"], factor=per_si(column.unit))


def test_rmse_stand_with_their_intervals_and_products(made, tables):
    table, rows = tables["rmse"], made["accuracy"]["rmse"]
    assert_column(table.columns[1], [row["value_m"] for row in rows])
    assert_intervals(table.columns[2], rows)
    assert_column(table.columns[3], [row["df"] for row in rows])
    assert_column(table.columns[4], [row["product_m"] for row in rows])
    assert_column(table.columns[5], [row["iso_19157"] for row in rows])
    assert {column.unit for column in table.columns} == {"", "cm"}


def test_mean_errors_stand_with_their_standard_errors(made, tables):
    table, rows = tables["mean_errors"], made["accuracy"]["mean_error"]
    for column, key in zip(table.columns[1:], ("value_m", "se_m", "p", "iso_19157"), strict=True):
        assert_column(column, [row[key] for row in rows])


def test_percentiles_stand_with_their_intervals(made, tables):
    table, rows = tables["percentiles"], made["accuracy"]["percentiles"]
    assert table.columns[0].cells == tuple(row["name"] for row in rows)
    assert_column(table.columns[2], [row["value_m"] for row in rows])
    assert_intervals(table.columns[3], rows)
    assert_column(table.columns[4], [row["normal_m"] for row in rows])


def test_requirements_show_found_limit_margin_and_interval(made, tables):
    table, rows = tables["requirements"], made["requirements"]
    assert {row["margin"] > 0.0 for row in rows} == {True, False}
    assert table.columns[0].cells == tuple(row["clause"] or "–" for row in rows)
    for shown, row in zip(table.rows, rows, strict=True):
        factor = 100.0 if row["unit"] == "m" else 1.0
        for cell, key in zip(shown[2:5], ("found", "limit", "margin"), strict=True):
            assert_cell(cell, row[key], factor=factor)
        assert ("≥" in shown[3]) == (row["quantity"] in {"n_check_points", "remaining_drift_p"})
        assert shown[4].startswith("+") == (row["margin"] > 0.0)
        assert_cell(shown[5], *([None] if row["low"] is None else [row["low"], row["high"]]),
                    factor=factor)  # fmt: skip
        assert shown[6][0] == {"pass": "✓", "fail": "✗", "not assessed": "?"}[row["verdict"]]


def test_check_points_show_coordinates_differences_and_survey(made, tables):
    table, points = tables["check_points"], made["check_points"]
    keys = ("x_m", "y_m", "z_m", "dx_m", "dy_m", "dz_m", "dh_m", "survey_sigma_xy_m",
            "survey_sigma_z_m", "n_rays")  # fmt: skip
    assert table.columns[0].cells == tuple(point["point"] for point in points)
    for column, key in zip(table.columns[1:-1], keys, strict=True):
        assert_column(column, [point[key] for point in points])


def test_slopes_stand_in_front_of_their_intervals(tables):
    table = tables["regression"]
    rows = [row for row in as_values(RESULTS)["regression"] if row["scope"] == "block"]
    keys = ("n", "slope_rad_per_s", "r_squared")
    for column, key in zip(table.columns[2:5], keys, strict=True):
        assert_column(column, [row[key] for row in rows])
    assert_column(table.columns[6], [row["gls_slope_rad_per_s"] for row in rows])
    for cell, row in zip(table.columns[7].cells, rows, strict=True):
        assert_cell(cell, *row["gls_slope_ci95"], factor=per_si(table.columns[7].unit))


def test_parallax_is_mean_and_largest_of_the_models_of_a_strip(tables):
    table = tables["parallax"]
    strips = table.columns[0].cells[:-1]
    for at, key in ((2, "pos_px"), (4, "corrected_px"), (6, "independent_px")):
        models = as_values(RESULTS)["models"]
        of = [[m[key] for m in models if m["strip"] == strip] for strip in strips]
        of.append([m[key] for m in models])
        assert_column(table.columns[at], [float(np.mean(part)) for part in of])
        assert_column(table.columns[at + 1], [max(part) for part in of])


def test_arrows_at_few_points_are_their_differences(few):
    points = [point for point in few.check_points if point.status == "ok"]
    svg = svgs_of(build(few, RESULTS))["point_plan"]
    places = np.array([(p.x_m, p.y_m) for p in points])
    difference = np.array([(p.dx_m, p.dy_m, p.dz_m) for p in points])
    up = np.column_stack([np.zeros(len(points)), difference[:, 2]])
    scales = []
    for colour, expected in ((style.BLUE, difference[:, :2]), (style.VERMILLION, up)):
        found = arrows(svg, colour)
        tails = np.array([tail for tail, _ in found])
        offset, turn = on_ground(places, tails)
        np.testing.assert_allclose(offset + tails @ turn, places, atol=0.01 * np.ptp(places))
        drawn = np.array([tip - tail for tail, tip in found]) @ turn
        scales.append(np.sum(drawn * expected) / np.sum(expected**2))
        assert scales[-1] > 0.0
        np.testing.assert_allclose(drawn / scales[-1], expected, atol=0.03 * np.abs(expected).max())
    assert scales[0] == pytest.approx(scales[1], rel=0.02)


def test_key_figures_are_what_was_found_in_plan_then_in_height(made, document):
    plan, height, points = document.key_figures
    found = {row["id"]: row["found"] for row in made["requirements"]}
    assert_cell(plan.value, found["rmse_h"], factor=per_si(plan.unit))
    assert_cell(height.value, found["rmse_v"], factor=per_si(height.unit))
    assert_cell(points.value, found["points"])
