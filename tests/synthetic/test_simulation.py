"""Simulated blocks are what their scenario says.

Oracle: the scenario itself, coplanarity of the true rays, invariances, and the numbers measured
for the paper's areas.
"""

from dataclasses import fields, replace

import numpy as np
import pytest
from simulated_blocks import (
    LAMBERT_93,
    SYSTEMS,
    UTM_33,
    angle_errors,
    intersected,
    scenario_with,
    true_models,
)

from posstats.block.image_pairs import stereo_models
from posstats.errors import GeometryError
from posstats.formats.block_folder import read_block, write_block
from posstats.synthetic import simulate
from posstats.synthetic.scenario import AngleError, load_scenario


def model_rms_mm(models):
    q2 = models.y_parallax_px() ** 2
    offsets = models.pairs.offsets
    mean = np.add.reduceat(q2, offsets[:-1]) / np.diff(offsets)
    return np.sqrt(mean) * models.pixel_size_mm


def assert_equal_blocks(one, other):
    for name in ("orientations", "adjusted", "tie_points", "ground_points"):
        a, b = getattr(one, name), getattr(other, name)
        for field in fields(a):
            np.testing.assert_array_equal(getattr(a, field.name), getattr(b, field.name))


@pytest.fixture(scope="module")
def area1():
    return simulate(load_scenario("area1"))


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
    assert read.notices == ()
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


@pytest.mark.parametrize(
    ("tables", "message"),
    [
        ({"terrain": {"relief_m": 3000, "wavelength_m": 500}}, "above the flight"),
        ({"flight": {"tilt_rad": 0.5, "images_per_strip": 50}}, "towards the horizon"),
        ({"tie_points": {"per_model": 1e8}}, "lower .tie_points. per_model"),
        ({"flight": {"n_strips": 1, "images_per_strip": 1}}, "in two images"),
        ({"block": {"crs": "EPSG:0", "origin_m": [1, 1]}}, "know the crs"),
        ({"block": {"crs": "EPSG:4326", "origin_m": [5, 43]}}, "no map grid"),
        ({"block": {"crs": "EPSG:4326", "origin_m": [5, 43], "frame": "grid"}}, "no map grid"),
        ({"block": UTM_33 | {"origin_m": [5e7, 5e6]}}, "is outside EPSG:32633"),
        (
            {"camera": {"distortion": {"model": "radial", "k1": -5.0}}},
            "cannot be inverted",
        ),
    ],
)
def test_an_impossible_block_is_refused_in_words(tables, message):
    with pytest.raises(GeometryError, match=message):
        simulate(scenario_with(**tables))


def test_short_strips_and_unseen_points_are_noted():
    flight = {"n_strips": None, "images_per_strip": [1, 3], "forward_overlap": 0.3}
    spec = {"n": 60, "distribution": "grid"}
    notes = simulate(scenario_with(flight=flight, check_points=spec)).notices
    found = {each.code: each.values for each in notes}
    assert "strips_of_one_image" in found
    assert found["ground_points_with_few_rays"]["ids"][0].startswith("C")


def test_area_1_has_the_numbers_of_the_paper(area1):
    models = stereo_models(area1)
    assert len(area1.orientations) == 300
    assert len(models) == 295
    assert len(area1.tie_points.point_id) == pytest.approx(111_000, rel=0.01)
    assert len(area1.tie_points) == pytest.approx(380_000, rel=0.01)
    assert models.pairs.n_points.mean() == pytest.approx(757, rel=0.01)
    assert area1.notices == ()


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
