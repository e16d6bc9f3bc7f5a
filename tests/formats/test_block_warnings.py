"""What a block is warned of when it is read."""

from dataclasses import replace

import pandas as pd
from perfect_block import edit, perfect_block, written

from posstats.formats.block_folder import read_block


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
