"""Simulated blocks are what their scenario says.

Oracle: the scenario itself (closed forms: overlaps, times, error models), coplanarity of the true
rays, sampling bounds of the noise, invariances, and the numbers measured for the paper's areas.
"""

from dataclasses import fields, replace

import numpy as np
import pytest
from minimal_scenario import changed

from posstats.block.image_pairs import cross_strip_pairs, stereo_models
from posstats.errors import GeometryError
from posstats.formats.block_folder import read_block, write_block
from posstats.numerics.kernels.rotation import rotation_from_angles, vector_from_rotation, wrapped
from posstats.synthetic import simulate
from posstats.synthetic.scenario import AngleError, load_scenario

SYSTEMS = ("omega-phi-kappa", "phi-omega-kappa")
LAMBERT_93 = {"crs": "EPSG:2154", "origin_m": [760_000.0, 6_300_000.0]}
UTM_33 = {"crs": "EPSG:32633", "origin_m": [640_000.0, 5_300_000.0]}


def scenario_with(**tables):
    """Two strips of five images, perfect but for what `tables` say."""
    flight = {"images_per_strip": 5} | tables.pop("flight", {})
    return load_scenario(changed(flight=flight, **tables))


def true_models(block):
    return stereo_models(block).with_orientations(block.adjusted)


def model_rms_mm(models):
    q2 = models.y_parallax_px() ** 2
    offsets = models.pairs.offsets
    mean = np.add.reduceat(q2, offsets[:-1]) / np.diff(offsets)
    return np.sqrt(mean) * models.pixel_size_mm


def angle_errors(block):
    return wrapped(block.orientations.angles_rad - block.adjusted.angles_rad)


def assert_equal_blocks(one, other):
    for name in ("orientations", "adjusted", "tie_points", "ground_points"):
        a, b = getattr(one, name), getattr(other, name)
        for field in fields(a):
            np.testing.assert_array_equal(getattr(a, field.name), getattr(b, field.name))


@pytest.fixture(scope="module")
def area1():
    return simulate(load_scenario("area1"))


# --- truth --------------------------------------------------------------------------------------


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("frame", [{}, LAMBERT_93, UTM_33, LAMBERT_93 | {"frame": "grid"}])
@pytest.mark.parametrize(
    "distortion",
    [
        {"model": "none"},
        {"model": "radial", "k1": -0.05, "k2": 0.01},
        {"model": "brown", "k1": 0.05, "k2": -0.02, "k3": 0.004, "p1": 1e-3, "p2": -5e-4},
    ],
)
def test_perfect_blocks_have_no_parallax(system, frame, distortion):
    block = simulate(
        scenario_with(
            block={"angles": system} | frame,
            camera={"distortion": distortion},
            flight={"headings_deg": [37, 217], "position_jitter_m": 20},
            terrain={"relief_m": 100, "wavelength_m": 900},
        )
    )
    q = stereo_models(block).y_parallax_px()
    assert len(q) > 700
    assert np.abs(q).max() < 1e-9
    np.testing.assert_allclose(angle_errors(block), 0.0, atol=1e-15)
    np.testing.assert_array_equal(block.orientations.position_m, block.adjusted.position_m)
    assert block.simulated


@pytest.mark.parametrize("frame", [LAMBERT_93, UTM_33])
def test_a_block_with_crs_is_computed_in_a_tangent_frame_and_maps_back(frame):
    block = simulate(scenario_with(block=frame, terrain={"mean_height_m": 300}))
    assert block.frame.is_tangent
    position = block.frame.to_crs(block.adjusted.position_m)
    np.testing.assert_allclose(position[:, :2].mean(axis=0), frame["origin_m"], atol=1e-4)
    np.testing.assert_allclose(position[:, 2], 1800.0, atol=1e-4)


def test_vertical_images_of_a_block_with_crs_look_down_the_local_vertical_and_up_the_grid():
    # Far off the central meridian and over 30 km: small steps in the crs, mapped, are the axes.
    block = simulate(
        scenario_with(
            block=UTM_33,
            flight={"tilt_rad": 0, "headings_deg": 0, "images_per_strip": 100},
            tie_points={"per_model": 10},
        )
    )
    position = block.frame.to_crs(block.adjusted.position_m)
    for axis, column in ((1, 1), (2, 2)):  # image y: grid north; image z: the vertical
        step = np.zeros(3)
        step[axis] = 50.0
        moved = block.frame.to_computing(position + step) - block.frame.to_computing(
            position - step
        )
        direction = moved / np.linalg.norm(moved, axis=1, keepdims=True)
        np.testing.assert_allclose(
            block.adjusted.ground_from_image[:, :, column], direction, atol=2e-5
        )
    # The vertical at the ends of the strips does lean, by 16 km over the earth's radius.
    assert np.abs(block.adjusted.ground_from_image[:, 1, 2]).max() > 2e-3


@pytest.mark.parametrize("frame", [{}, LAMBERT_93, UTM_33 | {"frame": "grid"}])
def test_a_simulated_block_is_read_back_as_it_was_written(frame, tmp_path):
    errors = {"image_px": 0.2, "omega": {"noise_rad": 1e-5}, "position": {"noise_m": 0.05}}
    distortion = {"distortion": {"model": "brown", "k1": 0.05, "p1": 1e-3}}
    spec = {"n": 4, "ground_m": 0.1}
    block = simulate(
        scenario_with(block=frame, errors=errors, camera=distortion, check_points=spec)
    )
    write_block(block, tmp_path)
    read = read_block(tmp_path)
    assert read.simulated
    assert read.warnings == ()
    assert list(read.orientations.image) == list(block.orientations.image)
    assert list(read.tie_points.point_id) == list(block.tie_points.point_id)
    np.testing.assert_allclose(read.tie_points.xy_px, block.tie_points.xy_px, atol=1e-7)
    np.testing.assert_allclose(angle_errors(read), angle_errors(block), atol=1e-12)
    q, truth = true_models(read).y_parallax_px(), true_models(block).y_parallax_px()
    np.testing.assert_allclose(q, truth, atol=1e-6)


def test_a_block_on_the_grid_keeps_its_coordinates():
    block = simulate(scenario_with(block=UTM_33 | {"frame": "grid"}))
    assert not block.frame.is_tangent
    assert block.frame.crs == "EPSG:32633"
    np.testing.assert_allclose(block.adjusted.position_m[:, :2].mean(axis=0), UTM_33["origin_m"])


def test_measurements_lie_in_the_image_and_are_sorted():
    block = simulate(
        scenario_with(
            errors={"blunder_share": 0.2, "blunder_px": 200},
            camera={
                "distortion": {"model": "radial", "k1": -0.1},
                "principal_point_px": [520, 390],
            },
        )
    )
    ties, camera = block.tie_points, block.cameras[0]
    measured = camera.measured_from_ideal(ties.xy_px)
    assert (measured >= -1e-9).all()
    assert (measured <= np.array([1000, 800]) + 1e-9).all()
    np.testing.assert_array_equal(np.lexsort((ties.image, ties.point)), np.arange(len(ties)))
    assert list(ties.point_id) == sorted(ties.point_id)
    assert np.bincount(ties.point).min() >= 2


def test_strong_barrel_distortion_does_not_fold_far_points_into_the_image():
    # r' = r - 0.45 r^3 turns back at r = 0.86: points beyond r = 1.2 would fold into the corners,
    # which are at r' = 0.427, r = 0.475. The deep terrain makes such points candidates.
    block = simulate(
        scenario_with(
            camera={"distortion": {"model": "radial", "k1": -0.45}},
            terrain={"relief_m": 200, "wavelength_m": 3000},
            flight={"tilt_rad": 0},
        )
    )
    camera = block.cameras[0]
    corner = np.hypot(*camera.ideal_from_measured([0.0, 0.0]))
    assert np.hypot(*block.tie_points.xy_px.T).max() <= corner
    xy = block.tie_points.xy_px
    np.testing.assert_allclose(
        camera.ideal_from_measured(camera.measured_from_ideal(xy)), xy, atol=1e-8
    )


def test_every_point_inside_an_image_is_measured_there():
    # Brute force over all points and images, with the true rays.
    block = simulate(
        scenario_with(terrain={"relief_m": 80, "wavelength_m": 700}, flight={"tilt_rad": 0.05})
    )
    truth, ties, camera = block.adjusted, block.tie_points, block.cameras[0]
    ground = intersected(block)
    seen = np.zeros((len(ground), len(truth)), dtype=bool)
    seen[ties.point, ties.image] = True
    vector = np.einsum(
        "nij,pni->pnj", truth.ground_from_image, ground[:, None] - truth.position_m[None]
    )
    xy = -camera.principal_distance_px * vector[..., :2] / vector[..., 2:]
    half = np.array([500.0, 400.0])
    np.testing.assert_array_equal(seen, (np.abs(xy) <= half).all(axis=-1))


def intersected(block):
    """Ground points (p, 3): two-ray closest point of the first two rays, from the truth."""
    ties, truth = block.tie_points, block.adjusted
    first = np.searchsorted(ties.point, np.arange(len(ties.point_id)))
    distance = np.full(len(ties), -block.cameras[0].principal_distance_px)
    vectors = np.column_stack([ties.xy_px, distance])
    direction = np.einsum("mij,mj->mi", truth.ground_from_image[ties.image], vectors)
    a, b = direction[first], direction[first + 1]
    base = truth.position_m[ties.image[first + 1]] - truth.position_m[ties.image[first]]
    normal = np.cross(a, b)
    along = np.einsum("pi,pi->p", np.cross(base, b), normal) / (normal**2).sum(axis=1)
    return truth.position_m[ties.image[first]] + along[:, None] * a


# --- flight -------------------------------------------------------------------------------------


def test_overlaps_follow_from_the_footprints():
    scenario = scenario_with(flight={"tilt_rad": 0, "n_strips": 3, "headings_deg": [0, 180]})
    position = simulate(scenario).adjusted.position_m.reshape(3, 5, 3)
    along, across = 800.0, 1000.0  # px = m at 1500 m and 1500 px
    steps = np.diff(position, axis=1)
    np.testing.assert_allclose(1 - np.abs(steps[..., 1]) / along, 0.6, atol=1e-12)
    np.testing.assert_allclose(steps[..., [0, 2]], 0.0, atol=1e-9)
    np.testing.assert_array_equal(np.sign(steps[:, 0, 1]), [1, -1, 1])
    np.testing.assert_allclose(1 - np.diff(position[:, 0, 0]) / across, 0.3, atol=1e-12)


def test_times_follow_from_speed_and_turns():
    flight = {"speed_m_per_s": 40, "turn_s": 250, "start_time_s": 1e9, "images_per_strip": [3, 2]}
    block = simulate(scenario_with(flight=flight))
    np.testing.assert_allclose(block.orientations.time_s - 1e9, [0, 8, 16, 266, 274], atol=1e-6)
    assert list(block.orientations.strip) == ["1", "1", "1", "2", "2"]
    assert list(block.orientations.image) == ["1-1", "1-2", "1-3", "2-1", "2-2"]


@pytest.mark.parametrize("heading", [0.0, 30.0, 90.0, 200.0, -45.0])
def test_the_image_top_points_along_the_flight(heading):
    block = simulate(scenario_with(flight={"headings_deg": heading, "tilt_rad": 0}))
    forward = np.array([np.sin(np.radians(heading)), np.cos(np.radians(heading)), 0.0])
    up = block.adjusted.ground_from_image[:, :, 1]
    np.testing.assert_allclose(up, np.broadcast_to(forward, up.shape), atol=1e-14)
    step = np.diff(block.adjusted.position_m[:5], axis=0)
    np.testing.assert_allclose(step, np.broadcast_to(320.0 * forward, step.shape), atol=1e-9)


def test_cross_strips_cross_in_the_middle():
    flight = {"n_strips": 3, "headings_deg": [0, 180, 90], "tilt_rad": 0}
    position = simulate(scenario_with(flight=flight)).adjusted.position_m.reshape(3, 5, 3)
    np.testing.assert_allclose(position[:2].mean(axis=(0, 1))[:2], 0.0, atol=1e-9)
    np.testing.assert_allclose(position[2, :, 1], 0.0, atol=1e-9)
    np.testing.assert_allclose(np.diff(position[2, :, 0]), 320.0, atol=1e-9)


def test_a_gap_between_strips_leaves_them_alone():
    assert len(cross_strip_pairs(simulate(scenario_with(flight={"side_overlap": -0.2})))) == 0
    assert len(cross_strip_pairs(simulate(scenario_with(flight={"side_overlap": 0.3})))) > 4


def test_tilts_and_jitter_have_their_standard_deviation():
    flight = {"images_per_strip": 200, "tilt_rad": 0.02, "position_jitter_m": 8}
    sparse = {"tie_points": {"per_model": 8}}
    block = simulate(scenario_with(flight=flight | {"headings_deg": 0}, **sparse))
    still = simulate(
        scenario_with(flight=flight | {"headings_deg": 0, "position_jitter_m": 0}, **sparse)
    )
    # 1,200 draws: the SD is known to 2 %; five of its standard errors are 10 %.
    assert np.std(block.adjusted.angles_rad) == pytest.approx(0.02, rel=0.1)
    assert np.std(block.adjusted.position_m - still.adjusted.position_m) == pytest.approx(
        8, rel=0.1
    )


# --- POS errors ---------------------------------------------------------------------------------


@pytest.mark.parametrize("system", SYSTEMS)
def test_ground_errors_are_constant_plus_drift_from_the_first_exposure(system):
    errors = {
        "omega": {"constant_rad": 0.018, "drift_rad_per_s": 4.68e-7},
        "phi": {"constant_rad": -0.002},
        "kappa": {"drift_rad_per_s": -1e-6},
    }
    scenario = scenario_with(
        block={"angles": system}, flight={"start_time_s": 3.5e5}, errors=errors
    )
    block = simulate(scenario)
    since = block.orientations.time_s - 3.5e5
    stated = np.column_stack([0.018 + 4.68e-7 * since, np.full_like(since, -0.002), -1e-6 * since])
    np.testing.assert_allclose(angle_errors(block), stated, atol=2e-15)
    assert np.abs(true_models(block).y_parallax_px()).max() < 1e-9


@pytest.mark.parametrize("system", SYSTEMS)
def test_a_boresight_is_constant_in_the_camera_and_flips_in_the_ground_frame(system):
    boresight = np.array([0.018, -0.004, 0.002])
    errors = {
        name: {"constant_rad": value}
        for name, value in zip(("pitch", "roll", "yaw"), boresight, strict=True)
    }
    flight = {"headings_deg": [0, 180], "tilt_rad": 0}
    block = simulate(scenario_with(block={"angles": system}, flight=flight, errors=errors))
    turn = (
        np.swapaxes(block.adjusted.ground_from_image, -1, -2) @ block.orientations.ground_from_image
    )
    np.testing.assert_allclose(
        vector_from_rotation(turn), np.broadcast_to(boresight, (10, 3)), atol=1e-14
    )
    forth, back = angle_errors(block)[:5], angle_errors(block)[5:]
    np.testing.assert_allclose(back[:, :2], -forth[:, :2], atol=1e-4)
    assert forth[0, 0] == pytest.approx(0.018, abs=1e-4)


def test_camera_errors_turn_the_erroneous_angles():
    errors = {"omega": {"constant_rad": 0.01}, "yaw": {"constant_rad": 0.02}}
    block = simulate(scenario_with(errors=errors))
    angles = block.adjusted.angles_rad + np.array([0.01, 0.0, 0.0])
    expected = rotation_from_angles(angles, "omega-phi-kappa") @ rotation_from_angles(
        [0.0, 0.0, 0.02], "omega-phi-kappa"
    )
    np.testing.assert_allclose(block.orientations.ground_from_image, expected, atol=1e-14)


def test_noise_has_its_standard_deviation():
    angle = {"noise_rad": 1e-5}
    errors = {
        "image_px": 0.3,
        "position": {"noise_m": 0.05},
        "omega": angle,
        "phi": {"noise_rad": 2e-5},
        "kappa": {"noise_rad": 5e-5},
    }
    flight = {"images_per_strip": 200}
    noisy = simulate(scenario_with(errors=errors, flight=flight, tie_points={"per_model": 20}))
    perfect = simulate(scenario_with(flight=flight, tie_points={"per_model": 20}))
    # 400 draws an angle: SD known to 3.5 %, bounds of four standard errors.
    np.testing.assert_allclose(angle_errors(noisy).std(axis=0), [1e-5, 2e-5, 5e-5], rtol=0.14)
    assert (np.abs(angle_errors(noisy).mean(axis=0)) < 4 * np.array([1, 2, 5]) * 5e-7).all()
    position = noisy.orientations.position_m - noisy.adjusted.position_m
    assert position.std() == pytest.approx(0.05, rel=0.1)
    image = noisy.tie_points.xy_px - perfect.tie_points.xy_px
    assert image.std() == pytest.approx(0.3, rel=4 / np.sqrt(2 * image.size))


def test_strip_constants_and_gnss_shifts_stay_through_a_strip():
    errors = {
        "omega": {"strip_rad": 1e-3},
        "position": {"strip_shift_m": 0.2, "strip_drift_m_per_s": 0.01},
    }
    block = simulate(scenario_with(errors=errors, flight={"n_strips": 60, "images_per_strip": 3}))
    omega = angle_errors(block)[:, 0].reshape(60, 3)
    np.testing.assert_allclose(omega, np.repeat(omega[:, :1], 3, axis=1), atol=2e-15)
    assert omega[:, 0].std() == pytest.approx(1e-3, rel=4 / np.sqrt(120))
    position = (block.orientations.position_m - block.adjusted.position_m).reshape(60, 3, 3)
    time = block.orientations.time_s.reshape(60, 3)
    rate = (position[:, 1] - position[:, 0]) / (time[:, 1] - time[:, 0])[:, None]
    np.testing.assert_allclose(
        position[:, 2] - position[:, 0], rate * (time[:, 2] - time[:, 0])[:, None], atol=1e-8
    )
    assert position[:, 0].std() == pytest.approx(0.2, rel=4 / np.sqrt(360))
    assert rate.std() == pytest.approx(0.01, rel=4 / np.sqrt(360))


def test_angle_drifts_start_anew_with_every_strip():
    errors = {"phi": {"strip_drift_rad_per_s": 1e-5}}
    block = simulate(scenario_with(errors=errors, flight={"n_strips": 60, "images_per_strip": 3}))
    phi = angle_errors(block)[:, 1].reshape(60, 3)
    time = block.orientations.time_s.reshape(60, 3)
    np.testing.assert_allclose(phi[:, 0], 0.0, atol=2e-15)
    rate = phi[:, 1] / (time[:, 1] - time[:, 0])
    np.testing.assert_allclose(phi[:, 2], rate * (time[:, 2] - time[:, 0]), atol=1e-13)
    assert rate.std() == pytest.approx(1e-5, rel=4 / np.sqrt(120))


def test_drifts_of_angles_leave_the_other_errors_as_they_were():
    errors = {"phi": {"strip_rad": 1e-3, "noise_rad": 1e-4}, "position": {"noise_m": 0.1}}
    plain = simulate(scenario_with(errors=errors))
    errors["phi"] = errors["phi"] | {"strip_drift_rad_per_s": 1e-5}
    drifting = simulate(scenario_with(errors=errors))
    first = [0, len(plain.orientations) // 2]
    np.testing.assert_array_equal(
        drifting.orientations.angles_rad[first], plain.orientations.angles_rad[first]
    )
    np.testing.assert_array_equal(drifting.orientations.position_m, plain.orientations.position_m)


def test_the_lever_arm_turns_with_the_image():
    arm = np.array([0.3, -0.2, 1.5])
    block = simulate(scenario_with(errors={"position": {"lever_arm_m": arm.tolist()}}))
    offset = block.orientations.position_m - block.adjusted.position_m
    in_image = np.einsum("nij,ni->nj", block.adjusted.ground_from_image, offset)
    np.testing.assert_allclose(in_image, np.tile(arm, (len(offset), 1)), atol=1e-9)


def test_blunders_have_their_share_and_length_and_spare_the_check_points():
    settings = {"tie_points": {"per_model": 1000}, "check_points": {"n": 9}}
    errors = {"blunder_share": 0.1, "blunder_px": 30}
    block = simulate(scenario_with(errors=errors, **settings))
    perfect = simulate(scenario_with(**settings))
    length = np.hypot(*(block.tie_points.xy_px - perfect.tie_points.xy_px).T)
    blundered = length > 1e-6
    np.testing.assert_allclose(length[blundered], 30.0, atol=1e-9)
    is_check = block.check_points[block.tie_points.point]
    assert not blundered[is_check].any()
    n = (~is_check).sum()
    assert blundered.sum() / n == pytest.approx(0.1, abs=4 * np.sqrt(0.09 / n))


# --- check and control points -------------------------------------------------------------------


@pytest.mark.parametrize("distribution", ["grid", "corners", "side-overlap", "random"])
@pytest.mark.parametrize("n", [1, 2, 4, 7, 15])
def test_surveyed_points_lie_in_the_block_and_are_seen_twice(distribution, n):
    spec = {"n": n, "distribution": distribution}
    block = simulate(scenario_with(check_points=spec, flight={"n_strips": 3}))
    assert len(block.ground_points) == n
    assert block.warnings == ()
    plane = block.ground_points.position_m[:, :2]
    assert len(np.unique(plane.round(3), axis=0)) == n
    limit = block.adjusted.position_m[:, :2]
    assert (plane >= limit.min(axis=0) - 1e-9).all()
    assert (plane <= limit.max(axis=0) + 1e-9).all()


def test_corner_points_are_the_middle_the_corners_and_a_grid():
    def plane(n):
        spec = {"n": n, "distribution": "corners"}
        block = simulate(scenario_with(control_points=spec, flight={"n_strips": 3, "tilt_rad": 0}))
        assert not block.ground_points.is_check.any()
        return {tuple(xy) for xy in block.ground_points.position_m[:, :2].round(6)}

    corners = {(x, y) for x in (-700.0, 700.0) for y in (-640.0, 640.0)}
    assert plane(1) == {(0.0, 0.0)}
    assert plane(4) == corners
    assert plane(9) >= corners | {(0.0, 0.0)}


def test_points_in_the_side_overlaps_lie_midway_between_the_strips():
    def across(n):
        spec = {"n": n, "distribution": "side-overlap"}
        block = simulate(scenario_with(check_points=spec, flight={"n_strips": 5, "tilt_rad": 0}))
        assert np.bincount(block.tie_points.point)[block.check_points].min() >= 4
        return block.ground_points.position_m[:, 0]

    # Strips at x = -1400, -700, 0, 700, 1400.
    np.testing.assert_allclose(across(6), [-1050, -1050, -350, -350, 350, 1050], atol=1e-9)
    np.testing.assert_allclose(across(2), [-350, 1050], atol=1e-9)
    assert np.bincount(np.digitize(across(15), [-700, 0, 700])).tolist() == [4, 4, 4, 3]


def test_a_long_cross_strip_does_not_draw_the_surveyed_points_out_of_the_block():
    flight = {"n_strips": None, "images_per_strip": [5, 5, 15], "headings_deg": [0, 180, 90]}
    spec = {"n": 15, "distribution": "corners"}
    block = simulate(scenario_with(flight=flight, check_points=spec))
    assert np.abs(block.ground_points.position_m[:, 0]).max() == pytest.approx(350.0)
    assert block.warnings == ()


def test_the_terrain_has_the_standard_deviation_of_a_sine_of_its_amplitude():
    terrain = {"relief_m": 60, "wavelength_m": 500, "mean_height_m": 200}
    block = simulate(scenario_with(terrain=terrain, flight={"images_per_strip": 40}))
    height = intersected(block)[:, 2]
    # 24 waves over some ten wavelengths: near, not at, the expectation.
    assert height.std() == pytest.approx(60 / np.sqrt(2), rel=0.15)
    assert height.mean() == pytest.approx(200, abs=10)


def test_surveyed_points_have_their_own_image_and_ground_noise():
    settings = {"flight": {"n_strips": 4}, "tie_points": {"per_model": 20}}
    spec = {"n": 400, "image_px": 1.5, "ground_m": 0.3}
    noisy = simulate(scenario_with(check_points=spec, **settings))
    perfect = simulate(scenario_with(check_points={"n": 400}, **settings))
    survey = noisy.ground_points.position_m - perfect.ground_points.position_m
    assert survey.std() == pytest.approx(0.3, rel=4 / np.sqrt(2400))
    image = noisy.tie_points.xy_px - perfect.tie_points.xy_px
    is_check = noisy.check_points[noisy.tie_points.point]
    assert image[is_check].std() == pytest.approx(1.5, rel=4 / np.sqrt(4 * is_check.sum()))
    np.testing.assert_allclose(image[~is_check], 0.0, atol=1e-9)
    assert (noisy.ground_points.sigma_xy_m == 0.3).all()
    assert np.isnan(perfect.ground_points.sigma_z_m).all()


def test_true_ground_points_are_where_the_true_rays_meet():
    block = simulate(
        scenario_with(block=LAMBERT_93, check_points={"n": 9}, terrain={"relief_m": 50})
    )
    ground = intersected(block)
    rows = {point: row for row, point in enumerate(block.tie_points.point_id)}
    found = ground[[rows[point] for point in block.ground_points.point]]
    np.testing.assert_allclose(found, block.ground_points.position_m, atol=1e-7)


# --- seeds --------------------------------------------------------------------------------------


def test_equal_seeds_give_equal_blocks_and_others_do_not():
    scenario = load_scenario("area1-small")
    assert_equal_blocks(simulate(scenario), simulate(scenario, seed=scenario.block.seed))
    other = simulate(scenario, seed=99)
    assert not np.array_equal(simulate(scenario).adjusted.position_m, other.adjusted.position_m)


def test_each_noise_has_a_stream_of_its_own():
    scenario = load_scenario("area1-small")
    errors = replace(scenario.errors, image_px=1.0, omega=AngleError(noise_rad=1e-3))
    one, other = simulate(scenario), simulate(replace(scenario, errors=errors))
    np.testing.assert_array_equal(one.adjusted.angles_rad, other.adjusted.angles_rad)
    np.testing.assert_array_equal(one.tie_points.image, other.tie_points.image)
    np.testing.assert_array_equal(one.ground_points.position_m, other.ground_points.position_m)
    np.testing.assert_array_equal(one.orientations.position_m, other.orientations.position_m)
    np.testing.assert_array_equal(angle_errors(one)[:, 1:], angle_errors(other)[:, 1:])


# --- what cannot be flown -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"terrain": {"relief_m": 3000, "wavelength_m": 500}}, "terrain rises above the flight"),
        ({"flight": {"tilt_rad": 0.5, "images_per_strip": 50}}, "towards the horizon"),
        ({"tie_points": {"per_model": 1e8}}, "lower .tie_points. per_model"),
        ({"flight": {"n_strips": 1, "images_per_strip": 1}}, "no tie point lies in two images"),
        ({"block": {"crs": "EPSG:0", "origin_m": [1, 1]}}, "does not know the crs"),
        ({"block": {"crs": "EPSG:4326", "origin_m": [5, 43]}}, "is no map grid"),
        ({"block": {"crs": "EPSG:4326", "origin_m": [5, 43], "frame": "grid"}}, "is no map grid"),
        ({"block": UTM_33 | {"origin_m": [5e7, 5e6]}}, "is outside EPSG:32633"),
        (
            {"camera": {"distortion": {"model": "radial", "k1": -5.0}}},
            "distortion cannot be inverted",
        ),
    ],
)
def test_an_impossible_block_is_refused_in_words(tables, message):
    with pytest.raises(GeometryError, match=message):
        simulate(scenario_with(**tables))


def test_short_strips_and_unseen_points_are_noted():
    flight = {"n_strips": None, "images_per_strip": [1, 3], "forward_overlap": 0.3}
    spec = {"n": 60, "distribution": "grid"}
    notes = simulate(scenario_with(flight=flight, check_points=spec)).warnings
    assert any("strip" in note and "one image" in note for note in notes)
    assert any("ground points measured in fewer than two images: C" in note for note in notes)


# --- the paper's area 1 -------------------------------------------------------------------------


def test_area_1_has_the_numbers_of_the_paper(area1):
    models = stereo_models(area1)
    assert len(area1.orientations) == 300
    assert len(models) == 295
    assert len(area1.tie_points.point_id) == pytest.approx(111_000, rel=0.01)
    assert len(area1.tie_points) == pytest.approx(380_000, rel=0.01)
    assert models.pairs.n_points.mean() == pytest.approx(757, rel=0.01)
    assert area1.warnings == ()


def test_area_1_has_the_parallax_of_the_paper(area1):
    # method.md, section 8: simulated 0.280 mm (published 0.269); truth leaves 0.0034 mm of noise.
    assert model_rms_mm(stereo_models(area1)).mean() == pytest.approx(0.280, abs=0.002)
    assert model_rms_mm(true_models(area1)).mean() == pytest.approx(0.0034, abs=0.00005)


def test_the_small_area_1_is_like_the_large_one():
    block = simulate(load_scenario("area1-small"))
    assert len(block.orientations) == 48
    assert block.check_points.sum() == 15
    assert model_rms_mm(stereo_models(block)).mean() == pytest.approx(0.27, abs=0.01)
    assert model_rms_mm(true_models(block)).mean() == pytest.approx(0.0034, abs=0.0001)
