"""`posstats adjust`: files, messages, and the report on an adjustment."""

import csv
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from small_scenario import small_block

from posstats import read_block
from posstats.adjustment import AdjustmentSettings, adjust_block
from posstats.adjustment.results import adjustment_results
from posstats.formats.block_folder import write_block
from posstats.reports.adjustment.document import build
from posstats.reports.adjustment.words import words_in
from posstats.reports.commands.cli import cli
from posstats.reports.pages import html

POINTS = {"n": 9, "distribution": "grid", "image_px": 0.2, "ground_m": 0.02}


def run(*arguments: str | Path):
    return CliRunner().invoke(cli, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("small") / "block"
    write_block(small_block(check_points=POINTS), path)
    return path


@pytest.fixture(scope="module")
def adjusted(folder, tmp_path_factory):
    out = tmp_path_factory.mktemp("adjusted") / "out"
    return out, run("adjust", folder, "--control", "corners", "--out", out)


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_adjust_writes_everything_that_it_names(adjusted):
    out, result = adjusted
    assert result.exit_code == 0, result.output
    assert {path.name for path in out.iterdir()} == {
        "adjustment.json", "adjusted_orientations.csv", "points.csv", "adjustment.html",
        "adjustment.pdf",
    }  # fmt: skip
    assert (out / "adjustment.pdf").read_bytes().startswith(b"%PDF-")
    assert "sigma0" in result.output
    assert str(out / "adjustment.html") in result.output


def test_help_shows_an_example():
    text = run("adjust", "--help").output
    assert "\n  Example:\n" in text
    assert "--self-calibration" in text


def test_adjusted_orientations_are_read_back_as_those_of_the_block(adjusted, folder, tmp_path):
    out, _ = adjusted
    copy = tmp_path / "copy"
    copy.mkdir()
    for path in folder.iterdir():
        (copy / path.name).write_bytes(path.read_bytes())
    (copy / "adjusted.csv").write_bytes((out / "adjusted_orientations.csv").read_bytes())
    expected = adjust_block(read_block(folder), AdjustmentSettings(control="corners"))
    found = read_block(copy).adjusted
    np.testing.assert_allclose(found.angles_rad, expected.orientations.angles_rad, atol=1e-12)
    np.testing.assert_allclose(found.position_m, expected.orientations.position_m, atol=1e-6)


def test_columns_of_the_input_are_kept_and_sigmas_added(adjusted, folder):
    before = rows_of(folder / "orientations.csv")
    after = rows_of(adjusted[0] / "adjusted_orientations.csv")
    assert list(after[0])[: len(before[0])] == list(before[0])
    assert [row["image"] for row in after] == [row["image"] for row in before]
    assert 0.0 < float(after[0]["sigma_omega"]) < 0.01
    assert 0.0 < float(after[0]["sigma_z"]) < 1.0


def test_points_have_roles_and_positive_covariances(adjusted):
    points = rows_of(adjusted[0] / "points.csv")
    roles = [row["role"] for row in points]
    assert {role: roles.count(role) for role in ("control", "check")} == {"control": 4, "check": 5}
    for row in points:
        xx, xy, xz, yy, yz, zz = (
            float(row[f"cov_{pair}"]) for pair in ("xx", "xy", "xz", "yy", "yz", "zz")
        )
        covariance = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        assert np.linalg.eigvalsh(covariance).min() > 0.0


def test_a_file_chooses_control_points(folder, tmp_path):
    ids = tmp_path / "ids.txt"
    ids.write_text("C2\nC8\n")
    result = run("adjust", folder, "--control", ids, "--out", tmp_path / "out", "--no-pdf")
    assert result.exit_code == 0, result.output
    values = json.loads((tmp_path / "out" / "adjustment.json").read_text())
    assert [row["point"] for row in values["control_points"]] == ["C2", "C8"]
    assert values["settings"]["control"] == ["C2", "C8"]


@pytest.mark.parametrize(
    ("control", "words"), [("C99\n", "nearest id is 'C9'"), (None, "neither a choice")]
)
def test_wrong_control_is_told_and_nothing_is_written(folder, tmp_path, control, words):
    ids = tmp_path / "ids.txt"
    if control:
        ids.write_text(control)
    out = tmp_path / "out"
    result = run("adjust", folder, "--control", ids, "--out", out)
    assert result.exit_code == 1
    assert words in result.output
    assert not out.exists()


def test_the_error_of_a_calibration_does_not_weaken_a_pos_whose_boresight_is_unknown(
    folder, tmp_path
):
    file, out = tmp_path / "boresight.toml", tmp_path / "out"
    assert run("calibrate", folder, "--control", "all", "--out", file).exit_code == 0
    result = run(
        "adjust", folder, "--control", "corners", "--drift", "strip", "--calibration", file,
        "--out", out, "--no-pdf",
    )  # fmt: skip
    assert result.exit_code == 0, result.output
    values = json.loads((out / "adjustment.json").read_text())
    imu = next(row for row in values["groups"] if row["group"] == "imu")
    simulated_over_stated = 0.13  # variances: 1.6e-5, 1.6e-5 and 5e-5 rad against 0.005 degrees
    assert imu["variance_factor"] > 0.4 * simulated_over_stated
    assert "boresight.toml" in [each["file"] for each in values["block"]["inputs"]]


def test_an_adjustment_that_fails_writes_nothing(tmp_path):
    block = small_block(flight={"n_strips": 2, "images_per_strip": 4})
    turned = block.orientations.angles_rad + np.array([np.pi, 0.0, 0.0])
    write_block(block.with_angles(turned), tmp_path / "block")
    out = tmp_path / "out"
    result = run("adjust", tmp_path / "block", "--out", out)
    assert result.exit_code == 1
    assert "Error: " in result.output
    assert not out.exists()


@pytest.fixture(scope="module")
def results():
    block = small_block(check_points=POINTS, block={"name": "<i>north</i>"})
    surveyed = block.ground_points
    position = surveyed.position_m + [[0.0, 5.0, 0.0]] * (surveyed.point == "C5")[:, None]
    block = replace(block, ground_points=replace(surveyed, position_m=position))
    settings = AdjustmentSettings(control="all", drift="strip", self_calibration="brown")
    return adjustment_results(adjust_block(block, settings))


def test_the_verdict_says_what_was_found(results):
    verdict, words = build(results).verdict.summary, words_in("en")
    assert re.search(r"omega shift 1\.0\d°", verdict)
    assert words.of("named", "control", image="", point="C5") in verdict
    assert words.text("checks.none") in verdict


@pytest.mark.parametrize("language", ["en", "zh"])
def test_every_part_of_the_report_is_there_and_text_is_text(results, language):
    document = build(results, language)
    page = html.render(document)
    names = {item.table.name for s in document.sections for item in s.items if item.kind == "table"}
    assert names >= {"groups", "parameters", "correlations", "orientations", "control_points",
                     "blunders", "settings"}  # fmt: skip
    figures = {i.drawing.name for s in document.sections for i in s.items if i.kind == "figure"}
    assert "residuals_1" in figures
    assert "<i>north" not in page
    assert "&lt;i&gt;north" in page
    assert "None" not in re.sub(r"<[^>]*>", "", page)
    assert "nan" not in re.sub(r"<[^>]*>", "", page).lower().split()


def test_a_report_in_chinese_leaves_the_data_in_english_and_no_old_pdf(adjusted, folder, tmp_path):
    out = tmp_path / "out"
    out.mkdir()
    (out / "adjustment.pdf").write_text("of an earlier run", encoding="utf-8")
    result = run("adjust", folder, "--control", "corners", "--out", out, "--language", "zh",
                 "--no-pdf")  # fmt: skip
    assert result.exit_code == 0, result.output
    assert not (out / "adjustment.pdf").exists()
    page = (out / "adjustment.html").read_text(encoding="utf-8")
    assert '<html lang="zh-CN">' in page
    assert words_in("zh").text("bundle_document.title") in page
    chinese, english = (
        json.loads((each / "adjustment.json").read_text(encoding="utf-8"))
        for each in (out, adjusted[0])
    )
    assert {**chinese, "created": None} == {**english, "created": None}


@pytest.mark.parametrize("language", ["en", "zh"])
def test_a_block_that_is_not_determined_is_explained_in_words(tmp_path, language):
    block = small_block(flight={"n_strips": 1, "images_per_strip": 4}, check_points={"n": 0})
    pos = block.orientations
    nothing = np.full_like(pos.position_m, 1e6)
    loose = replace(pos, sigma_position_m=1e3 * nothing, sigma_angles_rad=nothing)
    write_block(replace(block, orientations=loose, adjusted=None), tmp_path / "block")
    result = run("adjust", tmp_path / "block", "--drift", "none", "--out", tmp_path / "out",
                 "--language", language)  # fmt: skip
    assert result.exit_code == 1
    words = words_in(language)
    said = " ".join(result.output.split())
    assert words.text("defect.all_images") in said
    assert words.text("notice.helps_datum") in said
