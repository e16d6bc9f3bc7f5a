"""Everything that is written for one block: tables, figures, HTML and PDF."""

import gc
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from . import block_document, figures, html, tables
from . import pdf as pdf_writer
from .results_view import Results


def write_report(results: Results, folder: Path, *, pdf: bool = True) -> list[Path]:
    """Write ``tables/*.csv``, ``figures/*.svg``, ``report.html`` and ``report.pdf`` into a folder.

    The PDF comes last: if it cannot be made (`PdfUnavailableError`), the rest is there.

    Returns
    -------
    list of Path
        The files written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with _garbage_kept():
        written = tables.write_tables(results, folder / "tables")
        drawings = figures.draw(results)
        written += figures.write_figures(results, folder / "figures", drawings)
        page = html.render(block_document.build(results, drawings))
        written.append(_write(folder / "report.html", page.encode("utf-8")))
        if pdf:
            written.append(_write(folder / "report.pdf", pdf_writer.render(page)))
    return written


@contextmanager
def _garbage_kept() -> Iterator[None]:
    """No search for garbage: pages are trees that live to the end, and walking them costs 25 %."""
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_enabled:
            gc.enable()


def _write(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path
