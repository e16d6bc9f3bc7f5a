"""Every cell and vector of an adjustment's report against the results that it comes from."""

import math
from dataclasses import replace

import numpy as np
import pytest
from shown_values import (
    arrows,
    assert_cell,
    assert_column,
    numbers,
    on_ground,
    per_si,
    svgs_of,
    tables_of,
)
from small_blocks import Layout, observed_block, true_block

from posstats.adjustment import AdjustmentSettings, adjust_block
from posstats.adjustment.results import adjustment_results
from posstats.block.model import GroundPoints
from posstats.reports.adjustment import document as adjustment_document
from posstats.reports.figures import style

UNITS = {"rad": "°", "m": "m", "px": "px", "rad/s": "nrad/s", "m/s": "mm/s"}


def residual_cells():
    """Mean residuals over the format that no exchange of axes or signs leaves as they are."""
    rng = np.random.default_rng(6)
    return [
        {"camera": "c", "x_px": 250.0 + 500.0 * i, "y_px": 250.0 + 500.0 * j, "n": 9 + i,
         "dx_px": float(0.1 + 0.02 * i + rng.uniform(0, 0.01)), "dy_px": float(0.03 * j - 0.05),
         "rms_px": 0.2}
        for i in range(4) for j in range(5)
    ]  # fmt: skip


@pytest.fixture(scope="module")
def values():
    truth = true_block(Layout(n_strips=3, n_images=4, n_points=120, sigma_image_px=0.1))
    block = observed_block(truth, np.random.default_rng(8), np.array([0.003, -0.001, 0.002]))
    free = adjust_block(block, AdjustmentSettings(control="none", robust=False))
    known = np.flatnonzero(np.isfinite(free.adjusted.ground_m).all(axis=1))
    chosen = known[np.linspace(0, len(known) - 1, 8).astype(int)]
    rng = np.random.default_rng(9)
    given = free.adjusted.ground_m[chosen] + rng.normal(0.0, [0.05, 0.08, 0.15], (8, 3))
    points = GroundPoints(block.tie_points.point_id[chosen], given, np.arange(8) % 2 == 0,
                          np.full(8, 0.05), np.full(8, 0.1))  # fmt: skip
    settings = AdjustmentSettings(camera=True, self_calibration="brown", robust=False)
    adjusted = adjust_block(replace(block, ground_points=points), settings)
    made = adjustment_results(adjusted)
    image = block.orientations.image[3]
    made["blunders"] = [
        {"kind": "image", "image": image, "point": "p7", "w": 12.3, "size": [3.25, -1.5],
         "unit": "px", "found_by": "snooping", "taken_out": True},
        {"kind": "imu", "image": image, "point": None, "w": -5.6, "size": [0.01, -0.02, 0.03],
         "unit": "rad", "found_by": "snooping", "taken_out": True},
    ]  # fmt: skip
    made["correlations"] = [
        {"first": "boresight_yaw", "first_scope": "block", "second": "imu_kappa_shift",
         "second_scope": "block", "value": value}
        for value in (0.96, -0.99, 0.97)
    ]  # fmt: skip
    made["image_residuals"] = residual_cells()
    return made


@pytest.fixture(scope="module")
def document(values):
    return adjustment_document.build(values)


@pytest.fixture(scope="module")
def tables(document):
    return tables_of(document)


def test_groups_show_their_own_numbers_in_their_own_units(values, tables):
    table = tables["groups"]
    rows = [row for row in values["groups"] if row["n"]]
    units = [UNITS.get(row["unit"], "") for row in rows]
    assert_column(table.columns[1], [row["n"] for row in rows])
    assert_column(table.columns[2], [row["redundancy"] for row in rows])
    for column, key in ((3, "rms"), (4, "median_detectable")):
        for cell, row, unit in zip(table.columns[column].cells, rows, units, strict=True):
            assert_cell(cell, row[key], factor=per_si(unit))
    assert_column(table.columns[6], [row["variance_factor"] for row in rows])
    for cell, unit in zip(table.columns[5].cells, units, strict=True):
        assert not unit or cell == unit


def test_parameters_show_their_own_numbers_in_their_own_units(values, tables):
    table, rows = tables["parameters"], values["parameters"]
    assert len(table.rows) == len(rows)
    for shown, row in zip(table.rows, rows, strict=True):
        factor = {"mm/s": 1e3}.get(shown[4]) or per_si(shown[4])
        assert shown[4] == UNITS.get(row["unit"], shown[4])
        assert_cell(shown[2], row["value"], factor=factor)
        assert_cell(shown[3], row["sigma"], factor=factor)
        assert_cell(shown[5], row["t"])
        assert_cell(shown[6], row["p"]) if row["p"] >= 0.001 else numbers(shown[6])
    assert table.strong == {k for k, row in enumerate(rows) if row["significant"]}


def test_cameras_show_stated_beside_adjusted_and_column_before_row(values, tables):
    (row,) = values["cameras"]
    stated, adjusted = row["stated_principal_point_px"], row["principal_point_px"]
    expected = (row["stated_principal_distance_px"], *stated,
                row["principal_distance_px"], *adjusted)  # fmt: skip
    for column, value in zip(tables["cameras"].columns[1:], expected, strict=True):
        assert_column(column, [value])
    # the camera's parameters: y of the principal point is upwards, rows are downwards
    found = {each["name"]: each["value"] for each in values["parameters"]}
    assert adjusted[0] - stated[0] == pytest.approx(found["camera_x0"])
    assert adjusted[1] - stated[1] == pytest.approx(-found["camera_y0"])
    change = row["principal_distance_px"] - row["stated_principal_distance_px"]
    assert change == pytest.approx(found["camera_c"])


def test_orientations_show_accuracy_and_what_the_pos_differs(values, tables):
    keys = ("median_sigma", "max_sigma", "pos_mean", "pos_rms")
    for shown, row in zip(tables["orientations"].rows, values["orientations"], strict=True):
        assert shown[1] == UNITS[row["unit"]]
        for cell, key in zip(shown[2:], keys, strict=True):
            assert_cell(cell, row[key], factor=per_si(shown[1]))


@pytest.mark.parametrize("table_name", ["control_points", "check_point_list"])
def test_points_show_east_north_up(values, tables, table_name):
    table = tables[table_name]
    if table_name == "control_points":
        rows, keys = values["control_points"], ("dx_m", "dy_m", "dz_m", "largest_w")
    else:
        rows = [row for row in values["check_point_residuals"] if row["orientation"] == "bundle"]
        keys = ("n_rays", "dx_m", "dy_m", "dz_m", "sigma_x_m", "sigma_y_m", "sigma_z_m")
    assert table.columns[0].cells == tuple(row["point"] for row in rows)
    for column, key in zip(table.columns[1:], keys, strict=True):
        assert_column(column, [row[key] for row in rows])


def test_blunders_show_measured_minus_adjusted_in_their_unit(values, tables):
    for shown, row in zip(tables["blunders"].rows, values["blunders"], strict=True):
        assert shown[1] == row["image"]
        assert_cell(shown[3], row["w"])
        assert_cell(shown[4], *row["size"], factor=per_si(UNITS[row["unit"]]))
        assert shown[5] == UNITS[row["unit"]]


def test_correlations_come_by_size_with_their_signs(tables):
    assert_column(tables["correlations"].columns[2], [-0.99, 0.97, 0.96])


def test_arrows_of_image_residuals_point_from_computed_to_measured(values, document):
    """x of the image to the right, y up, as the results have them."""
    found = arrows(svgs_of(document)["residuals_1"], style.BLUE)
    cells = values["image_residuals"]
    places = np.array([(row["x_px"], row["y_px"]) for row in cells])
    mean = np.array([(row["dx_px"], row["dy_px"]) for row in cells])
    tails = np.array([tail for tail, _ in found])
    offset, turn = on_ground(places, tails)
    np.testing.assert_allclose(offset + tails @ turn, places, atol=10.0)
    assert turn[0, 0] > 0.0
    assert turn[1, 1] > 0.0
    drawn = np.array([tip - tail for tail, tip in found]) @ turn
    factor = np.sum(drawn * mean) / np.sum(mean**2)
    assert factor > 0.0
    np.testing.assert_allclose(drawn / factor, mean, atol=0.03 * math.hypot(*mean.max(axis=0)))


def test_key_figures_are_those_of_the_results_and_plan_before_height(values, document):
    sigma0, image, orientations, points = document.key_figures
    assert_cell(sigma0.value, values["sigma0"])
    assert_cell(image.value, next(r["rms"] for r in values["groups"] if r["group"] == "image"))
    median = {row["element"]: row["median_sigma"] for row in values["orientations"]}
    assert_cell(orientations.value, max(median[axis] for axis in "xyz"))
    (kept,) = (
        row
        for row in values["check_points"]
        if row["orientation"] == "bundle" and not row["translation_removed"]
    )
    assert_cell(points.value, kept["rmse_horizontal_m"], kept["rmse_vertical_m"])
