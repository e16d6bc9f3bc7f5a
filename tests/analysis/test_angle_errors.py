"""Angle errors: simulated truth, Monte Carlo, invariances, numerical derivatives, real blocks."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest
from helpers import shared_path
from small_blocks import Layout, observed_block, true_block

from posstats.analysis.angle_errors import adjusted_errors, coplanarity_errors, in_camera_frame
from posstats.analysis.regression import fit_drift
from posstats.block.image_pairs import stereo_models
from posstats.block.model import Block, GroundPoints
from posstats.contract.notice import listing
from posstats.errors import GeometryError
from posstats.formats.block_folder import read_block, write_block
from posstats.geometry.coplanarity.point_pairs import SHORTEST_BASE
from posstats.numerics.kernels.rotation import (
    angles_from_rotation,
    rotation_from_angles,
    vector_from_rotation,
    wrapped,
)

SIDE_OVERLAP = Layout()


def errors_of(block: Block, **options):
    return coplanarity_errors(block, stereo_models(block), **options)


def some_errors(block: Block, seed: int = 2) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return 1e-3 * rng.standard_normal((len(block.orientations), 3)) + [0.01, 0.002, -0.003]


@pytest.mark.parametrize("system", ["omega-phi-kappa", "phi-omega-kappa"])
@pytest.mark.parametrize("robust", [True, False])
def test_perfect_data_give_back_the_errors_up_to_the_pull_of_the_weak_prior(system, robust):
    truth = true_block(replace(SIDE_OVERLAP, system=system))
    loose = replace(truth.orientations, sigma_angles_rad=np.full((len(truth.orientations), 3), 1e3))
    truth = replace(truth, orientations=loose)
    error = some_errors(truth)
    found = errors_of(observed_block(truth, np.random.default_rng(0), error, noise=0.0),
                      robust=robust)  # fmt: skip
    np.testing.assert_allclose(found.error_rad, error, atol=1e-9)
    assert found.used.all()


def test_estimates_scatter_as_their_covariance_says():
    """Monte Carlo: mean of e'C^-1 e / u is 1 within four standard errors, coverage 95 %."""
    truth = true_block(SIDE_OVERLAP)
    rng = np.random.default_rng(11)
    distances, inside = [], []
    for _ in range(150):
        error = some_errors(truth)
        found = errors_of(observed_block(truth, rng, error), robust=False)
        miss = found.error_rad - error
        covariance = found.covariance_rad2.reshape(miss.size, miss.size)
        distances.append(miss.ravel() @ np.linalg.solve(covariance, miss.ravel()) / miss.size)
        inside.append(np.abs(miss) < 1.96 * found.sigma_rad)
    scatter = np.std(distances) / np.sqrt(len(distances))
    assert abs(np.mean(distances) - 1.0) < 4.0 * scatter
    assert 0.92 < np.mean(inside) < 0.97


def test_sigma0_is_the_noise_of_the_image_coordinates():
    truth = true_block(SIDE_OVERLAP)
    rng = np.random.default_rng(3)
    found = [errors_of(observed_block(truth, rng)).sigma0 for _ in range(40)]
    spread = np.std(found) / np.sqrt(len(found))
    assert abs(np.mean(found) - SIDE_OVERLAP.sigma_image_px) < 4.0 * spread


def test_blunders_are_taken_out():
    """Eight per cent of the rays off by 5-50 px change no angle by more than 4 of its sigmas."""
    truth = true_block(SIDE_OVERLAP)
    rng = np.random.default_rng(4)
    error = some_errors(truth)
    block = observed_block(truth, rng, error)
    ties = block.tie_points
    bad = rng.random(len(ties)) < 0.08
    offset = rng.uniform(5.0, 50.0, (len(ties), 2)) * rng.choice([-1.0, 1.0], (len(ties), 2))
    spoiled = replace(block, tie_points=replace(ties, xy_px=ties.xy_px + bad[:, None] * offset))
    robust, plain = errors_of(spoiled), errors_of(spoiled, robust=False)
    assert np.abs((robust.error_rad - error) / robust.sigma_rad).max() < 4.0
    assert robust.sigma0 == pytest.approx(SIDE_OVERLAP.sigma_image_px, rel=0.1)
    assert plain.sigma0 > 5.0 * SIDE_OVERLAP.sigma_image_px


def test_check_points_take_no_part():
    truth = true_block(SIDE_OVERLAP)
    block = observed_block(truth, np.random.default_rng(5))
    ties = block.tie_points
    checks = ties.point_id[:40]
    ground = GroundPoints(
        checks, np.zeros((40, 3)), np.ones(40, dtype=bool), np.full(40, np.nan), np.full(40, np.nan)
    )
    is_check = np.isin(ties.point_id[ties.point], checks)
    moved = replace(ties, xy_px=ties.xy_px + 30.0 * is_check[:, None])
    with_checks = errors_of(replace(block, ground_points=ground, tie_points=moved))
    without = errors_of(replace(block, tie_points=ties.subset(~is_check)))
    np.testing.assert_allclose(with_checks.error_rad, without.error_rad, atol=1e-14)
    assert np.abs(with_checks.error_rad - errors_of(block).error_rad).max() > 1e-7


def test_turning_the_ground_frame_about_the_vertical_keeps_camera_frame_errors():
    block = observed_block(true_block(SIDE_OVERLAP), np.random.default_rng(6), 0.005)
    pos = block.orientations
    cosine, sine = np.cos(0.7), np.sin(0.7)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    turned = replace(
        block,
        orientations=replace(
            pos,
            position_m=pos.position_m @ turn.T,
            angles_rad=angles_from_rotation(turn @ pos.ground_from_image, pos.system),
        ),
    )
    before = in_camera_frame(errors_of(block), pos)
    after = in_camera_frame(errors_of(turned), turned.orientations)
    # The weak prior weighs angles, which mix: allow it a hundredth of a standard deviation.
    assert np.abs((after.error_rad - before.error_rad) / before.sigma_rad).max() < 1e-2
    np.testing.assert_allclose(after.sigma_rad, before.sigma_rad, rtol=1e-3)


def test_order_of_tie_points_ids_does_not_matter():
    block = observed_block(true_block(SIDE_OVERLAP), np.random.default_rng(7))
    ties = block.tie_points
    backwards = len(ties.point_id) - 1 - ties.point
    order = np.lexsort((ties.image, backwards))
    renumbered = replace(
        ties,
        point_id=ties.point_id[::-1],
        point=backwards[order],
        image=ties.image[order],
        xy_px=ties.xy_px[order],
    )
    found = errors_of(replace(block, tie_points=renumbered))
    np.testing.assert_allclose(found.error_rad, errors_of(block).error_rad, atol=1e-11)


def test_names_of_images_and_order_of_rows_do_not_matter(tmp_path):
    """The block written, its images renamed against the order of flight, its rows shuffled."""
    block = observed_block(true_block(SIDE_OVERLAP), np.random.default_rng(7))
    write_block(block, tmp_path)
    before = errors_of(read_block(tmp_path))
    shuffled = np.random.default_rng(1)
    for name in ("orientations.csv", "tie_points.csv"):
        head, *rows = (tmp_path / name).read_text().splitlines()
        renamed = [re.sub(r"\bi00(\d)\b", lambda m: f"x{9 - int(m[1])}", row) for row in rows]
        shuffled.shuffle(renamed)
        (tmp_path / name).write_text("\n".join([head, *renamed]) + "\n")
    after = errors_of(read_block(tmp_path))
    assert list(after.image) == [f"x{9 - k}" for k in range(10)]
    np.testing.assert_allclose(after.error_rad, before.error_rad, rtol=0.0, atol=1e-11)
    np.testing.assert_allclose(after.covariance_rad2, before.covariance_rad2, rtol=1e-6, atol=1e-18)


def test_the_order_in_which_the_strips_were_flown_does_not_matter():
    """Parallax is then measured in the other image of every pair across: equal within noise."""
    block = observed_block(true_block(SIDE_OVERLAP), np.random.default_rng(7))
    pos, ties = block.orientations, block.tie_points
    order = np.concatenate([np.arange(5, 10), np.arange(5)])  # its own inverse
    columns = ("image", "strip", "position_m", "angles_rad", "sigma_position_m", "sigma_angles_rad")
    swapped = replace(pos, **{name: getattr(pos, name)[order] for name in columns})
    image = order[ties.image]
    rows = np.lexsort((image, ties.point))
    moved = replace(ties, point=ties.point[rows], image=image[rows], xy_px=ties.xy_px[rows])
    before = errors_of(block, robust=False)
    after = errors_of(replace(block, orientations=swapped, tie_points=moved), robust=False)
    miss = (after.error_rad[order] - before.error_rad) / before.sigma_rad
    assert np.abs(miss).max() < 0.05
    np.testing.assert_allclose(after.sigma_rad[order], before.sigma_rad, rtol=0.01)


def test_robust_and_plain_agree_on_data_without_blunders():
    """Rejecting beyond 3.5 sigma costs nothing: a small part of a standard deviation."""
    truth = true_block(SIDE_OVERLAP)
    rng = np.random.default_rng(14)
    for _ in range(3):
        block = observed_block(truth, rng, some_errors(truth))
        robust, plain = errors_of(block), errors_of(block, robust=False)
        assert np.abs((robust.error_rad - plain.error_rad) / plain.sigma_rad).max() < 0.5
        np.testing.assert_allclose(robust.sigma_rad, plain.sigma_rad, rtol=0.03)


def test_covariance_is_symmetric_to_the_last_bit_in_both_frames():
    block = observed_block(true_block(SIDE_OVERLAP), np.random.default_rng(8))
    ground = errors_of(block)
    for errors in (ground, in_camera_frame(ground, block.orientations)):
        covariance = errors.covariance_rad2
        np.testing.assert_array_equal(covariance, covariance.transpose(2, 3, 0, 1))


def test_camera_frame_covariance_is_that_of_the_exact_derivative():
    """Oracle: central differences of log(R_est' R_pos) at errors of up to 20 degrees."""
    truth = true_block(replace(SIDE_OVERLAP, tilt_rad=0.3, system="phi-omega-kappa"))
    errors = errors_of(observed_block(true_block(SIDE_OVERLAP), np.random.default_rng(8)))
    pos = truth.orientations
    rng = np.random.default_rng(9)
    errors = replace(errors, error_rad=0.2 * rng.standard_normal((10, 3)))
    camera = in_camera_frame(errors, pos)

    def rotation_vectors(error_rad):
        estimated = rotation_from_angles(pos.angles_rad - error_rad, pos.system)
        return vector_from_rotation(np.swapaxes(estimated, -1, -2) @ pos.ground_from_image)

    np.testing.assert_allclose(camera.error_rad, rotation_vectors(errors.error_rad), atol=1e-15)
    step = 1e-5
    columns = [
        (rotation_vectors(errors.error_rad + s) - rotation_vectors(errors.error_rad - s)) / 2 / step
        for s in step * np.eye(3)
    ]
    turn = np.stack(columns, axis=-1)
    expected = np.einsum("iab,ibjc,jdc->iajd", turn, errors.covariance_rad2, turn)
    size = np.abs(expected).max()
    np.testing.assert_allclose(camera.covariance_rad2, expected, atol=1e-8 * size)


def test_roll_of_a_perfectly_straight_strip_is_reported_undetermined():
    truth = true_block(Layout(n_strips=1, jitter_m=0.0, n_points=200))
    found = errors_of(observed_block(truth, np.random.default_rng(10)))
    block, strip = found.observability
    assert block.rotations == strip.rotations == ("about_base_axis",)
    assert strip.images == tuple(truth.orientations.image)
    assert not found.used.any()
    assert found.notices[0].code == "angles_loose"


def test_roll_that_a_crooked_strip_barely_determines_is_open_as_that_of_its_images():
    """Position jitter bends the axis, so that the images' rotations are not exactly alike."""
    truth = true_block(Layout(n_strips=1, jitter_m=10.0, n_images=12, n_points=600))
    found = errors_of(observed_block(truth, np.random.default_rng(0)))
    limit = np.radians(0.1)
    assert np.all((limit < found.sigma_rad[:, 1]) & (found.sigma_rad[:, 1] < 1.3 * limit))
    assert found.observability[0].rotations == ("about_base_axis",)


def test_the_base_axis_of_a_wide_block_is_that_of_its_strips():
    """Strips 5 km apart and 1.2 km long, heading north-east, without common points."""
    truth = true_block(Layout(strip_distance_m=5000.0, n_points=1500, heading_rad=0.8))
    found = errors_of(observed_block(truth, np.random.default_rng(0)))
    assert [each.rotations for each in found.observability] == [("about_base_axis",)] * 3


def test_pairs_with_too_short_a_base_are_left_out_and_counted():
    """Two strips flown over the same places within centimetres: five bases of no direction."""
    truth = true_block(Layout(strip_distance_m=0.0, jitter_m=0.02))
    found = errors_of(observed_block(truth, np.random.default_rng(0)))
    assert found.notices[0].values == {"n": 5, "n_pairs": 33, "n_sigmas": SHORTEST_BASE}
    assert np.isfinite(found.error_rad).all()


def test_side_overlap_determines_everything():
    found = errors_of(observed_block(true_block(SIDE_OVERLAP), np.random.default_rng(10)))
    assert all(not each.rotations and not each.images for each in found.observability)
    assert [each.scope for each in found.observability] == ["block", "s0", "s1"]
    assert found.notices == ()


def test_an_image_without_tie_points_is_missing_not_zero():
    block = observed_block(true_block(SIDE_OVERLAP), np.random.default_rng(12))
    ties = block.tie_points
    alone = replace(block, tie_points=ties.subset(ties.image != 9))
    found = errors_of(alone)
    assert np.isnan(found.error_rad[9]).all()
    assert np.isnan(found.sigma_rad[9]).all()
    assert not found.used[9]
    assert np.isfinite(found.error_rad[:9]).all()
    assert found.notices == listing("images_untied", ["i009"])
    assert np.isnan(in_camera_frame(found, alone.orientations).error_rad[9]).all()


def test_no_common_points_is_a_clear_error():
    block = true_block(SIDE_OVERLAP)
    empty = replace(block, tie_points=block.tie_points.subset(block.tie_points.image == 0))
    with pytest.raises(GeometryError, match="common tie points"):
        errors_of(empty)


def test_adjusted_errors_are_wrapped_differences_and_missing_ones_are_named():
    block = true_block(SIDE_OVERLAP)
    angles = block.orientations.angles_rad.copy()
    angles[3] = np.nan
    angles[4, 2] += 2.0 * np.pi - 1e-3
    found = adjusted_errors(replace(block, adjusted=replace(block.orientations, angles_rad=angles)))
    assert found.error_rad[4, 2] == pytest.approx(1e-3)
    assert np.isnan(found.error_rad[3]).all()
    assert not found.used[3]
    assert found.notices == listing("no_adjusted_orientation", ["i003"])
    assert np.isnan(found.sigma_rad).all()
    with pytest.raises(GeometryError, match=r"adjusted\.csv"):
        adjusted_errors(block)


def test_seneca_converges_from_errors_of_tens_of_degrees():
    """Real drone POS: estimates agree with COLMAP's orientation within their uncertainty."""
    block = read_block(shared_path("data", "seneca"))
    found = errors_of(block)
    miss = wrapped(found.error_rad - adjusted_errors(block).error_rad)[found.used]
    assert found.used.all()
    assert np.sqrt(np.mean((miss / found.sigma_rad[found.used]) ** 2)) < 1.2
    assert np.abs(np.degrees(found.error_rad)).max() > 20.0


def test_one_badly_tied_image_is_listed_without_calling_its_strip_unobservable():
    block = observed_block(true_block(SIDE_OVERLAP), np.random.default_rng(13))
    ties = block.tie_points
    last = np.flatnonzero(ties.image == 9)
    keep = ties.image != 9
    keep[last[:3]] = True
    found = errors_of(replace(block, tie_points=ties.subset(keep)))
    scope, _, strip = found.observability
    assert scope.images == strip.images == ("i009",)
    assert found.notices == listing("angles_of_few_points", ["i009"], n_needed=6)
    assert scope.rotations == strip.rotations == ()
    assert found.used[:9].all()
    assert np.isfinite(found.error_rad[9]).all()


def test_injected_drift_of_a_real_block_is_found():
    """IGN block: the omega slope by GLS within 3e-8 rad/s of the one put in."""
    folder = shared_path("data", "ign-fd1305")
    injected = json.loads((folder / "injected.json").read_text())
    found = errors_of(read_block(folder))
    used = np.flatnonzero(found.used)
    covariance = found.covariance_rad2[used, 0][:, used, 0]
    fit = fit_drift(found.time_s[used], found.error_rad[used, 0], covariance)
    assert fit.slope == pytest.approx(injected["slope_rad_per_s"][0], abs=3e-8)
    assert len(used) == 60
