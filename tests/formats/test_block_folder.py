"""Block folders that must be read, and those that must be refused, with what is said then."""

import errno
import hashlib
import os
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet
import pytest
from helpers import shared_path
from perfect_block import edit, largest_parallax_mm, perfect_block, written

from posstats.block.camera import Distortion
from posstats.block.image_pairs import stereo_models
from posstats.errors import BlockFormatError
from posstats.formats.block_folder import read_block


@pytest.fixture
def folder(tmp_path) -> Path:
    """A small Cartesian block of perfect data."""
    return written(perfect_block(None), tmp_path / "block")


def findings(folder: Path) -> tuple[str, ...]:
    with pytest.raises(BlockFormatError) as refused:
        read_block(folder)
    return refused.value.findings


def refused(folder: Path, *expected: str) -> None:
    """There is one finding, and it holds the expected pieces."""
    found = findings(folder)
    assert len(found) == 1, found
    for piece in expected:
        assert piece in found[0]


def set_cell(folder: Path, name: str, row: int, column: str, value: str) -> None:
    table = pd.read_csv(folder / name, dtype=str, keep_default_na=False)
    table.loc[row, column] = value
    table.to_csv(folder / name, index=False)


# Real blocks


@pytest.mark.parametrize(
    ("name", "n_images", "n_warnings"), [("ign-fd1305", 68, 2), ("seneca", 81, 2)]
)
def test_real_blocks_are_read(name, n_images, n_warnings) -> None:
    block = read_block(shared_path("data", name))
    assert len(block.orientations) == n_images
    assert len(block.warnings) == n_warnings
    for file, digest in block.inputs:
        content = shared_path("data", name, file).read_bytes()
        assert hashlib.sha256(content).hexdigest() == digest


def test_ign_adjusted_orientation_leaves_the_published_parallax() -> None:
    """Oracle: 0.214 px, mean over the 53 models of six or more points (data README: 0.21)."""
    block = read_block(shared_path("data", "ign-fd1305"))
    models = stereo_models(block).with_orientations(block.adjusted)
    squares = np.add.reduceat(models.y_parallax_px() ** 2, models.pairs.offsets[:-1])
    rms = np.sqrt(squares / models.pairs.n_points)[models.pairs.n_points >= 6]
    assert len(rms) == 53
    assert rms.mean() == pytest.approx(0.2144, abs=2e-4)


# What changes nothing


def test_order_of_rows_changes_nothing(folder) -> None:
    before = read_block(folder)
    for name in ("orientations", "tie_points", "ground_points", "adjusted"):
        table = pd.read_csv(folder / f"{name}.csv", dtype=str, keep_default_na=False)
        table.sample(frac=1.0, random_state=7).to_csv(folder / f"{name}.csv", index=False)
    after = read_block(folder)
    for part in ("orientations", "tie_points", "ground_points", "adjusted"):
        for name, values in vars(getattr(before, part)).items():
            assert np.array_equal(vars(getattr(after, part))[name], values, equal_nan=False) or (
                np.array_equal(np.isnan(values), np.isnan(vars(getattr(after, part))[name]))
            )
    assert [w for w in after.warnings if "out of time order" not in w] == list(before.warnings)
    assert any("rows of orientations out of time order" in w for w in after.warnings)


def test_byte_order_mark_windows_lines_and_extra_columns_change_nothing(folder) -> None:
    before = read_block(folder)
    for path in folder.iterdir():
        text = path.read_text(encoding="utf-8")
        if path.suffix == ".csv":
            head, *rows = text.splitlines()
            text = "\n".join([head + ",remark", *(row + ',"a, ""b"""' for row in rows), ""])
        path.write_bytes(b"\xef\xbb\xbf" + text.replace("\n", "\r\n").encode())
    after = read_block(folder)
    assert np.array_equal(after.tie_points.xy_px, before.tie_points.xy_px)
    assert np.array_equal(after.orientations.position_m, before.orientations.position_m)
    assert after.orientations.image[0] == "1_000"


def test_parquet_is_read_like_csv(folder) -> None:
    before = read_block(folder)
    for path in folder.glob("*.csv"):
        types = dict.fromkeys(("image", "strip", "point", "role"), str)
        pd.read_csv(path, dtype=types).to_parquet(path.with_suffix(".parquet"))
        path.unlink()
    after = read_block(folder)
    assert np.array_equal(after.tie_points.xy_px, before.tie_points.xy_px)
    assert np.array_equal(after.orientations.angles_rad, before.orientations.angles_rad)
    assert np.array_equal(
        after.ground_points.sigma_xy_m, before.ground_points.sigma_xy_m, equal_nan=True
    )
    assert after.warnings == before.warnings


def test_ids_are_text(folder) -> None:
    """Leading zeros, commas, quotes and HTML stay as they are, and 0012 is not 12."""
    names = {
        "1_000": "0012",
        "1_001": "12",
        "1_002": 'a, "b"',
        "1_003": "<script>&",
        "2_000": "1e3",
    }
    for name in ("orientations", "tie_points", "adjusted"):
        table = pd.read_csv(folder / f"{name}.csv", dtype=str, keep_default_na=False)
        table["image"] = table["image"].replace(names)
        table.to_csv(folder / f"{name}.csv", index=False)
    block = read_block(folder)
    assert set(names.values()) <= set(block.orientations.image)
    assert largest_parallax_mm(block) < 1e-6


def test_millimetres_are_x_right_y_up_from_the_principal_point(folder) -> None:
    before = read_block(folder)
    camera = before.cameras[0]
    table = pd.read_csv(folder / "tie_points.csv", dtype={"image": str, "point": str})
    table["x"] = (table["x"] - camera.principal_point_px[0]) * camera.pixel_size_mm
    table["y"] = (camera.principal_point_px[1] - table["y"]) * camera.pixel_size_mm
    table.to_csv(folder / "tie_points.csv", index=False)
    edit(folder, "block.toml", ('image_coordinates = "px"', 'image_coordinates = "mm"'))
    assert np.allclose(read_block(folder).tie_points.xy_px, before.tie_points.xy_px, atol=1e-9)


def test_control_characters_in_ids_are_refused(folder) -> None:
    set_cell(folder, "orientations.csv", 1, "strip", "a\x1b[31m")
    refused(folder, "orientations.csv:3, strip", "without control characters")


@pytest.mark.parametrize(
    "distortion",
    [
        Distortion("radial", -0.08, 0.03),
        Distortion("radial", -0.45),  # the corners come in by a quarter
        Distortion("brown", -0.08, 0.03, 1e-3, 5e-4, -4e-4),
        Distortion("brown", -0.5, 0.1, 0.02, 2e-3, -2e-3),
    ],
)
def test_distortion_is_taken_off(tmp_path, distortion) -> None:
    block = read_block(written(perfect_block("EPSG:2154", distortion=distortion), tmp_path))
    assert block.cameras[0].distortion == distortion
    assert largest_parallax_mm(block) < 1e-6


def test_sigma_columns_are_taken_where_they_are_filled(folder) -> None:
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table["sigma_x"] = ["0.5", "", "nan", "0.25", "", "", "", "0.125"]
    table["sigma_kappa"] = "0.01"
    table.to_csv(folder / "orientations.csv", index=False)
    orientations = read_block(folder).orientations
    assert np.array_equal(orientations.sigma_position_m[:4, 0], [0.5, 0.05, 0.05, 0.25])
    assert np.all(orientations.sigma_position_m[:, 1] == 0.05)
    assert np.allclose(orientations.sigma_angles_rad, np.radians([0.005, 0.005, 0.01]))


# Times


def with_times(folder: Path, column: str, values: list[str]) -> Path:
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table = table.rename(columns={"time_s": column})
    table[column] = values
    table.to_csv(folder / "orientations.csv", index=False)
    return folder


GPS_TIMES = ["604770", "604780", "604790", "0", "500", "510.5", "520", "530"]


def test_gps_seconds_count_on_over_the_end_of_the_week(folder) -> None:
    times = read_block(with_times(folder, "time_gps_s", GPS_TIMES)).orientations.time_s
    assert np.array_equal(times, [604770, 604780, 604790, 604800, 605300, 605310.5, 605320, 605330])


def test_gps_seconds_of_mixed_rows_count_on_too(folder) -> None:
    with_times(folder, "time_gps_s", GPS_TIMES)
    expected = read_block(folder).orientations
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    for seed in range(5):
        table.sample(frac=1.0, random_state=seed).to_csv(folder / "orientations.csv", index=False)
        mixed = read_block(folder).orientations
        assert np.array_equal(mixed.time_s, expected.time_s)
        assert np.array_equal(mixed.image, expected.image)


def test_a_pause_of_days_in_rows_of_flight_order_is_no_new_week(folder) -> None:
    times = [str(t) for t in (100, 110, 120, 130, 500000, 500010, 500020, 500030)]
    block = read_block(with_times(folder, "time_gps_s", times))
    assert np.array_equal(block.orientations.time_s, np.array(times, dtype=float))


def test_gps_seconds_lie_within_a_week(folder) -> None:
    with_times(folder, "time_gps_s", ["604800", "-1", *GPS_TIMES[2:]])
    found = findings(folder)
    assert len(found) == 2
    assert "orientations.csv:2, time_gps_s: found 604800" in found[0]
    assert "orientations.csv:3, time_gps_s: found -1" in found[1]


def test_utc_is_counted_from_midnight_before_the_first_exposure(folder) -> None:
    moments = [
        "2024-05-17T23:59:50Z",
        "2024-05-17T23:59:59.125",
        "2024-05-18T02:00:05.250+02:00",
        "2024-05-18 00:00:10",
        *(f"2024-05-18T00:10:{k}0.000001Z" for k in range(4)),
    ]
    times = read_block(with_times(folder, "time_utc", moments)).orientations.time_s
    expected = [86390, 86399.125, 86405.25, 86410, *(87000.000001 + 10 * np.arange(4))]
    assert np.allclose(times, expected, rtol=0, atol=1e-9)


@pytest.mark.parametrize("moment", ["2024-05-17", "yesterday", "", "2024-13-01T00:00:00", "12345"])
def test_what_is_no_moment_is_refused(folder, moment) -> None:
    good = [f"2024-05-17T00:00:{k}0Z" for k in range(6)]
    with_times(folder, "time_utc", [good[0], moment, *good])
    refused(folder, "orientations.csv:3, time_utc", repr(moment), "ISO 8601")


def test_one_kind_of_time_is_expected(folder) -> None:
    with_times(folder, "when", ["1"] * 8)
    refused(folder, "no time column", "time_s, time_gps_s, time_utc")
    edit(folder, "orientations.csv", (",when,", ",time_s,"))
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table.assign(time_gps_s="1").to_csv(folder / "orientations.csv", index=False)
    refused(folder, "found time_s and time_gps_s")


# Files that cannot be read


def test_a_missing_folder_or_a_file_is_no_block(folder) -> None:
    refused(folder / "nowhere", "found nothing, expected a block folder")
    refused(folder / "block.toml", "found a file, expected a block folder")


@pytest.mark.parametrize("name", ["block.toml", "orientations.csv", "tie_points.csv"])
def test_missing_files_are_named(folder, name) -> None:
    (folder / name).unlink()
    refused(folder, name.removesuffix(".csv"), "expected")


@pytest.mark.parametrize(
    "name",
    ["block.toml", "orientations.csv", "tie_points.csv", "ground_points.csv", "adjusted.csv"],
)
@pytest.mark.parametrize(
    ("content", "what"),
    [
        (b"", "empty file"),
        (b"\r\n \n", "empty file"),
        (b"\xff\xfe\x00binary\x80", "not UTF-8"),
        (b"\x89PNG\r\n\x1a\n\0\0", "not UTF-8"),
        (b"point,image\n\0\0,1\n", ""),
        (b'"', ""),
        (b'a,"b\n', ""),
        (b"\xef\xbb\xbf", ""),
        (b"point,image,x,y,z,strip,time_s,omega,phi,kappa,role\n", ""),
    ],
)
def test_files_that_are_no_tables_are_refused(folder, name, content, what) -> None:
    (folder / name).write_bytes(content)
    found = findings(folder)
    assert all(text.startswith(name) for text in found), found
    assert what in found[0]


@pytest.mark.parametrize("content", [b"", b"PAR1", b"no parquet at all", b"PAR1" + b"\0" * 50])
def test_broken_parquet_is_refused(folder, content) -> None:
    (folder / "tie_points.csv").unlink()
    (folder / "tie_points.parquet").write_bytes(content)
    refused(folder, "tie_points.parquet: found")


def test_parquet_with_numbers_for_ids_or_text_for_numbers_is_refused(folder) -> None:
    table = pd.read_csv(folder / "tie_points.csv", dtype={"image": str, "point": str})
    (folder / "tie_points.csv").unlink()
    table["x"] = table["x"].astype(object).where(table.index != 4, None).astype(float)
    table["y"] = table["y"].astype(str).where(table.index != 2, "12,5")
    table.assign(point=np.arange(len(table)) / 2).to_parquet(folder / "tie_points.parquet")
    found = findings(folder)
    assert "tie_points.parquet, point: found values of type double, expected text" in found
    assert any("tie_points.parquet, row 5, x: found" in text for text in found)
    assert any("tie_points.parquet, row 3, y: found '12,5'" in text for text in found)


def test_a_folder_in_place_of_a_file_is_refused(folder) -> None:
    for name in ("tie_points.csv", "block.toml"):
        (folder / name).unlink()
        (folder / name).mkdir()
    found = findings(folder)
    assert found == (
        "block.toml: found a folder, expected a file",
        "tie_points.csv: found a folder, expected a file",
    )


def test_an_unreadable_file_is_refused(folder, monkeypatch) -> None:
    read_bytes = Path.read_bytes

    def denied(path: Path) -> bytes:
        if path.name == "tie_points.csv":
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
        return read_bytes(path)

    monkeypatch.setattr(Path, "read_bytes", denied)
    refused(folder, "tie_points.csv: cannot be read (Permission denied)")


def test_csv_and_parquet_of_one_table_are_refused(folder) -> None:
    pd.read_csv(folder / "adjusted.csv").to_parquet(folder / "adjusted.parquet")
    refused(folder, "found both adjusted.csv and adjusted.parquet")


# Columns, numbers and ids


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
    refused(folder, f"{name}:1, {column}: found no such column")


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
    refused(folder, f"{name}:4, {column}: found {shown}, expected a finite number")


@pytest.mark.parametrize("value", ["+1.5", " 1.5", "1.5e0", "15.E-1", "1.50"])
def test_all_ways_of_writing_a_number_are_read(folder, value) -> None:
    set_cell(folder, "orientations.csv", 2, "phi", value)
    assert read_block(folder).source is not None


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
    assert found[0] == "tie_points.csv:2: found 5 values, expected 4; decimal commas?"
    assert found[1] == "tie_points.csv:4: found 1 values, expected 4"


def test_a_column_twice_is_refused(folder) -> None:
    edit(folder, "tie_points.csv", ("point,image,x,y", "point,image,x,x"))
    refused(folder, "tie_points.csv:1, x: found the column twice")


def test_an_image_twice_is_refused(folder) -> None:
    set_cell(folder, "orientations.csv", 3, "image", "1_000")
    found = findings(folder)
    assert (
        "orientations.csv:5, image: found image '1_000' again (orientations.csv:2, image)"
        in found[0]
    )


def test_a_point_twice_in_one_image_is_refused(folder) -> None:
    lines = (folder / "tie_points.csv").read_text().splitlines()
    (folder / "tie_points.csv").write_text("\n".join([*lines, lines[3]]) + "\n")
    point, image = lines[3].split(",")[:2]
    refused(
        folder,
        f"tie_points.csv:{len(lines) + 1}, point: found point {point!r} again in image {image!r}",
        "(tie_points.csv:4, point)",
    )


@pytest.mark.parametrize("name", ["tie_points.csv", "adjusted.csv"])
def test_unknown_images_are_refused(folder, name) -> None:
    set_cell(folder, name, 1, "image", "unknown")
    refused(folder, f"{name}:3, image: found image 'unknown'")


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
    assert f"{name}:3, {column}: found nothing, expected an id" in findings(folder)


def test_cameras_of_images_must_be_known(folder) -> None:
    edit(folder, "block.toml", ("[camera]", "[[camera]]\nid = 'a'"))
    text = (folder / "block.toml").read_text()
    second = text[text.index("[[camera]]") : text.index("[accuracy]")].replace("'a'", "'b'")
    (folder / "block.toml").write_text(text + second)
    refused(folder, "orientations.csv:1, camera: found no such column")
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table.assign(camera=["a", "b"] * 3 + ["c", "a"]).to_csv(
        folder / "orientations.csv", index=False
    )
    refused(folder, "orientations.csv:8, camera: found camera 'c', expected 'a' or 'b'")


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
    assert all("kappa" in text and "degrees given as radians?" in text for text in found)


def test_sigmas_are_positive(folder) -> None:
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table.assign(sigma_z=["0.1"] * 6 + ["0", "x"]).to_csv(folder / "orientations.csv", index=False)
    found = findings(folder)
    assert "orientations.csv:9, sigma_z: found 'x', expected a finite number" in found
    assert "orientations.csv:8, sigma_z: found 0, expected a positive number" in found


def test_ground_points_have_a_role_and_stand_once(folder) -> None:
    set_cell(folder, "ground_points.csv", 1, "role", "Check")
    set_cell(folder, "ground_points.csv", 3, "sigma_z", "-1")
    first = pd.read_csv(folder / "ground_points.csv", dtype=str).point[0]
    set_cell(folder, "ground_points.csv", 4, "point", first)
    found = findings(folder)
    assert found == (
        "ground_points.csv:3, role: found 'Check', expected control or check",
        "ground_points.csv:5, sigma_z: found -1, expected no negative number",
        f"ground_points.csv:6, point: found point {first!r} again, expected once",
    )


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
    refused(folder, "geoid.gtx: cannot be read (No such file")
    (folder / "geoid.gtx").write_bytes(b"no grid")
    refused(folder, "block.crs: PROJ cannot read the geoid grid geoid.gtx")
    header = struct.pack(">4d2i", 40.0, 0.0, 4.0, 4.0, 5, 5)
    (folder / "geoid.gtx").write_bytes(header + np.full(25, 50.0).astype(">f4").tobytes())
    block = read_block(folder)
    assert np.allclose(block.orientations.position_m[:, 2] - ellipsoidal[:, 2], 50.0, atol=1e-3)
    assert "geoid.gtx" in dict(block.inputs)
    assert block.warnings == ()
    elsewhere = header[:8] + struct.pack(">d", 90.0) + header[16:] + bytes(100)
    (folder / "elsewhere.gtx").write_bytes(elsewhere)
    edit(folder, "block.toml", ("geoid.gtx", "elsewhere.gtx"))
    assert all("outside EPSG:32631 or its geoid grid" in text for text in findings(folder))


def test_positions_outside_the_crs_are_refused(tmp_path) -> None:
    folder = written(perfect_block("EPSG:32631"), tmp_path)
    set_cell(folder, "ground_points.csv", 2, "x", "9e8")
    refused(folder, "ground_points.csv:4, x: found a position outside EPSG:32631")


# Warnings


def test_a_perfect_block_gives_no_warning(folder) -> None:
    assert read_block(folder).warnings == ()


def test_oddities_are_counted_and_named(folder) -> None:
    table = pd.read_csv(folder / "tie_points.csv", dtype=str)
    table = table[table.image != "1_003"]
    surveyed = set(pd.read_csv(folder / "ground_points.csv", dtype=str).point)
    free = [point for point in dict.fromkeys(table.point) if point not in surveyed]
    once = table.point.isin(free[:6]) & table.duplicated("point")
    table[~once].to_csv(folder / "tie_points.csv", index=False)
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table.loc[7, "strip"] = "9"
    table.iloc[[1, 0, *range(2, 8)]].to_csv(folder / "orientations.csv", index=False)
    warnings = read_block(folder).warnings
    assert "1 row of orientations out of time order: 1_000." in warnings
    assert "1 image without tie points: 1_003." in warnings
    assert "1 strip of one image: 9." in warnings
    assert any(
        "stereo model with fewer than 6 common points" in w and "1_002 - 1_003" in w
        for w in warnings
    )
    seen_once = next(w for w in warnings if "seen in one image only" in w)
    assert f"{free[0]}, {free[1]}, " in seen_once
    assert seen_once.endswith("more.")


def test_assumed_accuracy_is_named(folder) -> None:
    text = (folder / "block.toml").read_text()
    (folder / "block.toml").write_text(
        text[: text.index("[accuracy]")] + "[accuracy]\nposition_m = 0.1\n"
    )
    block = read_block(folder)
    assert block.accuracy.position_m == 0.1
    assert block.warnings == (
        "The accuracy is not stated in full; assumed: angle_deg = 0.005, image_px = 0.2.",
    )


def test_orthometric_heights_without_geoid_are_named(tmp_path) -> None:
    folder = written(perfect_block("EPSG:2154"), tmp_path)
    edit(folder, "block.toml", ('"ellipsoidal"', '"orthometric"'))
    assert "taken as ellipsoidal" in read_block(folder).warnings[0]


def test_ground_points_without_measurements_are_named(tmp_path) -> None:
    block = perfect_block(None)
    renamed = block.ground_points.point.copy()
    renamed[0] = "lost"
    block = replace(block, ground_points=replace(block.ground_points, point=renamed))
    warnings = read_block(written(block, tmp_path)).warnings
    assert warnings == ("1 ground point measured in fewer than two images: lost.",)


# Tables of other programs, and values that no survey has


@pytest.mark.parametrize(
    ("separator", "name"), [(";", "semicolons"), ("\t", "tabs"), ("|", "bars"), (" ", "spaces")]
)
@pytest.mark.parametrize("decimal", [".", ","])
def test_another_separator_is_named_once(folder, separator, name, decimal) -> None:
    path = folder / "tie_points.csv"
    path.write_text(path.read_text().replace(",", separator).replace(".", decimal))
    refused(folder, f"tie_points.csv:1: found columns separated by {name}, expected commas")


def test_decimal_commas_are_named(folder) -> None:
    set_cell(folder, "orientations.csv", 1, "phi", "0,25")
    refused(folder, "orientations.csv:3, phi: found '0,25'", "with a decimal point")
    path = folder / "tie_points.csv"
    head, *rows = path.read_text().splitlines()
    path.write_text("\n".join([head, *(row.replace(".", ",") for row in rows)]))
    assert "tie_points.csv:2: found 6 values, expected 4; decimal commas?" in findings(folder)


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


def as_parquet(folder: Path, stem: str, column: str, kind: pa.DataType) -> None:
    """The table as Parquet, one column of another type."""
    types = dict.fromkeys(("image", "strip", "point", "role"), str)
    table = pa.Table.from_pandas(pd.read_csv(folder / f"{stem}.csv", dtype=types))
    number = table.column_names.index(column)
    values = table[column].cast(kind) if kind != pa.bool_() else pa.array([True] * len(table))
    pyarrow.parquet.write_table(
        table.set_column(number, column, values), folder / f"{stem}.parquet"
    )
    (folder / f"{stem}.csv").unlink()


@pytest.mark.parametrize("kind", [pa.large_string(), pa.string_view()])
def test_all_kinds_of_parquet_text_are_read(folder, kind) -> None:
    before = read_block(folder)
    as_parquet(folder, "tie_points", "point", kind)
    assert np.array_equal(read_block(folder).tie_points.point_id, before.tie_points.point_id)


@pytest.mark.parametrize("column", ["point", "image"])
def test_ids_of_a_type_that_is_no_text_are_one_finding(folder, column) -> None:
    as_parquet(folder, "tie_points", column, pa.binary())
    refused(folder, f"tie_points.parquet, {column}: found values of type binary, expected text")


def test_truth_values_are_no_numbers(folder) -> None:
    as_parquet(folder, "orientations", "omega", pa.bool_())
    found = findings(folder)
    assert found[0] == "orientations.parquet, row 1, omega: found True, expected a finite number"


def test_an_empty_block_toml_is_no_table(folder) -> None:
    (folder / "block.toml").write_bytes(b"")
    refused(folder, "block.toml: found an empty file, expected the settings of the block")


def test_models_without_base_are_named(folder) -> None:
    """A hovering drone: two exposures at one place, and two nearer than the positions are known."""
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table.loc[1, ["x", "y", "z"]] = table.loc[0, ["x", "y", "z"]].to_numpy()
    table.loc[5, ["x", "y", "z"]] = table.loc[4, ["x", "y", "z"]].to_numpy()
    table.loc[5, "x"] = str(float(table.loc[4, "x"]) + 0.03)  # stated accuracy: 0.05 m
    table.to_csv(folder / "orientations.csv", index=False)
    assert read_block(folder).warnings == (
        "2 stereo models with a base shorter than the accuracy of their positions:"
        " 1_000 - 1_001, 2_000 - 2_001.",
    )
