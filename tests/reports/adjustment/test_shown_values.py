"""Every cell and vector of the report on an adjustment against the results that it comes from."""

import math
import re
from dataclasses import fields, replace

import numpy as np
import pytest
from adjustment_double import adjustment_double
from shown_values import (
    arrows,
    assert_cell,
    assert_column,
    numbers,
    on_ground,
    paragraphs_of,
    svgs_of,
    tables_of,
)

from posstats.contract.notice import Notice
from posstats.reports.adjustment.document import build
from posstats.reports.adjustment.parameters import SHOWN_CORRELATIONS, correlation_table
from posstats.reports.adjustment.points import check_table, control_table
from posstats.reports.adjustment.words import words_in
from posstats.reports.figures import style

PER_SHOWN = {"rad": ("°", math.degrees(1.0)), "m": ("m", 1.0), "px": ("px", 1.0), "": ("", 1.0),
             "m/s": ("mm/s", 1e3), "rad/s": ("nrad/s", 1e9), "1/mm2": ("1/mm²", 1.0),
             "standard deviations": ("σ", 1.0)}  # fmt: skip
"""Units in which values are shown, and how many of them are one of the results' units."""


@pytest.fixture(scope="module")
def results():
    return adjustment_double()


@pytest.fixture(scope="module")
def document(results):
    return build(results)


@pytest.fixture(scope="module")
def tables(document):
    return tables_of(document)


def assert_scaled(column, rows, key):
    """Every cell shows the value of its row in the unit that the row's unit column names."""
    for cell, row in zip(column.cells, rows, strict=True):
        assert_cell(cell, getattr(row, key), factor=PER_SHOWN[row.unit][1])


def in_metres(text):
    """Numbers in a text that are metres, each with half of its last digit."""
    return [numbers(found)[0] for found in re.findall(r"([\d.]+)\u00a0m\b", text)]


def assert_units(column, rows):
    assert column.cells == tuple(PER_SHOWN[row.unit][0] for row in rows)


def test_the_double_has_no_two_numbers_alike(results):
    listed = (*results.groups, *results.parameters, *results.orientations, *results.control_points,
              *results.check_points, *results.image_residuals)  # fmt: skip
    values = [
        getattr(row, field.name) for row in listed for field in fields(row)
        if field.name not in ("n", "n_unchecked", "x_px", "y_px", "x_m", "y_m", "z_m",
                              "prior_sigma")
    ]  # fmt: skip
    floats = [abs(value) for value in values if type(value) is float]
    assert len(set(floats)) == len(floats)


def test_groups_show_their_own_figures(results, tables):
    columns, rows = tables["groups"].columns, results.groups
    assert_column(columns[1], [row.n for row in rows])
    assert_column(columns[2], [row.redundancy for row in rows])
    assert_scaled(columns[3], rows, "rms")
    assert_scaled(columns[4], rows, "median_detectable")
    assert_units(columns[5], rows)
    assert_column(columns[6], [row.variance_factor for row in rows])
    assert_column(columns[7], [row.weight_factor for row in rows])
    assert len(columns) == 8


def test_groups_without_observations_and_estimated_weights_are_left_out(results):
    rows = [replace(row, weight_factor=None, n=0 if row.group == "control" else row.n)
            for row in results.groups]  # fmt: skip
    table = tables_of(build(replace(results, groups=tuple(rows))))["groups"]
    assert len(table.columns) == 7
    assert_column(table.columns[1], [row.n for row in rows if row.group != "control"])


def test_parameters_show_their_own_value_sigma_and_test(results, tables):
    columns, rows = tables["parameters"].columns, results.parameters
    words = words_in("en")
    assert columns[0].cells == tuple(words.parameter(row.name) for row in rows)
    assert len(set(columns[0].cells)) == len(rows)
    assert_scaled(columns[2], rows, "value")
    assert_scaled(columns[3], rows, "sigma")
    assert_units(columns[4], rows)
    assert_column(columns[5], [row.t for row in rows])
    assert_column(columns[6], [row.p for row in rows])
    said = (words.text("answer.no"), words.text("answer.yes"))
    assert columns[7].cells == tuple(said[row.significant] for row in rows)
    assert tables["parameters"].strong == {k for k, row in enumerate(rows) if row.significant}


def test_what_a_parameter_is_known_from(results, tables):
    words, cells = words_in("en"), tables["parameters"].columns[8].cells
    expected = {(False, True): "prior", (False, False): "hardly"}
    for cell, row in zip(cells, results.parameters, strict=True):
        known = "freed" if row.prior_released else "measurements"
        key = expected.get((row.determined, row.prior_sigma is not None), known)
        assert cell == words.text(f"source.{key}")


def test_cameras_show_stated_before_adjusted(results, tables):
    columns, rows = tables["cameras"].columns, results.cameras
    assert columns[0].cells == ("left", "right")
    shown = [[c.cells[k] for c in columns[1:]] for k in range(2)]
    for cells, row in zip(shown, rows, strict=True):
        values = (row.stated_principal_distance_px, *row.stated_principal_point_px,
                  row.principal_distance_px, *row.principal_point_px)  # fmt: skip
        for cell, value in zip(cells, values, strict=True):
            assert_cell(cell, value)
    groups = [column.group for column in columns[1:]]
    assert groups[:3] == [groups[0]] * 3
    assert groups[3:] == [groups[3]] * 3
    assert groups[0] != groups[3]


def test_correlations_are_shown_the_strongest_first(tables):
    columns = tables["correlations"].columns
    assert_column(columns[2], [0.987, -0.961])
    assert "S1-0" in columns[1].cells[0]
    assert "S2" in columns[1].cells[1]


def test_correlations_beyond_the_first_are_counted(results):
    pair = results.correlations[0]
    many = tuple(replace(pair, second_scope=str(k), value=0.95 + 0.001 * k) for k in range(40))
    table = correlation_table(words_in("en"), many)
    assert len(table.rows) == SHOWN_CORRELATIONS
    assert table.rows[0][1].endswith(" 39")
    assert table.notes == (words_in("en").text("correlations.more", n="15"),)


def test_points_that_tables_leave_out_are_counted(results):
    words = words_in("en")
    for n, notes in ((60, ()), (75, (words.text("table.more", n="15"),))):
        control = control_table(words, results.control_points[:1] * n)
        checks = check_table(words, results.check_point_residuals[:1] * n)
        for table in (control, checks):
            assert len(table.rows) == 60
            assert table.notes == notes


def test_orientations_show_sigma_and_pos_minus_adjusted(results, tables):
    columns, rows = tables["orientations"].columns, results.orientations
    assert_units(columns[1], rows)
    keys = ("median_sigma", "max_sigma", "pos_mean", "pos_rms")
    for column, key in zip(columns[2:], keys, strict=True):
        assert_scaled(column, rows, key)
    assert [column.group for column in columns[2:]].count(columns[2].group) == 2


def test_differences_of_control_points_stand_under_their_axes(results, tables):
    columns, rows = tables["control_points"].columns, results.control_points
    assert columns[0].cells == tuple(row.point for row in rows)
    for column, title, key in zip(
        columns[1:4], ("east", "north", "up"), ("dx_m", "dy_m", "dz_m"), strict=True
    ):
        assert column.title == title
        assert_column(column, [getattr(row, key) for row in rows])
    assert_column(columns[4], [row.largest_w for row in rows])


def test_check_points_stand_under_their_own_heads(results, tables):
    columns = tables["check_points_shift_kept"].columns
    rows = [row for row in results.check_points if not row.translation_removed]
    assert_column(columns[1], [row.n for row in rows])
    heads = {"maximum": "max", "minimum": "min", "RMSE": "rmse"}
    letters = {"H": "horizontal", "V": "vertical"}
    for column in columns[2:8]:
        key = f"{heads[column.group]}_{letters[column.title]}_m"
        assert_column(column, [getattr(row, key) for row in rows])
    for axis, column in enumerate(columns[8:]):
        assert column.title == ("east", "north", "up")[axis]
        assert_column(column, [row.shift_m[axis] for row in rows])


def test_every_check_point_shows_differences_before_standard_deviations(results, tables):
    columns = tables["check_point_list"].columns
    rows = [row for row in results.check_point_residuals if row.orientation == "bundle"]
    assert columns[0].cells == tuple(row.point for row in rows)
    keys = ("n_rays", "dx_m", "dy_m", "dz_m", "sigma_x_m", "sigma_y_m", "sigma_z_m")
    for column, key in zip(columns[1:], keys, strict=True):
        assert_column(column, [getattr(row, key) for row in rows])


def test_blunders_show_their_place_and_measured_minus_adjusted(results, tables):
    columns, rows = tables["blunders"].columns, results.blunders
    assert columns[1].cells == tuple(row.image or "–" for row in rows)
    assert columns[2].cells == tuple(row.point or "–" for row in rows)
    assert_column(columns[3], [row.w for row in rows])
    for cell, row in zip(columns[4].cells, rows, strict=True):
        assert_cell(cell, *row.size, factor=PER_SHOWN[row.unit][1])
    assert_units(columns[5], rows)
    held = [k for k, row in enumerate(rows) if not row.taken_out]
    kept = words_in("en").text("held.snooping")
    assert [k for k, cell in enumerate(columns[6].cells) if cell == kept] == held


def test_what_is_open_in_several_strips_stands_in_one_row(results, tables):
    table, words = tables["observability"], words_in("en")
    assert [len(column.cells) for column in table.columns] == [3, 3, 3]
    assert "S1" in table.columns[0].cells[0]
    assert "S2" in table.columns[0].cells[0]
    rows = results.observability[1:]
    assert table.columns[1].cells == tuple(words.notice(row.reason_notice) for row in rows)
    assert table.columns[2].cells == tuple(words.notice(row.remedy_notice) for row in rows)


def test_settings_are_those_that_were_asked_for(results, tables):
    settings = results.settings
    shown = dict(tables["settings"].rows)
    words = words_in("en")

    def value(key):
        return shown[words.text(f"bundle_setting.{key}")]

    assert value("control") == "A, B"
    assert value("calibration") == "boresight.toml"
    degree = math.degrees(1.0)
    assert_cell(value("position"), settings.position_m)
    assert_cell(value("angle"), settings.angle_rad, factor=degree)
    assert_cell(value("image"), settings.image_px)
    switches = ("camera", "lever_arm", "estimate_weights", "drop_insignificant", "robust")
    assert [value(key) for key in switches] == ["yes", "no", "yes", "yes", "no"]
    priors = {
        "gnss_shift": (settings.priors.shift_m, 1.0),
        "gnss_drift": (settings.priors.drift_m_per_s, 100.0),
        "imu_shift": (settings.priors.shift_rad, degree),
        "boresight": (settings.priors.boresight_rad, degree),
    }
    for key, (prior, factor) in priors.items():
        cell = shown[words.text("prior.sigma", parameter=words.text(f"prior.{key}"))]
        number, half = numbers(cell)[0]
        assert abs(number - prior * factor) <= half * (1.0 + 1e-9)
    free = words.text("prior.sigma", parameter=words.text("prior.imu_drift"))
    assert shown[free] == words.text("prior.free")


def test_key_figures_are_sigma0_residuals_worst_axes_and_check_points(results, document):
    sigma0, image, orientation, points = document.key_figures
    assert_cell(sigma0.value, results.sigma0)
    assert_cell(image.value, results.groups[0].rms)
    by_unit = {unit: max(row.median_sigma for row in results.orientations if row.unit == unit)
               for unit in ("m", "rad")}  # fmt: skip
    assert_cell(orientation.value, by_unit["m"])
    number, half = numbers(orientation.remark)[0]
    assert abs(number - math.degrees(by_unit["rad"])) <= half
    row = results.check_points[0]
    assert_cell(points.value, row.rmse_horizontal_m, row.rmse_vertical_m)


def test_points_are_said_to_be_known_east_north_and_up(results, document):
    (said,) = [text for text in paragraphs_of(document) if " 319 " in text]
    shown = in_metres(said)
    for (number, half), value in zip(shown, results.points.median_sigma_m, strict=True):
        assert abs(number - value) <= half


def test_the_verdict_compares_found_with_predicted_and_with_the_pos(results, document):
    bundle = [row for row in results.check_point_residuals if row.orientation == "bundle"]
    predicted_h = math.sqrt(np.mean([r.sigma_x_m**2 + r.sigma_y_m**2 for r in bundle]))
    predicted_v = math.sqrt(np.mean([r.sigma_z_m**2 for r in bundle]))
    found, pos = results.check_points[0], results.check_points[2]
    expected = [found.rmse_horizontal_m, found.rmse_vertical_m, predicted_h, predicted_v,
                pos.rmse_horizontal_m, pos.rmse_vertical_m]  # fmt: skip
    shown = in_metres(document.verdict.summary)[-6:]
    for (number, half), value in zip(shown, expected, strict=True):
        assert abs(number - value) <= half


def assert_alike(drawn, differences):
    """Drawn is a positive multiple of the differences, to the digits of the figure."""
    factor = np.sum(drawn * differences) / np.sum(differences**2)
    assert factor > 0.0
    np.testing.assert_allclose(drawn / factor, differences, atol=0.02 * np.abs(differences).max())


def drawn_vectors(found, places):
    """Vectors (n, 2) of arrows in the axes of the places that they start from."""
    tails = np.array([tail for tail, _ in found])
    offset, turn = on_ground(places, tails)
    np.testing.assert_allclose(offset + tails @ turn, places, atol=0.02 * np.ptp(places))
    return np.array([tip - tail for tail, tip in found]) @ turn


def test_arrows_of_the_format_are_mean_residuals_measured_minus_adjusted(results, document):
    cells = results.image_residuals
    places = np.array([(cell.x_px, cell.y_px) for cell in cells])
    drawn = drawn_vectors(arrows(svgs_of(document)["residuals_1"], style.BLUE), places)
    assert_alike(drawn, np.array([(cell.dx_px, cell.dy_px) for cell in cells]))


@pytest.mark.parametrize(("panel", "orientation"), [(0, "pos"), (1, "bundle")])
def test_arrows_at_check_points_point_from_given_to_computed(results, document, panel, orientation):
    points = [row for row in results.check_point_residuals if row.orientation == orientation]
    places = np.array([(row.x_m, row.y_m) for row in points])
    svg, own = svgs_of(document)["check_points"], slice(3 * panel, 3 * panel + 3)
    difference = np.array([(row.dx_m, row.dy_m, row.dz_m) for row in points])
    plane = drawn_vectors(arrows(svg, style.BLUE)[own], places)
    height = drawn_vectors(arrows(svg, style.VERMILLION)[own], places)
    assert_alike(plane, difference[:, :2])
    assert_alike(height, np.column_stack([np.zeros(3), difference[:, 2]]))


def test_the_same_numbers_stand_in_both_languages(results, tables):
    chinese = tables_of(build(results, "zh"))
    assert chinese.keys() == tables.keys()
    for name, table in tables.items():
        for column, other in zip(table.columns, chinese[name].columns, strict=True):
            if column.align == "right":
                assert other.cells == column.cells


def test_warnings_are_said_in_the_language_of_the_report(results):
    notice = Notice(code="weights_kept", values={"groups": ("gnss", "control")})
    for language in ("en", "zh"):
        made = build(replace(results, notices=(notice,)), language)
        (said,) = [i.texts for s in made.sections for i in s.items if i.kind == "bullets"]
        assert said == (words_in(language).notice(notice),)
