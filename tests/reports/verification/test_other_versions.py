"""Documents beside their inputs, and beside what other versions of programs make."""

import zlib
from dataclasses import replace
from pathlib import Path

import pytest
from answers import OTHER, failures, rewritten
from archive_documents import (
    NOW,
    STEPS,
    document,
    results_of,
    write_inputs,
)

from posstats.reports.archive import writing as archive_pdf
from posstats.reports.verification import words
from posstats.reports.verification.questions import verify
from posstats.reports.verification.values import differences
from posstats.reports.verification.words import Answer, Standing


def test_swapped_and_missing_inputs_are_named(ask, archive, inputs, tmp_path):
    other = tmp_path / "block"
    write_inputs(other)
    (other / "orientations.csv").write_bytes(b"image,x\na,3.0\n")
    said = failures(ask(archive, inputs=other))
    assert said[words.INPUTS] == "orientations.csv is another file than the one used"
    assert "stated" in said[words.RECOMPUTED]
    (other / "orientations.csv").unlink()
    said = failures(ask(archive, inputs=other))
    assert said[words.INPUTS] == "orientations.csv is missing"
    assert "cannot be recomputed" in said[words.RECOMPUTED]


@pytest.mark.parametrize("name", ["../block.toml", "/etc/hostname", "", "."])
def test_inputs_outside_of_the_folder_are_not_opened(ask, inputs, name):
    results = results_of(inputs)
    results["block"]["inputs"][0]["file"] = name
    said = failures(ask(document(results), inputs=inputs))[words.INPUTS]
    assert "no name of a file" in said or "is missing" in said


def test_with_other_versions_the_text_of_pages_is_compared_and_that_is_said(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("#eee", "#eef"))
    answers = ask(data, OTHER)
    assert ask.holds
    assert "text of the pages alone" in answers[words.PAGES].text
    assert "other versions made it" in answers[words.ASSESSMENT].text
    assert words.PAGES in failures(ask(data))


def test_another_compression_of_the_same_contents_is_no_fault(inputs, monkeypatch):
    packing = zlib.compressobj
    monkeypatch.setattr("zlib.compressobj", lambda level: packing(level=1))
    data = document(results_of(inputs), render=archive_pdf.render_archive)
    monkeypatch.undo()
    answers = {each.question: each for each in _verified(data, inputs)}
    assert answers[words.PAGES].text == words.SAME_DECODED


def _verified(data: bytes, folder: Path) -> list[Answer]:
    (folder / "again.pdf").write_bytes(data)
    return list(verify(folder / "again.pdf", STEPS, now=NOW))


def test_a_document_saved_by_another_program_is_not_the_one_made(ask, archive):
    assert failures(ask(rewritten(archive, "no file", None))).keys() == {words.PAGES}


def test_with_other_versions_another_text_is_named(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace(">p7<", ">p8<"))
    said = failures(ask(data, OTHER))[words.PAGES]
    assert "the text differs on page 2" in said
    assert words.NOT_HERE in said


def test_numbers_may_differ_in_the_last_digits_with_other_versions_only(ask, archive, inputs):
    def recompute(folder, pattern):
        found = STEPS.recompute(folder, pattern)
        for row in found["check_points"]:
            row["dx_m"] *= 1 + 1e-9
        return found

    said = failures(ask(archive, replace(STEPS, recompute=recompute), inputs=inputs))
    assert set(said) == {words.RECOMPUTED}
    answers = ask(archive, replace(OTHER, recompute=recompute), inputs=inputs)
    assert "within 1e-06" in answers[words.RECOMPUTED].text
    assert answers[words.RECOMPUTED].standing is Standing.PASS


@pytest.mark.parametrize(
    ("stated", "found", "n"),
    [
        ({"a": 1}, {"a": 1.0}, 0),
        ({"a": True}, {"a": 1}, 1),
        ({"a": 1}, {"b": 1}, 2),
        ([1, 2], [1, 2, 3], 1),
        ([1, 2], (1, 2), 0),
        ("1", 1, 1),
        (None, 0, 1),
        ({"a": [{"b": 0.1}]}, {"a": [{"b": 0.1000001}]}, 1),
        (float("nan"), 1.0, 1),
    ],
)
def test_differences_of_values(stated, found, n):
    assert len(list(differences(stated, found))) == n
