"""The `posstats` command as a user meets it: exit codes, files, messages, processes."""

import contextlib
import csv
import errno
import json
import os
import resource
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result
from helpers import ROOT
from small_scenario import small_block

from posstats import __version__, read_block
from posstats.formats.block_folder import write_block
from posstats.reports.commands.cli import cli

COMMAND = Path(sys.executable).with_name("posstats")


def posstats(*arguments: str | Path) -> Result:
    """The command in this process."""
    return CliRunner().invoke(cli, [str(each) for each in arguments])


def refused(*arguments: str | Path, code: int = 1) -> str:
    """The message of a command that fails: on standard error, without a traceback."""
    run = posstats(*arguments)
    assert run.exit_code == code, run.output
    assert isinstance(run.exception, SystemExit)
    return run.stderr


def process(*arguments: str | Path, **options) -> subprocess.CompletedProcess[str]:
    """The command as a process of its own."""
    return subprocess.run(
        [COMMAND, *arguments], capture_output=True, text=True, check=False, **options
    )


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
    return out, process("analyse", block_folder, "--out", out)


def test_help_names_the_commands_with_an_example():
    run = posstats("--help")
    assert run.exit_code == 0
    for word in ("analyse", "simulate", "check", "Example"):
        assert word in run.output


@pytest.mark.parametrize("command", ["analyse", "simulate", "check"])
def test_help_shows_an_example_on_its_own_lines(command):
    text = posstats(command, "--help").output
    assert "\n  Example:\n" in text
    assert "\\b" not in text


def test_the_version_is_told():
    assert __version__ in posstats("--version").output


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
    assert posstats("analyse", block_folder, "--out", tmp_path, "--no-pdf").exit_code == 0
    assert (tmp_path / "notes.txt").read_text() == "mine"
    assert json.loads((tmp_path / "results.json").read_text())["schema"] == "posstats-results/1"
    assert not (tmp_path / "report.pdf").exists()


def test_simulate_writes_a_block_that_check_accepts(tmp_path):
    area = ROOT / "posstats" / "synthetic" / "scenarios" / "area1-small.toml"
    run = posstats("simulate", "--scenario", area, "--out", tmp_path / "a", "--seed", "3")
    assert run.exit_code == 0, run.stderr
    assert "simulated = true" in (tmp_path / "a" / "block.toml").read_text()
    assert (tmp_path / "a" / "adjusted.csv").exists()
    checked = posstats("check", tmp_path / "a")
    assert checked.exit_code == 0
    assert "48 images" in checked.stdout
    again = posstats("simulate", "--scenario", area, "--out", tmp_path / "b", "--seed", "3")
    assert again.exit_code == 0
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
def test_what_is_not_there_is_named(arguments, word, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert word in refused(*arguments)
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


def opened_for_writing(pipe: Path, running: subprocess.Popen) -> int:
    """A named pipe once the process reads from it: there it stays until somebody writes."""
    while running.poll() is None:
        with contextlib.suppress(OSError):  # nobody reads yet
            return os.open(pipe, os.O_WRONLY | os.O_NONBLOCK)
        with contextlib.suppress(subprocess.TimeoutExpired):
            running.wait(0.05)
    return pytest.fail(running.communicate()[1])


def interruptible() -> None:
    """A job in the background inherits that SIGINT is ignored."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_an_interrupt_leaves_nothing_behind(block_folder, tmp_path, number):
    """While the block is read, from a pipe in place of a table, the folder for output is there."""
    shutil.copytree(block_folder, tmp_path / "block")
    pipe = tmp_path / "block" / "tie_points.csv"
    pipe.unlink()
    os.mkfifo(pipe)
    running = subprocess.Popen(
        [COMMAND, "analyse", tmp_path / "block", "--out", tmp_path / "out"],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        preexec_fn=interruptible,  # noqa: PLW1509 - no threads here
    )
    end = opened_for_writing(pipe, running)
    assert list(tmp_path.glob(".posstats-*"))
    running.send_signal(number)
    _, message = running.communicate()
    os.close(end)
    assert running.returncode not in (0, None)
    assert "Traceback" not in message
    assert {path.name for path in tmp_path.iterdir()} == {"block"}


def _write_little() -> None:
    resource.setrlimit(resource.RLIMIT_FSIZE, (4096, 4096))


def test_a_file_that_cannot_be_written_is_said_and_leaves_nothing_behind(block_folder, tmp_path):
    out = tmp_path / "out"
    run = process("analyse", block_folder, "--out", out, "--no-pdf", preexec_fn=_write_little)
    assert run.returncode == 1
    assert os.strerror(errno.EFBIG) in run.stderr
    assert "Traceback" not in run.stderr
    assert list(tmp_path.iterdir()) == []


def test_hostile_names_are_text_in_the_report(tmp_path):
    folder = tmp_path / "block"
    few = {"n_strips": 2, "images_per_strip": 5}
    write_block(small_block(block={"name": "<script>alert(1)</script>"}, flight=few), folder)
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
    run = posstats("analyse", folder, "--out", tmp_path / "out", "--no-pdf")
    assert run.exit_code == 0, run.output
    page = (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    assert "<script" not in page
    assert "&lt;script&gt;" in page
    assert "<img>" not in page
