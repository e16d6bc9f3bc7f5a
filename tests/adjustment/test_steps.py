"""The chain of a block's adjustment: what it finds, and what it says of bad input."""

import json
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from helpers import shared_path
from scipy.spatial.transform import Rotation
from small_scenario import OMEGA_CONSTANT_RAD, OMEGA_DRIFT_RAD_PER_S, small_block

from posstats import read_block
from posstats.adjustment import Adjustment, AdjustmentSettings, adjust_block
from posstats.adjustment.axes import images_with_wrong_axes
from posstats.adjustment.block_problem import bundle_problem
from posstats.adjustment.results import adjustment_results
from posstats.adjustment.snooping import Blunder
from posstats.adjustment.undetermined import UndeterminedBlockError
from posstats.contract.adjustment import AdjustmentResults
from posstats.contract.files import from_json, to_json
from posstats.contract.notice import Notice
from posstats.errors import PosstatsError
from posstats.formats.block_folder import write_block
from posstats.geometry.ground.intersection import intersect
from posstats.numerics.kernels.rotation import wrapped
from posstats.reports.adjustment.verdict import paragraph
from posstats.reports.adjustment.words import words_in

OPK, RPH = "omega-phi-kappa", "roll-pitch-heading"
GOOD_POINTS = {"n": 9, "distribution": "grid", "image_px": 0.2, "ground_m": 0.02}


@pytest.fixture(scope="module")
def block():
    return small_block(check_points=GOOD_POINTS)


@pytest.fixture(scope="module")
def tiny():
    return small_block(
        flight={"n_strips": 3, "images_per_strip": 5},
        tie_points={"per_model": 30},
        check_points=GOOD_POINTS,
    )


@pytest.fixture(scope="module")
def corners(block) -> Adjustment:
    return adjust_block(block, AdjustmentSettings(control="corners"))


def parameter(adjustment: Adjustment, name: str, scope: str = "block"):
    return next(p for p in adjustment.parameters if (p.name, p.scope) == (name, scope))


def test_the_simulated_errors_of_the_pos_are_found(corners):
    for name, true in (
        ("imu_omega_shift", OMEGA_CONSTANT_RAD),
        ("imu_omega_drift", OMEGA_DRIFT_RAD_PER_S),
    ):
        found = parameter(corners, name)
        assert found.significant
        assert abs(found.value - true) < 4.0 * found.sigma
        assert found.sigma < 0.1 * true
    assert corners.overall.p > 0.001


def test_adjusted_orientations_are_nearer_the_truth_as_far_as_their_sigmas_say(corners, block):
    adjusted, truth = corners.orientations, block.adjusted
    turned = wrapped(adjusted.angles_rad - truth.angles_rad) / adjusted.sigma_angles_rad
    moved = (adjusted.position_m - truth.position_m) / adjusted.sigma_position_m
    assert np.sqrt(np.mean(turned**2)) < 3.0
    assert np.sqrt(np.mean(moved**2)) < 3.0


def test_check_points_fit_within_their_predicted_accuracy(corners):
    residuals = corners.check_points
    assert residuals.orientation == "bundle"
    assert sorted(residuals.point) == ["C2", "C4", "C5", "C6", "C8"]
    assert np.sqrt(np.mean((residuals.difference_m / residuals.sigma_m) ** 2)) < 2.0
    pos = corners.pos_check_points
    assert np.abs(residuals.difference_m).max() < 0.05 * np.abs(pos.difference_m).max()


def test_rays_to_check_points_take_no_part(block, corners):
    ties = block.tie_points
    checks = np.isin(ties.point_id[ties.point], ["C2", "C5"])
    moved = replace(block, tie_points=replace(ties, xy_px=ties.xy_px + 50.0 * checks[:, None]))
    again = adjust_block(moved, AdjustmentSettings(control="corners"))
    np.testing.assert_array_equal(again.orientations.angles_rad, corners.orientations.angles_rad)
    assert np.abs(again.check_points.difference_m - corners.check_points.difference_m).max() > 1.0


def test_covariance_of_a_check_point_by_perturbing_all_that_it_depends_on(corners):
    block, adjusted = corners.block, corners.adjusted
    point = int(np.flatnonzero(block.tie_points.point_id == "C5")[0])
    rays = np.flatnonzero(block.tie_points.point == point)
    images = block.tie_points.image[rays]

    def position(ties, orientations):
        return intersect(ties, orientations, block.cameras, [point]).position_m[0]

    by_image, by_pose = [], []
    for ray in rays:
        for axis in range(2):
            ends = []
            for step in (0.5, -0.5):
                xy = block.tie_points.xy_px.copy()
                xy[ray, axis] += step
                ties = replace(block.tie_points, xy_px=xy)
                ends.append(position(ties, corners.orientations))
            by_image.append(ends[0] - ends[1])
    for image in images:
        for element, h in enumerate([1e-5] * 3 + [0.1] * 3):
            ends = []
            for step in (h, -h):
                pose = corners.orientations
                values = np.concatenate([pose.angles_rad, pose.position_m], axis=1)
                values[image, element] += step
                turned = replace(pose, angles_rad=values[:, :3], position_m=values[:, 3:])
                ends.append(position(block.tie_points, turned))
            by_pose.append((ends[0] - ends[1]) / (2.0 * h))
    joint = _covariance_of_elements(corners, images)
    by_image, by_pose = np.array(by_image).T, np.array(by_pose).T
    expected = block.accuracy.image_px**2 * by_image @ by_image.T + by_pose @ joint @ by_pose.T
    row = list(corners.check_points.point).index("C5")
    found = corners.check_point_covariance_m2[row] / corners.scale**2
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    assert np.abs((found - expected) / scale).max() < 1e-3
    assert len(adjusted.position_m) == 32


def _covariance_of_elements(adjustment: Adjustment, images) -> np.ndarray:
    """Joint covariance of omega, phi, kappa, X, Y, Z of images of neighbouring levels."""
    from posstats.numerics.bundle.pos_observations import angles_by_rotation_vector

    n, adjusted = len(images), adjustment.adjusted
    by_pose = np.tile(np.eye(6), (n, 1, 1))
    system = adjustment.orientations.system
    by_pose[:, :3, :3] = angles_by_rotation_vector(adjusted.angles_rad[images], system)
    joint = np.empty((n, 6, n, 6))
    for i in range(n):
        for j in range(n):
            block = adjusted.inverse.blocks(images[[i]], images[[j]])[0]
            joint[i, :, j, :] = by_pose[i] @ block @ by_pose[j].T
    return joint.reshape(6 * n, 6 * n)


def test_strips_share_what_contradicts_their_priors(block):
    strips = adjust_block(block, AdjustmentSettings(control="corners", drift="strip"))
    shift = parameter(strips, "imu_omega_shift")
    assert shift.significant
    assert abs(shift.value - OMEGA_CONSTANT_RAD) < 4.0 * shift.sigma + OMEGA_DRIFT_RAD_PER_S * 2000
    assert strips.overall.p > 0.001


def test_weights_come_out_as_simulated():
    wrong = small_block(check_points=GOOD_POINTS)
    wrong = replace(wrong, accuracy=replace(wrong.accuracy, image_px=0.1))
    found = adjust_block(wrong, AdjustmentSettings(control="all", estimate_weights=True))
    assert found.weights.factor["image"] == pytest.approx(4.0, rel=0.1)
    assert found.overall.sigma0 == pytest.approx(1.0, abs=0.05)


def test_a_block_without_additional_parameters_is_adjusted(block):
    right = replace(block, orientations=block.adjusted)
    stated = block.orientations
    right = replace(
        right,
        orientations=replace(
            block.adjusted,
            sigma_position_m=stated.sigma_position_m,
            sigma_angles_rad=stated.sigma_angles_rad,
        ),
    )
    plain = adjust_block(right, AdjustmentSettings(control="all", drift="none"))
    assert plain.parameters == ()
    assert adjustment_results(plain).correlations == ()


def test_a_systematic_error_without_parameters_is_called_by_its_name(tiny):
    results = adjustment_results(adjust_block(tiny, AdjustmentSettings("all", drift="none")))
    assert Notice(code="systematic_imu", values={"n": 15, "n_images": 15}) in results.notices


def test_insignificant_parameters_are_dropped_on_request(block):
    settings = AdjustmentSettings(
        control="corners", self_calibration="brown", drop_insignificant=True
    )
    dropped = adjust_block(block, settings)
    assert {each.parameter.name for each in dropped.dropped} >= {"brown_k2", "brown_k3"}
    left = {p.name for p in dropped.parameters}
    assert not left & {each.parameter.name for each in dropped.dropped}


def test_bauer_needs_a_pixel_size(block):
    cameras = tuple(replace(camera, pixel_size_mm=None) for camera in block.cameras)
    with pytest.raises(PosstatsError, match="pixel size"):
        adjust_block(replace(block, cameras=cameras), AdjustmentSettings(self_calibration="bauer"))


def test_an_unknown_setting_is_refused():
    with pytest.raises(PosstatsError, match="choose one of none, block, strip"):
        AdjustmentSettings(drift="image")


# Bad input: the message names the cause, or data snooping the observation.


def test_no_control_and_no_pos_weights_is_a_datum_defect(block):
    nothing = np.full_like(block.orientations.position_m, np.inf)
    loose = replace(
        block,
        orientations=replace(
            block.orientations, sigma_position_m=nothing, sigma_angles_rad=nothing
        ),
    )
    with pytest.raises(UndeterminedBlockError, match="open_datum") as caught:
        adjust_block(loose, AdjustmentSettings(control="none", drift="none"))
    assert [each.reason.code for each in caught.value.defects] == ["open_datum"]


def test_points_on_a_line_leave_angles_to_the_imu(block):
    ties = block.tie_points
    on_line = np.abs(ties.xy_px[:, 1]) < 60.0
    one_strip = np.isin(ties.image, np.flatnonzero(block.orientations.strip == "1"))
    thin = replace(block, tie_points=ties.subset(on_line | ~one_strip))
    found = adjust_block(thin, AdjustmentSettings(control="none"))
    images = {name for each in found.undetermined if each.kind == "image" for name in each.names}
    assert images & set(block.orientations.image[block.orientations.strip == "1"])


def test_strips_without_overlap_are_named():
    apart = small_block(flight={"side_overlap": -0.2}, check_points={"n": 0})
    found = adjust_block(apart)
    parts = [each for each in found.undetermined if each.kind == "connection"]
    assert len(parts) == 3
    assert {name for each in parts for name in each.names} < {"1", "2", "3", "4"}


def test_a_control_point_off_by_100_m_is_named(block):
    surveyed = block.ground_points
    position = surveyed.position_m.copy()
    position[list(surveyed.point).index("C3"), 0] += 100.0
    off = replace(block, ground_points=replace(surveyed, position_m=position))
    found = adjust_block(off, AdjustmentSettings(control="all"))
    named = [row for row in adjustment_results(found).blunders if row.kind == "control"]
    assert [row.point for row in named] == ["C3"]
    assert named[0].size[0] == pytest.approx(100.0, abs=2.0)
    assert found.overall.p > 1e-4


@pytest.mark.parametrize(("control", "axis"), [("all", 2), (("C1", "C3"), 0)])
def test_a_wrong_control_point_is_no_witness_against_priors(block, control, axis):
    surveyed = block.ground_points
    position = surveyed.position_m.copy()
    position[list(surveyed.point).index("C3"), axis] += 100.0
    off = replace(block, ground_points=replace(surveyed, position_m=position))
    found = adjust_block(off, AdjustmentSettings(control=control, drift="strip"))
    named = [row for row in adjustment_results(found).blunders if row.kind == "control"]
    assert [row.point for row in named] == ["C3"]
    for each in found.parameters:
        if each.name.startswith("gnss") and each.name.endswith("shift"):
            assert abs(each.value) < 1.0


def test_a_single_control_point_against_the_priors_is_warned_of(block):
    surveyed = block.ground_points
    position = surveyed.position_m.copy()
    position[list(surveyed.point).index("C3"), 0] += 100.0
    off = replace(block, ground_points=replace(surveyed, position_m=position))

    def warned(block):
        found = adjust_block(block, AdjustmentSettings(control=("C3",)))
        return [n.values for n in adjustment_results(found).notices if n.code == "lone_control"]

    assert warned(off) == [{"point": "C3", "parameters": ("gnss_x_shift",)}]
    assert warned(block) == []


def test_an_image_with_swapped_axes_is_named_and_spoils_no_check_point(block):
    ties = block.tie_points
    image = 12
    xy = ties.xy_px.copy()
    rays = ties.image == image
    xy[rays] = xy[rays][:, ::-1]
    swapped = replace(block, tie_points=replace(ties, xy_px=xy))
    found = adjust_block(swapped, AdjustmentSettings(control="corners", drift="strip"))
    named = [row for row in adjustment_results(found).blunders if row.kind == "axes"]
    assert [row.image for row in named] == [block.orientations.image[image]]
    assert np.nanmax(np.abs(found.check_points.difference_m)) < 5.0


def test_an_image_mirrored_along_the_flight_shows_against_the_next_strip(block):
    ties = block.tie_points
    image = 12
    xy = ties.xy_px.copy()
    rays = ties.image == image
    along = np.argmax(np.abs(_flight_in_image(block, image)))
    xy[rays, along] *= -1.0
    reversed_ = replace(block, tie_points=replace(ties, xy_px=xy))
    found = adjust_block(reversed_, AdjustmentSettings(control="corners", drift="strip"))
    named = [row for row in adjustment_results(found).blunders if row.kind == "axes"]
    assert [row.image for row in named] == [block.orientations.image[image]]


@pytest.mark.parametrize("signs", [(-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)])
def test_every_mirrored_image_is_found_and_no_other(block, signs):
    problem = bundle_problem(block)
    for image in range(len(block.orientations)):
        assert images_with_wrong_axes(mirrored(problem, image, signs)).tolist() == [image]


@pytest.mark.parametrize("image", [35, 43])
def test_the_neighbour_of_a_mirrored_image_of_the_real_block_is_not_blamed(image):
    problem = bundle_problem(read_block(shared_path("data", "ign-fd1305")))
    assert images_with_wrong_axes(problem).tolist() == []
    found = images_with_wrong_axes(mirrored(problem, image, (-1.0, 1.0)))
    assert found.tolist() == [image]


def mirrored(problem, image, signs):
    own = (problem.image == image)[:, None]
    return replace(problem, xy_px=np.where(own, problem.xy_px * np.array(signs), problem.xy_px))


def _flight_in_image(block, image):
    pos = block.orientations
    ahead = pos.position_m[image + 1] - pos.position_m[image]
    return (pos.ground_from_image[image].T @ ahead)[:2]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda b: replace(b, tie_points=replace(b.tie_points, xy_px=b.tie_points.xy_px * [-1, 1])),
         "x of the image coordinates has the wrong sign"),
    ],
)  # fmt: skip
def test_a_mistake_in_all_images_is_named(block, change, message):
    with pytest.raises(PosstatsError, match=message):
        adjust_block(change(block), AdjustmentSettings(control="corners"))


@pytest.mark.parametrize(
    ("true", "stated", "message"),
    [
        (("gon", OPK), ("deg", OPK), "the angles are in gon, not in degrees"),
        (("deg", OPK), ("gon", OPK), "the angles are in degrees, not in gon"),
        (("rad", OPK), ("deg", OPK), "the angles are in radians, not in degrees"),
        (("deg", OPK), ("deg", RPH), "the angles are omega-phi-kappa, not roll-pitch-heading"),
        (("deg", RPH), ("deg", OPK), "the angles are roll-pitch-heading, not omega-phi-kappa"),
        (("deg", "pitch-roll-heading"), ("deg", RPH), "roll and pitch are exchanged"),
    ],
)
def test_angles_of_a_file_that_are_no_such_angles_are_named(tmp_path, true, stated, message):
    block = small_block(
        block={"crs": "EPSG:32631", "origin_m": [520_000.0, 4_800_000.0]},
        flight={"n_strips": 3, "images_per_strip": 5, "tilt_rad": 0.05},
        tie_points={"per_model": 30},
    )
    rewritten(block, tmp_path, true, stated)
    with pytest.raises(PosstatsError, match=message):
        adjust_block(read_block(tmp_path), AdjustmentSettings(control="all"))


def rewritten(block, folder, true, stated):
    """The block's files with angles of a system and unit, but said to be of another one."""
    write_block(replace(block, adjusted=None), folder)
    table = pd.read_csv(folder / "orientations.csv")
    angles = table[["omega", "phi", "kappa"]].to_numpy()
    if true[1] != OPK:
        # body axes (forward, right, down) in (east, north, up), image top forward
        rotation = Rotation.from_euler("XYZ", angles, degrees=True).as_matrix()
        body = rotation @ np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]])
        north_east_down = np.array([[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]) @ body
        angles = Rotation.from_matrix(north_east_down).as_euler("ZYX", degrees=True)[:, ::-1]
        if true[1] != RPH:
            angles = angles[:, [1, 0, 2]]
    angles[:, 2] %= 360.0
    angles *= {"deg": 1.0, "gon": 1.0 / 0.9, "rad": np.pi / 180.0}[true[0]]
    table = table.drop(columns=["omega", "phi", "kappa"])
    table[stated[1].split("-")] = angles
    table.to_csv(folder / "orientations.csv", index=False)
    toml = (folder / "block.toml").read_text(encoding="utf-8")
    toml = toml.replace('angle_unit = "deg"', f'angle_unit = "{stated[0]}"')
    toml = toml.replace(f'angles = "{OPK}"', f'angles = "{stated[1]}"')
    (folder / "block.toml").write_text(toml, encoding="utf-8")


def test_a_control_point_without_any_error_is_refused(block):
    surveyed = block.ground_points
    exact = replace(surveyed, sigma_xy_m=np.zeros(len(surveyed)))
    with pytest.raises(PosstatsError, match="of 0, expected a positive"):
        adjust_block(replace(block, ground_points=exact), AdjustmentSettings(control="corners"))


def test_points_in_one_image_each_are_told(block):
    ties = block.tie_points
    with pytest.raises(PosstatsError, match="measured in two images"):
        adjust_block(replace(block, tie_points=ties.subset(ties.image == 0)))


def test_an_observation_that_the_block_needs_is_said_to_be_doubtful(tiny):
    found = adjust_block(tiny, AdjustmentSettings("all"))
    ray = Blunder("image", 0, 9.0, np.array([1.0, 0.0]), "px")
    snooping = replace(found.snooping, held=ray, complete=False)
    results = adjustment_results(replace(found, snooping=snooping))
    codes = [each.code for each in results.notices]
    assert "snooping_held" in codes
    assert "snooping_stopped" not in codes
    words, (held,) = words_in("en"), [row for row in results.blunders if not row.taken_out]
    named = words.of("named", "image", image=held.image, point=held.point)
    assert words.text("blunders.held", what=named) in paragraph(words, results)


@pytest.mark.parametrize(
    ("spoil", "words"),
    [
        (lambda b: replace(b, orientations=replace(b.orientations, system="phi-omega-kappa")),
         "the angles are omega-phi-kappa, not phi-omega-kappa"),
        (lambda b: b.with_angles(b.orientations.angles_rad[:, [1, 0, 2]]),
         "omega and phi are exchanged"),
        (lambda b: replace(b, orientations=replace(
            b.orientations, position_m=b.orientations.position_m[:, [1, 0, 2]].copy())),
         "x and y of the POS positions are exchanged"),
        (lambda b: replace(b, tie_points=replace(
            b.tie_points, xy_px=b.tie_points.xy_px * [1.0, -1.0])),
         "y of the image coordinates has the wrong sign"),
        (lambda b: replace(b, ground_points=replace(
            b.ground_points, position_m=b.ground_points.position_m[:, [1, 0, 2]].copy())),
         "x and y of the ground points are exchanged"),
    ],
)  # fmt: skip
def test_a_wrong_convention_is_named(tiny, spoil, words):
    with pytest.raises(PosstatsError, match=words):
        adjust_block(spoil(tiny), AdjustmentSettings(control="all"))


def test_results_are_the_schema_in_plain_values(corners):
    text = to_json(adjustment_results(corners, created="2020-01-01"))
    assert to_json(from_json(text, AdjustmentResults, "adjustment.json")) == text
    values = json.loads(text)
    assert values["schema"] == "posstats-adjustment/1"
    assert values["converged"] is True
    assert {row["group"] for row in values["groups"]} >= {"image", "gnss", "imu", "control"}
    assert set(values) >= {
        "n_iterations", "sigma0", "dof", "chi2_p", "parameters", "correlations",
        "observability", "blunders", "check_points",
    }  # fmt: skip
    assert set(values["parameters"][0]) >= {
        "name", "scope", "value", "sigma", "t", "p", "significant", "unit",
    }  # fmt: skip
    redundancy = sum(row["redundancy"] for row in values["groups"])
    assert redundancy == pytest.approx(values["dof"], rel=1e-6)
    assert {row["orientation"] for row in values["check_points"]} == {"bundle", "pos"}
    assert [row["point"] for row in values["control_points"]] == ["C1", "C3", "C7", "C9"]


def test_written_blocks_give_the_same_adjustment(block, corners, tmp_path):
    write_block(block, tmp_path)
    again = adjust_block(read_block(tmp_path), AdjustmentSettings(control="corners"))
    first, second = parameter(corners, "imu_omega_drift"), parameter(again, "imu_omega_drift")
    assert second.value == pytest.approx(first.value, abs=1e-3 * first.sigma)


@pytest.fixture(scope="module")
def marseille() -> Adjustment:
    return adjust_block(read_block(shared_path("data", "ign-fd1305")))


def test_the_injected_errors_of_the_real_block_are_found(marseille):
    injected = json.loads(shared_path("data", "ign-fd1305", "injected.json").read_text())
    shift = parameter(marseille, "imu_omega_shift").value
    drift = parameter(marseille, "imu_omega_drift").value
    assert np.degrees(shift) == pytest.approx(injected["intercept_deg_at_t0"][0], abs=0.005)
    assert drift == pytest.approx(injected["slope_rad_per_s"][0], abs=3e-8)


def test_image_residuals_of_the_real_block_are_as_long_as_known(marseille):
    residual = marseille.adjusted.residual_px[~marseille.adjusted.rejected]
    length_px = np.hypot(*residual.T)
    assert np.sqrt(np.mean(length_px**2)) == pytest.approx(0.2, abs=0.05)


def test_an_unknown_camera_is_found_and_told_in_the_terms_of_the_block(block):
    # the block states a principal distance 20 px too short, a principal point 6 px right, 4 px up
    true = block.cameras[0]
    column, row = true.principal_point_px
    stated = replace(
        true,
        principal_distance_px=true.principal_distance_px - 20.0,
        principal_point_px=(column + 6.0, row - 4.0),
    )
    ties = block.tie_points
    wrong = replace(
        block, cameras=(stated,), tie_points=replace(ties, xy_px=ties.xy_px - [6.0, 4.0])
    )
    adjustment = adjust_block(wrong, AdjustmentSettings(control="all", camera=True))
    results = adjustment_results(adjustment)
    (camera,) = results.cameras
    sigma = {name: parameter(adjustment, name).sigma for name in ("camera_c", "camera_x0")}
    assert sigma["camera_c"] < 3.0
    assert sigma["camera_x0"] < 1.0
    assert abs(camera.principal_distance_px - true.principal_distance_px) < (
        4.0 * sigma["camera_c"]
    )
    found = np.array(camera.principal_point_px) - true.principal_point_px
    assert (np.abs(found) < 4.0 * sigma["camera_x0"]).all()
    assert results.settings.camera
