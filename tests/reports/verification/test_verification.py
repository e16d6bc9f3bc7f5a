"""`posstats verify` against everything that can happen to a document."""

import datetime as dt
import io
import json
import os
import re
import sys
import zlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pikepdf
import pytest
from archive_documents import (
    NOW,
    STEPS,
    appended_update,
    certificate,
    document,
    p12,
    pem,
    remembering,
    results_of,
    write_inputs,
)

from posstats.reports.archive import writing as archive_pdf
from posstats.reports.archive.reading import decoded
from posstats.reports.archive.signing import sign
from posstats.reports.verification import pages as verification_pages
from posstats.reports.verification import words
from posstats.reports.verification.questions import holds, verify
from posstats.reports.verification.signature import TrustError, read_trust
from posstats.reports.verification.values import differences
from posstats.reports.verification.words import Answer, Standing

INTACT = words.intact_question("the signature")
IN_FORCE = words.certificate_question("the signature")
TRUSTED = words.trust_question("the signature")


@pytest.fixture(scope="module")
def inputs(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("inputs")
    write_inputs(folder)
    return folder


@pytest.fixture(scope="module")
def archive(inputs) -> bytes:
    return document(results_of(inputs))


@pytest.fixture(scope="module")
def signed(archive) -> bytes:
    return sign(archive, p12(certificate()), b"secret", now=NOW)


@pytest.fixture
def ask(tmp_path, monkeypatch):
    """Verify bytes: the answers by question."""
    monkeypatch.setattr(verification_pages, "render_archive", remembering)

    def run(data: bytes, steps=STEPS, now=NOW, **options) -> dict[str, Answer]:
        path = tmp_path / "asked.pdf"
        path.write_bytes(data)
        answers = list(verify(path, steps, now=now, **options))
        run.holds = holds(answers)
        return {each.question: each for each in answers}

    return run


def failures(answers: dict[str, Answer]) -> dict[str, str]:
    return {q: each.text for q, each in answers.items() if each.standing is Standing.FAIL}


def changed(data: bytes, at: int) -> bytes:
    return data[:at] + bytes([data[at] ^ 1]) + data[at + 1 :]


def test_an_unsigned_document_is_said_to_be_unsigned_and_judged_on_the_rest(ask, archive, inputs):
    answers = ask(archive, inputs=inputs)
    assert ask.holds
    assert [each.standing.value for each in answers.values()] == [
        *("PASS", "NOT SIGNED", "PASS", "PASS", "PASS", "PASS", "PASS", "PASS")
    ]
    assert answers[words.PAGES].text == words.SAME_BYTES


def test_an_unsigned_document_needs_no_pyhanko(ask, archive, signed, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyhanko.sign", None)
    ask(archive)
    assert ask.holds
    assert "posstats[sign]" in failures(ask(signed))[INTACT]


def test_a_signed_document_passes_and_names_its_signer(ask, signed, inputs):
    answers = ask(signed, inputs=inputs)
    assert ask.holds
    assert "over the whole file, by Common Name: Example Survey Ltd" in answers[INTACT].text
    assert answers[TRUSTED].standing is Standing.NOT_ASKED
    assert "self-signed" in answers[TRUSTED].text
    assert answers[words.APPENDED].text == words.ONLY_SIGNATURES


def test_two_signatures_are_both_judged(ask, signed):
    client = certificate("Example Client Ltd")
    twice = sign(signed, p12(client, "Example Client Ltd"), b"secret", now=NOW)
    answers = ask(twice, trust=read_trust(pem(client)))
    assert set(failures(answers)) == {words.trust_question("signature 1")}
    assert "later ones follow" in answers[words.intact_question("signature 1")].text
    assert "whole file" in answers[words.intact_question("signature 2")].text


def test_no_network_is_used(ask, signed, monkeypatch):
    def refuse(*_, **__):
        raise AssertionError("a connection was tried")

    monkeypatch.setattr("socket.socket.connect", refuse)
    ask(signed, trust=read_trust(pem(certificate())))


def places(data: bytes) -> dict[str, int]:
    return {
        "header": 7,
        "comment": 11,
        "page": data.index(b"stream\n", data.index(b"/Filter /FlateDecode")) + 40,
        "attachment": data.index(b"stream\n", data.index(b"/EmbeddedFile")) + 30,
        "listing": data.index(b"/AFRelationship /Data") + 17,
        "producer": data.index(b"/Producer (WeasyPrint") + 22,
        "title": data.index(b"/Title (Acceptance") + 9,
        "metadata": data.index(b"<dc:title>") + 60,
        "table": data.index(b"xref\n0") + 45,
        "start": data.index(b"startxref\n") + 10,
        "identifier": data.index(b"/ID [") + 8,
        "end": data.index(b"%%EOF") + 3,
    }


PLACES = [
    *("header", "comment", "page", "attachment", "listing", "title"),
    *("producer", "metadata", "table", "start", "identifier", "end"),
]


@pytest.mark.parametrize("place", PLACES)
def test_one_changed_byte_is_found_in_an_unsigned_document(ask, archive, place):
    answers = ask(changed(archive, places(archive)[place]))
    assert not ask.holds
    assert failures(answers)


@pytest.mark.parametrize("place", PLACES)
def test_one_changed_byte_is_found_in_a_signed_document(ask, signed, place):
    answers = ask(changed(signed, places(signed)[place]))
    assert not ask.holds
    assert {INTACT, words.READABLE} & set(failures(answers))


def test_a_changed_signature_is_found_also_in_its_padding(ask, signed):
    begin = signed.rindex(b"/Contents <") + 11
    end = signed.index(b">", begin)
    for at in (begin + 9, begin + 400, end - 900, end - 2):
        digit = b"0" if signed[at : at + 1] != b"0" else b"1"
        answers = ask(signed[:at] + digit + signed[at + 1 :])
        assert INTACT in failures(answers)
        assert failures(answers).keys() <= {INTACT, IN_FORCE}


def test_any_changed_byte_of_the_appended_part_is_found(ask, archive, signed):
    begin = signed.rindex(b"/Contents <")
    end = signed.index(b">", begin)
    for at in (*range(len(archive), begin, 97), *range(end + 1, len(signed), 41)):
        ask(changed(signed, at))
        assert not ask.holds, at


def rewritten(data: bytes, name: str, edit) -> bytes:
    """A file replaced, the whole PDF written again with a right cross-reference table."""
    pdf = pikepdf.open(io.BytesIO(data))
    for each in pikepdf.NameTree(pdf.Root.Names.EmbeddedFiles).values():
        if str(each.UF) == name:
            each.EF.F.write(edit(each.EF.F.read_bytes()))
    out = io.BytesIO()
    pdf.save(out)
    return out.getvalue()


@pytest.mark.parametrize("name", ["results.json", "profile.toml", "tables/points.csv"])
def test_a_changed_attachment_is_named(ask, archive, signed, name):
    for data in (archive, signed):
        answers = ask(rewritten(data, name, lambda content: content.replace(b"1", b"2")))
        assert f"{name} was changed" in failures(answers)[words.FILES]


def test_a_better_verdict_in_the_data_is_found_by_assessing_again(ask, inputs):
    def better(acceptance):
        acceptance["verdict"] = "accepted with honours"

    answers = ask(document(results_of(inputs), change=better))
    assert failures(answers) == {
        words.ASSESSMENT: "verdict: accepted with honours stated, accepted found"
    }


def test_a_better_verdict_on_the_page_alone_is_found_by_laying_it_out_again(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("accepted", "honoured"))
    assert failures(ask(data)) == {words.PAGES: "page 1 is not what the data make"}


def test_what_pages_share_is_compared_too(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("Residual", "Resydual"))
    assert "StructElem" in failures(ask(data))[words.PAGES]


def test_another_number_of_pages_is_said(ask, inputs):
    data = document(results_of(inputs), edit=lambda page: page.replace("</body>", "<h1>X</h1>"))
    assert re.search(r"it has \d pages, the data make \d", failures(ask(data))[words.PAGES])


def test_missing_unlisted_and_unassessed_files_are_named(ask, inputs):
    def edit(acceptance):
        acceptance["attachments"][-1]["file"] = "templates/other.j2"
        acceptance["attachments"][0]["relationship"] = "Source"
        acceptance["results"]["sha256"] = "0"

    said = failures(ask(document(results_of(inputs), change=edit)))[words.FILES]
    assert "templates/other.j2 is missing" in said
    assert "templates/logo.svg is not listed" in said
    assert "results.json has another relationship" in said
    assert "results.json is not what was assessed" in said


def test_rewriting_everything_consistently_needs_a_signature_or_the_inputs_to_be_found(ask, inputs):
    results = results_of(inputs)
    results["check_points"][7]["dx_m"] = 0.0001
    data = document(results)
    ask(data)
    assert ask.holds  # documented: without signature and inputs nothing contradicts it
    said = failures(ask(data, inputs=inputs))
    assert said == {words.RECOMPUTED: "check_points[8].dx_m: 0.0001 stated, 0.007 found"}


def with_page(data: bytes) -> bytes:
    """A page added by an incremental update."""
    pdf = pikepdf.open(io.BytesIO(data))
    size = int(pdf.trailer.Size)
    kids = " ".join(f"{each.obj.objgen[0]} 0 R" for each in pdf.pages)
    parent = pdf.Root.Pages.objgen[0]
    pages = f"<</Type/Pages/Kids[{kids} {size} 0 R]/Count {len(pdf.pages) + 1}>>"
    page = f"<</Type/Page/Parent {parent} 0 R/MediaBox[0 0 595 842]/Resources<<>>>>"
    return appended_update(data, {parent: pages.encode(), size: page.encode()}, size + 1)


def test_an_added_page_is_named_unsigned_and_signed_before_or_after(ask, archive, signed):
    number = len(pikepdf.open(io.BytesIO(archive)).pages) + 1
    after = sign(with_page(archive), p12(certificate()), b"secret", now=NOW)
    for data in (with_page(archive), with_page(signed), after):
        said = failures(ask(data))[words.APPENDED]
        assert f"page {number} was added" in said
    assert "changed after it" in failures(ask(with_page(signed)))[INTACT]


def with_content(data: bytes) -> bytes:
    """Page 1 drawn otherwise by an incremental update: first bytes and data stay as they are."""
    pdf = pikepdf.open(io.BytesIO(data))
    number, size = pdf.pages[0].Contents.objgen[0], int(pdf.trailer.Size)
    packed = zlib.compress(b"q Q")
    stream = b"<</Filter/FlateDecode/Length %d>>\nstream\n%b\nendstream" % (len(packed), packed)
    return appended_update(data, {number: stream}, size)


def test_a_page_drawn_otherwise_by_an_update_is_named(ask, archive):
    after = sign(with_content(archive), p12(certificate()), b"secret", now=NOW)
    assert "page 1 was changed" in failures(ask(with_content(archive)))[words.APPENDED]
    assert failures(ask(after)).keys() == {words.APPENDED}


def with_root(data: bytes, entries: str, **objects: str) -> bytes:
    pdf = pikepdf.open(io.BytesIO(data))
    root, size = pdf.Root.objgen[0], int(pdf.trailer.Size)
    catalog = pdf.Root.unparse(resolved=True).rstrip()[:-2] + entries.encode() + b">>"
    others = {size + n: each.encode() for n, each in enumerate(objects.values())}
    return appended_update(data, {root: catalog, **others}, size + len(others))


@pytest.mark.parametrize(
    ("entries", "word"),
    [
        ("/OpenAction<</S/JavaScript/JS(app.alert(1))>>", "the catalog was changed"),
        ("/AcroForm<</Fields[]/XFA()>>", "a form with /XFA"),
        ("/AcroForm<</Fields[<</FT/Tx/T(note)>>]>>", "form field note"),
        ("/AcroForm<</Fields[<</FT/Sig/T(s)/Rect[0 0 500 800]>>]>>", "s draws on a page"),
    ],
)
def test_updates_that_do_more_than_sign_are_named(ask, archive, entries, word):
    answers = ask(with_root(archive, entries))
    assert word in failures(answers)[words.APPENDED]


def test_an_update_that_changes_nothing_is_still_not_a_signature(ask, archive):
    assert "1 updates, but 0 signatures" in failures(ask(with_root(archive, "")))[words.APPENDED]


def test_a_hidden_revision_is_found(ask, archive):
    update = with_page(archive)
    at = update.rindex(b"/Prev")
    said = failures(ask(update[:at] + b"/Pre#76" + update[at + 5 :]))
    assert said == {words.READABLE: "its revisions are hidden"}


def test_other_metadata_behind_a_signature_are_named(ask, archive):
    pdf = pikepdf.open(io.BytesIO(archive))
    info, size = pdf.trailer.Info.objgen[0], int(pdf.trailer.Size)
    update = appended_update(archive, {info: b"<</Title(ACCEPTED)>>"}, size)
    data = sign(update, p12(certificate()), b"secret", now=NOW)
    assert "the title or author was changed" in failures(ask(data))[words.APPENDED]


def test_metadata_updated_by_another_signing_program_are_no_fault(ask, archive):
    from pyhanko.pdf_utils.incremental_writer import IncrementalPdfFileWriter
    from pyhanko.sign import PdfSignatureMetadata, SimpleSigner, sign_pdf

    signer = SimpleSigner.load_pkcs12_data(p12(certificate()), [], b"secret")
    writer = IncrementalPdfFileWriter(io.BytesIO(archive))
    data = sign_pdf(writer, PdfSignatureMetadata(field_name="Client"), signer).getvalue()
    assert failures(ask(data)) == {}


def test_a_signature_cut_off_leaves_an_unsigned_document(ask, archive, signed):
    answers = ask(signed[: len(archive)])
    assert answers[words.SIGNED].standing is Standing.NOT_SIGNED
    assert TRUSTED not in answers
    assert words.TRUSTED in failures(ask(archive, trust=[]))


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


def test_an_authority_that_issued_the_certificate_makes_it_trusted(ask, archive):
    name, authority = "Example Survey Ltd", "Example Authority"
    root, leaf = certificate(authority), certificate(name, authority)
    data = sign(archive, p12(leaf), b"secret", now=NOW)
    answers = ask(data, trust=read_trust(pem(root)))
    assert ask.holds
    assert "issued by Common Name: Example Authority" in answers[TRUSTED].text
    said = failures(ask(data, trust=read_trust(pem(certificate("Other Authority")))))
    assert set(said) == {TRUSTED}
    same_name = read_trust(pem(certificate(authority, key="another")))
    assert set(failures(ask(data, trust=same_name))) == {TRUSTED}


def test_a_self_signed_certificate_is_trusted_only_if_it_is_the_one_given(ask, archive):
    own, other = certificate(), certificate("Example Impostor")
    forged = sign(archive, p12(other, "Example Impostor"), b"secret", now=NOW)
    said = failures(ask(forged, trust=read_trust(pem(own))))
    assert "self-signed" in said[TRUSTED]


def test_an_expired_certificate_fails_then_and_later(ask, archive, signed):
    expired = p12(certificate(days=(-20, -10)))
    data = sign(archive, expired, b"secret", now=NOW - dt.timedelta(days=15))
    assert "but signed on" in failures(ask(data))[IN_FORCE]
    later = failures(ask(signed, now=NOW + dt.timedelta(days=500)))
    assert set(later) == {IN_FORCE}
    assert "the signer's own statement" in later[IN_FORCE]
    early = failures(ask(signed, now=NOW - dt.timedelta(days=5)))
    assert "in the future" in early[IN_FORCE]


def test_a_certificate_without_key_usage_is_accepted(ask, archive):
    own = certificate(usage=None)
    data = sign(archive, p12(own), b"secret", now=NOW)
    ask(data, trust=read_trust(pem(own)))
    assert ask.holds


def test_trust_without_a_certificate_is_refused():
    for content in (b"", b"-----BEGIN CERTIFICATE-----\n", b"{}"):
        with pytest.raises(TrustError):
            read_trust(content)


@pytest.mark.parametrize("share", [0.0, 0.001, 0.3, 0.9, 0.9999])
def test_a_truncated_file_says_so(ask, archive, signed, share):
    for data in (archive, signed):
        said = failures(ask(data[: int(share * len(data))]))
        assert set(said) == {words.READABLE}
        assert "cut off" in said[words.READABLE] or "no PDF" in said[words.READABLE]


def test_bytes_behind_the_end_are_said(ask, archive):
    assert "behind its end" in failures(ask(archive + b"x"))[words.READABLE]
    end = archive[archive.rindex(b"startxref") :]
    assert words.APPENDED in failures(ask(archive + b"% note\n" + end))


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
        (foreign(), "no acceptance document of posstats"),
        (foreign(object_stream_mode=pikepdf.ObjectStreamMode.generate), "another program"),
        (foreign(encryption=pikepdf.Encryption(owner="o", user="")), "encrypted"),
        (foreign(encryption=pikepdf.Encryption(owner="o", user="u", R=4)), "encrypted"),
    ],
)
def test_other_files_are_told_apart(ask, data, word):
    said = failures(ask(data))
    assert word in said[words.READABLE]
    assert not ask.holds


def test_a_large_file_is_not_read(tmp_path):
    path = tmp_path / "large.pdf"
    with path.open("wb") as stream:
        stream.write(b"%PDF-1.7\n")
        stream.truncate(1_000_000_000)
    (only,) = verify(path, STEPS, now=NOW)
    assert "1000 MB" in only.text


def test_folders_and_pipes_are_refused_and_links_followed(tmp_path, archive):
    os.mkfifo(tmp_path / "pipe")
    for path in (tmp_path, tmp_path / "pipe", Path("/dev/zero")):
        (only,) = verify(path, STEPS, now=NOW)
        assert "is no file" in only.text
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
    assert words.READABLE in failures(ask(whole))


def test_texts_of_a_document_cannot_steer_the_terminal(ask, inputs):
    def edit(acceptance):
        acceptance["document_id"] = "PA\x1b[2J\nPASS  all"

    for each in ask(document(results_of(inputs), change=edit)).values():
        assert each.line.isprintable()


OTHER = replace(STEPS, layout="posstats 9, WeasyPrint 99", numbers={"posstats": "9"})


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
