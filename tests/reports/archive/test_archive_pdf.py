"""PDF/A-3a: what the standard asks for, the same bytes always, and nothing fetched."""

import io
import os
import subprocess
import sys
from pathlib import Path

import pikepdf
import pytest
from archive_conformance import problems
from archive_documents import CREATED, contents, document, results_of, write_inputs
from helpers import ROOT
from page_reading import pdf_pages

from posstats.reports.archive import writing as archive_pdf
from posstats.reports.archive.writing import ArchiveError, Attachment, render_archive

PAGE = "<!DOCTYPE html><html lang='en'><title>T</title><h1>A</h1><p>{}</p></html>"


def render(text="b", attachments=(), created=CREATED) -> bytes:
    return render_archive(PAGE.format(text), attachments, created, b"PA-1")


@pytest.fixture(scope="module")
def inputs(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("inputs")
    write_inputs(folder)
    return folder


@pytest.fixture(scope="module")
def archive(inputs) -> bytes:
    return document(results_of(inputs))


def test_the_document_meets_what_can_be_checked_of_level_a(archive):
    assert problems(archive) == []


def test_what_weasyprint_leaves_out_would_be_seen(inputs, monkeypatch):
    monkeypatch.setattr(archive_pdf, "mend", lambda document, pdf: None)
    found = set(problems(document(results_of(inputs), render=render_archive)))
    for fault in ("without scope", "interpolation", "associated files", "ids", "marked content"):
        assert any(fault in each for each in found), fault


def test_another_process_writes_the_same_bytes(archive, inputs):
    code = (
        "import sys; from pathlib import Path; from archive_documents import document, results_of;"
        f"sys.stdout.buffer.write(document(results_of(Path({str(inputs)!r}))))"
    )
    settings = {
        "PYTHONPATH": str(ROOT / "tests" / "support"),
        "PYTHONHASHSEED": "7",
        "TZ": "Asia/Tokyo",
    }
    run = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        check=True,
        env=os.environ | settings,
        cwd=ROOT,
    )
    assert run.stdout == archive


def test_files_are_embedded_in_order_with_types_of_ours(archive, inputs):
    pdf = pikepdf.open(io.BytesIO(archive))
    specifications = list(pikepdf.NameTree(pdf.Root.Names.EmbeddedFiles).values())
    kinds = {str(each.UF): str(each.EF.F.Subtype) for each in specifications}
    assert list(kinds) == sorted(kinds)
    assert kinds["profile.toml"] == "/application/toml"
    assert kinds["tables/points.csv"] == "/text/csv"
    assert kinds["acceptance.json"] == "/application/json"
    for each in contents(results_of(inputs))[1]:
        embedded = next(one for one in specifications if str(one.UF) == each.name)
        assert embedded.EF.F.read_bytes() == each.content
        assert str(embedded.AFRelationship) == f"/{each.relationship}"
        assert str(embedded.EF.F.Params.ModDate) == "D:20260102030405Z"


def test_the_order_of_the_files_given_does_not_matter():
    files = [Attachment(name, name.encode()) for name in ("b.csv", "a.json", "合同.toml")]
    assert render(attachments=files) == render(attachments=files[::-1])


def test_headers_and_text_are_on_the_pages(archive, tmp_path):
    (tmp_path / "a.pdf").write_bytes(archive)
    pages = pdf_pages(tmp_path / "a.pdf")
    assert "page 2 of" in pages[1]
    assert "Example Survey Ltd" in pages[0]


@pytest.mark.parametrize(
    "address", ["http://127.0.0.1:9/x", "file:///etc/hostname", "//a.example/"]
)
def test_nothing_is_fetched(address, monkeypatch):
    def refuse(*_, **__):
        raise AssertionError("a connection was tried")

    monkeypatch.setattr("socket.socket.connect", refuse)
    markup = (
        f"<img alt='x' src='{address}'><link rel='attachment' href='{address}'>"
        f"<style>@import url({address}); @font-face {{ font-family: f; src: url({address}) }}"
        f" p {{ font-family: f; background: url({address}) }}</style>"
        f"<svg xmlns='http://www.w3.org/2000/svg'><title>t</title><image href='{address}'/></svg>"
    )
    pdf = pikepdf.open(io.BytesIO(render(markup)))
    assert "/AF" not in pdf.Root
    assert "/Names" not in pdf.Root or "/EmbeddedFiles" not in pdf.Root.Names


@pytest.mark.parametrize("created", ["2026-01-02T03:04:05", "yesterday", None, 7])
def test_a_time_without_zone_is_refused(created):
    with pytest.raises(ArchiveError, match=r"time"):
        render(created=created)


@pytest.mark.parametrize(
    ("files", "word"),
    [
        ([Attachment("a", b""), Attachment("a", b"")], "two attachments"),
        ([Attachment("a", b"", "Related")], "relationship"),
    ],
)
def test_attachments_that_could_not_be_told_apart_are_refused(files, word):
    with pytest.raises(ArchiveError, match=word):
        render(attachments=files)
