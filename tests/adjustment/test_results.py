"""Numbers of adjustment.json against what is computed here from the adjusted orientations."""

from dataclasses import replace

import numpy as np
import pytest
from small_blocks import Layout, observed_block, true_block

from posstats.adjustment import AdjustmentSettings, adjust_block
from posstats.adjustment.results import adjustment_results
from posstats.block.model import GroundPoints
from posstats.numerics.kernels.rotation import rotation_from_angles

ERROR_RAD = np.array([0.03, -0.02, 0.05])
DEFORMED_PX = 0.8


@pytest.fixture(scope="module")
def adjusted():
    """A block whose POS angles are off, and whose images are off to the right at their right."""
    truth = true_block(Layout(n_strips=3, n_images=5, n_points=250, sigma_image_px=0.1))
    block = observed_block(truth, np.random.default_rng(3), ERROR_RAD)
    ties = block.tie_points
    right = np.array([DEFORMED_PX, -0.5 * DEFORMED_PX]) * (ties.xy_px[:, :1] > 1200.0)
    return adjust_block(
        replace(block, tie_points=replace(ties, xy_px=ties.xy_px + right)),
        AdjustmentSettings(control="none", drift="block", robust=False),
    )


@pytest.fixture(scope="module")
def values(adjusted):
    return adjustment_results(adjusted)


def measured_and_computed(adjustment):
    """(m, 2) each, of the rays that took part; computed by collinearity written out."""
    ties, pose = adjustment.stated, adjustment.orientations
    rotation = rotation_from_angles(pose.angles_rad, pose.system)[ties.image]
    line = adjustment.adjusted.ground_m[ties.point] - pose.position_m[ties.image]
    seen = np.einsum("mji,mj->mi", rotation, line)
    computed = -adjustment.block.cameras[0].principal_distance_px * seen[:, :2] / seen[:, 2:]
    used = ~adjustment.adjusted.rejected
    return ties.xy_px[used], computed[used]


def test_pos_minus_adjusted_has_the_sign_and_size_of_the_errors_put_in(values, adjusted):
    rows = {row.element: row for row in values.orientations}
    for name, error in zip(("omega", "phi", "kappa"), ERROR_RAD, strict=True):
        assert rows[name].pos_mean == pytest.approx(error, abs=2e-3)
        assert rows[name].pos_rms == pytest.approx(abs(error), abs=2e-3)
    moved = adjusted.block.orientations.position_m - adjusted.orientations.position_m
    for axis, name in enumerate("xyz"):
        assert rows[name].pos_mean == pytest.approx(moved[:, axis].mean())
        assert rows[name].pos_rms == pytest.approx(np.sqrt((moved[:, axis] ** 2).mean()))


def test_standard_deviations_of_elements_are_those_of_their_own_columns(values, adjusted):
    sigma = np.hstack([adjusted.orientations.sigma_angles_rad,
                       adjusted.orientations.sigma_position_m])  # fmt: skip
    for row, column in zip(values.orientations, sigma.T, strict=True):
        assert row.median_sigma == pytest.approx(np.median(column))
        assert row.max_sigma == pytest.approx(column.max())


def test_cells_hold_mean_residuals_measured_minus_computed(values, adjusted):
    """Every cell from its own rays."""
    measured, computed = measured_and_computed(adjusted)
    residual = measured - computed
    size = 6000.0 / 12
    for row in values.image_residuals:
        place = np.array([row.x_px, row.y_px])
        inside = (np.abs(measured - place) < size / 2).all(axis=1)
        assert row.n == inside.sum()
        mean = residual[inside].mean(axis=0)
        assert (row.dx_px, row.dy_px) == pytest.approx(tuple(mean), abs=1e-6)
        rms = np.sqrt((residual[inside] ** 2).mean())
        assert row.rms_px == pytest.approx(rms, abs=1e-6)


def test_rms_of_image_coordinates_is_that_of_all_components(values, adjusted):
    measured, computed = measured_and_computed(adjusted)
    residual = measured - computed
    group = next(row for row in values.groups if row.group == "image")
    assert group.n == residual.size
    assert group.rms == pytest.approx(np.sqrt((residual**2).mean()), rel=1e-6)


def test_control_points_are_adjusted_minus_given_with_the_sign_of_what_the_others_say():
    """One of five control points is given 3 m too far east and 2 m too high."""
    truth = true_block(Layout(n_strips=3, n_images=4, n_points=150, sigma_image_px=0.1))
    block = observed_block(truth, np.random.default_rng(4))
    ground = adjust_block(block, AdjustmentSettings(control="none", robust=False)).adjusted.ground_m
    known = np.flatnonzero(np.isfinite(ground).all(axis=1))
    chosen = known[np.linspace(0, len(known) - 1, 5).astype(int)]
    given = ground[chosen] + np.where(np.arange(5)[:, None] == 2, [3.0, 0.0, 2.0], 0.0)
    sigma = np.full(5, 1.0)
    points = GroundPoints(block.tie_points.point_id[chosen], given, np.zeros(5, bool), sigma, sigma)
    found = adjust_block(
        replace(block, ground_points=points), AdjustmentSettings(control="all", robust=False)
    )
    rows = {row.point: row for row in adjustment_results(found).control_points}
    wrong = rows[block.tie_points.point_id[chosen[2]]]
    assert wrong.dx_m == pytest.approx(-3.0, abs=0.7)
    assert wrong.dy_m == pytest.approx(0.0, abs=0.7)
    assert wrong.dz_m == pytest.approx(-2.0, abs=0.7)
    assert wrong.x_m == pytest.approx(given[2, 0])


def test_an_adjusted_camera_is_the_stated_one_and_its_parameters_with_rows_downwards():
    truth = true_block(Layout(n_strips=3, n_images=4, n_points=120, sigma_image_px=0.1))
    block = observed_block(truth, np.random.default_rng(8))
    settings = AdjustmentSettings(control="none", camera=True, robust=False)
    results = adjustment_results(adjust_block(block, settings))
    (camera,) = results.cameras
    found = {each.name: each.value for each in results.parameters}
    column, row = camera.stated_principal_point_px
    assert (column, row) == truth.cameras[0].principal_point_px
    assert camera.principal_point_px[0] - column == pytest.approx(found["camera_x0"])
    assert camera.principal_point_px[1] - row == pytest.approx(-found["camera_y0"])
    change = camera.principal_distance_px - camera.stated_principal_distance_px
    assert change == pytest.approx(found["camera_c"])
