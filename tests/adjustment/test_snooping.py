"""Data snooping: blunders put into small simulated blocks are found and named."""

from dataclasses import replace

import numpy as np
import pytest
from dense_bundle import noisy_problem
from small_scenario import small_block

from posstats.adjustment.axes import images_with_wrong_axes
from posstats.adjustment.block_problem import bundle_problem
from posstats.adjustment.snooping import snoop
from posstats.numerics.bundle import adjust

ERRORS = {
    "image_px": 0.2,
    "position": {"noise_m": 0.05},
    **{angle: {"noise_rad": 8.7e-5} for angle in ("omega", "phi", "kappa")},
}


@pytest.fixture(scope="module")
def problem():
    """Four strips of eight images with nine control points; all errors as stated."""
    block = small_block(errors=ERRORS, check_points={"image_px": 0.2})
    ground = replace(block.ground_points, is_check=np.zeros(9, dtype=bool))
    return bundle_problem(replace(block, ground_points=ground))


def names(found):
    return [(blunder.kind, blunder.index) for blunder in found.blunders]


def with_axes(problem, image, axes):
    xy = problem.xy_px.copy()
    rays = problem.image == image
    xy[rays] = xy[rays] @ np.transpose(axes)
    return replace(problem, xy_px=xy)


def ray_of_many(problem, image, least=3):
    """A ray of an image to a point with at least so many rays."""
    often = np.bincount(problem.point)[problem.point] >= least
    return int(np.flatnonzero(often & (problem.image == image))[0])


def test_a_block_without_blunders_loses_nothing(problem):
    found = snoop(problem)
    assert found.blunders == ()
    assert found.held is None
    assert found.complete
    assert found.result.square_sum == adjust(problem).square_sum


def test_a_control_point_off_by_100_m_is_named(problem):
    position = problem.control.position_m.copy()
    position[4] += [60.0, 80.0, 0.0]
    found = snoop(replace(problem, control=replace(problem.control, position_m=position)))
    assert names(found) == [("control", 4)]
    assert found.complete
    (blunder,) = found.blunders
    assert blunder.unit == "m"
    # 0.2 px are 0.19 m on the ground, twice that in height, in three and more rays
    np.testing.assert_allclose(blunder.size, [60.0, 80.0, 0.0], atol=1.0)
    assert len(found.problem.control.point) == 8


def test_a_gnss_outlier_of_5_m_is_named(problem):
    antenna = problem.pos.antenna_m.copy()
    antenna[12, 1] -= 5.0
    found = snoop(replace(problem, pos=replace(problem.pos, antenna_m=antenna)))
    assert names(found) == [("gnss", 12)]
    np.testing.assert_allclose(found.blunders[0].size, [0.0, -5.0, 0.0], atol=1.0)


def test_an_imu_outlier_is_named(problem):
    angles = problem.pos.angles_rad.copy()
    angles[20, 2] += 0.02
    found = snoop(replace(problem, pos=replace(problem.pos, angles_rad=angles)))
    assert names(found) == [("imu", 20)]
    assert found.blunders[0].unit == "rad"
    np.testing.assert_allclose(found.blunders[0].size, [0.0, 0.0, 0.02], atol=5e-4)


def test_several_blunders_of_all_kinds_are_named_together(problem):
    xy, antenna = problem.xy_px.copy(), problem.pos.antenna_m.copy()
    position = problem.control.position_m.copy()
    rays = [ray_of_many(problem, image) for image in (3, 10, 28)]
    xy[rays] += [[25.0, 0.0], [0.0, -40.0], [30.0, 30.0]]
    antenna[17, 2] += 5.0
    position[0, 2] += 20.0
    found = snoop(
        replace(
            problem,
            xy_px=xy,
            pos=replace(problem.pos, antenna_m=antenna),
            control=replace(problem.control, position_m=position),
        )
    )
    assert sorted(names(found)) == sorted(
        [("control", 0), ("gnss", 17), *(("image", ray) for ray in rays)]
    )
    size = {blunder.index: blunder.size for blunder in found.blunders if blunder.kind == "image"}
    np.testing.assert_allclose(
        [size[ray] for ray in rays], [[25.0, 0.0], [0.0, -40.0], [30.0, 30.0]], atol=2.0
    )


SWAPPED, TURNED = [[0, 1], [1, 0]], [[0, -1], [1, 0]]
Y_REVERSED, UPSIDE_DOWN = [[1, 0], [0, -1]], [[-1, 0], [0, -1]]


@pytest.mark.parametrize("image", [0, 12])
def test_swapped_axes_of_an_image_are_named_and_its_orientation_is_that_of_pos(problem, image):
    found = snoop(with_axes(problem, image, SWAPPED))
    assert names(found) == [("axes", image)]
    assert found.complete
    assert (found.blunders[0].size > 1000.0).all()
    difference = found.result.position_m[image] - problem.pos.antenna_m[image]
    np.testing.assert_allclose(difference, 0.0, atol=1e-6)


@pytest.mark.parametrize("axes", [SWAPPED, TURNED, Y_REVERSED, UPSIDE_DOWN])
def test_other_axes_are_seen_in_the_parallax(problem, axes):
    wrong = with_axes(with_axes(problem, 5, axes), 22, axes)
    assert images_with_wrong_axes(wrong).tolist() == [5, 22]
    assert images_with_wrong_axes(problem).size == 0


def test_what_the_block_cannot_do_without_is_named_and_kept():
    # without POS, three control points define the datum and have a redundancy of 9 - 7 = 2
    problem = noisy_problem(n_control=3)
    nothing = np.full((8, 3), np.inf)
    position = problem.control.position_m.copy()
    position[1, 0] += 10.0
    found = snoop(
        replace(
            problem,
            pos=replace(problem.pos, sigma_antenna_m=nothing, sigma_angles_rad=nothing),
            control=replace(problem.control, position_m=position),
        )
    )
    assert found.blunders == ()
    assert found.held is not None
    assert found.held.kind == "control"
    assert not found.complete


def test_snooping_stops_at_the_largest_number(problem):
    xy = problem.xy_px.copy()
    rays = [ray_of_many(problem, image) for image in (3, 10, 28)]
    xy[rays] += 30.0
    found = snoop(replace(problem, xy_px=xy), most=2)
    assert len(found.blunders) == 2
    assert not found.complete


def test_mismatches_by_half_an_image_are_named():
    problem = noisy_problem(seed=2, n_strips=3, n_images=8, n_points=400)
    rng = np.random.default_rng(0)
    often = np.flatnonzero(np.bincount(problem.point)[problem.point] >= 4)
    rays = rng.choice(often, 20, replace=False)
    xy = problem.xy_px.copy()
    xy[rays] += 3000.0 * rng.standard_normal((20, 2))
    found = snoop(replace(problem, xy_px=xy))
    assert sorted(names(found)) == [("image", ray) for ray in sorted(rays)]
    for blunder in found.blunders:
        error = xy[blunder.index] - problem.xy_px[blunder.index]
        np.testing.assert_allclose(blunder.size, error, atol=3.0)
    assert found.complete
