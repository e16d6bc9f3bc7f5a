"""Calibration of a POS: estimated from one flight, kept in a file, taken off another.

Oracle: the injected boresight and lever arm, the perfect POS of a simulated block, and the
scatter of the estimates over repeated flights.
"""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from catalogues import OF
from click.testing import CliRunner
from small_scenario import small_block

from posstats.adjustment import AdjustmentSettings, adjust_block
from posstats.adjustment.block_problem import bundle_problem
from posstats.adjustment.calibration import (
    Calibration,
    apply_calibration,
    calibrate,
    calibrated,
    calibration_of,
    read_calibration,
    write_calibration,
)
from posstats.errors import BlockFormatError, PosstatsError
from posstats.formats.block_folder import write_block
from posstats.numerics.bundle import adjust
from posstats.numerics.kernels.rotation import wrapped
from posstats.papers.wucaps.adjustments import adjusted_block, control_points, pos_parameters
from posstats.reports.commands.cli import cli

ROLL_PITCH_YAW = np.array([-3e-3, 5e-3, 8e-3])
LEVER_ARM_M = np.array([0.4, -0.3, 1.2])
NONE = {"constant_rad": 0.0, "drift_rad_per_s": 0.0, "noise_rad": 2e-5}


def flown(seed=1, lever_arm_m=(0.0, 0.0, 0.0), strip_rad=0.0, **camera):
    """A flight with a boresight, and shifts of its strips."""
    roll, pitch, yaw = ROLL_PITCH_YAW
    angle = NONE | {"strip_rad": strip_rad}
    return small_block(
        seed,
        camera=camera,
        flight={"side_overlap": 0.4, "images_per_strip": 6},
        errors={
            "omega": angle, "phi": angle, "kappa": angle,
            "roll": {"constant_rad": roll}, "pitch": {"constant_rad": pitch},
            "yaw": {"constant_rad": yaw},
            "position": {"noise_m": 0.05, "lever_arm_m": list(lever_arm_m)},
        },
        control_points={"n": 9, "image_px": 0.2, "ground_m": 0.05},
        accuracy={"angle_deg": 0.0012},
    )  # fmt: skip


def made_up(lever_arm_m=None, camera="DMC") -> Calibration:
    n = 3 if lever_arm_m is None else 6
    spread = np.diag([1e-5, 2e-5, 3e-5, 0.01, 0.02, 0.03][:n]) + 1e-6
    return Calibration(ROLL_PITCH_YAW, lever_arm_m, spread @ spread.T, "field", camera, 24)


def test_the_estimated_boresight_is_the_injected_one_within_its_sigma():
    calibration = calibrate(adjust_block(flown(), AdjustmentSettings(drift="strip")))
    sigma = np.sqrt(np.diagonal(calibration.covariance))
    assert (np.abs(calibration.boresight_rad - ROLL_PITCH_YAW) < 3.0 * sigma).all()
    # yaw is told from the shifts of kappa by their priors alone, 0.05 degrees for each of 4 strips
    assert sigma[2] == pytest.approx(np.radians(0.05) / 2.0, rel=0.01)
    assert (calibration.block, calibration.camera, calibration.n_images) == ("small", "DMC", 24)
    assert calibration.lever_arm_m is None


def test_the_covariance_of_the_boresight_holds_the_scatter_of_flights():
    strip_rad = np.radians(0.05)
    flights = [flown(seed, strip_rad=strip_rad) for seed in range(1, 7)]
    problems = [
        bundle_problem(each, pos_parameters(each, "weighted"), control=control_points(each, "all"))
        for each in flights
    ]
    adjusted = [adjust(problem) for problem in problems]
    found = [
        calibration_of(flight, problem, each, each.common_covariance)
        for flight, problem, each in zip(flights, problems, adjusted, strict=True)
    ]
    error = np.array([each.boresight_rad for each in found]) - ROLL_PITCH_YAW
    chi2 = np.einsum("si,ij,sj->", error, np.linalg.inv(found[0].covariance), error)
    assert 6.3 < chi2 < 37.2  # 99 % of chi-square with 18 degrees of freedom


def test_the_covariance_is_scaled_by_sigma0_where_measurements_make_it():
    # all stated standard deviations of measurements three times the true ones: sigma0 is a third
    right = flown()
    pos, stated = right.orientations, right.accuracy
    timid = replace(
        right,
        orientations=replace(
            pos,
            sigma_position_m=3.0 * pos.sigma_position_m,
            sigma_angles_rad=3.0 * pos.sigma_angles_rad,
        ),
        accuracy=replace(stated, image_px=3.0 * stated.image_px),
        ground_points=replace(
            right.ground_points,
            sigma_xy_m=3.0 * right.ground_points.sigma_xy_m,
            sigma_z_m=3.0 * right.ground_points.sigma_z_m,
        ),
    )
    settings = AdjustmentSettings(drift="block", robust=False)
    first, second = (
        np.sqrt(np.diagonal(calibrate(adjust_block(each, settings)).covariance))
        for each in (right, timid)
    )
    assert second[:2] == pytest.approx(first[:2], rel=0.1)
    # the prior of the shift of kappa alone knows the yaw, whatever the measurements' noise
    assert second[2] == pytest.approx(np.radians(0.05), rel=0.02)


def test_a_lever_arm_is_estimated_on_request():
    settings = AdjustmentSettings(drift="block", lever_arm=True)
    calibration = calibrate(adjust_block(flown(lever_arm_m=LEVER_ARM_M), settings))
    sigma = np.sqrt(np.diagonal(calibration.covariance))[3:]
    assert (np.abs(calibration.lever_arm_m - LEVER_ARM_M) < 3.0 * sigma).all()
    assert (sigma[:2] < 0.15).all()  # headings turn it, and not a shift of the GNSS


@pytest.mark.parametrize("lever_arm_m", [None, LEVER_ARM_M])
def test_the_injected_calibration_restores_a_perfect_pos(lever_arm_m):
    perfect = {"noise_rad": 0.0, "constant_rad": 0.0, "drift_rad_per_s": 0.0}
    roll = ROLL_PITCH_YAW[0]
    block = small_block(
        errors={
            "omega": perfect, "phi": perfect, "kappa": perfect,
            "roll": {"constant_rad": roll},
            "position": {"noise_m": 0.0, "lever_arm_m": [0.0] * 3 if lever_arm_m is None
                         else lever_arm_m.tolist()},
        }
    )  # fmt: skip
    calibration = replace(made_up(lever_arm_m), boresight_rad=np.array([roll, 0.0, 0.0]))
    pos = apply_calibration(block, calibration).orientations
    np.testing.assert_allclose(pos.angles_rad, block.adjusted.angles_rad, atol=1e-12)
    np.testing.assert_allclose(pos.position_m, block.adjusted.position_m, atol=1e-8)


def test_standard_deviations_grow_by_those_of_the_calibration():
    block = flown()
    calibration = made_up(LEVER_ARM_M)
    pos = apply_calibration(block, calibration).orientations
    root = np.linalg.cholesky(calibration.covariance)
    draws = np.random.default_rng(3).normal(size=(400, 6)) @ root.T
    positions, angles = [], []
    for draw in draws:
        other = replace(
            calibration,
            boresight_rad=calibration.boresight_rad + draw[:3],
            lever_arm_m=calibration.lever_arm_m + draw[3:],
        )
        drawn = apply_calibration(block, other).orientations
        positions.append(drawn.position_m)
        angles.append(wrapped(drawn.angles_rad - pos.angles_rad))
    before = block.orientations
    expected = np.sqrt(before.sigma_angles_rad**2 + np.var(angles, axis=0))
    np.testing.assert_allclose(pos.sigma_angles_rad, expected, rtol=0.05)
    expected = np.sqrt(before.sigma_position_m**2 + np.var(positions, axis=0))
    np.testing.assert_allclose(pos.sigma_position_m, expected, rtol=0.05)


def test_standard_deviations_stay_where_the_boresight_is_estimated_anew():
    block, calibration = flown(), made_up(LEVER_ARM_M)
    pos = apply_calibration(block, calibration, unknown=True).orientations
    np.testing.assert_array_equal(pos.sigma_angles_rad, block.orientations.sigma_angles_rad)
    np.testing.assert_array_equal(pos.sigma_position_m, block.orientations.sigma_position_m)
    known = apply_calibration(block, calibration).orientations
    np.testing.assert_array_equal(pos.angles_rad, known.angles_rad)


@pytest.mark.parametrize("lever_arm_m", [None, LEVER_ARM_M])
def test_a_file_gives_back_what_was_written(tmp_path, lever_arm_m):
    written = replace(made_up(lever_arm_m), block='field "7"\x7f', camera="caméra")
    write_calibration(written, tmp_path / "calibration.toml")
    read = read_calibration(tmp_path / "calibration.toml")
    np.testing.assert_array_equal(read.boresight_rad, written.boresight_rad)
    np.testing.assert_array_equal(read.covariance, written.covariance)
    assert (read.lever_arm_m is None) == (lever_arm_m is None)
    assert (read.block, read.camera) == (written.block, written.camera)
    assert (read.n_images, read.posstats_version) == (24, written.posstats_version)


@pytest.mark.parametrize(
    ("old", "new", "finding"),
    [
        ("boresight_rad", "boresite_rad", "key, expected boresight_rad?"),
        ("posstats-calibration/1", "posstats-calibration/2", "schema"),
        ("boresight_roll", "boresight_pitch", "parameters"),
        ("n_images = 24", "n_images = 0", "whole number"),
        ("covariance = [[", "covariance = [[-", "covariance matrix"),
        ("n_images = 24", "n_images 24", "no valid TOML"),
    ],
)
def test_a_wrong_file_is_refused_by_name(tmp_path, old, new, finding):
    path = tmp_path / "flight.toml"
    write_calibration(made_up(), path)
    text = path.read_text(encoding="utf-8")
    assert old in text
    path.write_text(text.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(BlockFormatError, match=r"flight\.toml") as refused:
        read_calibration(path)
    assert finding in str(refused.value)


def test_a_calibration_of_another_camera_is_refused():
    with pytest.raises(PosstatsError, match="'UCX'; small has 'DMC'"):
        apply_calibration(flown(), made_up(camera="UCX"))


def test_an_adjustment_without_boresight_gives_no_calibration():
    result = adjusted_block(flown(), "all", "none")
    with pytest.raises(PosstatsError, match="not an unknown"):
        calibration_of(flown(), result.problem, result.adjusted, np.empty((0, 0)))


def test_a_calibrated_block_lists_the_file_among_its_inputs(tmp_path):
    path = tmp_path / "calibration.toml"
    write_calibration(made_up(), path)
    block = calibrated(flown(), path)
    (name, digest) = block.inputs[-1]
    assert name == "calibration.toml"
    assert len(digest) == 64
    assert not np.array_equal(block.orientations.angles_rad, flown().orientations.angles_rad)


def test_the_command_estimates_a_file_that_another_flight_takes(tmp_path):
    write_block(flown(), tmp_path / "field")
    write_block(flown(2), tmp_path / "flight")
    path = tmp_path / "boresight.toml"
    told = run("calibrate", tmp_path / "field", "--out", path, "--lever-arm")
    assert told.exit_code == 0, told.output
    assert "DMC, from 24 images" in told.output
    calibration = read_calibration(path)
    sigma = np.sqrt(np.diagonal(calibration.covariance))[:3]
    assert (np.abs(calibration.boresight_rad - ROLL_PITCH_YAW) < 3.0 * sigma).all()
    assert f"boresight_pitch: {np.degrees(calibration.boresight_rad[1]):.4f}° ±" in told.output
    assert "lever_arm_w: " in told.output
    assert re.search(r"sigma0: (0\.9|1\.0)", told.output)
    assert OF["en", "adjustment"].text("blunders.none") in " ".join(told.output.split())
    told = run("analyse", tmp_path / "flight", "--out", tmp_path / "out", "--no-pdf",
               "--calibration", path)  # fmt: skip
    assert told.exit_code == 0, told.output
    results = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert "boresight.toml" in json.dumps(results["block"])
    # 5 mrad of pitch alone leave some 70 µm; a constant in the ground frame leaves nothing
    assert results["verdict"]["raw_mm"] < 0.01


def test_a_calibration_is_not_written_where_it_cannot_be(tmp_path):
    write_block(flown(), tmp_path / "field")
    for place in (tmp_path, tmp_path / "missing" / "boresight.toml"):
        told = run("calibrate", tmp_path / "field", "--out", place)
        assert told.exit_code == 1
        assert "cannot be written" in told.output


def run(*arguments):
    return CliRunner().invoke(cli, [str(argument) for argument in arguments])
