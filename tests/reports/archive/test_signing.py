"""`posstats sign`: a signature is appended, the document itself is left alone."""

import datetime as dt
import io
import os
import pty
import subprocess
import sys
from pathlib import Path

import pikepdf
import pytest
from archive_conformance import problems
from archive_documents import ALWAYS, NOW, certificate, document, p12, results_of, write_inputs
from cryptography import x509
from cryptography.hazmat.primitives import hashes
from cryptography.hazmat.primitives.asymmetric import rsa
from cryptography.hazmat.primitives.serialization import NoEncryption, pkcs12
from needed import program
from pyhanko.pdf_utils.reader import PdfFileReader

from posstats.errors import PosstatsError
from posstats.reports.archive.signing import PyHankoMissingError, SigningError, sign
from posstats.reports.commands.sign import sign_file

COMMAND = Path(sys.executable).with_name("posstats")


@pytest.fixture(scope="module")
def archive(tmp_path_factory) -> bytes:
    folder = tmp_path_factory.mktemp("inputs")
    write_inputs(folder)
    return document(results_of(folder))


@pytest.fixture
def folder(archive, tmp_path) -> Path:
    (tmp_path / "a.pdf").write_bytes(archive)
    (tmp_path / "key.p12").write_bytes(p12(certificate()))
    (tmp_path / "word").write_bytes(b"secret\nand no more\n")
    return tmp_path


def run(folder: Path, *, document="a.pdf", key="key.p12", out="out.pdf", word="word") -> str:
    paths = (folder / document, folder / key, folder / out, folder / word)
    return sign_file(*paths, lambda: pytest.fail("asked"), now=NOW)


def test_the_signed_copy_begins_with_the_document(folder, archive, monkeypatch):
    def refuse(*_, **__):
        raise AssertionError("a connection was tried")

    monkeypatch.setattr("socket.socket.connect", refuse)
    assert "PA-3F2A-91C0-77DE" in run(folder)
    signed = (folder / "out.pdf").read_bytes()
    assert signed.startswith(archive)
    assert b"/ETSI.CAdES.detached" in signed[len(archive) :]
    assert (folder / "a.pdf").read_bytes() == archive
    assert not list(folder.glob(".posstats-*"))


def test_a_signed_document_is_still_one_for_the_archive(folder):
    run(folder)
    signed = (folder / "out.pdf").read_bytes()
    assert problems(signed) == []
    pdf = pikepdf.open(folder / "out.pdf")
    assert "/Version" not in pdf.Root
    assert str(pdf.trailer.Info.ModDate).startswith("D:20260102")


def test_another_program_finds_the_signature_valid(folder):
    run(folder)
    told = subprocess.run(
        [program("pdfsig", package="poppler-utils"), "out.pdf"],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | {"HOME": str(folder)},
    ).stdout
    assert "Signature is Valid" in told
    assert "Total document signed" in told


def test_a_further_signature_is_appended(folder):
    run(folder)
    run(folder, document="out.pdf", out="twice.pdf")
    once, twice = ((folder / name).read_bytes() for name in ("out.pdf", "twice.pdf"))
    assert twice.startswith(once)
    pdf = pikepdf.open(folder / "twice.pdf")
    fields = pdf.Root.AcroForm.Fields
    assert [str(each.T) for each in fields] == ["Signature1", "Signature2"]


def test_an_rsa_key_without_passphrase_signs(archive):
    key = rsa.generate_private_key(public_exponent=65537, key_size=2048)
    made = certificate("RSA Survey Ltd")
    builder = (
        x509.CertificateBuilder(made.issuer, made.subject, key.public_key())
        .serial_number(1)
        .not_valid_before(made.not_valid_before_utc)
        .not_valid_after(made.not_valid_after_utc)
    )
    own = builder.sign(key, hashes.SHA256())
    packed = pkcs12.serialize_key_and_certificates(b"k", key, own, None, NoEncryption())
    assert sign(archive, packed, b"", now=NOW).startswith(archive)


@pytest.mark.parametrize(
    ("key", "passphrase", "word"),
    [
        (p12(certificate()), b"guess", "passphrase is wrong"),
        (p12(certificate()), b"", "passphrase is wrong"),
        (b"no key", b"secret", "no PKCS #12"),
        (b"", b"secret", "no PKCS #12"),
        (p12(certificate(days=(-20, -10))), b"secret", "valid from"),
        (p12(certificate(days=(10, 20))), b"secret", "valid from"),
        (p12(certificate(usage=False)), b"secret", "key usage"),
        (pkcs12.serialize_key_and_certificates(None, None, None, [certificate()], NoEncryption()),
         b"", "no private key"),
    ],
)  # fmt: skip
def test_a_key_that_cannot_sign_is_refused(archive, key, passphrase, word):
    with pytest.raises(SigningError, match=word):
        sign(archive, key, passphrase, now=NOW)


@pytest.mark.parametrize("link", [Path.symlink_to, Path.hardlink_to])
def test_the_document_is_never_written_over(folder, archive, link):
    with pytest.raises(PosstatsError, match="left alone"):
        run(folder, out="a.pdf")
    link(folder / "same.pdf", folder / "a.pdf")
    with pytest.raises(PosstatsError, match="left alone"):
        run(folder, out="same.pdf")
    assert (folder / "a.pdf").read_bytes() == archive


def test_a_link_as_output_is_replaced_not_followed(folder):
    (folder / "mine.txt").write_text("mine")
    (folder / "out.pdf").symlink_to(folder / "mine.txt")
    run(folder)
    assert (folder / "mine.txt").read_text() == "mine"
    assert (folder / "out.pdf").read_bytes().startswith(b"%PDF-")


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"out": "."}, "is a folder"),
        ({"document": "."}, "is no file"),
        ({"document": "word"}, "no PDF"),
        ({"document": "other.pdf"}, "not signed"),
        ({"key": "."}, "is no file"),
        ({"word": "key.p12"}, "no text"),
    ],
)
def test_what_cannot_be_signed_is_said_and_nothing_is_written(folder, change, word):
    pikepdf.new().save(folder / "other.pdf")
    before = {path.name for path in folder.iterdir()}
    with pytest.raises(PosstatsError, match=word):
        run(folder, **change)
    assert {path.name for path in folder.iterdir()} == before


def test_without_pyhanko_the_extra_is_named(folder, monkeypatch):
    monkeypatch.setitem(sys.modules, "pyhanko.sign", None)
    with pytest.raises(PyHankoMissingError, match=r"posstats\[sign\]"):
        run(folder)


def test_the_passphrase_is_asked_for_without_showing_it(folder):
    (folder / "key.p12").write_bytes(p12(certificate(days=ALWAYS)))
    arguments = [COMMAND, "sign", "a.pdf", "--p12", "key.p12", "--out", "out.pdf"]
    ours, theirs = pty.openpty()
    with subprocess.Popen(
        arguments, stdin=theirs, stdout=theirs, stderr=theirs, cwd=folder, start_new_session=True
    ) as process:
        os.close(theirs)
        shown = os.read(ours, 100)
        while b"Passphrase" not in shown:
            shown += os.read(ours, 100)
        os.write(ours, b"secret\n")
        assert process.wait() == 0
    shown += os.read(ours, 1000)
    os.close(ours)
    assert b"secret" not in shown
    assert (folder / "out.pdf").exists()


def test_without_terminal_the_file_for_the_passphrase_is_named(folder):
    run = subprocess.run(
        [COMMAND, "sign", "a.pdf", "--p12", "key.p12", "--out", "out.pdf"],
        cwd=folder,
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 1
    assert "--passphrase-file" in run.stderr
    assert "Traceback" not in run.stderr


def test_a_signature_states_the_time_given(folder):
    """In the form field, with the offset of the time zone, and under the signature."""
    run(folder)
    pdf = pikepdf.open(folder / "out.pdf")
    stated = str(pdf.Root.AcroForm.Fields[0].V.M)
    written = stated[2:].replace("'", "").replace("Z", "+0000")[:19]
    assert dt.datetime.strptime(written, "%Y%m%d%H%M%S%z") == NOW
    (signature,) = PdfFileReader(io.BytesIO((folder / "out.pdf").read_bytes())).embedded_signatures
    assert signature.self_reported_timestamp == NOW
