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
from .answers import (
    SIGNED,
    TRUSTED,
    Answer,
    Question,
    Standing,
    answer,
    caught,
    failed,
    not_asked,
    said,
)

CLOCKS_DIFFER = dt.timedelta(minutes=10)

# Of pyHanko and asn1crypto, which are imported where they are needed and have no types.
Signature = Any
Status = Any
Certificate = Any
Name = Any


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
        unsigned = [Answer(Standing.NOT_SIGNED, SIGNED, (said("unsigned"),))]
        return unsigned if trust is None else [*unsigned, failed(TRUSTED, said("nobody_signed"))]
    try:
        require_pyhanko()
        with quiet_pyhanko():
            return list(_judged(file, n_found, trust, now))
    except PyHankoMissingError as error:
        return [failed(Question("intact"), caught("because", error))]
    except MALFORMED as error:
        return [failed(Question("intact"), caught("signature_unreadable", error))]


def _judged(
    file: ArchiveFile, n_found: int, trust: Sequence[bytes] | None, now: dt.datetime
) -> Iterator[Answer]:
    from pyhanko.pdf_utils.misc import PdfError
    from pyhanko.pdf_utils.reader import PdfFileReader

    try:
        found = PdfFileReader(io.BytesIO(file.data)).embedded_signatures
    except PdfError as error:
        yield failed(Question("intact"), caught("signature_unreadable", error))
        return
    if len(found) != n_found:
        problem = said("signatures_outside_fields", n_found=n_found, n_fields=len(found))
        yield failed(SIGNED, problem)
    for place, signature in enumerate(found, 1):
        number = place if len(found) > 1 else None
        if signature.sig_object_type == "/DocTimeStamp":
            yield not_asked(Question("intact", number), said("time_stamp"))
            continue
        yield from _judge(file, signature, number, trust, now)


def _judge(
    file: ArchiveFile,
    signature: Signature,
    number: int | None,
    trust: Sequence[bytes] | None,
    now: dt.datetime,
) -> Iterator[Answer]:
    from pyhanko.pdf_utils.misc import PdfError
    from pyhanko.sign.validation.errors import SignatureValidationError

    try:
        status = _status(signature, trust or (), now)
    except (PdfError, SignatureValidationError, *MALFORMED) as error:
        yield failed(Question("intact", number), caught("signature_unchecked", error))
        return
    certificate = signature.signer_cert
    yield _intact(file, signature, status, Question("intact", number))
    claimed = signature.self_reported_timestamp
    yield _in_force(certificate, claimed, Question("in_force", number), now)
    yield _trusted(status, certificate, Question("signer_trusted", number), trust)


def _status(signature: Signature, trust: Sequence[bytes], now: dt.datetime) -> Status:
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


def _intact(file: ArchiveFile, signature: Signature, status: Status, question: Question) -> Answer:
    from pyhanko.sign.diff_analysis import SuspiciousModification

    problems = []
    covered = _covered_bytes(file.data, signature)
    if not (status.intact and status.valid and _is_consistent(signature)):
        problems.append(said("signed_changed"))
    elif covered not in file.ends:
        problems.append(said("signed_incompletely"))
    elif isinstance(status.diff_result, SuspiciousModification):
        problems.append(said("changed_after_signature", reason=str(status.diff_result)))
    signer = _readable(signature.signer_cert.subject)
    holds = (
        said("signed_whole", signer=signer) if covered == len(file.data)
        else said("signed_part", n_bytes=covered, signer=signer)
    )  # fmt: skip
    return answer(question, problems, holds)


def _covered_bytes(data: bytes, signature: Signature) -> int | None:
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


def _is_consistent(signature: Signature) -> bool:
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


def _readable(name: Name) -> str:
    return str(name.human_friendly)


def _in_force(
    certificate: Certificate, claimed: dt.datetime | None, question: Question, now: dt.datetime
) -> Answer:
    """The signing time is the signer's own statement: no certificate is in force by that alone."""
    if claimed is None:
        return failed(question, said("signing_time_missing"))
    begin, end = certificate.not_valid_before, certificate.not_valid_after
    span = {"begin": f"{begin:%Y-%m-%d}", "end": f"{end:%Y-%m-%d}"}
    signed = f"{claimed:%Y-%m-%d}"
    if not begin <= claimed <= end:
        return failed(question, said("signed_outside_validity", **span, signed=signed))
    if claimed > now + CLOCKS_DIFFER:
        return failed(question, said("signed_in_future", signed=signed))
    if not begin <= now <= end:
        return failed(question, said("no_longer_in_force", **span, signed=signed))
    return answer(question, [], said("in_force", **span, signed=signed))


def _trusted(
    status: Status, certificate: Certificate, question: Question, trust: Sequence[bytes] | None
) -> Answer:
    own = certificate.issuer == certificate.subject
    names = {
        "signer": _readable(certificate.subject),
        "issuer": None if own else _readable(certificate.issuer),
    }
    if trust is None:
        return not_asked(question, said("no_anchor", **names))
    if status.trusted:
        return answer(question, [], said("trusted", **names))
    problem = status.trust_problem_indic
    if problem is None:
        return failed(question, said("untrusted", **names))
    reason = problem.name.lower().replace("_", " ")
    return failed(question, said("untrusted_because", reason=reason, **names))
