"""Electronic signatures on documents: PAdES B-B by pyHanko, without any network.

pyHanko is the optional extra ``sign``.
"""

import datetime as dt
import io
import logging
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from posstats.errors import PosstatsError

if TYPE_CHECKING:
    from cryptography.x509 import Certificate
    from pyhanko.sign import SimpleSigner

EXTRA = "pip install 'posstats[sign]'"


class SigningError(PosstatsError):
    """A document that cannot be signed with this key."""


class PyHankoMissingError(PosstatsError):
    """The optional extra ``sign`` is not installed."""


def require_pyhanko() -> None:
    """Import pyHanko.

    Raises
    ------
    PyHankoMissingError
        If it is not installed.
    """
    try:
        import pyhanko.sign  # noqa: F401
    except ImportError as error:
        raise PyHankoMissingError(f"signatures need the optional extra sign: {EXTRA}") from error


def sign(data: bytes, key_file: bytes, passphrase: bytes, *, now: dt.datetime) -> bytes:
    """Append a signature to a PDF, whose own bytes stay in front unchanged.

    Parameters
    ----------
    key_file
        PKCS #12: a private key with its certificate, and those of the issuers.
    now
        The time that the signature states; the certificate has to be valid then.

    Raises
    ------
    SigningError
        For a wrong passphrase, a key file without key, a certificate that is not valid now or may
        not sign, a PDF that cannot be extended.
    PyHankoMissingError
        Without pyHanko.
    """
    require_pyhanko()
    from pyhanko.pdf_utils.misc import PdfError
    from pyhanko.sign.general import SigningError as RefusedSignature

    signer = _signer(key_file, passphrase, now)
    try:
        with quiet_pyhanko():
            signed = _appended(data, signer, now)
    except (PdfError, RefusedSignature, ValueError) as error:
        raise SigningError(f"the signature failed: {error}") from error
    if not signed.startswith(data):
        raise SigningError("the signature would change the document")
    return signed


@contextmanager
def quiet_pyhanko() -> Iterator[None]:
    """Keep pyHanko's log, tracebacks included, off the terminal: what it finds is returned."""
    loggers = [logging.getLogger(name) for name in ("pyhanko", "pyhanko_certvalidator")]
    levels = [logger.level for logger in loggers]
    for logger in loggers:
        logger.setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for logger, level in zip(loggers, levels, strict=True):
            logger.setLevel(level)


def _appended(data: bytes, signer: "SimpleSigner", now: dt.datetime) -> bytes:
    from pyhanko.pdf_utils.incremental_writer import IncrementalPdfFileWriter
    from pyhanko.sign import PdfSignatureMetadata, PdfSigner
    from pyhanko.sign.fields import SigSeedSubFilter, enumerate_sig_fields

    class Writer(IncrementalPdfFileWriter):
        """Adds no more than the signature: PDF/A-3 is PDF 1.7, and metadata stay as they are."""

        def ensure_output_version(self, version: object) -> None:
            """Leave the version alone."""

        def _update_meta(self) -> None:
            """Leave producer and dates alone."""

    class Signer(PdfSigner):
        """States the time given, where pyHanko reads the clock."""

        def init_signing_session(self, *arguments: Any, **options: Any) -> Any:
            """Begin to sign, at the time given."""
            session = super().init_signing_session(*arguments, **options)
            session.system_time = now.astimezone()
            return session

    writer = Writer(io.BytesIO(data))
    taken = {name for name, _, _ in enumerate_sig_fields(writer)}
    free = next(n for n in range(1, len(taken) + 2) if f"Signature{n}" not in taken)
    settings = PdfSignatureMetadata(
        field_name=f"Signature{free}", md_algorithm="sha256", subfilter=SigSeedSubFilter.PADES
    )
    signed: bytes = Signer(settings, signer).sign_pdf(writer).getvalue()
    return signed


def _signer(key_file: bytes, passphrase: bytes, now: dt.datetime) -> "SimpleSigner":
    from cryptography.hazmat.primitives.serialization import pkcs12
    from pyhanko.sign import SimpleSigner

    try:
        key, certificate, _ = pkcs12.load_key_and_certificates(key_file, passphrase or None)
    except (ValueError, TypeError) as error:
        raise SigningError(
            "the key file cannot be opened: the passphrase is wrong, or it is no PKCS #12 file"
        ) from error
    if key is None or certificate is None:
        raise SigningError("the key file holds no private key with its certificate")
    _require_validity(certificate, now)
    try:
        signer: SimpleSigner = SimpleSigner.load_pkcs12_data(key_file, [], passphrase or None)
    except ValueError as error:
        raise SigningError(f"this kind of key cannot sign: {error}") from error
    return signer


def _require_validity(certificate: "Certificate", now: dt.datetime) -> None:
    """Neither too early nor too late, and meant for signatures."""
    from cryptography import x509

    begin, end = certificate.not_valid_before_utc, certificate.not_valid_after_utc
    if not begin <= now <= end:
        raise SigningError(
            f"the certificate is valid from {begin:%Y-%m-%d} to {end:%Y-%m-%d}, not on"
            f" {now:%Y-%m-%d}"
        )
    try:
        usage = certificate.extensions.get_extension_for_class(x509.KeyUsage).value
    except x509.ExtensionNotFound:
        return
    if not (usage.digital_signature or usage.content_commitment):
        raise SigningError("the certificate is not for signatures: its key usage excludes them")
