"""Dots and lines of the figures against the values that they stand for."""

import re
import xml.etree.ElementTree as ET
from dataclasses import replace

import numpy as np
import pytest
from report_results import with_rows
from shown_values import svgs_of

from posstats.reports.block.document import build
from posstats.reports.block.words import words_in
from posstats.reports.figures import style

WORDS = words_in("en")
ANGLES = ("omega", "phi", "kappa")


@pytest.fixture(scope="module")
def drawn(area_document):
    return svgs_of(area_document)


def paths(svg, *looks):
    """Points of the paths with a look, y upwards."""
    return [
        np.array(re.findall(r"(-?[\d.]+) (-?[\d.]+)", node.get("d")), dtype=float) * [1.0, -1.0]
        for node in ET.fromstring(svg).iter("{http://www.w3.org/2000/svg}path")  # noqa: S314
        if all(look in node.get("style", "").lower() for look in looks)
    ]


def starts(svg, look, length):
    """First points of the marks in the paths with a look; a mark has `length` points."""
    return [path[::length] for path in paths(svg, look) if len(path) >= 3 * length]


def texts(svg):
    root = ET.fromstring(svg)  # noqa: S314 - made here
    return [node.text for node in root.iter("{http://www.w3.org/2000/svg}text")]


def assert_straight(drawn_at, values):
    """What is drawn is a straight and rising function of the values."""
    slope, constant = np.polyfit(values, drawn_at, 1)
    assert slope > 0.0
    np.testing.assert_allclose(drawn_at, constant + slope * np.asarray(values), atol=0.05)


def test_dots_of_models_stand_at_the_logarithm_of_their_parallax(area, drawn):
    series = {
        (style.VERMILLION, 2): [model.pos_px for model in area.models],
        (style.BLUE, 4): [model.corrected_px for model in area.models],
        (style.GREEN, 3): [model.independent_px for model in area.models],
    }
    for (colour, length), values in series.items():
        (found,) = starts(drawn["models"], f"stroke: {colour.lower()}", length)
        assert_straight(found[:, 1], np.log10(values))
        assert_straight(found[:, 0], np.arange(len(values)))


@pytest.mark.parametrize("angle", ANGLES)
def test_marks_of_errors_stand_at_time_and_error_of_their_image(area, drawn, angle):
    rows = [row for row in area.angle_errors if row.strip == "1"]
    errors = np.array([getattr(row, f"{angle}_rad") for row in rows])
    times = np.array([row.time_s for row in rows])
    line = next(r for r in area.regression if r.angle == angle and r.scope == "block")
    fitted = line.intercept_rad + line.slope_rad_per_s * (times - line.time_origin_s)
    circles = starts(drawn[f"regression_ground_{angle}"], f"stroke: {style.BLUE.lower()}", 25)
    upper, lower = [found for found in circles if len(found) == len(rows)]
    for found, values in ((upper, errors), (lower, errors - fitted)):
        assert_straight(found[:, 0], times)
        assert_straight(found[:, 1], values)


def test_the_constant_taken_off_is_drawn_at_its_value(area):
    constant = with_rows(
        area, "selection",
        lambda row: replace(row, form="constant") if row.angle == "phi" else row,
    )  # fmt: skip
    drawn = svgs_of(build(constant))
    label = WORDS.text("legend.constant")
    assert label in texts(drawn["regression_ground_phi"])
    assert label not in texts(drawn["regression_ground_omega"])


def test_stations_of_the_plan_stand_where_the_images_are(area, drawn):
    (dots,) = starts(drawn["plan"], f"fill: {style.BLACK.lower()}; stroke", 2)
    assert_straight(dots[:, 0], [image.x_m for image in area.images])
    assert_straight(dots[:, 1], [image.y_m for image in area.images])


def stretched(image):
    corners = tuple((x, 8.0 * y) for x, y in image.footprint)
    return replace(image, y_m=8.0 * image.y_m, footprint=corners)


def test_a_long_block_is_turned_and_its_arrow_says_so(area, drawn):
    assert "N →" not in texts(drawn["plan"])
    document = build(with_rows(area, "images", stretched))
    assert "N →" in texts(svgs_of(document)["plan"])
    assert document.opening[0].drawing.caption.startswith(WORDS.text("plan.turned"))


def test_strips_and_lines_are_named_in_the_legend(drawn):
    named = texts(drawn["regression_ground_omega"])
    for words in (WORDS.scope("1"), WORDS.text("legend.ols"), WORDS.text("legend.gls")):
        assert words in named
