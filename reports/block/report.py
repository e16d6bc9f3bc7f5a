"""Everything that is written for one block: tables, figures, HTML and PDF."""

from pathlib import Path

from posstats.contract.choices import DEFAULT_LANGUAGE, Language
from posstats.contract.results import Results

from ..pages.garbage import garbage_kept
from ..pages.writing import write_figures, write_pages
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
