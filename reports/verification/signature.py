"""Who signed a document, whether that is intact, and whether the signer is trusted: by pyHanko."""

import datetime as dt
import io
from collections.abc import Iterator, Sequence
from typing import Any

import pikepdf

from posstats.errors import PosstatsError

from ..archive.file import ArchiveFile, UnreadableArchiveError
from ..archive.reading import MALFORMED
from ..archive.signing import PyHankoMissingError, quiet_pyhanko, require_pyhanko
from .words import (
    NO_ANCHOR,
    SIGNED,
    TRUSTED,
    UNSIGNED,
    UNSIGNED_TRUST,
    Answer,
    Standing,
    answer,
    certificate_question,
    failed,
    intact_question,
    trust_question,
)

CLOCKS_DIFFER = dt.timedelta(minutes=10)


class TrustError(PosstatsError):
    """A file of trusted certificates that holds none."""


def count_signatures(pdf: pikepdf.Pdf) -> int:
    """Signatures anywhere in a document, in a form field or not.

    Raises
    ------
    UnreadableArchiveError
        If an object cannot be read.
    """
    try:
        dictionaries = (each for each in pdf.objects if isinstance(each, pikepdf.Dictionary))
        return sum("/ByteRange" in each for each in dictionaries)
    except MALFORMED as error:
        raise UnreadableArchiveError(f"it is damaged ({error})") from error


def read_trust(content: bytes) -> list[bytes]:
    """Certificates, PEM or DER, as DER.

    Raises
    ------
    TrustError
        If there are none.
    PyHankoMissingError
        Without the extra that can read them.
    """
    require_pyhanko()
    from cryptography import x509
    from cryptography.hazmat.primitives.serialization import Encoding

    try:
        if b"-----BEGIN" in content:
            found = x509.load_pem_x509_certificates(content)
        else:
            found = [x509.load_der_x509_certificate(content)]
    except ValueError as error:
        raise TrustError(f"no certificate can be read ({error})") from error
    return [certificate.public_bytes(Encoding.DER) for certificate in found]


def signatures(
    file: ArchiveFile, n_found: int, trust: Sequence[bytes] | None, now: dt.datetime
) -> list[Answer]:
    """Answers on every signature; on none, that the document is not signed.

    Parameters
    ----------
    trust
        Certificates, DER; None: trust is not asked for.
    """
    if not n_found:
        unsigned = [Answer(Standing.NOT_SIGNED, SIGNED, UNSIGNED)]
        return unsigned if trust is None else [*unsigned, failed(TRUSTED, UNSIGNED_TRUST)]
    try:
        require_pyhanko()
        with quiet_pyhanko():
            return list(_judged(file, n_found, trust, now))
    except PyHankoMissingError as error:
        return [failed(intact_question("the signature"), error)]
    except MALFORMED as error:
        return [failed(intact_question("the signature"), f"it cannot be read ({error})")]


def _judged(
    file: ArchiveFile, n_found: int, trust: Sequence[bytes] | None, now: dt.datetime
) -> Iterator[Answer]:
    from pyhanko.pdf_utils.misc import PdfError
    from pyhanko.pdf_utils.reader import PdfFileReader

    try:
        found = PdfFileReader(io.BytesIO(file.data)).embedded_signatures
    except PdfError as error:
        yield failed(intact_question("the signature"), f"it cannot be read ({error})")
        return
    if len(found) != n_found:
        yield failed(SIGNED, f"{n_found} signatures, but {len(found)} in fields for signatures")
    for number, signature in enumerate(found, 1):
        name = f"signature {number}" if len(found) > 1 else "the signature"
        if signature.sig_object_type == "/DocTimeStamp":
            yield Answer(Standing.NOT_ASKED, intact_question(name), "a time stamp, not checked")
            continue
        yield from _judge(file, signature, name, trust, now)


def _judge(
    file: ArchiveFile, signature: Any, name: str, trust: Sequence[bytes] | None, now: dt.datetime
) -> Iterator[Answer]:
    from pyhanko.pdf_utils.misc import PdfError
    from pyhanko.sign.validation.errors import SignatureValidationError

    try:
        status = _status(signature, trust or (), now)
    except (PdfError, SignatureValidationError, *MALFORMED) as error:
        yield failed(intact_question(name), f"it cannot be checked ({error})")
        return
    certificate = signature.signer_cert
    yield _intact(file, signature, status, name)
    yield _in_force(certificate, signature.self_reported_timestamp, name, now)
    yield _trusted(status, certificate, name, trust)


def _status(signature: Any, trust: Sequence[bytes], now: dt.datetime) -> Any:
    """PyHanko's status; nothing is fetched, and the system's list of authorities is not used."""
    from asn1crypto import x509
    from pyhanko.sign.validation import validate_pdf_signature
    from pyhanko.sign.validation.settings import KeyUsageConstraints
    from pyhanko_certvalidator import ValidationContext

    context = ValidationContext(
        trust_roots=[x509.Certificate.load(each) for each in trust],
        moment=now,
        allow_fetching=False,
        revocation_mode="soft-fail",
    )
    usage = KeyUsageConstraints(key_usage={"digital_signature", "non_repudiation"})
    return validate_pdf_signature(signature, context, key_usage_settings=usage)


def _intact(file: ArchiveFile, signature: Any, status: Any, name: str) -> Answer:
    from pyhanko.sign.diff_analysis import SuspiciousModification

    problems = []
    covered = _covered_bytes(file.data, signature)
    if not (status.intact and status.valid and _is_consistent(signature)):
        problems.append("no, what was signed has been changed, or the signature itself")
    elif covered not in file.ends:
        problems.append("no, it does not cover all that was there when it was made")
    elif isinstance(status.diff_result, SuspiciousModification):
        problems.append(f"no, the document was changed after it ({status.diff_result})")
    whole = covered == len(file.data)
    extent = "the whole file" if whole else f"the first {covered} bytes, later ones follow"
    return answer(intact_question(name), problems, f"yes, over {extent}, by {_signer(signature)}")


def _covered_bytes(data: bytes, signature: Any) -> int | None:
    """Up to where a signature covers everything but itself; None if it does not."""
    if len(signature.byte_range) != 4:
        return None
    start, before, after, length = (int(each) for each in signature.byte_range)
    digits = signature.pkcs7_content.hex()
    own = {f"<{digits}>".encode(), f"<{digits.upper()}>".encode()}
    if start != 0 or data[before:after] not in own or _hides_bytes(signature.pkcs7_content):
        return None
    return after + length


def _hides_bytes(content: bytes) -> bool:
    """Whether the space kept for a signature holds anything but its DER encoding and zeros."""
    from asn1crypto import cms

    encoded: bytes = cms.ContentInfo.load(content).dump(force=True)
    return not content.startswith(encoded) or any(content[len(encoded) :])


def _is_consistent(signature: Any) -> bool:
    """Whether the parts of a CMS object that are not signed are what they have to be."""
    data, signer, certificate = (
        signature.signed_data,
        signature.signer_info,
        signature.signer_cert,
    )
    digests = [
        (each["algorithm"].native, each["parameters"].native)
        for each in (*data["digest_algorithms"], signer["digest_algorithm"])
    ]
    serial = signer["sid"].chosen
    return bool(
        {data["version"].native, signer["version"].native} <= {"v1", "v3"}
        and set(digests) == {(signature.md_algorithm, None)}
        and data["encap_content_info"]["content_type"].native == "data"
        and data["encap_content_info"]["content"].native is None
        and serial["issuer"] == certificate.issuer
        and serial["serial_number"].native == certificate.serial_number
    )


def _signer(signature: Any) -> str:
    return _readable(signature.signer_cert.subject)


def _readable(name: Any) -> str:
    return str(name.human_friendly)


def _in_force(certificate: Any, claimed: dt.datetime | None, name: str, now: dt.datetime) -> Answer:
    """The signing time is the signer's own statement: no certificate is in force by that alone."""
    begin, end = certificate.not_valid_before, certificate.not_valid_after
    span = f"valid from {begin:%Y-%m-%d} to {end:%Y-%m-%d}"
    problems = []
    if claimed is None:
        problems.append("the signature states no time")
    elif not begin <= claimed <= end:
        problems.append(f"no, {span}, but signed on {claimed:%Y-%m-%d}")
    elif claimed > now + CLOCKS_DIFFER:
        problems.append(f"no, signed in the future, on {claimed:%Y-%m-%d}")
    elif not begin <= now <= end:
        problems.append(
            f"no longer, {span}; that it was signed on {claimed:%Y-%m-%d} is the signer's own"
            " statement"
        )
    said = "" if claimed is None else f", signed on {claimed:%Y-%m-%d} as the signer states"
    return answer(certificate_question(name), problems, f"yes, {span}{said}")


def _trusted(status: Any, certificate: Any, name: str, trust: Sequence[bytes] | None) -> Answer:
    own = certificate.issuer == certificate.subject
    issuer = "itself (self-signed)" if own else _readable(certificate.issuer)
    said = f"{_readable(certificate.subject)}, issued by {issuer}"
    question = trust_question(name)
    if trust is None:
        return Answer(Standing.NOT_ASKED, question, f"{NO_ANCHOR}; {said}")
    if status.trusted:
        return answer(question, [], f"yes, {said}")
    problem = status.trust_problem_indic
    reason = f" ({problem.name.lower().replace('_', ' ')})" if problem is not None else ""
    return failed(question, f"no, {said}: does not lead to the certificate given{reason}")
