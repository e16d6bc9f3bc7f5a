"""block.toml: every key, and what is said about those that are wrong."""

import numpy as np
import pytest

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
    ("old", "new", "expected"),
    [
        (
            "angle_unit",
            "angel_unit",
            "block.toml:7, block.angel_unit: found an unknown key, expected angle_unit?",
        ),
        (
            "[accuracy]",
            "[acuracy]",
            "block.toml:25, acuracy: found an unknown key, expected accuracy?",
        ),
        ("k2 = 0.0", "k3 = 0.0", "block.toml:18, camera.distortion.k3: found an unknown key"),
        (
            "width_px",
            "width",
            "block.toml:13, camera.width: found an unknown key, expected width_px?",
        ),
        ("lever_arm_m", "lever_arm", "block.toml:21, pos.lever_arm: found an unknown key"),
        (
            '"deg"',
            '"degree"',
            "block.toml:7, block.angle_unit: found 'degree', expected deg or rad or gon",
        ),
        ('"px"', '"pixels"', "block.toml:8, block.image_coordinates: found 'pixels'"),
        ('"omega-phi-kappa"', '"opk"', "block.toml:6, block.angles: found 'opk'"),
        ('"ellipsoidal"', '"normal"', "block.toml:5, block.heights: found 'normal'"),
        ("simulated = false", 'simulated = "no"', "block.toml:9, block.simulated: found 'no'"),
        (
            '"EPSG:2154"',
            '"EPSG:4326"',
            "block.toml:3, block.crs: EPSG:4326 (WGS 84) is no map grid",
        ),
        ('"EPSG:2154"', '"EPSG:0"', "block.toml:3, block.crs: PROJ does not know the crs 'EPSG:0'"),
        ('crs = "EPSG:2154"\n', "", "block.toml:3, block.frame: found tangent without crs"),
        ("width_px = 13824\n", "", "block.toml:11, camera.width_px: found nothing"),
        (
            "width_px = 13824",
            "width_px = true",
            "camera.width_px: found True, expected a positive number",
        ),
        (
            "width_px = 13824",
            "width_px = -1",
            "camera.width_px: found -1, expected a positive number",
        ),
        (
            "height_px = 7680",
            "height_px = nan",
            "camera.height_px: found nan, expected a positive number",
        ),
        ("principal_distance_mm = 120.0\n", "", "camera.principal_distance_mm: found nothing"),
        ("pixel_size_mm = 0.012\n", "", "camera.pixel_size_mm: found nothing"),
        (
            "pixel_size_mm = 0.012\n",
            "principal_distance_px = 1e4\npixel_size_mm = 0.012\n",
            "camera.principal_distance_mm: found also principal_distance_px",
        ),
        (
            "[6912.0, 3840.0]",
            "[6912.0]",
            "camera.principal_point_px: found [6912.0], expected 2 finite",
        ),
        ('"radial"', '"fisheye"', "camera.distortion.model: found 'fisheye'"),
        ('{ model = "radial", k1 = 0.1, k2 = 0.0 }', "0.1", "camera.distortion: found 0.1"),
        ("k1 = 0.1", "k1 = inf", "camera.distortion.k1: found inf, expected a finite number"),
        ("k1 = 0.1", f"k1 = {10**400}", "camera.distortion.k1: found 1000"),
        (
            "k1 = 0.1",
            "k1 = 1e10",
            "camera.distortion.k1: found 10000000000.0, expected a finite number of at most 1e+09",
        ),
        (
            "position_m = 0.05",
            "position_m = 1e-10",
            "accuracy.position_m: found 1e-10, expected a positive number from 1e-09",
        ),
        (
            "position_m = 0.05",
            "position_m = 1e200",
            "accuracy.position_m: found 1e+200, expected a positive number from 1e-09 to 1e+09",
        ),
        (
            "mounting_deg = 0",
            "mounting_deg = 90",
            "pos.mounting_deg: found it with omega-phi-kappa",
        ),
        (
            "position_m = 0.05",
            "position_m = 0",
            "accuracy.position_m: found 0, expected a positive",
        ),
        ('name = "area1"', "name = 1", "block.name: found 1, expected text in quotes"),
        ("simulated", 'geoid = "g.tif"\nsimulated', "block.geoid: found a geoid grid"),
        ("[pos]", "pos = 3\n[acc]", "pos"),
    ],
)
def test_wrong_keys_are_named_with_their_line(old, new, expected) -> None:
    found = findings((old, new))
    assert any(expected in text for text in found), found


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
    assert found == [
        "block.toml:4, block.angles: found roll-pitch-heading without crs, expected a crs beside it"
    ]


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
    assert "block.toml:11, camera.id: found a camera without id" in found[0]
    assert "block.toml:20, camera.id: found a camera without id" in found[1]
    found.clear()
    text = text.replace('name = "DMC"', 'name = "DMC"\nid = "a"')
    assert parse_settings(text.encode(), "folder", found) is None
    assert found == ["block.toml:23, camera.id: found camera 'a' twice, expected once"]


def test_toml_that_is_none_is_refused() -> None:
    assert findings(('"area1"', '"area1'))[0].startswith("block.toml: found no valid TOML")
