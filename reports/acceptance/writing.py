"""The three files of an acceptance: page, archive document, data."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from posstats.contract.acceptance import Acceptance
from posstats.contract.files import to_json
from posstats.contract.results import Results
from posstats.errors import PosstatsError

from ..archive.writing import Attachment, render_archive
from ..pages.pdf import PdfUnavailableError
from .data import ACCEPTANCE
from .page import render_document

_TEMPLATE_SUFFIXES = (".j2", ".css", ".svg", ".png", ".jpg", ".jpeg")
_LARGEST_TEMPLATES = 10_000_000


def write_document(
    acceptance: Acceptance,
    results: Results,
    templates: Mapping[str, bytes],
    files: Sequence[Attachment],
    folder: Path,
    *,
    pdf: bool = True,
) -> str:
    """Write ``acceptance.json``, ``acceptance.html`` and ``acceptance.pdf`` into a folder.

    Returns
    -------
    str
        What is missing for a PDF, where one was wanted and none could be made; else empty.
    """
    text = to_json(acceptance)
    (folder / ACCEPTANCE).write_text(text, encoding="utf-8")
    page = render_document(acceptance, results, templates)
    (folder / "acceptance.html").write_text(page, encoding="utf-8")
    data = Attachment(ACCEPTANCE, text.encode("utf-8"), "Data")
    try:
        if pdf:
            identifier = acceptance.document_id.encode("ascii")
            written = render_archive(page, [*files, data], acceptance.created, identifier)
            (folder / "acceptance.pdf").write_bytes(written)
    except PdfUnavailableError as missing:
        return str(missing)
    return ""


def read_templates(folder: Path) -> dict[str, bytes]:
    """Templates and images of a user's folder, by name.

    Raises
    ------
    PosstatsError
        If it is no folder, holds none, or something that is none.
    """
    if not folder.is_dir():
        raise PosstatsError(f"--templates {folder}: is no folder")
    paths = sorted(path for path in folder.iterdir() if not path.name.startswith("."))
    strange = [path.name for path in paths
               if path.suffix not in _TEMPLATE_SUFFIXES or not path.is_file()]  # fmt: skip
    if strange or not paths:
        found = ", ".join(strange) or "nothing"
        raise PosstatsError(
            f"--templates {folder}: found {found}, expected files {', '.join(_TEMPLATE_SUFFIXES)}"
        )
    if sum(path.stat().st_size for path in paths) > _LARGEST_TEMPLATES:
        raise PosstatsError(f"--templates {folder}: more than 10 MB are not embedded")
    return {path.name: path.read_bytes() for path in paths}
