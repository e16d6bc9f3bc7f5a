"""The `posstats` command as a user meets it: whole processes, exit codes, files, messages."""

import csv
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from helpers import ROOT
from small_scenario import small_block

from posstats import __version__, read_block
from posstats.formats.block_folder import write_block

COMMAND = Path(sys.executable).with_name("posstats")


def posstats(*arguments: str | Path, **options) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [COMMAND, *arguments], capture_output=True, text=True, check=False, timeout=120, **options
    )


def refused(*arguments: str | Path, code: int = 1, **options) -> str:
    """The message of a command that fails: on standard error, without a traceback."""
    run = posstats(*arguments, **options)
    assert run.returncode == code, run.stderr
    assert "Traceback" not in run.stderr
    return run.stderr


def files_below(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file()}


@pytest.fixture(scope="module")
def block_folder(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("small") / "block"
    write_block(small_block(), folder)
    return folder


@pytest.fixture(scope="module")
def report(block_folder, tmp_path_factory) -> tuple[Path, subprocess.CompletedProcess[str]]:
    out = tmp_path_factory.mktemp("report") / "deep" / "out"
    return out, posstats("analyse", block_folder, "--out", out)


def test_help_names_the_commands_with_an_example():
    run = posstats("--help")
    assert run.returncode == 0
    for word in ("analyse", "simulate", "check", "Example"):
        assert word in run.stdout


@pytest.mark.parametrize("command", ["analyse", "simulate", "check"])
def test_help_shows_an_example_on_its_own_lines(command):
    text = posstats(command, "--help").stdout
    assert "\n  Example:\n" in text
    assert "\\b" not in text


def test_the_version_is_told():
    assert __version__ in posstats("--version").stdout


def test_analyse_writes_everything_that_it_names(report):
    out, run = report
    assert run.returncode == 0, run.stderr
    written = files_below(out)
    assert {"results.json", "corrected_orientations.csv", "report.html", "report.pdf"} <= written
    assert any(name.startswith("tables/") and name.endswith(".csv") for name in written)
    assert any(name.startswith("figures/") and name.endswith(".svg") for name in written)
    assert not list(out.parent.parent.rglob(".posstats-*"))
    assert (out / "report.pdf").read_bytes().startswith(b"%PDF-")


def test_a_pipe_sees_a_summary_and_no_progress(report):
    out, run = report
    assert run.stderr == ""
    assert "omega: linear" in run.stdout
    assert str(out / "report.html") in run.stdout
    assert "\x1b" not in run.stdout


def test_corrected_orientations_are_a_pos_table_of_the_same_block(report, block_folder, tmp_path):
    out, _ = report
    copy = tmp_path / "corrected"
    copy.mkdir()
    for path in block_folder.iterdir():
        (copy / path.name).write_bytes(path.read_bytes())
    (copy / "orientations.csv").write_bytes((out / "corrected_orientations.csv").read_bytes())
    old, new = read_block(block_folder), read_block(copy)
    moved = old.orientations.angles_rad - new.orientations.angles_rad
    assert np.abs(moved[:, 0] - 0.018).max() < 0.002
    np.testing.assert_array_equal(moved[:, 1:], 0.0)


def test_an_existing_folder_keeps_what_is_not_ours(block_folder, tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "results.json").write_text("old")
    assert posstats("analyse", block_folder, "--out", tmp_path, "--no-pdf").returncode == 0
    assert (tmp_path / "notes.txt").read_text() == "mine"
    assert json.loads((tmp_path / "results.json").read_text())["schema"] == "posstats-results/1"
    assert not (tmp_path / "report.pdf").exists()


def test_simulate_writes_a_block_that_check_accepts(tmp_path):
    area = ROOT / "posstats" / "synthetic" / "scenarios" / "area1-small.toml"
    run = posstats("simulate", "--scenario", area, "--out", tmp_path / "a", "--seed", "3")
    assert run.returncode == 0, run.stderr
    assert "simulated = true" in (tmp_path / "a" / "block.toml").read_text()
    assert (tmp_path / "a" / "adjusted.csv").exists()
    checked = posstats("check", tmp_path / "a")
    assert checked.returncode == 0
    assert "48 images" in checked.stdout
    again = posstats("simulate", "--scenario", area, "--out", tmp_path / "b", "--seed", "3")
    assert again.returncode == 0
    for name in files_below(tmp_path / "a"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()


def test_check_prints_the_findings_of_a_refused_block(block_folder, tmp_path):
    for path in block_folder.iterdir():
        (tmp_path / path.name).write_bytes(path.read_bytes())
    with (tmp_path / "orientations.csv").open(newline="") as file:
        rows = list(csv.reader(file))
    rows[2][rows[0].index("x")] = "nan"
    with (tmp_path / "orientations.csv").open("w", newline="") as file:
        csv.writer(file).writerows(rows)
    message = refused("check", tmp_path)
    assert "orientations.csv" in message
    assert "line 3" in message or "orientations.csv:3" in message


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("analyse", "no-such-folder"), "no-such-folder"),
        (("check", __file__), "a file"),
        (("simulate", "--scenario", "no-such.toml", "--out", "x"), "no-such.toml"),
    ],
)
def test_what_is_not_there_is_named(arguments, word, tmp_path):
    assert word in refused(*arguments, cwd=tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_usage_errors_exit_with_two(block_folder):
    assert "--frame" in refused("analyse", block_folder, "--frame", "aero", code=2)
    assert "--scenario" in refused("simulate", "--out", "x", code=2)


def test_unknown_rules_are_refused_before_anything_is_written(block_folder, tmp_path):
    out = tmp_path / "out"
    assert "stricter" in refused("analyse", block_folder, "--out", out, "--rules", "stricter")
    assert not out.exists()


def test_an_output_path_that_is_a_file_is_refused(block_folder, tmp_path):
    (tmp_path / "out").write_text("mine")
    assert "is a file" in refused("analyse", block_folder, "--out", tmp_path / "out")
    assert (tmp_path / "out").read_text() == "mine"


def test_an_interrupt_leaves_nothing_behind(tmp_path):
    write_block(small_block(flight={"n_strips": 5, "images_per_strip": 40}), tmp_path / "block")
    out = tmp_path / "out"
    for number in (signal.SIGINT, signal.SIGTERM):
        process = subprocess.Popen(
            [COMMAND, "analyse", tmp_path / "block", "--out", out],
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        )
        while not list(tmp_path.glob(".posstats-*")) and process.poll() is None:
            time.sleep(0.01)
        time.sleep(0.2)  # the folder is there: let the command know of it too
        process.send_signal(number)
        _, message = process.communicate(timeout=60)
        assert process.returncode not in (0, None)
        assert "Traceback" not in message
        assert {path.name for path in tmp_path.iterdir()} == {"block"}


@pytest.mark.skipif(os.geteuid() != 0, reason="mounting a small file system needs root")
def test_a_full_disk_is_said_and_leaves_nothing_behind(block_folder, tmp_path):
    disk = tmp_path / "disk"
    disk.mkdir()
    mount = subprocess.run(
        ["mount", "-t", "tmpfs", "-o", "size=64k", "tmpfs", str(disk)], check=False
    )
    if mount.returncode:
        pytest.skip("this machine does not allow mounts")
    try:
        message = refused("analyse", block_folder, "--out", disk / "out", "--no-pdf")
        assert "No space left on device" in message
        assert list(disk.iterdir()) == []
    finally:
        subprocess.run(["umount", str(disk)], check=True)


def test_hostile_names_are_text_in_the_report(tmp_path):
    folder = tmp_path / "block"
    write_block(small_block(block={"name": "<script>alert(1)</script>"}), folder)
    rename = {
        "strip": lambda strip: f'<b>"{strip}",</b>',
        "image": lambda image: f"a,'{image}<img>",
    }
    for name in ("orientations.csv", "tie_points.csv", "adjusted.csv"):
        with (folder / name).open(newline="") as file:
            table = list(csv.DictReader(file))
        for row in table:
            row.update({key: change(row[key]) for key, change in rename.items() if key in row})
        with (folder / name).open("w", newline="") as file:
            writer = csv.DictWriter(file, table[0])
            writer.writeheader()
            writer.writerows(table)
    run = posstats("analyse", folder, "--out", tmp_path / "out")
    assert run.returncode == 0, run.stderr
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    assert "<img>" not in page
