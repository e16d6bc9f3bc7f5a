"""Which ground points are control."""

from dataclasses import replace

import numpy as np
import pytest
from small_scenario import small_block

from posstats.adjustment.control import chosen_control, measured_points, read_ids
from posstats.errors import PosstatsError


@pytest.fixture(scope="module")
def block():
    """Nine ground points on a 3 x 3 grid, all check points: C1 ... C9 by columns."""
    return small_block()


def chosen(block, choice) -> list[str]:
    return [str(point) for point in block.ground_points.point[chosen_control(block, choice)]]


def test_the_central_and_corner_points_are_those_of_the_grid(block):
    assert chosen(block, "centre") == ["C5"]
    assert chosen(block, "corners") == ["C1", "C3", "C7", "C9"]


def test_corners_follow_a_block_that_is_flown_askew(block):
    angle = np.radians(40.0)
    turn = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    turned = replace(
        block,
        orientations=replace(block.orientations, position_m=block.orientations.position_m @ turn.T),
        ground_points=replace(
            block.ground_points, position_m=block.ground_points.position_m @ turn.T
        ),
    )
    assert chosen(turned, "corners") == ["C1", "C3", "C7", "C9"]


def test_no_point_serves_two_corners(block):
    few = np.isin(block.ground_points.point, ["C1", "C2", "C4", "C5"])
    points = replace(
        block.ground_points,
        **{
            name: getattr(block.ground_points, name)[few]
            for name in ("point", "position_m", "is_check", "sigma_xy_m", "sigma_z_m")
        },
    )
    assert sorted(chosen(replace(block, ground_points=points), "corners")) == [
        "C1", "C2", "C4", "C5",
    ]  # fmt: skip


def test_roles_all_and_none(block):
    assert chosen(block, "roles") == []
    assert chosen(block, "none") == []
    assert len(chosen(block, "all")) == 9


def test_points_of_fewer_than_two_images_are_not_chosen(block):
    ties = block.tie_points
    c5 = int(np.flatnonzero(ties.point_id == "C5")[0])
    rays = np.flatnonzero(ties.point == c5)
    keep = np.ones(len(ties), dtype=bool)
    keep[rays[1:]] = False
    hidden = replace(block, tie_points=ties.subset(keep))
    assert not measured_points(hidden, hidden.ground_points)[4]
    assert chosen(hidden, "centre") != ["C5"]
    with pytest.raises(PosstatsError, match="'C5' is not measured"):
        chosen_control(hidden, ("C5",))


def test_an_unknown_id_is_refused_with_the_nearest_known_one(block):
    with pytest.raises(PosstatsError, match="'C55'; the nearest id"):
        chosen_control(block, ("C1", "C55"))


def test_too_few_points_for_the_corners_are_told(block):
    none = replace(block, ground_points=None)
    with pytest.raises(PosstatsError, match=r"no ground_points\.csv"):
        chosen_control(none, "corners")
    assert len(chosen_control(none, "all")) == 0


def test_a_file_of_ids_may_hold_comments(tmp_path):
    path = tmp_path / "ids.txt"
    path.write_text("# marked points\nC1\n\n  C7 # in the wood\n", encoding="utf-8")
    assert read_ids(path) == ("C1", "C7")


@pytest.mark.parametrize("content", [b"# none\n", b"\xff\xfe\x00"])
def test_a_file_without_ids_is_refused(tmp_path, content):
    path = tmp_path / "ids.txt"
    path.write_bytes(content)
    with pytest.raises(PosstatsError, match=r"ids\.txt"):
        read_ids(path)
