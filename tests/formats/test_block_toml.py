"""block.toml: every key, and what is said about those that are wrong."""

import numpy as np
import pytest
from finding_parts import assert_finding, parts

from posstats.formats.block_toml import parse_settings

GOOD = """\
[block]
name = "area1"
crs = "EPSG:2154"
frame = "tangent"
heights = "ellipsoidal"
angles = "omega-phi-kappa"
angle_unit = "deg"
image_coordinates = "px"
simulated = false

[camera]
name = "DMC"
width_px = 13824
height_px = 7680
pixel_size_mm = 0.012
principal_distance_mm = 120.0
principal_point_px = [6912.0, 3840.0]
distortion = { model = "radial", k1 = 0.1, k2 = 0.0 }

[pos]
lever_arm_m = [0.1, 0.2, 0.3]
boresight_deg = [1.0, 2.0, 3.0]
mounting_deg = 0

[accuracy]
position_m = 0.05
angle_deg = 0.005
image_px = 0.2
"""


def findings(*changes: tuple[str, str]) -> list[str]:
    text = GOOD
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    found: list[str] = []
    settings = parse_settings(text.encode(), "folder", found)
    assert (settings is None) == bool(found)
    return found


def test_the_whole_file_is_understood() -> None:
    found: list[str] = []
    settings = parse_settings(GOOD.encode(), "folder", found)
    assert found == []
    assert settings.name == "area1"
    assert settings.tangent
    assert settings.cameras[0].principal_distance_px == pytest.approx(10_000.0)
    assert settings.cameras[0].distortion.k1 == 0.1
    assert settings.lever_arm_m == (0.1, 0.2, 0.3)
    assert np.allclose(settings.boresight_rad, np.radians([1.0, 2.0, 3.0]))
    assert settings.accuracy.angle_rad == pytest.approx(np.radians(0.005))
    assert settings.assumed_accuracy == ()


@pytest.mark.parametrize(
    ("old", "new", "where", "found", "expected"),
    [
        (
            "angle_unit",
            "angel_unit",
            "block.toml:7, block.angel_unit",
            "an unknown key",
            "angle_unit?",
        ),
        (
            "[accuracy]",
            "[acuracy]",
            "block.toml:25, acuracy",
            "an unknown key",
            "accuracy?",
        ),
        ("k2 = 0.0", "k3 = 0.0", "block.toml:18, camera.distortion.k3", "an unknown key", "k2?"),
        (
            "width_px",
            "width",
            "block.toml:13, camera.width",
            "an unknown key",
            "width_px?",
        ),
        (
            "lever_arm_m",
            "lever_arm",
            "block.toml:21, pos.lever_arm",
            "an unknown key",
            "lever_arm_m?",
        ),
        (
            '"deg"',
            '"degree"',
            "block.toml:7, block.angle_unit",
            "'degree'",
            "deg or rad",
        ),
        ('"px"', '"pixels"', "block.toml:8, block.image_coordinates", "'pixels'", "px or mm;"),
        (
            '"omega-phi-kappa"',
            '"opk"',
            "block.toml:6, block.angles",
            "'opk'",
            "omega-phi-kappa or phi-omega-kappa",
        ),
        (
            '"ellipsoidal"',
            '"normal"',
            "block.toml:5, block.heights",
            "'normal'",
            "ellipsoidal or orthometric",
        ),
        (
            "simulated = false",
            'simulated = "no"',
            "block.toml:9, block.simulated",
            "'no'",
            "true or false",
        ),
        (
            '"EPSG:2154"',
            '"EPSG:4326"',
            "block.toml:3, block.crs",
            "EPSG:4326 (WGS 84) is",
            "",
        ),
        ('"EPSG:2154"', '"EPSG:0"', "block.toml:3, block.crs", "PROJ does not", ""),
        (
            'crs = "EPSG:2154"\n',
            "",
            "block.toml:3, block.frame",
            "tangent without crs",
            "a crs beside",
        ),
        (
            "width_px = 13824\n",
            "",
            "block.toml:11, camera.width_px",
            "nothing",
            "a positive number",
        ),
        (
            "width_px = 13824",
            "width_px = true",
            "block.toml:13, camera.width_px",
            "True",
            "a positive number",
        ),
        (
            "width_px = 13824",
            "width_px = -1",
            "block.toml:13, camera.width_px",
            "-1",
            "a positive number",
        ),
        (
            "height_px = 7680",
            "height_px = nan",
            "block.toml:14, camera.height_px",
            "nan",
            "a positive number",
        ),
        (
            "principal_distance_mm = 120.0\n",
            "",
            "block.toml:11, camera.principal_distance_mm",
            "nothing",
            "a positive number",
        ),
        (
            "pixel_size_mm = 0.012\n",
            "",
            "block.toml:11, camera.pixel_size_mm",
            "nothing",
            "it with principal_distance_mm",
        ),
        (
            "pixel_size_mm = 0.012\n",
            "principal_distance_px = 1e4\npixel_size_mm = 0.012\n",
            "block.toml:17, camera.principal_distance_mm",
            "also principal_distance_px",
            "one",
        ),
        (
            "[6912.0, 3840.0]",
            "[6912.0]",
            "block.toml:17, camera.principal_point_px",
            "[6912.0]",
            "2 finite numbers in",
        ),
        (
            '"radial"',
            '"fisheye"',
            "block.toml:18, camera.distortion.model",
            "'fisheye'",
            "none or radial",
        ),
        (
            '{ model = "radial", k1 = 0.1, k2 = 0.0 }',
            "0.1",
            "block.toml:18, camera.distortion",
            "0.1",
            "a table of",
        ),
        ("k1 = 0.1", "k1 = inf", "block.toml:18, camera.distortion.k1", "inf", "a finite number"),
        (
            "k1 = 0.1",
            f"k1 = {10**400}",
            "block.toml:18, camera.distortion.k1",
            "1000",
            "a finite number",
        ),
        (
            "k1 = 0.1",
            "k1 = 1e10",
            "block.toml:18, camera.distortion.k1",
            "10000000000.0",
            "a finite number",
        ),
        (
            "position_m = 0.05",
            "position_m = 1e-10",
            "block.toml:26, accuracy.position_m",
            "1e-10",
            "a positive number",
        ),
        (
            "position_m = 0.05",
            "position_m = 1e200",
            "block.toml:26, accuracy.position_m",
            "1e+200",
            "a positive number",
        ),
        (
            "mounting_deg = 0",
            "mounting_deg = 90",
            "block.toml:23, pos.mounting_deg",
            "it with omega-phi-kappa",
            "roll-pitch-heading",
        ),
        (
            "position_m = 0.05",
            "position_m = 0",
            "block.toml:26, accuracy.position_m",
            "0",
            "a positive number",
        ),
        ('name = "area1"', "name = 1", "block.toml:2, block.name", "1", "text in quotes"),
        (
            "simulated",
            'geoid = "g.tif"\nsimulated',
            "block.toml:9, block.geoid",
            "a geoid grid",
            "it with crs",
        ),
        (
            "[pos]",
            "pos = 3\n[acc]",
            "block.toml:20, camera.pos",
            "an unknown key",
            "one of width_px,",
        ),
    ],
)
def test_wrong_keys_are_named_with_their_line(old, new, where, found, expected) -> None:
    (finding, *_) = [text for text in findings((old, new)) if parts(text)[0] == where]
    assert_finding(finding, where, found, expected)


@pytest.mark.parametrize("key", ["angles", "angle_unit", "image_coordinates"])
def test_what_cannot_be_guessed_must_be_said(key) -> None:
    line = next(line for line in GOOD.splitlines() if line.startswith(key + " "))
    assert any(f"block.{key}: found nothing" in text for text in findings((line, "")))


@pytest.mark.parametrize("section", ["block", "camera"])
def test_sections_that_are_needed(section) -> None:
    start = GOOD.index(f"[{section}]")
    text = GOOD[:start] + GOOD[GOOD.index("\n\n", start) :]
    found: list[str] = []
    assert parse_settings(text.encode(), "folder", found) is None
    assert any(f"block.toml, {section}: found nothing" in finding for finding in found)


def test_navigation_angles_need_a_crs() -> None:
    found = findings(
        ('crs = "EPSG:2154"\nframe = "tangent"\n', ""), ("omega-phi-kappa", "roll-pitch-heading")
    )
    (finding,) = found
    assert_finding(
        finding, "block.toml:4, block.angles", "roll-pitch-heading without crs", "a crs beside"
    )


def test_millimetres_need_the_pixel_size() -> None:
    found = findings(
        ('image_coordinates = "px"', 'image_coordinates = "mm"'),
        ("pixel_size_mm = 0.012\nprincipal_distance_mm = 120.0", "principal_distance_px = 1e4"),
    )
    assert len(found) == 1
    assert "has no pixel_size_mm" in found[0]


def test_several_cameras_have_different_ids() -> None:
    camera = GOOD[GOOD.index("[camera]") : GOOD.index("[pos]")].replace("[camera]", "[[camera]]")
    text = GOOD.replace(GOOD[GOOD.index("[camera]") : GOOD.index("[pos]")], camera + camera)
    found: list[str] = []
    assert parse_settings(text.encode(), "folder", found) is None
    assert_finding(found[0], "block.toml:11, camera.id", "a camera without")
    assert_finding(found[1], "block.toml:20, camera.id", "a camera without")
    found.clear()
    text = text.replace('name = "DMC"', 'name = "DMC"\nid = "a"')
    assert parse_settings(text.encode(), "folder", found) is None
    (finding,) = found
    assert_finding(finding, "block.toml:23, camera.id", "camera 'a' twice", "once")


def test_toml_that_is_none_is_refused() -> None:
    assert_finding(findings(('"area1"', '"area1'))[0], "block.toml", "no valid TOML")
