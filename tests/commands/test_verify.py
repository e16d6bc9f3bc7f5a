"""`posstats verify` as a user meets it: lines, exit codes, messages; and recomputing for real."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from archive_documents import (
    STEPS,
    certificate,
    document,
    p12,
    pem,
    results_of,
    write_inputs,
)
from click.testing import CliRunner
from helpers import ROOT
from small_scenario import small_block

from posstats.analysis.results import results
from posstats.analysis.steps import Settings, analyse
from posstats.contract.files import from_json, to_json
from posstats.contract.results import Results
from posstats.errors import PosstatsError
from posstats.formats.block_folder import read_block, write_block
from posstats.reports.archive.file import LARGEST_BYTES
from posstats.reports.commands import verify as verify_command
from posstats.reports.commands.cli import cli
from posstats.reports.verification import words
from posstats.reports.verification.recomputation import recompute
from posstats.reports.verification.values import TOLERANCE

COMMAND = Path(sys.executable).with_name("posstats")


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """A document, its inputs, and a key; the steps of the small document are the installed ones."""
    monkeypatch.setattr(verify_command, "steps", lambda: STEPS)
    monkeypatch.chdir(tmp_path)
    write_inputs(tmp_path / "block")
    Path("a.pdf").write_bytes(document(results_of(tmp_path / "block")))
    Path("key.p12").write_bytes(p12(certificate()))
    Path("word").write_bytes(b"secret\n")
    return tmp_path


def posstats(*arguments: str):
    return CliRunner().invoke(cli, arguments)


def test_each_answer_is_a_line_and_all_that_hold_exit_with_zero(folder):
    signing = ("sign", "a.pdf", "--p12", "key.p12", "--passphrase-file", "word", "--out", "s.pdf")
    assert posstats(*signing).output == "signed: PA-3F2A-91C0-77DE in s.pdf\n"
    run = posstats("verify", "s.pdf", "--inputs", "block")
    assert run.exit_code == 0
    lines = run.output.splitlines()
    assert len(lines) == 10
    assert {line[:9].rstrip() for line in lines} == {"PASS", "NOT ASKED"}


def test_what_does_not_hold_exits_with_one(folder):
    Path("cert.pem").write_bytes(pem(certificate()))
    run = posstats("verify", "a.pdf", "--trust", "cert.pem")
    assert run.exit_code == 1
    assert "FAIL        is the signer trusted: nobody signed" in run.output
    run = posstats("verify", "key.p12")
    assert run.exit_code == 1
    assert run.output.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "word"),
    [
        (("none.pdf",), "none.pdf"),
        (("a.pdf", "--trust", "word"), "no certificate"),
        (("a.pdf", "--trust", "none"), "none"),
        (("a.pdf", "--inputs", "none"), "no block folder"),
        (("a.pdf", "--inputs", "word"), "no block folder"),
    ],
)
def test_what_cannot_be_asked_is_an_error(folder, arguments, word):
    run = posstats("verify", *arguments)
    assert run.exit_code == 1
    assert run.output.startswith("Error: ")
    assert word in run.output


def test_every_question_is_described():
    page = (ROOT / "docs" / "verify.md").read_text(encoding="utf-8")
    questions = [
        *(words.READABLE, words.SIGNED, words.APPENDED, words.FILES, words.ASSESSMENT),
        *(words.PAGES, words.INPUTS, words.RECOMPUTED, words.intact_question("the signature")),
        words.certificate_question("the signature"),
        words.trust_question("the signature"),
    ]
    assert not [each for each in questions if f"| {each} |" not in page]
    assert f"{TOLERANCE:g}".replace("e-0", "e-") in page
    assert f"{LARGEST_BYTES // 1_000_000} MB" in page


@pytest.mark.parametrize("command", ["sign", "verify"])
def test_help_shows_an_example_and_never_a_passphrase(command):
    text = posstats(command, "--help").output
    assert "\n  Example:\n" in text
    assert "--passphrase " not in text


def test_the_commands_are_light_to_load():
    code = (
        "import sys, posstats.reports.verification.questions, posstats.reports.sign_command;"
        "print(*sys.modules)"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    heavy = {"pyhanko.sign", "numba", "statsmodels", "matplotlib", "weasyprint"}
    assert not heavy & set(run.stdout.split())


@pytest.fixture(scope="module")
def analysed(tmp_path_factory) -> tuple[Path, Results]:
    folder = tmp_path_factory.mktemp("small") / "block"
    write_block(small_block(), folder)
    (folder / "own.toml").write_bytes(
        (ROOT / "posstats" / "analysis" / "rule_sets" / "strict.toml").read_bytes()
    )
    settings = Settings(rules="strict", frame="auto")
    analysis = analyse(read_block(folder), settings)
    found = results(analysis, created="2026-01-02T03:04:05+00:00")
    return folder, from_json(to_json(found), Results, "results.json")


def test_recomputing_a_block_gives_its_results_again(analysed):
    folder, stated = analysed
    assert recompute(folder, stated) == stated


def test_rules_of_a_file_are_looked_for_in_the_folder(analysed):
    folder, stated = analysed
    own = replace(stated, settings=replace(stated.settings, rules="/elsewhere/own.toml"))
    assert recompute(folder, own).verdict == stated.verdict
    none = replace(stated, settings=replace(stated.settings, rules="/elsewhere/none.toml"))
    with pytest.raises(PosstatsError):
        recompute(folder, none)
