"""Files that are no whole document, and data of any shape."""

import io
import json
import os
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pikepdf
import pytest
from answers import failures, reason, rewritten
from archive_documents import (
    NOW,
    STEPS,
    document,
    results_of,
)

from posstats.reports.archive.reading import decoded
from posstats.reports.verification.answers import APPENDED, READABLE
from posstats.reports.verification.questions import holds, verify
from posstats.reports.verification.words import line, words_of


@pytest.mark.parametrize("share", [0.0, 0.001, 0.3, 0.9, 0.9999])
def test_a_truncated_file_says_so(ask, archive, signed, share):
    for data in (archive, signed):
        said = failures(ask(data[: int(share * len(data))]))
        assert set(said) == {READABLE}
        assert any(word in reason(said[READABLE]) for word in ("cut off", "no PDF"))


def test_bytes_behind_the_end_are_said(ask, archive):
    assert "behind its end" in reason(failures(ask(archive + b"x"))[READABLE])
    end = archive[archive.rindex(b"startxref") :]
    assert APPENDED in failures(ask(archive + b"% note\n" + end))


def test_damage_of_any_kind_makes_failures_not_tracebacks(ask, archive, signed):
    rng = np.random.default_rng(5)
    steps = replace(STEPS, render_document=lambda *_: "<p>quick</p>")
    for data in (archive, signed):
        for _ in range(12):
            begin, end = np.sort(rng.integers(0, len(data), 2))
            piece = data[begin : min(end, begin + 30)]
            at = int(rng.integers(0, len(data)))
            for damaged in (
                data[:at] + piece + data[at:],
                data[:at] + piece + data[at + len(piece) :],
            ):
                ask(damaged, steps)
                assert damaged == data or not ask.holds


def foreign(**options) -> bytes:
    pdf, out = pikepdf.new(), io.BytesIO()
    pdf.add_blank_page()
    pdf.save(out, **options)
    return out.getvalue()


@pytest.mark.parametrize(
    ("data", "word"),
    [
        (b"PK\x03\x04", "no PDF"),
        (b"%PDF-1.7\n", "cut off"),
        (b"%PDF-1.7\nstartxref\n5\n%%EOF\n", "damaged"),
        (b"%PDF-1.7\nxref\ntrailer <</Prev 9>>\nstartxref\n9\n%%EOF\n", "circle"),
        (b"%PDF-1.7\nxref\n0 0\ntrailer <<>>\nstartxref\n9\n%%EOF\n", "damaged"),
        (foreign(), "no acceptance document"),
        (foreign(object_stream_mode=pikepdf.ObjectStreamMode.generate), "another program"),
        (foreign(encryption=pikepdf.Encryption(owner="o", user="")), "encrypted"),
        (foreign(encryption=pikepdf.Encryption(owner="o", user="u", R=4)), "encrypted"),
    ],
)
def test_other_files_are_told_apart(ask, data, word):
    said = failures(ask(data))
    assert word in reason(said[READABLE])
    assert not ask.holds


def test_a_large_file_is_not_read(tmp_path):
    path = tmp_path / "large.pdf"
    with path.open("wb") as stream:
        stream.write(b"%PDF-1.7\n")
        stream.truncate(1_000_000_000)
    (only,) = verify(path, STEPS, now=NOW)
    assert "1000 MB" in reason(only.said)


def test_folders_and_pipes_are_refused_and_links_followed(tmp_path, archive):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path, tmp_path / "pipe", Path("/dev/zero")):
        (only,) = verify(path, STEPS, now=NOW)
        assert "is no file" in reason(only.said)
    (tmp_path / "a.pdf").write_bytes(archive)
    (tmp_path / "link.pdf").symlink_to("a.pdf")
    assert holds(list(verify(tmp_path / "link.pdf", STEPS, now=NOW)))
    with pytest.raises(FileNotFoundError):
        list(verify(tmp_path / "none.pdf", STEPS, now=NOW))


def test_a_file_that_grows_beyond_measure_is_not_unpacked():
    pdf = pikepdf.new()
    stream = pikepdf.Stream(pdf, zlib.compress(bytes(1_000_000)), Filter=pikepdf.Name.FlateDecode)
    with pytest.raises(Exception, match="larger than"):
        decoded(stream, 1000)


@pytest.mark.parametrize("wrong", [None, 7, "x", [], {}, [None], {"a": {}}])
def test_data_of_any_shape_make_failures_not_tracebacks(ask, inputs, archive, wrong):
    pdf = pikepdf.open(io.BytesIO(archive))
    specification = pikepdf.NameTree(pdf.Root.Names.EmbeddedFiles)["acceptance.json"]
    acceptance = json.loads(specification.EF.F.read_bytes())
    steps = replace(STEPS, render_document=lambda *_: "<p>quick</p>")
    for key in acceptance:
        edited = json.dumps(acceptance | {key: wrong}).encode()
        answers = ask(rewritten(archive, "acceptance.json", lambda _, new=edited: new), steps)
        assert answers
        assert not ask.holds
    whole = rewritten(archive, "acceptance.json", lambda _: json.dumps(wrong).encode())
    assert READABLE in failures(ask(whole))


def test_texts_of_a_document_cannot_steer_the_terminal(ask, inputs):
    def edit(acceptance):
        acceptance["document_id"] = "PA\x1b[2J\nPASS  all"

    for each in ask(document(results_of(inputs), change=edit)).values():
        for language in ("en", "zh"):
            assert line(words_of(language), each).isprintable()
