"""Everything that is written for one block: tables, figures, HTML and PDF."""

from collections.abc import Iterable
from pathlib import Path

from posstats.contract.choices import DEFAULT_LANGUAGE, Language
from posstats.contract.results import Results

from ..document.drawing import Drawing
from ..document.numbering import ReportDocument
from ..pages import html
from ..pages import pdf as pdf_writer
from ..pages.garbage import garbage_kept
from .csv_files import write_tables
from .document import build, drawings


def write_report(
    results: Results, folder: Path, *, language: Language = DEFAULT_LANGUAGE, pdf: bool = True
) -> str:
    """Write ``tables/*.csv``, ``figures/*.svg``, ``report.html`` and ``report.pdf`` into a folder.

    Returns
    -------
    str
        What is missing for a PDF, where one was wanted and none could be made; else empty.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with garbage_kept():
        write_tables(results, folder / "tables")
        document = build(results, language)
        write_figures(drawings(document), folder / "figures")
        return write_pages(document, folder / "report", pdf=pdf)


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
