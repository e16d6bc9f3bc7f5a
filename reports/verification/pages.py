"""Whether the pages say what the data say: the pages are made again and compared."""

from collections.abc import Iterator, Mapping

import pikepdf
from jinja2 import TemplateError

from posstats.contract.acceptance import Acceptance
from posstats.contract.notice import Notice
from posstats.errors import PosstatsError

from ..archive.reading import MALFORMED, Archive, decoded, open_pdf, written
from ..archive.writing import Attachment, render_archive
from .answers import PAGES, Answer, answer, failed, said
from .steps import Steps
from .text import page_texts

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
        return failed(PAGES, said("own_templates", files=tuple(strange)))
    try:
        again = rebuilt(archive, steps)
        if again == archive.file.first:
            return answer(PAGES, [], said("same_bytes"))
        shown, made = open_pdf(archive.file.first), open_pdf(again)
        if made_with(archive.acceptance) == steps.layout:
            problems = _differences(shown, made) or _unexplained(shown, made)
            return answer(PAGES, problems, said("same_contents"))
        return _text_answer(archive, steps, shown, made)
    except (PosstatsError, OSError, TemplateError, *MALFORMED) as error:
        reason = f"{type(error).__name__}: {error}"
        return failed(PAGES, said("pages_incomparable", reason=reason))


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


def _differences(shown: pikepdf.Pdf, made: pikepdf.Pdf) -> list[Notice]:
    if len(shown.pages) != len(made.pages):
        return [said("page_count", n_shown=len(shown.pages), n_made=len(made.pages))]
    pairs = enumerate(zip(shown.pages, made.pages, strict=True), 1)
    found = [
        said("page_differs", number=number)
        for number, (one, other) in pairs
        if decoded(one.Contents) != decoded(other.Contents)
    ]
    return found or list(_other_differences(shown, made))


def _other_differences(shown: pikepdf.Pdf, made: pikepdf.Pdf) -> Iterator[Notice]:
    """What pages share: fonts, figures, links, tags, metadata."""
    if len(shown.objects) != len(made.objects):
        yield said("other_objects")
        return
    for one, other in zip(shown.objects, made.objects, strict=True):
        if _unpacked(one) != _unpacked(other):
            yield said("object_differs", number=one.objgen[0], kind=_kind(one))


def _unexplained(shown: pikepdf.Pdf, made: pikepdf.Pdf) -> list[Notice]:
    """Bytes differ although all objects are the same: another compression changes most streams."""
    pairs = zip(shown.objects, made.objects, strict=True)
    streams = [(one, other) for one, other in pairs if isinstance(one, pikepdf.Stream)]
    changed = [one for one, other in streams if one.read_raw_bytes() != other.read_raw_bytes()]
    if 2 * len(changed) >= len(streams):
        return []
    repacked = [said("object_repacked", number=each.objgen[0]) for each in changed]
    return repacked or [said("other_bytes")]


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
    versions = {"made": made_with(archive.acceptance), "here": steps.layout}
    problems = list(_text_differences(shown, made))
    if problems:
        return failed(PAGES, *problems, said("other_versions", **versions), hedged=True)
    return answer(PAGES, [], said("same_text", **versions))


def _text_differences(shown: pikepdf.Pdf, made: pikepdf.Pdf) -> Iterator[Notice]:
    if _title(shown) != _title(made):
        yield said("title_differs")
        return
    told, again = page_texts(shown), page_texts(made)
    if len(told) != len(again):
        yield said("page_count", n_shown=len(told), n_made=len(again))
        return
    for number, (one, other) in enumerate(zip(told, again, strict=True), 1):
        if one != other:
            yield said("text_differs", number=number)


def _title(pdf: pikepdf.Pdf) -> dict[str, str]:
    return {key: str(entry) for key, entry in pdf.docinfo.items() if key != "/Producer"}
