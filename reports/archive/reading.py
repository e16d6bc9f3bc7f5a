"""A document of `posstats accept`, opened: the data inside it, and nothing believed yet."""

import io
import json
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

import pikepdf

from posstats.contract.acceptance import Acceptance
from posstats.contract.files import from_json
from posstats.contract.results import Results
from posstats.errors import PosstatsError

from .file import ArchiveFile, UnreadableArchiveError

ACCEPTANCE = "acceptance.json"
LARGEST_DECODED_BYTES = 200_000_000

D = TypeVar("D", Acceptance, Results)

# What reading values of any shape can raise.
MALFORMED = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    LookupError,
    RecursionError,
    TypeError,
    ValueError,
    pikepdf.PdfError,
)


@dataclass(frozen=True)
class EmbeddedFile:
    """A file inside a document, with its relationship to the pages."""

    content: bytes
    relationship: str


@dataclass(frozen=True)
class Archive:
    """An opened document.

    Attributes
    ----------
    pdf
        As its readers show it, with all revisions.
    acceptance, results
        The embedded acceptance.json and results.json.
    """

    file: ArchiveFile
    pdf: pikepdf.Pdf
    files: Mapping[str, EmbeddedFile]
    acceptance: Acceptance
    results: Results

    @property
    def stated_acceptance(self) -> dict[str, object]:
        """The values of acceptance.json as they stand there, with keys that nobody reads."""
        return _values(self.files[ACCEPTANCE])

    @property
    def stated_results(self) -> dict[str, object]:
        """The values of results.json as they stand there."""
        return _values(self.files[self.acceptance.results.file])


def open_archive(file: ArchiveFile) -> Archive:
    """Open a document and read the data inside it.

    Raises
    ------
    UnreadableArchiveError
        If it is encrypted, damaged, or no document of `posstats accept`.
    """
    pdf = open_pdf(file.data)
    if ("/Prev" in pdf.trailer) != (len(file.ends) > 1):
        raise UnreadableArchiveError("its revisions are hidden")
    try:
        files = _embedded_files(pdf)
        if ACCEPTANCE not in files:
            raise UnreadableArchiveError(
                f"it is no acceptance document of posstats: no {ACCEPTANCE} is embedded"
            )
        acceptance = _read(files, ACCEPTANCE, Acceptance)
        results = _read(files, acceptance.results.file, Results)
    except MALFORMED as error:
        raise UnreadableArchiveError(f"its embedded data are damaged ({error})") from error
    return Archive(file, pdf, files, acceptance, results)


def open_pdf(data: bytes) -> pikepdf.Pdf:
    """Open a PDF as it is: nothing is repaired.

    Raises
    ------
    UnreadableArchiveError
        If it is encrypted or damaged.
    """
    try:
        pdf = pikepdf.open(io.BytesIO(data), attempt_recovery=False, suppress_warnings=True)
    except pikepdf.PasswordError as error:
        raise UnreadableArchiveError("it is encrypted") from error
    except (pikepdf.PdfError, *MALFORMED) as error:
        raise UnreadableArchiveError(f"it is damaged ({error})") from error
    if pdf.is_encrypted:
        raise UnreadableArchiveError("it is encrypted")
    if "/XRefStm" in pdf.trailer:
        raise UnreadableArchiveError("it has two cross-reference tables at once")
    return pdf


def decoded(stream: pikepdf.Object, room: int = LARGEST_DECODED_BYTES) -> bytes:
    """The contents of a stream, unpacked up to a size.

    Raises
    ------
    UnreadableArchiveError
        If it is larger, or packed in a way that posstats does not use.
    """
    raw = stream.read_raw_bytes()
    packed = stream.get("/Filter")
    if packed is None:
        return raw
    if packed != pikepdf.Name.FlateDecode or "/DecodeParms" in stream:
        raise UnreadableArchiveError(f"a stream is packed with {packed}")
    unpacking = zlib.decompressobj()
    try:
        content = unpacking.decompress(raw, room + 1)
    except zlib.error as error:
        raise UnreadableArchiveError(f"a stream is damaged ({error})") from error
    if len(content) > room:
        raise UnreadableArchiveError(f"unpacked, it is larger than {room / 1e6:.0f} MB")
    if not unpacking.eof:
        raise UnreadableArchiveError("a stream is damaged (it is not complete)")
    return content


def written(value: object, *, resolved: bool = False) -> bytes:
    """A value as PDF writes it, references as such; pikepdf gives numbers as those of Python.

    Parameters
    ----------
    resolved
        Write what the value itself refers to, not the reference.
    """
    if isinstance(value, pikepdf.Object):
        return value.unparse(resolved=resolved)
    return repr(value).encode()


def _embedded_files(pdf: pikepdf.Pdf) -> dict[str, EmbeddedFile]:
    files: dict[str, EmbeddedFile] = {}
    room = LARGEST_DECODED_BYTES
    for specification in _specifications(pdf):
        name = str(specification.UF)
        if name in files:
            raise UnreadableArchiveError(f"two embedded files have the name {name}")
        content = decoded(specification.EF.F, room)
        room -= len(content)
        files[name] = EmbeddedFile(content, str(specification.AFRelationship).lstrip("/"))
    return files


def _specifications(pdf: pikepdf.Pdf) -> Iterator[pikepdf.Object]:
    tree = pdf.Root.get("/Names", pikepdf.Dictionary()).get("/EmbeddedFiles")
    return iter(()) if tree is None else iter(pikepdf.NameTree(tree).values())


def _read(files: Mapping[str, EmbeddedFile], name: str, kind: type[D]) -> D:
    if name not in files:
        raise UnreadableArchiveError(f"the embedded file {name} is missing")
    try:
        return from_json(files[name].content, kind, name)
    except PosstatsError as error:
        raise UnreadableArchiveError(f"its embedded data are damaged ({error})") from error


def _values(file: EmbeddedFile) -> dict[str, object]:
    values: dict[str, object] = json.loads(file.content)
    return values
