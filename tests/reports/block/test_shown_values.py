"""Every cell and vector of a block's report against the results that it comes from."""

import itertools

import numpy as np
import pytest
from report_results import area_results
from shown_values import arrows, assert_cell, assert_column, on_ground, svgs_of, tables_of

from posstats.contract.files import as_values, from_values
from posstats.contract.results import Results
from posstats.reports.block import document as block_document
from posstats.reports.figures import style

ANGLES = ("omega", "phi", "kappa")
SIDES = ("horizontal", "vertical")


def distinct_check_points(results):
    """Statistics of which no two are alike, so that no exchange goes unseen."""
    counter = itertools.count(1)
    for row in results["check_points"]:
        for key in ("max", "min", "rmse"):
            for side in SIDES:
                row[f"{key}_{side}_m"] = 0.0137 * next(counter)
        row["shift_m"] = [0.0211 * next(counter), -0.0319 * next(counter), 0.0173 * next(counter)]
    return results


def built(values):
    """The document of results.json."""
    return block_document.build(from_values(values, Results, "made up"))


@pytest.fixture(scope="module")
def area():
    """The values of results.json."""
    made = as_values(area_results(n_strips=3, per_strip=8))
    rng = np.random.default_rng(2)
    for key in ("error_sources", "corrected_parallax"):
        for row in made[key]:
            row["mean_px"] *= rng.uniform(0.7, 1.3)
    for row in made["models"]:
        row["n_rejected"] = int(rng.integers(0, 30))
    return distinct_check_points(made)


@pytest.fixture(scope="module")
def document(area):
    return built(area)


@pytest.fixture(scope="module")
def tables(document):
    return tables_of(document)


def of(results, key, **conditions):
    return [
        row for row in results[key] if all(row[name] == value for name, value in conditions.items())
    ]


def the(results, key, **conditions):
    (row,) = of(results, key, **conditions)
    return row


@pytest.mark.parametrize("removed", [True, False])
def test_check_points_stand_under_their_own_heads(area, tables, removed):
    table = tables[f"check_points_shift_{'removed' if removed else 'kept'}"]
    kept = of(area, "check_points", translation_removed=removed)
    assert_column(table.columns[1], [row["n"] for row in kept])
    heads = {"maximum": "max", "minimum": "min", "RMSE": "rmse"}
    letters = {"H": "horizontal", "V": "vertical"}
    measured = table.columns[2:8]
    assert len({(column.group, column.title) for column in measured}) == 6
    for column in measured:
        key = f"{heads[column.group]}_{letters[column.title]}_m"
        assert_column(column, [row[key] for row in kept])
    for axis, column in enumerate(table.columns[8:]):
        assert column.title == ("east", "north", "up")[axis]
        assert_column(column, [row["shift_m"][axis] for row in kept])
    assert len(table.columns) == (8 if removed else 11)


@pytest.mark.parametrize("unit", ["px", "mm"])
def test_parallax_of_strips_is_that_of_method_and_statistic(area, tables, unit):
    table = tables[f"parallax_{unit}"]
    strips = list(dict.fromkeys(row["strip"] for row in area["parallax"]))
    assert table.columns[0].cells[:-1] == tuple(strips)
    n_models = [the(area, "parallax", strip=s, method="pos")["n_models"] for s in strips]
    assert_column(table.columns[1], [*n_models, sum(n_models)])
    at = 2
    for method in ("pos", "independent", "dependent"):
        rows = [the(area, "parallax", strip=s, method=method) for s in strips]
        for key, total in (
            ("max", max),
            ("min", min),
            ("mean", lambda means: float(np.average(means, weights=n_models))),
        ):
            assert table.columns[at].title == key
            values = [row[f"{key}_{unit}"] for row in rows]
            assert_column(table.columns[at], [*values, total(values)], unit="")
            at += 1
    assert at == len(table.columns)


def test_models_stand_in_the_order_of_their_parallax(area, tables):
    table = tables["models"]
    ranked = sorted(area["models"], key=lambda row: -row["pos_px"])[: len(table.rows)]
    for k, key in enumerate(("left", "right", "strip")):
        assert table.columns[k].cells == tuple(row[key] for row in ranked)
    keys = ("n_points", "n_rejected", "pos_px", "corrected_px", "independent_px")
    for column, key in zip(table.columns[3:], keys, strict=True):
        assert_column(column, [row[key] for row in ranked])


def test_error_sources_are_those_of_the_angle_held(area, tables):
    table = tables["error_sources"]
    for column, name in zip(
        table.columns[1:], ("angles", "omega", "phi", "kappa", "none"), strict=True
    ):
        values = [
            the(area, "error_sources", strip=s, fixed=name)["mean_px"]
            for s in table.columns[0].cells
        ]
        assert_column(column, values)


def test_corrected_parallax_stands_between_pos_and_relative_orientation(area, tables):
    table = tables["corrected_parallax"]
    strips = table.columns[0].cells
    ends = {
        1: [the(area, "parallax", strip=s, method="pos")["mean_px"] for s in strips],
        6: [the(area, "parallax", strip=s, method="independent")["mean_px"] for s in strips],
    }
    for k, values in ends.items():
        assert_column(table.columns[k], values)
    for k, name in enumerate((*ANGLES, "selected"), start=2):
        rows = [the(area, "corrected_parallax", strip=s, corrected=name) for s in strips]
        assert_column(table.columns[k], [row["mean_px"] for row in rows])
    assert len(table.columns) == 7


def test_sizes_of_angle_errors_are_those_of_their_angle(area, tables):
    table = tables["angle_error_summary"]
    assert table.columns[0].cells == ANGLES
    assert_column(table.columns[2], [row["n"] for row in area["angle_error_summary"]])
    keys = ("mean_rad", "rms_rad", "max_abs_rad", "median_sigma_rad", "rms_rad")
    for column, key in zip(table.columns[3:], keys, strict=False):
        assert_column(column, [row[key] for row in area["angle_error_summary"]])
    assert table.columns[-1].unit == "°"


def regression(area, table):
    """Rows of the results in the order of a table, by angle and scope."""
    named = zip(table.columns[0].cells, table.columns[1].cells, strict=True)
    return [the(area, "regression", angle=angle, scope=scope) for angle, scope in named]


def test_ordinary_regressions_show_their_own_coefficients(area, tables):
    table = tables["regression_ols"]
    rows = regression(area, table)
    keys = ("n", "n_time_clusters", "intercept_rad", "slope_rad_per_s", "time_origin_s",
            "r_squared", "f_statistic")  # fmt: skip
    for column, key in zip(table.columns[2:-1], keys, strict=True):
        assert_column(column, [row[key] for row in rows])
    for cell, row in zip(table.columns[-1].cells, rows, strict=True):
        if not cell.startswith("<"):
            assert_cell(cell, row["p_value"])
        else:
            assert row["p_value"] < 0.001


def test_slopes_stand_in_front_of_their_own_intervals_with_the_lower_end_first(area, tables):
    table = tables["regression_gls"]
    rows = regression(area, table)
    of_gls, interval_of_gls, _, of_ols, interval_of_ols = table.columns[2:7]
    for prefix, slope, interval in (
        ("gls_", of_gls, interval_of_gls),
        ("", of_ols, interval_of_ols),
    ):
        assert_column(slope, [row[f"{prefix}slope_rad_per_s"] for row in rows])
        for cell, row in zip(interval.cells, rows, strict=True):
            assert_cell(cell, *row[f"{prefix}slope_ci95"], factor=10.0**7)
            assert row[f"{prefix}slope_ci95"][0] < row[f"{prefix}slope_ci95"][1]
    noise, effect = table.columns[7:9]
    assert_column(noise, [row["white_noise_sigma_rad"] for row in rows])
    assert_column(effect, [row["strip_effect_sigma_rad"] for row in rows])


def drawn_differences(svg, colour, points):
    """Differences (n, 2) of points as drawn in one panel, in metres east and north, and up to a
    positive factor: the places of the points tell how the panel shows the ground.
    """
    found = arrows(svg, colour)[: len(points)]
    places = np.array([(p["x_m"], p["y_m"]) for p in points])
    tails = np.array([tail for tail, _ in found])
    offset, turn = on_ground(places, tails)
    np.testing.assert_allclose(offset + tails @ turn, places, atol=0.02 * np.ptp(places))
    return np.array([tip - tail for tail, tip in found]) @ turn


def assert_alike(drawn, differences):
    """Drawn is a positive multiple of the differences, to the digits of the figure."""
    factor = np.sum(drawn * differences) / np.sum(differences**2)
    assert factor > 0.0
    np.testing.assert_allclose(drawn / factor, differences, atol=0.02 * np.abs(differences).max())


def test_arrows_of_the_plan_point_from_given_to_computed(area, document):
    points = of(area, "check_point_residuals", orientation="pos")
    drawn = drawn_differences(svgs_of(document)["plan"], style.VERMILLION, points)
    assert_alike(drawn, np.array([(p["dx_m"], p["dy_m"]) for p in points]))


@pytest.mark.parametrize("turned", [False, True])
def test_arrows_of_check_points_are_differences_less_their_mean(area, turned):
    made = as_values(area_results(n_strips=2, per_strip=30)) if turned else area
    points = of(made, "check_point_residuals", orientation="pos")
    svg = svgs_of(built(made))["check_points"]
    difference = np.array([(p["dx_m"], p["dy_m"], p["dz_m"]) for p in points])
    difference -= difference.mean(axis=0)
    assert_alike(drawn_differences(svg, style.BLUE, points), difference[:, :2])
    up = np.column_stack([np.zeros(len(points)), difference[:, 2]])
    assert_alike(drawn_differences(svg, style.VERMILLION, points), up)


def test_key_figures_are_parallax_in_the_order_of_its_decrease_and_plan_before_height(
    area, document
):
    *parallax, points = document.key_figures
    for figure, name in zip(parallax, ("raw", "corrected", "relative"), strict=True):
        assert_cell(figure.value, area["verdict"][f"{name}_px"])
    kept = the(area, "check_points", orientation="selected", translation_removed=False)
    assert_cell(points.value, kept["rmse_horizontal_m"], kept["rmse_vertical_m"])
    assert points.unit == "m"
