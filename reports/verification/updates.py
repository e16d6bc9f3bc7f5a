"""What incremental updates did to a document: signatures may be added, nothing else may change.

Looked at as a reader of PDF does, with all revisions, and without any cryptography: a signature
proves who appended something, not that it is harmless.
"""

from collections.abc import Iterator

import pikepdf

from posstats.contract.notice import Notice

from ..archive.file import ArchiveFile
from ..archive.reading import open_pdf, written
from .answers import APPENDED, Answer, answer, said

_CATALOG_ADDITIONS = {"/AcroForm", "/DSS", "/Extensions", "/Version"}
_FORM_KEYS = {"/DA", "/DR", "/Fields", "/SigFlags"}
_ACTIONS = {"/A", "/AA", "/Kids"}
_CHANGING_INFO = {"/ModDate", "/Producer"}
_CHANGING_METADATA = {
    "{http://ns.adobe.com/pdf/1.3/}Producer",
    "{http://ns.adobe.com/xap/1.0/}MetadataDate",
    "{http://ns.adobe.com/xap/1.0/}ModifyDate",
}


def appended(file: ArchiveFile, pdf: pikepdf.Pdf, n_signatures: int) -> Answer:
    """Compare the first revision with the document as it is shown.

    Raises
    ------
    UnreadableArchiveError
        If the first revision is no PDF of its own.
    """
    if len(file.ends) == 1 and file.ends[0] == len(file.data):
        return answer(APPENDED, [], said("nothing_appended"))
    first = open_pdf(file.first)
    problems = [said("revisions_hidden")] if "/Prev" in first.trailer else []
    problems += _changes(first, pdf)
    updates = len(file.ends) - 1
    if updates != n_signatures:
        problems.append(
            said("updates_without_signatures", n_updates=updates, n_signatures=n_signatures)
        )
    if file.ends[-1] != len(file.data):
        problems.append(said("bytes_behind_end"))
    return answer(APPENDED, problems, said("only_signatures"))


def _changes(first: pikepdf.Pdf, last: pikepdf.Pdf) -> Iterator[Notice]:
    yield from _page_changes(first, last)
    for key in ("/Root", "/Info"):
        if first.trailer[key].objgen != last.trailer[key].objgen:
            yield said("replaced", key=key)
            return
    fields = {field.objgen for field in _fields(last)}
    owners = _owners(first)
    for old in first.objects:
        new = last.get_object(old.objgen)
        if _content(old) != _content(new) and not _is_allowed(first, last, old, fields):
            yield owners.get(old.objgen, said("object_changed", number=old.objgen[0]))
    yield from _form_problems(last)


def _page_changes(first: pikepdf.Pdf, last: pikepdf.Pdf) -> Iterator[Notice]:
    old = [page.obj.objgen for page in first.pages]
    new = [page.obj.objgen for page in last.pages]
    yield from (said("page_added", number=n) for n, page in enumerate(new, 1) if page not in old)
    yield from (
        said("page_taken_out", number=n) for n, page in enumerate(old, 1) if page not in new
    )
    if sorted(old) == sorted(new) and old != new:
        yield said("pages_reordered")


def _owners(pdf: pikepdf.Pdf) -> dict[tuple[int, int], Notice]:
    """What is to be said of a change to the important objects."""
    owners: dict[tuple[int, int], Notice] = {
        pdf.Root.objgen: said("catalog_changed"),
        pdf.trailer.Info.objgen: said("title_changed"),
        pdf.Root.Metadata.objgen: said("metadata_changed"),
    }
    for number, page in enumerate(pdf.pages, 1):
        changed = said("page_changed", number=number)
        owners |= dict.fromkeys((page.obj.objgen, page.Contents.objgen), changed)
    for each in pdf.Root.get("/AF", pikepdf.Array()):
        changed = said("embedded_file_changed", file=str(each.UF))
        owners |= dict.fromkeys((each.objgen, each.EF.F.objgen), changed)
    return owners


def _content(value: pikepdf.Object) -> tuple[bytes, bytes]:
    """An object without what it refers to, for comparison."""
    if isinstance(value, pikepdf.Stream):
        return value.stream_dict.unparse(), value.read_raw_bytes()
    return written(value, resolved=True), b""


def _entries(value: pikepdf.Object, without: set[str]) -> dict[str, bytes]:
    return {key: written(entry) for key, entry in value.items() if key not in without}


def _is_allowed(
    first: pikepdf.Pdf, last: pikepdf.Pdf, old: pikepdf.Object, fields: set[tuple[int, int]]
) -> bool:
    """Whether a signature may have made this change."""
    new = last.get_object(old.objgen)
    if old.objgen == first.Root.objgen:
        added = _CATALOG_ADDITIONS - set(old.keys())
        return _entries(old, set()) == _entries(new, added)
    if old.objgen == first.docinfo.objgen:
        return _entries(old, _CHANGING_INFO) == _entries(new, _CHANGING_INFO)
    if old.objgen == first.Root.Metadata.objgen:
        return _metadata(first) == _metadata(last)
    if old.objgen in {page.obj.objgen for page in first.pages}:
        same = _entries(old, {"/Annots"}) == _entries(new, {"/Annots"})
        return same and _adds_fields_only(old, new, fields)
    return False


def _metadata(pdf: pikepdf.Pdf) -> dict[str, object]:
    with pdf.open_metadata(set_pikepdf_as_editor=False, update_docinfo=False) as metadata:
        return {key: metadata[key] for key in metadata if key not in _CHANGING_METADATA}


def _adds_fields_only(
    old: pikepdf.Object, new: pikepdf.Object, fields: set[tuple[int, int]]
) -> bool:
    before, after = (
        [each.objgen for each in page.get("/Annots", pikepdf.Array())] for page in (old, new)
    )
    return after[: len(before)] == before and set(after[len(before) :]) <= fields


def _fields(pdf: pikepdf.Pdf) -> list[pikepdf.Object]:
    form = pdf.Root.get("/AcroForm", pikepdf.Dictionary())
    return list(form.get("/Fields", pikepdf.Array()))


def _form_problems(pdf: pikepdf.Pdf) -> Iterator[Notice]:
    """Fields that are more than signatures, or draw on a page."""
    others = set(pdf.Root.get("/AcroForm", pikepdf.Dictionary()).keys()) - _FORM_KEYS
    yield from (said("form_entry", key=key) for key in sorted(others))
    for field in _fields(pdf):
        name = str(field.get("/T", ""))
        if field.get("/FT") != pikepdf.Name.Sig or _ACTIONS & set(field.keys()):
            yield said("form_field", field=name)
        elif not _is_invisible(field):
            yield said("visible_signature", field=name)


def _is_invisible(field: pikepdf.Object) -> bool:
    left, bottom, right, top = (float(each) for each in field.get("/Rect", [0, 0, 0, 0]))
    return left == right and bottom == top
