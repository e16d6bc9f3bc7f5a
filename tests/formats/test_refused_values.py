"""Columns, numbers, ids and positions that must be refused, and what is said then."""

import struct

import numpy as np
import pandas as pd
import pytest
from block_folders import findings, refused, set_cell
from finding_parts import assert_finding, parts
from perfect_block import edit, perfect_block, written

from posstats.errors import BlockFormatError
from posstats.formats.block_folder import read_block


def test_control_characters_in_ids_are_refused(folder) -> None:
    set_cell(folder, "orientations.csv", 1, "strip", "a\x1b[31m")
    refused(folder, "orientations.csv:3, strip", "without control characters")


@pytest.mark.parametrize(
    ("name", "column"),
    [
        *(
            ("orientations.csv", c)
            for c in ("image", "strip", "x", "y", "z", "omega", "phi", "kappa")
        ),
        *(("tie_points.csv", c) for c in ("point", "image", "x", "y")),
        *(("ground_points.csv", c) for c in ("point", "x", "y", "z", "role")),
        *(("adjusted.csv", c) for c in ("image", "x", "y", "z", "omega", "phi", "kappa")),
    ],
)
def test_missing_columns_are_named(folder, name, column) -> None:
    pd.read_csv(folder / name, dtype=str).drop(columns=column).to_csv(folder / name, index=False)
    refused(folder, f"{name}:1, {column}: found no such")


@pytest.mark.parametrize(
    "value", ["", "nan", "inf", "-inf", "1e400", "12,5", "abc", "0x10", "1_000", "\u0661"]
)
@pytest.mark.parametrize(
    ("name", "column"),
    [
        ("orientations.csv", "time_s"),
        ("orientations.csv", "y"),
        ("orientations.csv", "phi"),
        ("tie_points.csv", "x"),
        ("ground_points.csv", "z"),
        ("adjusted.csv", "kappa"),
    ],
)
def test_what_is_no_finite_number_is_refused(folder, name, column, value) -> None:
    set_cell(folder, name, 2, column, value)
    shown = repr(value) if value else "nothing"
    refused(folder, f"{name}:4, {column}: found {shown}, expected", "finite")


def test_line_numbers_count_blank_lines_and_lines_in_quotes(folder) -> None:
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table["remark"] = "two\nlines"
    table.loc[2, "time_s"] = "oops"
    table.to_csv(folder / "orientations.csv", index=False)
    edit(folder, "orientations.csv", ("image,", "\nimage,"), ("\n1_002", "\n\n\n1_002"))
    refused(folder, "orientations.csv:9, time_s: found 'oops'")


def test_rows_of_another_length_are_refused(folder) -> None:
    edit(folder, "tie_points.csv", ("\nP", "\nP0000,1_000,1.5,12,5\n\nshort\nP"))
    found = findings(folder)
    assert_finding(found[0], "tie_points.csv:2", "5 values", "4; decimal commas?")
    assert parts(found[1]) == ("tie_points.csv:4", "1 values", "4")


def test_a_column_twice_is_refused(folder) -> None:
    edit(folder, "tie_points.csv", ("point,image,x,y", "point,image,x,x"))
    refused(folder, "tie_points.csv:1, x: found", "twice")


def test_an_image_twice_is_refused(folder) -> None:
    set_cell(folder, "orientations.csv", 3, "image", "1_000")
    found = findings(folder)
    again = "image '1_000' again (orientations.csv:2, image)"
    assert_finding(found[0], "orientations.csv:5, image", again)


def test_a_point_twice_in_one_image_is_refused(folder) -> None:
    lines = (folder / "tie_points.csv").read_text().splitlines()
    (folder / "tie_points.csv").write_text("\n".join([*lines, lines[3]]) + "\n")
    point, image = lines[3].split(",")[:2]
    refused(
        folder,
        f"tie_points.csv:{len(lines) + 1}, point: found point {point!r}",
        f"again in image {image!r}",
        "(tie_points.csv:4, point)",
    )


@pytest.mark.parametrize("name", ["tie_points.csv", "adjusted.csv"])
def test_unknown_images_are_refused(folder, name) -> None:
    set_cell(folder, name, 1, "image", "unknown")
    refused(folder, f"{name}:3, image: found ", "'unknown'")


@pytest.mark.parametrize(
    ("name", "column"),
    [
        ("orientations.csv", "image"),
        ("orientations.csv", "strip"),
        ("tie_points.csv", "point"),
        ("tie_points.csv", "image"),
        ("ground_points.csv", "point"),
    ],
)
def test_empty_ids_are_refused(folder, name, column) -> None:
    set_cell(folder, name, 1, column, " ")
    assert any(f"{name}:3, {column}: found nothing" in each for each in findings(folder))


def test_cameras_of_images_must_be_known(folder) -> None:
    edit(folder, "block.toml", ("[camera]", "[[camera]]\nid = 'a'"))
    text = (folder / "block.toml").read_text()
    second = text[text.index("[[camera]]") : text.index("[accuracy]")].replace("'a'", "'b'")
    (folder / "block.toml").write_text(text + second)
    refused(folder, "orientations.csv:1, camera: found no")
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table.assign(camera=["a", "b"] * 3 + ["c", "a"]).to_csv(
        folder / "orientations.csv", index=False
    )
    refused(folder, "orientations.csv:8, camera: found camera 'c'", "expected 'a' or 'b'")


@pytest.mark.parametrize(
    ("column", "value"), [("x", "-692"), ("x", "14516"), ("y", "-385"), ("y", "8065")]
)
def test_coordinates_far_outside_the_image_are_refused(folder, column, value) -> None:
    set_cell(folder, "tie_points.csv", 0, column, value)
    refused(folder, f"tie_points.csv:2, {column}: found {value} px", "13824 x 7680 px")


@pytest.mark.parametrize(
    ("column", "value"), [("x", "-691"), ("x", "14515"), ("y", "-384"), ("y", "8064")]
)
def test_coordinates_a_little_outside_the_image_are_read(folder, column, value) -> None:
    set_cell(folder, "tie_points.csv", 0, column, value)
    read_block(folder)


def test_degrees_given_as_radians_are_noticed(folder) -> None:
    (folder / "adjusted.csv").unlink()
    edit(folder, "block.toml", ('angle_unit = "deg"', 'angle_unit = "rad"'))
    found = findings(folder)
    assert len(found) == 4
    assert all("kappa" in text and "given as radians?" in text for text in found)


def test_sigmas_are_positive(folder) -> None:
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table.assign(sigma_z=["0.1"] * 6 + ["0", "x"]).to_csv(folder / "orientations.csv", index=False)
    found = findings(folder)
    assert any("orientations.csv:9, sigma_z: found 'x'" in each for each in found)
    assert any("orientations.csv:8, sigma_z: found 0" in each for each in found)


def test_ground_points_have_a_role_and_stand_once(folder) -> None:
    set_cell(folder, "ground_points.csv", 1, "role", "Check")
    set_cell(folder, "ground_points.csv", 3, "sigma_z", "-1")
    first = pd.read_csv(folder / "ground_points.csv", dtype=str).point[0]
    set_cell(folder, "ground_points.csv", 4, "point", first)
    found = findings(folder)
    assert [parts(each)[:2] for each in found] == [
        ("ground_points.csv:3, role", "'Check'"),
        ("ground_points.csv:5, sigma_z", "-1"),
        ("ground_points.csv:6, point", f"point {first!r} again"),
    ]


def test_all_findings_are_kept_and_twenty_are_shown(folder) -> None:
    table = pd.read_csv(folder / "tie_points.csv", dtype=str)
    table.loc[:29, "x"] = "bad"
    table.to_csv(folder / "tie_points.csv", index=False)
    set_cell(folder, "orientations.csv", 0, "z", "bad")
    with pytest.raises(BlockFormatError) as error:
        read_block(folder)
    assert len(error.value.findings) == 31
    assert str(error.value).endswith("... and 11 more")


def test_a_geoid_grid_beside_the_block_turns_heights_ellipsoidal(tmp_path) -> None:
    folder = written(perfect_block("EPSG:32631"), tmp_path)
    ellipsoidal = read_block(folder).orientations.position_m
    edit(folder, "block.toml", ('"ellipsoidal"', '"orthometric"\ngeoid = "geoid.gtx"'))
    refused(folder, "geoid.gtx: ", "(No such file")
    (folder / "geoid.gtx").write_bytes(b"no grid")
    refused(folder, "block.crs: PROJ", "geoid.gtx")
    header = struct.pack(">4d2i", 40.0, 0.0, 4.0, 4.0, 5, 5)
    (folder / "geoid.gtx").write_bytes(header + np.full(25, 50.0).astype(">f4").tobytes())
    block = read_block(folder)
    assert np.allclose(block.orientations.position_m[:, 2] - ellipsoidal[:, 2], 50.0, atol=1e-3)
    assert "geoid.gtx" in dict(block.inputs)
    assert block.notices == ()
    elsewhere = header[:8] + struct.pack(">d", 90.0) + header[16:] + bytes(100)
    (folder / "elsewhere.gtx").write_bytes(elsewhere)
    edit(folder, "block.toml", ("geoid.gtx", "elsewhere.gtx"))
    assert all("EPSG:32631 or its geoid" in text for text in findings(folder))


def test_positions_outside_the_crs_are_refused(tmp_path) -> None:
    folder = written(perfect_block("EPSG:32631"), tmp_path)
    set_cell(folder, "ground_points.csv", 2, "x", "9e8")
    refused(folder, "ground_points.csv:4, x: found", "EPSG:32631")


@pytest.mark.parametrize(
    ("column", "value", "expected"),
    [
        ("x", "1e12", "at most 1e+09"),
        ("z", "-1e15", "at most 1e+09"),
        ("omega", "1e20", "at most 1e+06"),
        ("time_s", "1.7e12", "milliseconds?"),
        ("sigma_x", "1e300", "at most 1e+09"),
    ],
)
def test_numbers_too_large_to_be_computed_with_are_refused(folder, column, value, expected) -> None:
    set_cell(folder, "orientations.csv", 2, column, value)
    if column.startswith("sigma"):
        table = pd.read_csv(folder / "orientations.csv", dtype=str)
        table.assign(sigma_x=value).head(3).to_csv(folder / "orientations.csv", index=False)
    assert any(f"orientations.csv:4, {column}: " in f and expected in f for f in findings(folder))


def test_a_strip_must_not_be_called_as_the_scope_of_all_strips(folder) -> None:
    """Results keep block and strips apart by the name of their scope."""
    set_cell(folder, "orientations.csv", 2, "strip", "block")
    refused(folder, "orientations.csv:4, strip: found 'block'")
