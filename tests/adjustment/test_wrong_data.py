"""Bad input of an adjustment: the message names the cause, or data snooping the observation."""

from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
from helpers import shared_path
from scipy.spatial.transform import Rotation
from small_scenario import small_block

from posstats import read_block
from posstats.adjustment import AdjustmentSettings, adjust_block
from posstats.adjustment.axes import images_with_wrong_axes
from posstats.adjustment.block_problem import bundle_problem
from posstats.adjustment.diagnosis import MistakenDataError
from posstats.adjustment.results import adjustment_results
from posstats.adjustment.snooping import Blunder
from posstats.adjustment.undetermined import UndeterminedBlockError
from posstats.errors import PosstatsError
from posstats.formats.block_folder import write_block
from posstats.reports.adjustment.verdict import paragraph
from posstats.reports.adjustment.wording import mistaken
from posstats.reports.adjustment.words import words_in

OPK, RPH = "omega-phi-kappa", "roll-pitch-heading"


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

    (told,) = warned(off)
    assert told["point"] == "C3"
    assert "gnss_x_shift" in told["parameters"]
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
    ("change", "code"),
    [
        (lambda b: replace(b, tie_points=replace(b.tie_points, xy_px=b.tie_points.xy_px * [-1, 1])),
         "mistaken_image_x"),
    ],
)  # fmt: skip
def test_a_mistake_in_all_images_is_named(block, change, code):
    with pytest.raises(MistakenDataError, match=code):
        adjust_block(change(block), AdjustmentSettings(control="corners"))


@pytest.mark.parametrize(
    ("true", "stated", "found"),
    [
        (("gon", OPK), ("deg", OPK), {"angle_unit": "gon", "stated_unit": "deg"}),
        (("deg", OPK), ("gon", OPK), {"angle_unit": "deg", "stated_unit": "gon"}),
        (("rad", OPK), ("deg", OPK), {"angle_unit": "rad", "stated_unit": "deg"}),
        (("deg", OPK), ("deg", RPH), {"angles": OPK, "stated": RPH}),
        (("deg", RPH), ("deg", OPK), {"angles": RPH, "stated": OPK}),
        (("deg", "pitch-roll-heading"), ("deg", RPH), {"one": "roll", "other": "pitch"}),
    ],
)
def test_angles_of_a_file_that_are_no_such_angles_are_named(tmp_path, true, stated, found):
    block = small_block(
        block={"crs": "EPSG:32631", "origin_m": [520_000.0, 4_800_000.0]},
        flight={"n_strips": 3, "images_per_strip": 5, "tilt_rad": 0.05},
        tie_points={"per_model": 30},
    )
    rewritten(block, tmp_path, true, stated)
    with pytest.raises(MistakenDataError) as caught:
        adjust_block(read_block(tmp_path), AdjustmentSettings(control="all"))
    assert caught.value.mistake.values == found
    assert words_in("en").notice(caught.value.mistake) in mistaken(caught.value)


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
    with pytest.raises(PosstatsError, match="of 0, expected"):
        adjust_block(replace(block, ground_points=exact), AdjustmentSettings(control="corners"))


def test_points_in_one_image_each_are_told(block):
    ties = block.tie_points
    with pytest.raises(PosstatsError, match="two images"):
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
    ("spoil", "code"),
    [
        (lambda b: replace(b, orientations=replace(b.orientations, system="phi-omega-kappa")),
         "mistaken_angles"),
        (lambda b: b.with_angles(b.orientations.angles_rad[:, [1, 0, 2]]),
         "mistaken_columns"),
        (lambda b: replace(b, orientations=replace(
            b.orientations, position_m=b.orientations.position_m[:, [1, 0, 2]].copy())),
         "mistaken_pos_axes"),
        (lambda b: replace(b, tie_points=replace(
            b.tie_points, xy_px=b.tie_points.xy_px * [1.0, -1.0])),
         "mistaken_image_y"),
        (lambda b: replace(b, ground_points=replace(
            b.ground_points, position_m=b.ground_points.position_m[:, [1, 0, 2]].copy())),
         "mistaken_ground_axes"),
    ],
)  # fmt: skip
def test_a_wrong_convention_is_named(tiny, spoil, code):
    with pytest.raises(MistakenDataError, match=code):
        adjust_block(spoil(tiny), AdjustmentSettings(control="all"))
