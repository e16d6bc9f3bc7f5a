"""Whether the pages say what the data say: the pages are made again and compared."""

from collections.abc import Iterator, Mapping

import pikepdf
from jinja2 import TemplateError

from posstats.contract.acceptance import Acceptance
from posstats.errors import PosstatsError

from ..archive.reading import MALFORMED, Archive, decoded, open_pdf, written
from ..archive.writing import Attachment, render_archive
from .steps import Steps
from .text import page_texts
from .words import (
    NOT_HERE,
    PAGES,
    SAME_BYTES,
    SAME_DECODED,
    Answer,
    answer,
    failed,
    listed,
    other_versions,
    own_templates,
    same_text,
)

TEMPLATES = "templates/"


def pages(archive: Archive, steps: Steps, known: Mapping[str, bytes] | None = None) -> Answer:
    """Make the document again from the data inside it, and compare it with the first revision.

    Parameters
    ----------
    known
        Templates that the user knows, by name. Others that the document brings along may say or
        hide anything, whatever the data: then nothing is compared.
    """
    strange = _unknown_templates(archive, known or {})
    if strange:
        return failed(PAGES, own_templates(strange))
    try:
        again = rebuilt(archive, steps)
        if again == archive.file.first:
            return answer(PAGES, [], SAME_BYTES)
        shown, made = open_pdf(archive.file.first), open_pdf(again)
        if made_with(archive.acceptance) == steps.layout:
            problems = _differences(shown, made) or _unexplained(shown, made)
            return answer(PAGES, problems, SAME_DECODED)
        return _text_answer(archive, steps, shown, made)
    except (PosstatsError, OSError, TemplateError, *MALFORMED) as error:
        return failed(PAGES, f"they cannot be compared ({type(error).__name__}: {error})")


def _unknown_templates(archive: Archive, known: Mapping[str, bytes]) -> list[str]:
    """Names of the document's templates and style sheets that the user does not know."""
    return [
        short
        for short, content in _templates(archive).items()
        if short.endswith((".j2", ".css")) and known.get(short) != content
    ]


def _templates(archive: Archive) -> dict[str, bytes]:
    return {
        name.removeprefix(TEMPLATES): file.content
        for name, file in archive.files.items()
        if name.startswith(TEMPLATES)
    }


def rebuilt(archive: Archive, steps: Steps) -> bytes:
    """The document made again from the data inside it."""
    acceptance = archive.acceptance
    html = steps.render_document(acceptance, archive.results, _templates(archive))
    attachments = [
        Attachment(name, file.content, file.relationship)  # type: ignore[arg-type]
        for name, file in archive.files.items()
    ]
    identifier = acceptance.document_id.encode("ascii")
    return render_archive(html, attachments, acceptance.created, identifier)


def made_with(acceptance: Acceptance) -> str:
    """Versions that the pages depend on, as an acceptance states them."""
    weasyprint = acceptance.versions.get("weasyprint")
    return f"posstats {acceptance.posstats_version}, WeasyPrint {weasyprint}"


def _differences(shown: pikepdf.Pdf, made: pikepdf.Pdf) -> list[str]:
    if len(shown.pages) != len(made.pages):
        return [f"it has {len(shown.pages)} pages, the data make {len(made.pages)}"]
    pairs = enumerate(zip(shown.pages, made.pages, strict=True), 1)
    found = [
        f"page {number} is not what the data make"
        for number, (one, other) in pairs
        if decoded(one.Contents) != decoded(other.Contents)
    ]
    return found or list(_other_differences(shown, made))


def _other_differences(shown: pikepdf.Pdf, made: pikepdf.Pdf) -> Iterator[str]:
    """What pages share: fonts, figures, links, tags, metadata."""
    if len(shown.objects) != len(made.objects):
        yield "it holds other objects than the data make"
        return
    for one, other in zip(shown.objects, made.objects, strict=True):
        if _unpacked(one) != _unpacked(other):
            yield f"object {one.objgen[0]} ({_kind(one)}) is not what the data make"


def _unexplained(shown: pikepdf.Pdf, made: pikepdf.Pdf) -> list[str]:
    """Bytes differ although all objects are the same: another compression changes most streams."""
    pairs = zip(shown.objects, made.objects, strict=True)
    streams = [(one, other) for one, other in pairs if isinstance(one, pikepdf.Stream)]
    changed = [one for one, other in streams if one.read_raw_bytes() != other.read_raw_bytes()]
    if 2 * len(changed) >= len(streams):
        return []
    names = [f"object {each.objgen[0]} was packed again" for each in changed]
    return names or ["bytes that belong to no page or file were changed"]


def _unpacked(value: pikepdf.Object) -> tuple[object, bytes]:
    """Contents of a stream however they are packed; images as they are."""
    if not isinstance(value, pikepdf.Stream):
        return written(value, resolved=True), b""
    if "/DecodeParms" in value or value.get("/Filter") not in (None, pikepdf.Name.FlateDecode):
        return value.stream_dict.unparse(), value.read_raw_bytes()
    entries = {key: written(entry) for key, entry in value.stream_dict.items()}
    entries.pop("/Length", None)
    return entries, decoded(value)


def _kind(value: pikepdf.Object) -> str:
    if not isinstance(value, pikepdf.Dictionary | pikepdf.Stream):
        return "no dictionary"
    kind = value.get("/Type", value.get("/S", "no type"))
    return str(kind).lstrip("/")


def _text_answer(archive: Archive, steps: Steps, shown: pikepdf.Pdf, made: pikepdf.Pdf) -> Answer:
    other = other_versions(made_with(archive.acceptance), steps.layout)
    if _title(shown) != _title(made):
        return failed(PAGES, f"{NOT_HERE}: the title or author differs; {other}")
    said, again = page_texts(shown), page_texts(made)
    if len(said) != len(again):
        return failed(PAGES, f"{NOT_HERE}: {len(said)} pages, not {len(again)}; {other}")
    found = [
        f"page {n}" for n, pair in enumerate(zip(said, again, strict=True), 1) if len(set(pair)) > 1
    ]
    if found:
        return failed(PAGES, f"{NOT_HERE}: the text differs on {listed(found)}; {other}")
    return answer(PAGES, [], same_text(other))


def _title(pdf: pikepdf.Pdf) -> dict[str, str]:
    return {key: str(entry) for key, entry in pdf.docinfo.items() if key != "/Producer"}
