"""Angle errors from the bundle: simulated truth, a dense adjustment, control, blunders, report."""

import json
from dataclasses import replace

import numpy as np
import pytest
from catalogues import OF
from click.testing import CliRunner
from dense_bundle import DenseBundle
from helpers import shared_path
from scipy import stats
from small_blocks import Layout, observed_block, true_block
from small_scenario import OMEGA_DRIFT_RAD_PER_S, scenario, small_block

from posstats.adjustment.imu_free import MAX_IMAGES, ImuFreeBundle, adjust_imu_free
from posstats.analysis.angle_errors import AngleErrors, bundle_errors, coplanarity_errors
from posstats.analysis.results import results
from posstats.analysis.steps import analyse
from posstats.block.image_pairs import stereo_models
from posstats.block.model import Block
from posstats.contract.files import as_values
from posstats.errors import GeometryError
from posstats.formats.block_folder import read_block, write_block
from posstats.numerics.kernels.rotation import angles_from_rotation, rotation_from_vector, wrapped
from posstats.reports.block import document as block_document
from posstats.reports.commands.cli import cli
from posstats.reports.pages import html
from posstats.settings import Settings

CONTROL = {"n": 4, "distribution": "corners", "image_px": 0.2, "ground_m": 0.05}
ONE_STRIP = scenario()["flight"] | {"n_strips": 1}
STRAIGHT = ONE_STRIP | {"position_jitter_m": 0.0, "tilt_rad": 0.0}


def adjusted(block: Block, **options) -> tuple[ImuFreeBundle, AngleErrors]:
    bundle = adjust_imu_free(block, **options)
    return bundle, bundle_errors(block, bundle)


def true_errors(block: Block) -> np.ndarray:
    """Of simulated blocks, whose adjusted orientation is the truth."""
    return wrapped(block.orientations.angles_rad - block.adjusted.angles_rad)


def distance(errors: AngleErrors, truth: np.ndarray) -> float:
    """e'C^-1 e of the misses of all angles together."""
    miss = (errors.error_rad - truth).ravel()
    return miss @ np.linalg.solve(errors.covariance_rad2.reshape(miss.size, miss.size), miss)


@pytest.fixture(scope="module")
def block() -> Block:
    return small_block()


@pytest.fixture(scope="module")
def analysis(block):
    return analyse(block, Settings(errors="bundle"))


@pytest.mark.parametrize(
    "changes", [{}, {"control_points": CONTROL}, {"flight": ONE_STRIP, "control_points": CONTROL}],
    ids=["no control", "control", "one strip"],
)  # fmt: skip
def test_all_errors_together_miss_the_truth_as_their_covariance_says(changes):
    misses, n = 0.0, 0
    for seed in range(8):
        block = small_block(seed, **changes)
        _, errors = adjusted(block)
        assert errors.used.all()
        misses += distance(errors, true_errors(block))
        n += errors.error_rad.size
    assert 0.001 < stats.chi2.sf(misses, n) < 0.999


def test_the_covariance_is_that_of_a_dense_adjustment():
    block = observed_block(
        true_block(Layout(n_images=4, n_points=60)), np.random.default_rng(3), 1e-3
    )
    bundle, errors = adjusted(block, robust=False)
    n = len(block.orientations)
    cofactor = DenseBundle(bundle.problem, bundle.adjusted).cofactor[: 6 * n, : 6 * n]
    rotations = cofactor.reshape(n, 6, n, 6)[:, :3, :, :3]
    turned = bundle.adjusted.ground_from_image
    by_vector = np.empty((n, 3, 3))
    for axis in range(3):
        step = rotation_from_vector(1e-6 * np.eye(3)[axis])
        ahead, behind = (
            angles_from_rotation(turn @ turned, "omega-phi-kappa") for turn in (step, step.T)
        )
        by_vector[:, :, axis] = wrapped(ahead - behind) / 2e-6
    dense = np.einsum("iab,ibjc,jdc->iajd", by_vector, rotations, by_vector)
    scale = np.multiply.outer(errors.sigma_rad, errors.sigma_rad)
    np.testing.assert_allclose(errors.covariance_rad2 / scale, dense / scale, atol=1e-5)


def test_the_injected_drift_lies_in_the_interval_of_gls(analysis):
    row = next(
        each for each in as_values(results(analysis))["regression"]
        if (each["angle"], each["scope"]) == ("omega", "block")
    )  # fmt: skip
    low, high = row["gls_slope_ci95"]
    assert low < OMEGA_DRIFT_RAD_PER_S < high
    assert row["covariance_known"]
    assert {each.angle: each.form for each in analysis.chosen.decisions}["omega"] == "linear"


def test_bundle_and_coplanarity_agree_within_their_standard_deviations(block, analysis):
    errors = analysis.frames[0].errors
    other = coplanarity_errors(block, stereo_models(block))
    difference = np.abs(errors.error_rad - other.error_rad)
    assert (difference < 2.0 * np.minimum(errors.sigma_rad, other.sigma_rad)).all()
    assert np.median(errors.sigma_rad / other.sigma_rad) < 1.0


def test_control_points_fix_the_roll_of_a_single_strip():
    """The same measurements: C without control less C with it is positive, but for the noise."""
    with_control = small_block(2, flight=STRAIGHT, control_points=CONTROL)
    surveyed = with_control.ground_points
    keep = surveyed.is_check
    kept = replace(
        surveyed,
        point=surveyed.point[keep],
        position_m=surveyed.position_m[keep],
        is_check=surveyed.is_check[keep],
        sigma_xy_m=surveyed.sigma_xy_m[keep],
        sigma_z_m=surveyed.sigma_z_m[keep],
    )
    bundle, fixed = adjusted(with_control)
    without, loose = adjusted(replace(with_control, ground_points=kept))
    assert (len(bundle.problem.control.point), len(without.problem.control.point)) == (4, 0)
    size = fixed.error_rad.size
    noise = (bundle.sigma_px / without.sigma_px) ** 2
    assert noise == pytest.approx(1.0, abs=0.05)
    gained = (1.05 * loose.covariance_rad2 - fixed.covariance_rad2).reshape(size, size)
    scale = loose.sigma_rad.ravel()
    assert np.linalg.eigvalsh(gained / np.multiply.outer(scale, scale)).min() > 0.0
    assert loose.observability[0].rotations == ("about_base_axis",)
    assert fixed.observability[0].rotations == ()
    assert fixed.used.all()


def test_an_open_roll_is_named_and_its_images_take_no_part():
    layout = Layout(n_strips=1, jitter_m=0.0, relief_m=0.0)
    block = observed_block(true_block(layout), np.random.default_rng(8))
    _, errors = adjusted(block)
    assert errors.observability[0].rotations == ("about_base_axis",)
    assert not errors.used.any()
    assert errors.observability[1].images == tuple(block.orientations.image)


def test_the_angles_of_the_pos_do_not_draw_the_solution(block):
    bundle, errors = adjusted(block, robust=False)
    turned = block.orientations.angles_rad + np.array([0.002, -0.003, 0.004])
    other, _ = adjusted(block.with_angles(turned), robust=False)
    moved = wrapped(other.adjusted.angles_rad - bundle.adjusted.angles_rad)
    assert np.abs(moved / errors.sigma_rad).max() < 1e-2


def test_check_points_take_no_part_and_gain(block, analysis):
    ties = block.tie_points
    moved = replace(ties, xy_px=ties.xy_px + 30.0 * block.check_points[ties.point][:, None])
    other, _ = adjusted(replace(block, tie_points=moved))
    np.testing.assert_array_equal(other.adjusted.angles_rad, analysis.bundle.adjusted.angles_rad)
    rows = {(each["orientation"], each["translation_removed"]): each
            for each in as_values(results(analysis))["check_points"]}  # fmt: skip
    for removed in (False, True):
        for name in ("rmse_horizontal_m", "rmse_vertical_m"):
            assert rows["bundle", removed][name] < 0.1 * rows["pos", removed][name]


def test_check_points_differ_as_their_standard_deviations_say():
    square_sum, n = 0.0, 0
    as_stated = {"image_px": scenario()["accuracy"]["image_px"]}
    for seed in range(6):
        block = small_block(seed, control_points=CONTROL, check_points=as_stated)
        checks = adjust_imu_free(block).check_points
        ratio = checks.difference_m / checks.sigma_m
        square_sum, n = square_sum + (ratio**2).sum(), n + ratio.size
    assert 0.6 < square_sum / n < 1.4


def test_blunders_are_taken_out():
    """Four per cent of the rays off by 5-50 px change no angle by more than 4 of its sigmas."""
    truth = true_block(Layout())
    rng = np.random.default_rng(4)
    error = 1e-3 * rng.standard_normal((len(truth.orientations), 3))
    block = observed_block(truth, rng, error)
    ties = block.tie_points
    bad = rng.random(len(ties)) < 0.04
    offset = rng.uniform(5.0, 50.0, (len(ties), 2)) * rng.choice([-1.0, 1.0], (len(ties), 2))
    spoiled = replace(block, tie_points=replace(ties, xy_px=ties.xy_px + bad[:, None] * offset))
    bundle, errors = adjusted(spoiled)
    plain, _ = adjusted(spoiled, robust=False)
    assert np.abs((errors.error_rad - error) / errors.sigma_rad).max() < 4.0
    assert bundle.sigma_px == pytest.approx(Layout().sigma_image_px, rel=0.15)
    assert bundle.n_rejected == pytest.approx(bad.sum(), rel=0.3)
    assert plain.sigma_px > 5.0 * Layout().sigma_image_px


def test_a_wrong_image_accuracy_changes_sigma0_and_not_the_errors(block):
    stated = replace(block.accuracy, image_px=3.0 * block.accuracy.image_px)
    bundle, errors = adjusted(replace(block, accuracy=stated), robust=False)
    good, right = adjusted(block, robust=False)
    assert good.overall.p > 0.01
    assert bundle.overall.p < 1e-6
    assert bundle.overall.sigma0 == pytest.approx(1.0 / 3.0, rel=0.05)
    assert bundle.sigma_px == pytest.approx(good.sigma_px, rel=0.02)
    assert np.abs((errors.error_rad - right.error_rad) / right.sigma_rad).max() < 0.1
    np.testing.assert_allclose(errors.sigma_rad, right.sigma_rad, rtol=0.03)


def test_the_priors_of_the_angles_do_not_count_in_sigma0(block):
    """Whatever the errors of the angles, the measurements are as good."""
    bundle, _ = adjusted(block)
    turned = block.orientations.angles_rad + np.array([0.05, -0.05, 0.05])
    worse, _ = adjusted(block.with_angles(turned))
    assert worse.overall.sigma0 == pytest.approx(bundle.overall.sigma0, rel=1e-3)
    n_angles = 3 * len(block.orientations)
    assert bundle.overall.dof == bundle.adjusted.dof - n_angles


def test_a_wrong_control_point_is_named_and_costs_no_rays():
    block = small_block(1, control_points=CONTROL)
    surveyed = block.ground_points
    wrong = np.flatnonzero(~surveyed.is_check)[1]
    position = surveyed.position_m.copy()
    position[wrong, 2] += 5.0
    right, good = adjusted(block)
    bundle, errors = adjusted(replace(block, ground_points=replace(surveyed, position_m=position)))
    assert good.notices == ()
    (notice,) = (each for each in errors.notices if each.code == "contradicted_control")
    assert notice.values["ids"] == (surveyed.point[wrong],)
    assert bundle.n_rejected == right.n_rejected


def test_a_wrong_position_is_named_and_costs_no_rays(block, analysis):
    pos = block.orientations
    position = pos.position_m.copy()
    position[12, 0] += 5.0
    bundle, errors = adjusted(replace(block, orientations=replace(pos, position_m=position)))
    assert errors.notices[-1].code == "contradicted_positions"
    assert pos.image[12] in errors.notices[-1].values["ids"]
    assert bundle.n_rejected <= analysis.bundle.n_rejected + 1


def test_an_image_without_rays_is_listed_and_has_no_error(block):
    ties = block.tie_points
    apart = replace(block, tie_points=ties.subset(ties.image != 3))
    _, errors = adjusted(apart)
    assert not errors.used[3]
    assert np.isnan(errors.error_rad[3]).all()
    assert np.isnan(errors.covariance_rad2[3]).all()
    others = np.arange(len(errors)) != 3
    assert errors.used[others].all()
    assert np.isfinite(errors.covariance_rad2[others][:, :, others]).all()
    assert block.orientations.image[3] in errors.notices[0].values["ids"]


def test_blocks_that_are_too_large_are_refused():
    truth = true_block(Layout(n_strips=1, n_images=MAX_IMAGES + 1, n_points=4))
    with pytest.raises(GeometryError, match=r"at most 3000; .* 3001"):
        adjust_imu_free(truth)


def test_the_report_tells_of_the_bundle_and_of_its_check_points(analysis):
    found = results(analysis)
    page = html.render(block_document.build(found))
    words = OF["en", "block"]
    for said in (
        words.text("angle_errors_by.bundle"),
        'id="table-bundle"',
        words.text("bundle.no_control"),
        "bundle block adjustment",
    ):
        assert said in page
    assert found.bundle.n_control_points == 0
    assert found.settings.errors == "bundle"


def test_the_report_without_a_bundle_has_no_such_section(block):
    found = results(analyse(block, Settings(errors="adjusted")))
    assert found.bundle is None
    assert 'id="table-bundle"' not in html.render(block_document.build(found))


def test_the_command_takes_the_errors_from_the_bundle(block, tmp_path):
    write_block(block, tmp_path / "block")
    command = ["analyse", str(tmp_path / "block"), "--out", str(tmp_path / "out")]
    run = CliRunner().invoke(cli, [*command, "--errors", "bundle", "--no-pdf"])
    assert run.exit_code == 0, run.output
    written = json.loads((tmp_path / "out" / "results.json").read_text(encoding="utf-8"))
    assert written["bundle"]["dof"] > 0
    assert "Bundle adjustment" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")


def test_the_injected_drift_of_the_real_block_is_found():
    folder = shared_path("data", "ign-fd1305")
    found = analyse(read_block(folder), Settings(errors="bundle"))
    injected = json.loads((folder / "injected.json").read_text(encoding="utf-8"))
    row = next(
        each for each in as_values(results(found))["regression"]
        if (each["angle"], each["scope"]) == ("omega", "block")
    )  # fmt: skip
    assert abs(row["gls_slope_rad_per_s"] - injected["slope_rad_per_s"][0]) < 3e-8
