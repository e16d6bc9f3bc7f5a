"""Pages and figures of a document as files."""

from collections.abc import Iterable
from pathlib import Path

from ..document.drawing import Drawing
from ..document.numbering import ReportDocument
from . import html
from . import pdf as pdf_writer
from .garbage import garbage_kept


def write_figures(pictures: Iterable[Drawing], folder: Path) -> None:
    """Write figures as ``<name>.svg`` into a folder, made if it does not exist."""
    folder.mkdir(parents=True, exist_ok=True)
    for each in pictures:
        text = f'<?xml version="1.0" encoding="utf-8"?>\n{each.svg}'
        (folder / f"{each.name}.svg").write_text(text, encoding="utf-8")


def write_pages(document: ReportDocument, path: Path, *, pdf: bool = True) -> str:
    """Write a document as ``path.html`` and ``path.pdf``; `path` is without suffix.

    The PDF comes last: if it cannot be made, the rest is there.

    Returns
    -------
    str
        What is missing for a PDF, where one was wanted and none could be made; else empty.
    """
    with garbage_kept():
        page = html.render(document)
        path.with_suffix(".html").write_text(page, encoding="utf-8")
        try:
            if pdf:
                path.with_suffix(".pdf").write_bytes(pdf_writer.render(page))
        except pdf_writer.PdfUnavailableError as missing:
            return str(missing)
    return ""
