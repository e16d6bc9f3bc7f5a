"""`posstats paper`, `wucaps` and `simulate`: what they hand on, and what they refuse."""

import pytest
from click.testing import CliRunner

from posstats.errors import PosstatsError
from posstats.reports.commands import paper as paper_command
from posstats.reports.commands import wucaps as wucaps_command
from posstats.reports.commands.cli import cli


@pytest.mark.parametrize(
    ("options", "seed", "language", "pdf"),
    [([], 1, "en", True), (["--seed", "7", "--language", "zh", "--no-pdf"], 7, "zh", False)],
)
@pytest.mark.parametrize(
    ("name", "command"), [("paper", paper_command), ("wucaps", wucaps_command)]
)
def test_the_commands_hand_on_seed_language_and_pdf(
    monkeypatch, tmp_path, name, command, options, seed, language, pdf
):
    called = {}

    def record(out, seed, *, language, pdf):
        called.update(out=out, seed=seed, language=language, pdf=pdf)
        return ["written"]

    monkeypatch.setattr(command, f"reproduce_{name}", record)
    run = CliRunner().invoke(cli, [name, "--out", str(tmp_path), *options])
    assert run.output == "written\n"
    assert called == {"out": tmp_path, "seed": seed, "language": language, "pdf": pdf}


@pytest.mark.parametrize("command", [paper_command, wucaps_command])
def test_a_run_without_pdf_leaves_no_old_pdf(monkeypatch, tmp_path, command):
    """Of the folder only: what would be written into it stays away."""
    name = command.__name__.rpartition(".")[2]
    (tmp_path / f"{name}.pdf").write_text("of an earlier run", encoding="utf-8")

    def staged(out, replaced=()):
        for each in replaced:
            (out / each).unlink()
        raise PosstatsError("far enough")

    monkeypatch.setattr(command, "staged_folder", staged)
    with pytest.raises(PosstatsError):
        list(getattr(command, f"reproduce_{name}")(tmp_path, 1, pdf=False))
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["paper", "--seed", "-1"], "-1 is not in"),
        (["paper", "--out", ""], "is empty"),
        (["simulate", "--out", "x"], "exactly one"),
        (["simulate", "--out", "x", "--area", "1", "--scenario", "area1"], "exactly one"),
        (["simulate", "--out", "x", "--area", "4"], "4 is not in"),
    ],
)
def test_wrong_options_are_refused(options, message):
    run = CliRunner().invoke(cli, options)
    assert run.exit_code == 2
    assert message in run.output
