"""What is odd about a block when it is read."""

from dataclasses import replace

import pandas as pd
from perfect_block import edit, perfect_block, written

from posstats.contract.notice import Notice, listing
from posstats.formats.block_folder import read_block


def test_a_perfect_block_gives_no_notice(folder) -> None:
    assert read_block(folder).notices == ()


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
    found = {each.code: each.values for each in read_block(folder).notices}
    assert found["rows_out_of_order"] == {"n": 1, "ids": ("1_000",)}
    assert found["images_without_tie_points"] == {"n": 1, "ids": ("1_003",)}
    assert found["strips_of_one_image"] == {"n": 1, "ids": ("9",)}
    assert found["models_with_few_points"] == {"n": 1, "ids": ("1_002 - 1_003",), "n_needed": 6}
    assert found["tie_points_seen_once"]["n"] >= 6
    assert found["tie_points_seen_once"]["ids"] == tuple(free[:5])


def test_assumed_accuracy_is_named(folder) -> None:
    text = (folder / "block.toml").read_text()
    (folder / "block.toml").write_text(
        text[: text.index("[accuracy]")] + "[accuracy]\nposition_m = 0.1\n"
    )
    block = read_block(folder)
    assert block.accuracy.position_m == 0.1
    lines = ("angle_deg = 0.005", "image_px = 0.2")
    assert block.notices == (Notice(code="accuracy_assumed", values={"lines": lines}),)


def test_orthometric_heights_without_geoid_are_named(tmp_path) -> None:
    folder = written(perfect_block("EPSG:2154"), tmp_path)
    edit(folder, "block.toml", ('"ellipsoidal"', '"orthometric"'))
    assert read_block(folder).notices[0].code == "heights_without_geoid"


def test_ground_points_without_measurements_are_named(tmp_path) -> None:
    block = perfect_block(None)
    renamed = block.ground_points.point.copy()
    renamed[0] = "lost"
    block = replace(block, ground_points=replace(block.ground_points, point=renamed))
    notices = read_block(written(block, tmp_path)).notices
    assert notices == listing("ground_points_with_few_rays", ["lost"])


def test_models_without_base_are_named(folder) -> None:
    """A hovering drone: two exposures at one place, and two nearer than the positions are known."""
    table = pd.read_csv(folder / "orientations.csv", dtype=str)
    table.loc[1, ["x", "y", "z"]] = table.loc[0, ["x", "y", "z"]].to_numpy()
    table.loc[5, ["x", "y", "z"]] = table.loc[4, ["x", "y", "z"]].to_numpy()
    table.loc[5, "x"] = str(float(table.loc[4, "x"]) + 0.03)  # stated accuracy: 0.05 m
    table.to_csv(folder / "orientations.csv", index=False)
    short = ["1_000 - 1_001", "2_000 - 2_001"]
    assert read_block(folder).notices == listing("models_with_short_base", short)
