"""Everything that is written for one block: tables, figures, HTML and PDF."""

from pathlib import Path

from posstats.contract.results import Results

from ..document.numbering import ReportDocument
from ..pages import html
from ..pages import pdf as pdf_writer
from ..pages.garbage import garbage_kept
from . import document as block_document
from . import figures
from .csv_files import write_tables


def write_report(results: Results, folder: Path, *, pdf: bool = True) -> str:
    """Write ``tables/*.csv``, ``figures/*.svg``, ``report.html`` and ``report.pdf`` into a folder.

    Returns
    -------
    str
        What is missing for a PDF, where one was wanted and none could be made; else empty.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with garbage_kept():
        write_tables(results, folder / "tables")
        drawings = figures.draw(results)
        figures.write_figures(results, folder / "figures", drawings)
        return write_pages(block_document.build(results, drawings), folder / "report", pdf=pdf)


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
