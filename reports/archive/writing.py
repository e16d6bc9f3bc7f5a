"""HTML to PDF/A-3a by WeasyPrint: for the archive, with the data of the document inside."""

import base64
import datetime as dt
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any, get_args

from posstats.contract.acceptance import Relationship
from posstats.errors import PosstatsError

from ..pages import pdf
from ..pages.garbage import garbage_kept
from .mending import mend

# As `pdf.load` gives them: WeasyPrint is imported where it is needed.
WeasyPrint = Any
Fetcher = Any

BASE = "posstats:/"  # relative addresses lead nowhere; without any, WeasyPrint fails on some
RELATIONSHIPS = get_args(Relationship)

# Of our files, so that no data base of the system decides on what is written.
MIME_TYPES = {
    ".css": "text/css",
    ".csv": "text/csv",
    ".j2": "text/plain",
    ".jpeg": "image/jpeg",
    ".jpg": "image/jpeg",
    ".json": "application/json",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".toml": "application/toml",
    ".txt": "text/plain",
}
DESCRIPTIONS = {  # a function of the name alone: `posstats verify` writes them again
    "Alternative": "the document in another form",
    "Data": "data that the pages show",
    "Source": "what the data were made from",
    "Supplement": "more than the pages show",
    "Unspecified": "embedded file",
}


class ArchiveError(PosstatsError):
    """A document that cannot be written for the archive."""


@dataclass(frozen=True)
class Attachment:
    """A file inside the document.

    Attributes
    ----------
    name
        May have folders: ``tables/models.csv``.
    relationship
        To the pages, of ISO 19005-3: Data, Source, Supplement, Alternative or Unspecified.
    """

    name: str
    content: bytes
    relationship: Relationship = "Data"


@garbage_kept()
def render_archive(
    html_text: str, attachments: Sequence[Attachment], created: str, identifier: bytes
) -> bytes:
    """Render a self-contained HTML page as PDF/A-3a: the same bytes for the same arguments.

    Parameters
    ----------
    attachments
        Associated files, in any order.
    created
        ISO 8601 time with its zone: of the document and its files; no clock is read.
    identifier
        Permanent part of the file identifier, ASCII.

    Raises
    ------
    ArchiveError
        For a time without zone, two attachments of one name, or an unknown relationship.
    PdfUnavailableError
        If the libraries that WeasyPrint needs are not installed.
    """
    moment = _moment(created)
    files = _in_order(attachments)
    weasyprint, fetcher = pdf.load()
    document = weasyprint.HTML(string=html_text, base_url=BASE, url_fetcher=fetcher).render()
    document.metadata.created = document.metadata.modified = created
    document.metadata.generator = "posstats"
    with warnings.catch_warnings():
        # WeasyPrint 70 does not close its own colour profile
        warnings.filterwarnings("ignore", "unclosed file", ResourceWarning)
        written: bytes = document.write_pdf(
            finisher=mend,
            pdf_variant="pdf/a-3a",
            pdf_identifier=identifier,
            uncompressed_pdf=True,  # no object streams; `mend` compresses the streams one by one
            attachments=[_embedded(weasyprint, fetcher, file, moment) for file in files],
        )
    return written


def _moment(created: str) -> dt.datetime:
    try:
        moment = dt.datetime.fromisoformat(created)
    except (TypeError, ValueError) as error:
        raise ArchiveError(f"{created!r} is no ISO 8601 time") from error
    if moment.tzinfo is None:
        raise ArchiveError(f"{created!r} has no time zone")
    return moment.astimezone(dt.UTC)


def _in_order(attachments: Sequence[Attachment]) -> list[Attachment]:
    """Sorted as a name tree has to be: by the bytes of the names."""
    names = [file.name for file in attachments]
    for file in attachments:
        if names.count(file.name) > 1:
            raise ArchiveError(f"two attachments have the name {file.name}")
        if file.relationship not in RELATIONSHIPS:
            raise ArchiveError(f"{file.name}: {file.relationship!r} is no relationship of PDF/A-3")
    return sorted(attachments, key=lambda file: file.name.encode())


def _embedded(
    weasyprint: WeasyPrint, fetcher: Fetcher, file: Attachment, moment: dt.datetime
) -> object:
    """As a ``data:`` URI, which states its type itself."""
    kind = MIME_TYPES.get(PurePosixPath(file.name).suffix.lower(), "application/octet-stream")
    return weasyprint.Attachment(
        url=f"data:{kind};base64,{base64.b64encode(file.content).decode('ascii')}",
        url_fetcher=fetcher,
        name=file.name,
        description=f"{file.name}: {DESCRIPTIONS[file.relationship]}",
        created=moment,
        modified=moment,
        relationship=file.relationship,
    )
