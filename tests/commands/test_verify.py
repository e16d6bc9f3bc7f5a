"""`posstats verify` as a user meets it: lines, exit codes, messages; and recomputing for real."""

import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from archive_documents import (
    NOW,
    STEPS,
    certificate,
    document,
    p12,
    pem,
    reassess,
    render_document,
    results_of,
    write_inputs,
)
from click.testing import CliRunner
from helpers import ROOT
from small_scenario import small_block

from posstats.analysis.results import results
from posstats.analysis.steps import analyse
from posstats.contract.results import Results
from posstats.errors import PosstatsError
from posstats.formats.block_folder import read_block, write_block
from posstats.reports.archive.file import LARGEST_BYTES
from posstats.reports.block.wording import with_words
from posstats.reports.commands import verify as verify_command
from posstats.reports.commands.cli import cli
from posstats.reports.output import timestamp
from posstats.reports.verification import answers
from posstats.reports.verification.recomputation import recompute
from posstats.reports.verification.values import TOLERANCE
from posstats.reports.verification.words import asked, words_of
from posstats.settings import Settings

COMMAND = Path(sys.executable).with_name("posstats")


@pytest.fixture
def folder(tmp_path, monkeypatch) -> Path:
    """A document, its inputs, and a key; the steps of the small document are the installed ones."""
    monkeypatch.setattr(verify_command, "reassess", reassess)
    monkeypatch.setattr(verify_command, "render_document", render_document)
    monkeypatch.setattr(verify_command, "recompute", STEPS.recompute)
    monkeypatch.setattr(verify_command, "versions", lambda: {"numpy": "2.4"})
    monkeypatch.setattr(timestamp, "clock", lambda: NOW)
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
    words = words_of("en")
    question = asked(words, answers.TRUSTED)
    assert f"FAIL        {question}: {words.text('said.nobody_signed')}" in run.output
    run = posstats("verify", "key.p12")
    assert run.exit_code == 1
    assert run.output.count("\n") == 1


def test_answers_are_told_in_chinese_too(folder):
    run = posstats("verify", "a.pdf", "--language", "zh")
    assert run.exit_code == 0
    words = words_of("zh")
    for line in run.output.splitlines():
        assert line.startswith(tuple(words.of("standing", each) for each in answers.Standing))
        assert not re.search(r"[a-z]{3,}", line.replace("posstats", "").replace("--inputs", ""))


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
        *(answers.READABLE, answers.SIGNED, answers.APPENDED, answers.FILES, answers.ASSESSMENT),
        *(answers.PAGES, answers.INPUTS, answers.RECOMPUTED),
        *(answers.Question(code) for code in ("intact", "in_force", "signer_trusted")),
    ]
    assert not [each for each in questions if f"| {asked(words_of('en'), each)} |" not in page]
    assert f"{TOLERANCE:g}".replace("e-0", "e-") in page
    assert f"{LARGEST_BYTES // 1_000_000} MB" in page


@pytest.mark.parametrize("command", ["sign", "verify"])
def test_help_shows_an_example_and_never_a_passphrase(command):
    text = posstats(command, "--help").output
    assert "\n  Example:\n" in text
    assert "--passphrase " not in text


def test_the_commands_are_light_to_load():
    code = (
        "import sys, posstats.reports.verification.questions, posstats.reports.commands.sign;"
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
    return folder, with_words(results(analysis, created="2026-01-02T03:04:05+00:00"))


def test_recomputing_a_block_gives_its_results_again(analysed):
    folder, stated = analysed
    assert recompute(folder, stated) == stated


def test_rules_of_a_file_are_looked_for_in_the_folder(analysed):
    folder, stated = analysed

    def with_rules(path: str) -> Results:
        return replace(stated, settings=replace(stated.settings, rules=path))

    assert recompute(folder, with_rules("/elsewhere/own.toml")).verdict == stated.verdict
    with pytest.raises(PosstatsError):
        recompute(folder, with_rules("/elsewhere/none.toml"))
