"""What plans draw against the places and differences that they are given."""

import numpy as np
import pytest
from matplotlib.figure import Figure

from posstats.reports.figures.plan_view import (
    PlanView,
    arrow_scale,
    difference_arrows,
    many_arrows,
    view_around,
)

PLACE = np.array([[100.0, 2000.0], [400.0, 2500.0], [150.0, 3100.0]])
DIFFERENCE = np.array([[0.3, 0.1], [-0.2, 0.5], [0.4, -0.6]])
SCALE = 200.0
VIEWS = {turned: PlanView(0.0, 500.0, 1900.0, 3200.0, turned) for turned in (False, True)}


def axes():
    return Figure().add_subplot()


def on_ground(points, turned):
    """East, north of places on the axes."""
    return points[:, ::-1] if turned else points


@pytest.mark.parametrize("turned", [False, True])
def test_single_arrows_lead_from_the_place_along_the_difference(turned):
    axis = axes()
    difference_arrows(axis, VIEWS[turned], PLACE, DIFFERENCE, SCALE, "k")
    tails = on_ground(np.array([each.xyann for each in axis.texts]), turned)
    tips = on_ground(np.array([each.xy for each in axis.texts]), turned)
    np.testing.assert_allclose(tails, PLACE)
    np.testing.assert_allclose(tips, PLACE + SCALE * DIFFERENCE)


def test_unknown_differences_have_no_arrow_and_the_others_keep_theirs():
    axis, part = axes(), DIFFERENCE.copy()
    part[1] = np.nan
    difference_arrows(axis, VIEWS[False], PLACE, part, SCALE, "k")
    tips = np.array([each.xy for each in axis.texts])
    np.testing.assert_allclose(tips, (PLACE + SCALE * DIFFERENCE)[[0, 2]])


@pytest.mark.parametrize("turned", [False, True])
def test_many_arrows_lead_there_too_with_heads_at_their_tips(turned):
    axis = axes()
    many_arrows(axis, VIEWS[turned], PLACE, DIFFERENCE, SCALE, "k")
    line = on_ground(axis.lines[0].get_xydata(), turned).reshape(-1, 3, 2)
    np.testing.assert_allclose(line[:, 0], PLACE)
    np.testing.assert_allclose(line[:, 1], PLACE + SCALE * DIFFERENCE)
    heads = on_ground(axis.patches[0].get_path().vertices, turned).reshape(-1, 4, 2)
    np.testing.assert_allclose(heads[:, 0], PLACE + SCALE * DIFFERENCE)
    back = heads[:, 0] - heads[:, 1:3].mean(axis=1)
    cosine = np.sum(back * DIFFERENCE, axis=1) / np.hypot(*back.T) / np.hypot(*DIFFERENCE.T)
    np.testing.assert_allclose(cosine, 1.0)


def test_an_arrow_that_ends_outside_of_the_plan_is_drawn():
    axis = axes()
    axis.set(xlim=(0.0, 500.0), ylim=(1900.0, 3200.0))
    difference_arrows(axis, VIEWS[False], PLACE, np.array([[-1.0, 0.0]] * 3), SCALE, "k")
    assert [each.get_annotation_clip() for each in axis.texts] == [False] * 3


@pytest.mark.parametrize("turned", [False, True])
def test_the_largest_difference_is_a_tenth_of_the_plan_and_the_scale_a_round_length(turned):
    magnification, length = arrow_scale(np.array([0.013, 0.037, np.nan]), VIEWS[turned])
    assert magnification * 0.037 == pytest.approx(130.0)
    assert length == pytest.approx(0.02)
    assert arrow_scale(np.array([0.0, np.nan]), VIEWS[turned]) is None


def test_a_view_holds_its_places_and_is_turned_where_north_is_long():
    view = view_around(PLACE)
    assert view.turned
    assert view.west < 100.0 < 400.0 < view.east
    assert view.south < 2000.0 < 3100.0 < view.north
    assert view.width_m == view.north - view.south
    # on paper north is to the right and east down
    paper = view.on_paper(PLACE)
    np.testing.assert_allclose(np.diff(paper[:, 0]), np.diff(PLACE[:, 1]))
    np.testing.assert_allclose(np.diff(paper[:, 1]), -np.diff(PLACE[:, 0]))


def test_a_turned_plan_is_a_rotation_of_the_ground_not_a_mirror_image():
    view = PlanView(west=100.0, east=200.0, south=0.0, north=1000.0, turned=True)
    east_north = [(110.0, 20.0), (190.0, 20.0), (190.0, 900.0)]
    ground, paper = np.array(east_north), view.on_paper(east_north)
    sides = [np.diff(corners, axis=0) for corners in (ground, paper)]
    assert np.linalg.det(sides[0]) == pytest.approx(np.linalg.det(sides[1]))
    assert paper[0].tolist() == [20.0, 90.0]
