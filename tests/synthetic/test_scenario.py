"""Scenario files: every finding is named, good ones say what they mean.

Oracle: the published Table 1, closed forms, and the wrong values put in on purpose.
"""

import pandas as pd
import pytest
from finding_parts import assert_finding, parts
from helpers import shared_path
from minimal_scenario import MINIMAL, changed

from posstats.errors import BlockFormatError
from posstats.synthetic.scenario import load_scenario


def findings_of(content):
    with pytest.raises(BlockFormatError) as caught:
        load_scenario(content)
    return caught.value.findings


def test_minimal_scenario_has_quiet_defaults():
    scenario = load_scenario(MINIMAL)
    assert scenario.errors.omega.constant_rad == 0.0
    assert scenario.check_points.n == 0
    assert scenario.flight.image_counts == (3, 3)
    assert scenario.camera.camera.principal_point_px == (500.0, 400.0)
    assert scenario.control_points.distribution == "corners"


def test_scale_and_principal_distance_give_the_flying_height():
    scenario = load_scenario("area1")
    assert scenario.height_m == pytest.approx(78000 * 0.120, rel=1e-14)
    assert scenario.camera.camera.principal_distance_px == pytest.approx(10000.0, rel=1e-14)


@pytest.mark.parametrize("area", [1, 2, 3])
def test_the_areas_are_those_of_table_1(area):
    published = pd.read_csv(shared_path("paper", "table1.csv")).set_index("area").loc[area]
    scenario = load_scenario(f"area{area}")
    counts = scenario.flight.image_counts
    assert scenario.camera.principal_distance_mm == published.principal_distance_mm
    assert scenario.camera.width_px == published.width_px
    assert scenario.camera.height_px == published.height_px
    assert scenario.camera.pixel_size_mm == published.pixel_size_mm
    assert scenario.flight.scale_denominator == published.scale_denominator
    assert scenario.flight.forward_overlap == published.forward_overlap
    assert scenario.flight.side_overlap == published.side_overlap
    assert scenario.check_points.n == published.n_control_points
    # Table 1 speaks of 320 images in 5 strips for area 2; Table 2 lists nine strips.
    assert sum(counts) == published.n_images
    assert len(counts) == (9 if area == 2 else published.n_strips)


def test_strips_may_have_different_numbers_of_images():
    counts = load_scenario(changed(flight={"n_strips": None, "images_per_strip": [4, 2, 3]}))
    assert counts.flight.image_counts == (4, 2, 3)


@pytest.mark.parametrize(
    ("content", "where", "found", "expected"),
    [
        (
            changed(flight={"forward_overlap": 1.0}),
            "scenario, flight.forward_overlap",
            "1.0",
            "a share above 0",
        ),
        (
            changed(flight={"side_overlap": 1.0}),
            "scenario, flight.side_overlap",
            "1.0",
            "a share above -1",
        ),
        (changed(flight={"n_strips": 0}), "scenario, flight.n_strips", "0", "a whole number"),
        (
            changed(flight={"images_per_strip": []}),
            "scenario, flight.images_per_strip",
            "[]",
            "a whole number",
        ),
        (
            changed(flight={"images_per_strip": [3, 0]}),
            "scenario, flight.images_per_strip",
            "[3, 0]",
            "a whole number",
        ),
        (
            changed(flight={"images_per_strip": 2.5}),
            "scenario, flight.images_per_strip",
            "2.5",
            "a whole number",
        ),
        (
            changed(flight={"images_per_strip": [3, 3, 3]}),
            "scenario, flight.images_per_strip",
            "3 strips",
            "n_strips, 2",
        ),
        (
            changed(flight={"n_strips": 10_000, "images_per_strip": 10_000}),
            "scenario, flight",
            "100000000 images",
            "at most 100000",
        ),
        (
            changed(flight={"height_m": None}),
            "scenario, flight",
            "needs either scale_denominator",
            "",
        ),
        (
            changed(flight={"scale_denominator": 1e4}),
            "scenario, flight",
            "needs either scale_denominator",
            "",
        ),
        (
            changed(flight={"height_m": None, "scale_denominator": 1e4}),
            "scenario",
            "flight.scale_denominator needs camera.pixel_size_mm",
            "",
        ),
        (
            changed(flight={"speed_m_per_s": "fast"}),
            "scenario, flight.speed_m_per_s",
            "'fast'",
            "a number above 0",
        ),
        (
            changed(flight={"speed_m_per_s": True}),
            "scenario, flight.speed_m_per_s",
            "True",
            "a number above 0",
        ),
        (
            changed(flight={"start_time_s": float("nan")}),
            "scenario, flight.start_time_s",
            "nan",
            "a number",
        ),
        (
            changed(flight={"turn_s": 10**400}),
            "scenario, flight.turn_s",
            "1000",
            "a number above 0",
        ),
        (
            changed(flight={"forward_overlp": 0.6}),
            "scenario, flight.forward_overlp",
            "an unknown key",
            "forward_overlap?",
        ),
        (changed(flight={"tilt_rad": 5}), "scenario, flight.tilt_rad", "5", "an angle in"),
        (
            changed(flight={"headings_deg": [0, "S"]}),
            "scenario, flight.headings_deg",
            "[0, 'S']",
            "a number or",
        ),
        (
            changed(camera={"width_px": None}),
            "scenario, camera.width_px",
            "nothing",
            "a number above 0",
        ),
        (
            changed(camera={"principal_distance_px": None}),
            "scenario, camera",
            "needs either principal_distance_mm",
            "",
        ),
        (
            changed(camera={"principal_distance_mm": 100}),
            "scenario, camera",
            "needs either principal_distance_mm",
            "",
        ),
        (
            changed(camera={"principal_distance_px": None, "principal_distance_mm": 100}),
            "scenario, camera",
            "principal_distance_mm needs pixel_size_mm",
            "",
        ),
        (
            changed(camera={"distortion": {"model": "fisheye"}}),
            "scenario, camera.distortion.model",
            "'fisheye'",
            "none or radial",
        ),
        (
            changed(camera={"distortion": {"k1": 0.1}}),
            "scenario, camera.distortion",
            "has coefficients, but",
            "",
        ),
        (
            changed(camera={"distortion": {"model": "radial", "p1": 0.1}}),
            "scenario, camera.distortion",
            "has k3, p1",
            "",
        ),
        (
            changed(camera={"principal_point_px": [1]}),
            "scenario, camera.principal_point_px",
            "[1]",
            "a list of",
        ),
        (
            changed(block={"angles": "roll-pitch-heading"}),
            "scenario, block.angles",
            "'roll-pitch-heading'",
            "omega-phi-kappa or phi-omega-kappa",
        ),
        (changed(block={"crs": "EPSG:2154"}), "scenario, block", "crs needs origin_m,", ""),
        (changed(block={"name": " "}), "scenario, block.name", "' '", "a text"),
        (
            changed(errors={"omega": {"drift": 1e-6}}),
            "scenario, errors.omega.drift",
            "an unknown key",
            "drift_rad_per_s?",
        ),
        (changed(errors={"omega": 0.01}), "scenario, errors.omega", "0.01", "a table of"),
        (
            changed(errors={"omega": {"constant_rad": 18}}),
            "scenario, errors.omega.constant_rad",
            "18",
            "an angle in",
        ),
        (changed(errors={"image_px": -0.1}), "scenario, errors.image_px", "-0.1", "a number of"),
        (
            changed(errors={"blunder_share": 1.0}),
            "scenario, errors.blunder_share",
            "1.0",
            "a share from 0",
        ),
        (
            changed(errors={"blunder_px": 400}),
            "scenario, errors.blunder_px",
            "400",
            "less than half",
        ),
        (changed(check_points={"n": -1}), "scenario, check_points.n", "-1", "a whole number"),
        (
            changed(check_points={"distribution": "star"}),
            "scenario, check_points.distribution",
            "'star'",
            "grid or corners",
        ),
        (changed(accuracy={"image_px": 0}), "scenario, accuracy.image_px", "0", "a number above 0"),
        (
            changed(tie_points={"per_model": 0}),
            "scenario, tie_points.per_model",
            "0",
            "a number above 0",
        ),
        (changed(flights={}), "scenario, flights", "an unknown key", "flight?"),
    ],
)
def test_a_wrong_value_is_one_finding(content, where, found, expected):
    (finding,) = findings_of(content)
    assert_finding(finding, where, found, expected)


def test_all_findings_are_collected():
    content = changed(flight={"forward_overlap": 2, "n_strips": 0}, camera={"width_px": "wide"})
    assert len(findings_of(content)) == 3


def test_a_missing_table_is_named():
    content = changed()
    del content["flight"]
    (finding,) = findings_of(content)
    assert_finding(finding, "scenario, flight", "nothing", "a table of")


@pytest.mark.parametrize(
    ("content", "where", "found", "expected"),
    [
        (b"", "bad.toml, block", "nothing", "a table of"),
        (b"[block\nname = 1", "bad.toml", "no valid TOML:", ""),
        (b"\xff\xfe\x00\x01", "bad.toml:1", "a file that", ""),
        (b"[block]\nname = 3\n", "bad.toml:2, block.name", "3", "a text"),
    ],
)
def test_a_file_is_named_in_its_findings(tmp_path, content, where, found, expected):
    path = tmp_path / "bad.toml"
    path.write_bytes(content)
    with pytest.raises(BlockFormatError) as caught:
        load_scenario(path)
    (finding,) = [text for text in caught.value.findings if parts(text)[0] == where]
    assert_finding(finding, where, found, expected)


def test_a_folder_or_a_missing_file_is_refused(tmp_path):
    with pytest.raises(BlockFormatError, match=r"cannot be read \(Is a directory\)"):
        load_scenario(tmp_path)
    with pytest.raises(BlockFormatError, match=r"none\.toml: .*\(No such"):
        load_scenario(tmp_path / "none.toml")


def test_a_file_with_byte_order_mark_and_windows_line_ends_is_read(tmp_path):
    text = (
        "[block]\r\nname = 'x'\r\n[camera]\r\nwidth_px = 9\r\nheight_px = 9\r\n"
        "principal_distance_px = 9\r\n[flight]\r\nforward_overlap = 0.6\r\nside_overlap = 0\r\n"
        "height_m = 1\r\nimages_per_strip = 2\r\n[errors]\r\nblunder_px = 1\r\n"
    )
    path = tmp_path / "windows.toml"
    path.write_bytes(b"\xef\xbb\xbf" + text.encode())
    assert load_scenario(path).block.name == "x"
