"""Block folders that must be read, and what must change nothing in them."""

import hashlib

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.parquet
import pytest
from block_folders import as_parquet, set_cell
from helpers import shared_path
from perfect_block import edit, largest_parallax_mm, perfect_block, written

from posstats.block.camera import Distortion
from posstats.block.image_pairs import stereo_models
from posstats.formats.block_folder import read_block


@pytest.mark.parametrize(
    ("name", "n_images", "n_notices"), [("ign-fd1305", 68, 2), ("seneca", 81, 2)]
)
def test_real_blocks_are_read(name, n_images, n_notices) -> None:
    block = read_block(shared_path("data", name))
    assert len(block.orientations) == n_images
    assert len(block.notices) == n_notices
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
    assert after.notices[0].code == "rows_out_of_order"
    assert after.notices[1:] == before.notices


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
    assert after.notices == before.notices


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


@pytest.mark.parametrize("value", ["+1.5", " 1.5", "1.5e0", "15.E-1", "1.50"])
def test_all_ways_of_writing_a_number_are_read(folder, value) -> None:
    set_cell(folder, "orientations.csv", 2, "phi", value)
    assert read_block(folder).source is not None


@pytest.mark.parametrize("kind", [pa.large_string(), pa.string_view()])
def test_all_kinds_of_parquet_text_are_read(folder, kind) -> None:
    before = read_block(folder)
    as_parquet(folder, "tie_points", "point", kind)
    assert np.array_equal(read_block(folder).tie_points.point_id, before.tie_points.point_id)
