"""The whole chain: simulated truth, invariances, and the two real blocks."""

import json
from dataclasses import replace

import numpy as np
import pytest
from helpers import shared_path
from small_scenario import OMEGA_DRIFT_RAD_PER_S, mean_px, small_block

from posstats import PosstatsError, Settings, analyse, orient, read_block, stereo_models
from posstats.analysis.results import results
from posstats.analysis.steps import Analysis
from posstats.block.model import Block
from posstats.contract.files import as_values
from posstats.geometry.stereo.parallax import model_rms_px
from posstats.numerics.kernels.coplanarity import base_frames
from posstats.numerics.kernels.rotation import angles_from_rotation


@pytest.fixture(scope="module")
def block() -> Block:
    return small_block()


@pytest.fixture(scope="module")
def analysis(block: Block) -> Analysis:
    return analyse(block)


def block_row(analysis: Analysis, angle: str, frame: str = "ground"):
    rows = as_values(results(analysis))["regression"]
    return next(
        row for row in rows if (row["angle"], row["frame"], row["scope"]) == (angle, frame, "block")
    )


def form_of(analysis: Analysis) -> dict[str, str]:
    return {each.angle: each.form for each in analysis.chosen.decisions}


def test_the_drifting_angle_is_named_chosen_and_corrected(analysis):
    assert as_values(results(analysis))["verdict"]["cause"] == "omega"
    assert form_of(analysis) == {"omega": "linear", "phi": "none", "kappa": "none"}
    raw, left = mean_px(analysis.raw_px), mean_px(analysis.corrected_px["selected"])
    assert raw > 20.0
    assert left < 1.6 * mean_px(analysis.independent.y_parallax_rms_px)


def test_the_injected_drift_lies_in_the_interval_of_both_fits(analysis):
    row = block_row(analysis, "omega")
    for interval in (row["slope_ci95"], row["gls_slope_ci95"]):
        # three half widths: a seed must not decide
        middle, half = np.mean(interval), np.ptp(interval) / 2
        assert abs(middle - OMEGA_DRIFT_RAD_PER_S) < 3 * half


def test_only_the_angle_in_error_reduces_the_parallax(analysis):
    raw = mean_px(analysis.raw_px)
    assert mean_px(analysis.corrected_px["omega"]) < 0.05 * raw
    for angle in ("phi", "kappa"):
        assert mean_px(analysis.corrected_px[angle]) == pytest.approx(raw, rel=0.02)


def test_check_points_gain_from_the_correction(analysis):
    rows = {
        row["orientation"]: row
        for row in as_values(results(analysis))["check_points"]
        if row["translation_removed"]
    }
    for name in ("rmse_horizontal_m", "rmse_vertical_m"):
        assert rows["selected"][name] < 0.5 * rows["pos"][name]
        assert rows["adjusted"][name] < 0.5 * rows["pos"][name]


def test_errors_against_truth_need_no_tie_points(block):
    against_truth = analyse(block, Settings(errors="adjusted"))
    assert form_of(against_truth)["omega"] == "linear"
    pos, truth = block.orientations.angles_rad, block.adjusted.angles_rad
    errors = against_truth.frames[0].errors
    np.testing.assert_allclose(errors.error_rad, pos - truth, atol=1e-15)


def test_one_line_per_strip(block):
    by_strip = analyse(block, Settings(scope="strip"))
    assert {each.scope for each in by_strip.chosen.decisions} == set(block.orientations.strips)


def test_a_boresight_shows_in_the_camera_frame_only():
    # Five strips: an error of sign + - + - + has no trend (with four it has R2 = 0.2).
    boresight = small_block(
        flight={"n_strips": 5},
        tie_points={"per_model": 200},
        errors={
            "omega": {"noise_rad": 1.6e-5},
            "pitch": {"constant_rad": 0.018},
        },
    )
    ground = analyse(boresight)
    assert block_row(ground, "omega")["r_squared"] < 0.05
    assert set(form_of(ground).values()) == {"none"}
    for frame in ("camera", "auto"):
        camera = analyse(boresight, Settings(frame=frame, rules="strict"))
        assert camera.chosen.frame == "camera"
        assert form_of(camera)["pitch"] == "constant"
        left = mean_px(camera.corrected_px["selected"])
        assert left < 1.5 * mean_px(camera.independent.y_parallax_rms_px)


def test_auto_keeps_the_ground_frame_for_a_drift(block):
    assert analyse(block, Settings(frame="auto")).chosen.frame == "ground"


def summary_numbers(analysis: Analysis) -> np.ndarray:
    values = as_values(results(analysis))
    fits = [
        (row["r_squared"], row["f_statistic"], row["gls_slope_rad_per_s"] * 1e6)
        for row in values["regression"]
        if row["scope"] == "block"
    ]
    means = [values["verdict"][key] for key in ("raw_px", "relative_px", "corrected_px")]
    accuracy = [row["rmse_vertical_m"] for row in values["check_points"]]
    return np.concatenate([np.ravel(fits), means, accuracy])


def test_another_time_origin_changes_nothing(block, analysis):
    later = replace(
        block, orientations=replace(block.orientations, time_s=block.orientations.time_s + 2.0**30)
    )
    np.testing.assert_allclose(
        summary_numbers(analyse(later)), summary_numbers(analysis), rtol=1e-8
    )


def test_other_names_change_nothing(block, analysis):
    pos = block.orientations
    names = {name: f"<{name[::-1]}>" for name in pos.image}
    strips = {name: f"a,{name}" for name in pos.strips}
    renamed = replace(
        pos,
        image=np.array([names[name] for name in pos.image], dtype=object),
        strip=np.array([strips[name] for name in pos.strip], dtype=object),
    )
    other = analyse(replace(block, orientations=renamed))
    np.testing.assert_allclose(summary_numbers(other), summary_numbers(analysis), rtol=1e-9)


def turned(block: Block, angle_rad: float) -> Block:
    """The block in a ground frame turned about Z, which runs along the first base."""
    turn = np.swapaxes(base_frames(np.array([np.cos(angle_rad), np.sin(angle_rad), 0.0])), 0, 1)

    def orientations(old):
        rotation = turn @ old.ground_from_image
        return replace(
            old,
            position_m=old.position_m @ turn.T,
            angles_rad=angles_from_rotation(rotation, old.system),
        )

    ground = replace(block.ground_points, position_m=block.ground_points.position_m @ turn.T)
    return replace(
        block,
        orientations=orientations(block.orientations),
        adjusted=orientations(block.adjusted),
        ground_points=ground,
    )


def test_turning_the_ground_frame_changes_no_parallax_and_no_height(block, analysis):
    other = analyse(turned(block, 0.7))
    np.testing.assert_allclose(other.raw_px, analysis.raw_px, rtol=1e-9)
    np.testing.assert_allclose(
        other.independent.y_parallax_rms_px, analysis.independent.y_parallax_rms_px, rtol=1e-9
    )
    for here, there in zip(analysis.check_points, other.check_points, strict=True):
        if here.orientation in ("pos", "adjusted"):
            np.testing.assert_allclose(there.difference_m[:, 2], here.difference_m[:, 2], atol=1e-5)


def test_a_setting_that_does_not_exist_is_named():
    with pytest.raises(PosstatsError, match=r"'aero'.*ground, camera, auto"):
        Settings(frame="aero")


def test_without_stereo_models_there_is_nothing_to_analyse(block):
    alone = replace(
        block.orientations,
        strip=np.array([f"s{k}" for k in range(len(block.orientations))], dtype=object),
    )
    with pytest.raises(PosstatsError, match="no stereo model"):
        analyse(replace(block, orientations=alone))


def test_the_results_are_plain_json_without_nan(analysis):
    text = json.dumps(as_values(results(analysis)), allow_nan=False)
    assert json.loads(text)["schema"] == "posstats-results/1"


@pytest.fixture(scope="module")
def marseille() -> Analysis:
    return analyse(read_block(shared_path("data", "ign-fd1305")))


def test_the_adjusted_orientation_of_the_real_block_leaves_its_known_parallax():
    block = read_block(shared_path("data", "ign-fd1305"))
    models = stereo_models(replace(block, orientations=block.adjusted))
    assert mean_px(model_rms_px(models)) == pytest.approx(0.214, abs=0.002)
    assert mean_px(orient(models).y_parallax_rms_px) < 0.214


def test_the_injected_errors_of_the_real_block_are_found(marseille):
    injected = json.loads(shared_path("data", "ign-fd1305", "injected.json").read_text())
    row = block_row(marseille, "omega")
    assert abs(row["gls_slope_rad_per_s"] - injected["slope_rad_per_s"][0]) < 3e-8
    assert row["r_squared"] > 0.85
    assert form_of(marseille) == {"omega": "linear", "phi": "none", "kappa": "none"}


def test_correcting_the_real_block_is_worth_what_removing_the_injected_omega_is(marseille):
    block = marseille.block
    angles = block.orientations.angles_rad.copy()
    angles[:, 0] = block.adjusted.angles_rad[:, 0]
    best = mean_px(
        model_rms_px(marseille.models.with_orientations(block.with_angles(angles).orientations))
    )
    assert mean_px(marseille.corrected_px["selected"]) == pytest.approx(best, rel=0.02)


def test_a_low_cost_drone_runs_end_to_end():
    drone = analyse(read_block(shared_path("data", "seneca")))
    assert np.isfinite(drone.raw_px).sum() == 63
    assert np.nanmedian(drone.raw_px) == pytest.approx(279.0, rel=0.03)
    assert np.nanmedian(drone.independent.y_parallax_rms_px) <= 1.3


def test_models_of_too_few_points_are_listed_without_a_value():
    sparse = small_block(tie_points={"per_model": 3})
    values = as_values(results(analyse(sparse)))
    assert {row["pos_px"] for row in values["models"] if row["n_points"] < 6} == {None}
    few = [row for row in values["models"] if row["n_points"] < 6]
    assert few
    assert {row["status"] for row in few} == {"fewer than 6 points"}


def test_models_of_images_without_adjusted_orientation_have_no_adjusted_parallax(block):
    angles = block.adjusted.angles_rad.copy()
    angles[0] = np.nan
    partial = replace(block, adjusted=replace(block.adjusted, angles_rad=angles))
    analysis = analyse(partial)
    rows = as_values(results(analysis))["models"]
    first = block.orientations.image[0]
    missing = [row for row in rows if first in (row["left"], row["right"])]
    others = [row["adjusted_px"] for row in rows if row not in missing]
    assert [row["adjusted_px"] for row in missing] == [None] * len(missing)
    # the true orientations leave the image noise: a little over 0.2 px in y of either image
    assert 0.2 < np.mean(others) < 0.5
    assert {row["bundle_px"] for row in rows} == {None}


def test_survey_accuracy_stands_beside_every_check_point(analysis):
    points = as_values(results(analysis))["check_point_residuals"]
    assert points
    assert all(row["survey_sigma_xy_m"] > 0.0 and row["survey_sigma_z_m"] > 0.0 for row in points)
