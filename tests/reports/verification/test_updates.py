"""What was appended to a document: pages, forms, metadata, signatures."""

import datetime as dt
import io
import zlib

import pikepdf
import pytest
from answers import INTACT, codes, failures, reason
from answers import TRUSTED as SIGNER_TRUSTED
from archive_documents import (
    ALWAYS,
    NOW,
    appended_update,
    certificate,
    p12,
)

from posstats.reports.archive.signing import sign
from posstats.reports.verification.answers import (
    APPENDED,
    READABLE,
    SIGNED,
    TRUSTED,
    Standing,
    said,
)


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
        assert said("page_added", number=number) in failures(ask(data))[APPENDED]
    assert codes(failures(ask(with_page(signed)))[INTACT]) == {"changed_after_signature"}


def with_content(data: bytes) -> bytes:
    """Page 1 drawn otherwise by an incremental update: first bytes and data stay as they are."""
    pdf = pikepdf.open(io.BytesIO(data))
    number, size = pdf.pages[0].Contents.objgen[0], int(pdf.trailer.Size)
    packed = zlib.compress(b"q Q")
    stream = b"<</Filter/FlateDecode/Length %d>>\nstream\n%b\nendstream" % (len(packed), packed)
    return appended_update(data, {number: stream}, size)


def test_a_page_drawn_otherwise_by_an_update_is_named(ask, archive):
    after = sign(with_content(archive), p12(certificate()), b"secret", now=NOW)
    assert said("page_changed", number=1) in failures(ask(with_content(archive)))[APPENDED]
    assert failures(ask(after)).keys() == {APPENDED}


def with_root(data: bytes, entries: str, **objects: str) -> bytes:
    pdf = pikepdf.open(io.BytesIO(data))
    root, size = pdf.Root.objgen[0], int(pdf.trailer.Size)
    catalog = pdf.Root.unparse(resolved=True).rstrip()[:-2] + entries.encode() + b">>"
    others = {size + n: each.encode() for n, each in enumerate(objects.values())}
    return appended_update(data, {root: catalog, **others}, size + len(others))


@pytest.mark.parametrize(
    ("entries", "problem"),
    [
        ("/OpenAction<</S/JavaScript/JS(app.alert(1))>>", said("catalog_changed")),
        ("/AcroForm<</Fields[]/XFA()>>", said("form_entry", key="/XFA")),
        ("/AcroForm<</Fields[<</FT/Tx/T(note)>>]>>", said("form_field", field="note")),
        (
            "/AcroForm<</Fields[<</FT/Sig/T(s)/Rect[0 0 500 800]>>]>>",
            said("visible_signature", field="s"),
        ),
    ],
)
def test_updates_that_do_more_than_sign_are_named(ask, archive, entries, problem):
    answers = ask(with_root(archive, entries))
    assert problem in failures(answers)[APPENDED]


def test_an_update_that_changes_nothing_is_still_not_a_signature(ask, archive):
    problem = said("updates_without_signatures", n_updates=1, n_signatures=0)
    assert problem in failures(ask(with_root(archive, "")))[APPENDED]


def test_a_hidden_revision_is_found(ask, archive):
    update = with_page(archive)
    at = update.rindex(b"/Prev")
    found = failures(ask(update[:at] + b"/Pre#76" + update[at + 5 :]))
    assert set(found) == {READABLE}
    assert "hidden" in reason(found[READABLE])


def test_other_metadata_behind_a_signature_are_named(ask, archive):
    pdf = pikepdf.open(io.BytesIO(archive))
    info, size = pdf.trailer.Info.objgen[0], int(pdf.trailer.Size)
    update = appended_update(archive, {info: b"<</Title(ACCEPTED)>>"}, size)
    data = sign(update, p12(certificate()), b"secret", now=NOW)
    assert said("title_changed") in failures(ask(data))[APPENDED]


def test_metadata_updated_by_another_signing_program_are_no_fault(ask, archive):
    from pyhanko.pdf_utils.incremental_writer import IncrementalPdfFileWriter
    from pyhanko.sign import PdfSignatureMetadata, SimpleSigner, sign_pdf

    signer = SimpleSigner.load_pkcs12_data(p12(certificate(days=ALWAYS)), [], b"secret")
    writer = IncrementalPdfFileWriter(io.BytesIO(archive))
    data = sign_pdf(writer, PdfSignatureMetadata(field_name="Client"), signer).getvalue()
    late = NOW + dt.timedelta(days=ALWAYS[1] - 1)  # that program reads the clock
    assert failures(ask(data, now=late)) == {}


def test_a_signature_cut_off_leaves_an_unsigned_document(ask, archive, signed):
    answers = ask(signed[: len(archive)])
    assert answers[SIGNED].standing is Standing.NOT_SIGNED
    assert SIGNER_TRUSTED not in answers
    assert TRUSTED in failures(ask(archive, trust=[]))
