"""Documents beside their inputs, and beside what other versions of programs make."""

import zlib
from dataclasses import replace
from pathlib import Path

import pytest
from answers import OTHER, codes, failures, rewritten
from archive_documents import (
    NOW,
    STEPS,
    document,
    results_of,
    write_inputs,
)

from posstats.reports.archive import writing as archive_pdf
from posstats.reports.verification.answers import (
    ASSESSMENT,
    INPUTS,
    PAGES,
    RECOMPUTED,
    Answer,
    Standing,
    said,
)
from posstats.reports.verification.questions import verify
from posstats.reports.verification.values import differences


def test_swapped_and_missing_inputs_are_named(ask, archive, inputs, tmp_path):
    other = tmp_path / "block"
    write_inputs(other)
    (other / "orientations.csv").write_bytes(b"image,x\na,3.0\n")
    found = failures(ask(archive, inputs=other))
    assert found[INPUTS] == (said("input_differs", file="orientations.csv"),)
    assert codes(found[RECOMPUTED]) == {"value_differs"}
    (other / "orientations.csv").unlink()
    found = failures(ask(archive, inputs=other))
    assert found[INPUTS] == (said("file_missing", file="orientations.csv"),)
    assert codes(found[RECOMPUTED]) == {"unrecomputable"}


@pytest.mark.parametrize("name", ["../block.toml", "/etc/hostname", "", "."])
def test_inputs_outside_of_the_folder_are_not_opened(ask, inputs, name):
    results = results_of(inputs)
    first, *others = results.block.inputs
    block = replace(results.block, inputs=(replace(first, file=name), *others))
    data = document(replace(results, block=block))
    assert codes(failures(ask(data, inputs=inputs))[INPUTS]) <= {"no_file_name", "file_missing"}


def test_with_other_versions_the_text_of_pages_is_compared_and_that_is_said(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("#eee", "#eef"))
    answers = ask(data, OTHER)
    assert ask.holds
    assert codes(answers[PAGES].said) == {"same_text"}
    assert codes(answers[ASSESSMENT].said) == {"assessed_within"}
    assert PAGES in failures(ask(data))


def test_another_compression_of_the_same_contents_is_no_fault(inputs, monkeypatch):
    packing = zlib.compressobj
    monkeypatch.setattr("zlib.compressobj", lambda level: packing(level=1))
    data = document(results_of(inputs), render=archive_pdf.render_archive)
    monkeypatch.undo()
    answers = {each.question: each for each in _verified(data, inputs)}
    assert answers[PAGES].said == (said("same_contents"),)


def _verified(data: bytes, folder: Path) -> list[Answer]:
    (folder / "again.pdf").write_bytes(data)
    return list(verify(folder / "again.pdf", STEPS, now=NOW))


def test_a_document_saved_by_another_program_is_not_the_one_made(ask, archive):
    assert failures(ask(rewritten(archive, "no file", None))).keys() == {PAGES}


def test_with_other_versions_another_text_is_named(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace(">p7<", ">p8<"))
    told = ask(data, OTHER)[PAGES]
    assert told.standing is Standing.FAIL
    assert told.hedged
    assert said("text_differs", number=2) in told.said
    assert codes(told.said) == {"text_differs", "other_versions"}


def test_numbers_may_differ_in_the_last_digits_with_other_versions_only(ask, archive, inputs):
    def recompute(folder, pattern):
        found = STEPS.recompute(folder, pattern)
        rows = (replace(r, dx_m=r.dx_m * (1 + 1e-9)) for r in found.check_point_residuals)
        return replace(found, check_point_residuals=tuple(rows))

    found = failures(ask(archive, replace(STEPS, recompute=recompute), inputs=inputs))
    assert set(found) == {RECOMPUTED}
    answers = ask(archive, replace(OTHER, recompute=recompute), inputs=inputs)
    assert answers[RECOMPUTED].said == (said("recomputed_within", tolerance="1e-06"),)
    assert answers[RECOMPUTED].standing is Standing.PASS


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
