"""What WeasyPrint's PDF/A-3a lacks of level A, put in before the file is written.

Seen in WeasyPrint 70: associated files listed twice, header cells without scope and their ids
without the tree that resolves them, running headers as content outside of the structure, raster
images with interpolation. Each step leaves alone what is already right, so that a later WeasyPrint
that does it itself changes nothing.
"""

from collections.abc import Iterator
from typing import Any

# Of pydyf, which has no types: a document, and what may stand in it.
Pdf = Any
Value = Any
Node = dict[str, Value]


def mend(_document: object, pdf: Pdf) -> None:
    """Complete a `pydyf.PDF`; WeasyPrint's ``finisher``."""
    _compress_streams(pdf)
    _forbid_interpolation(pdf)
    _list_files_once(pdf)
    _scope_headers(pdf)
    _add_id_tree(pdf)
    _mark_running_headers(pdf)


def _resolved(pdf: Pdf, reference: Value) -> Value:
    """The object that ``b"12 0 R"`` names; anything else is returned as it is."""
    text = reference if isinstance(reference, bytes) else b""
    return pdf.objects[int(text.split()[0])] if text.endswith(b" 0 R") else reference


def _streams(pdf: Pdf) -> Iterator[Value]:
    return (each for each in pdf.objects if hasattr(each, "stream") and hasattr(each, "extra"))


def _elements(pdf: Pdf) -> Iterator[Value]:
    for each in pdf.objects:
        if isinstance(each, dict) and each.get("Type") == "/StructElem":
            yield each


def _compress_streams(pdf: Pdf) -> None:
    """One by one: objects in object streams could not be checked before they are unpacked.

    Metadata stay readable for programs that know nothing of PDF.
    """
    for stream in _streams(pdf):
        if "Filter" not in stream.extra and stream.extra.get("Type") != "/Metadata":
            stream.compress = True


def _forbid_interpolation(pdf: Pdf) -> None:
    """ISO 19005-3, 6.2.8: an image's Interpolate is false."""
    for stream in _streams(pdf):
        if stream.extra.get("Interpolate") == "true":
            stream.extra["Interpolate"] = "false"


def _list_files_once(pdf: Pdf) -> None:
    files = pdf.catalog.get("AF")
    if files is not None:
        files[:] = list(dict.fromkeys(files))


def _scope_headers(pdf: Pdf) -> None:
    """A header cell in a row with other cells heads the row, else its column."""
    for row in _elements(pdf):
        if row["S"] != "/TR":
            continue
        cells = [_resolved(pdf, kid) for kid in row["K"]]
        scope = "/Row" if any(cell["S"] == "/TD" for cell in cells) else "/Column"
        for cell in cells:
            if cell["S"] == "/TH" and "A" in cell:
                cell["A"].setdefault("Scope", scope)


def _add_id_tree(pdf: Pdf) -> None:
    """ISO 32000-1, table 322: required where elements have ids, which /Headers refer to."""
    root = _resolved(pdf, pdf.catalog["StructTreeRoot"])
    named = [(each["ID"], each.reference) for each in _elements(pdf) if "ID" in each]
    if "IDTree" in root or not named:
        return
    import pydyf

    named.sort(key=lambda pair: pair[0].string)
    tree = pydyf.Dictionary({"Names": pydyf.Array(each for pair in named for each in pair)})
    pdf.add_object(tree)
    root["IDTree"] = tree.reference


def _mark_running_headers(pdf: Pdf) -> None:
    """What stands in page margins belongs to no element: an artifact, ISO 32000-1, 14.8.2.2."""
    root = _resolved(pdf, pdf.catalog["StructTreeRoot"])
    inside = _below(pdf, root)
    numbers = _resolved(pdf, root["ParentTree"])["Nums"]
    parents = dict(zip(numbers[::2], numbers[1::2], strict=True))
    for page in (each for each in pdf.objects if isinstance(each, dict)):
        if page.get("Type") != "/Page":
            continue
        marks = parents[page["StructParents"]]
        outside = {mark for mark, element in enumerate(marks) if element not in inside}
        _as_artifacts(_resolved(pdf, page["Contents"]).stream, outside)
        marks[:] = ["null" if mark in outside else each for mark, each in enumerate(marks)]


def _below(pdf: Pdf, root: Node) -> set[bytes]:
    """References of all elements of the structure."""
    found: set[bytes] = set()
    open_ends = list(root["K"])
    while open_ends:
        reference = open_ends.pop()
        if isinstance(reference, bytes) and reference not in found:
            found.add(reference)
            open_ends += _resolved(pdf, reference).get("K", ())
    return found


def _as_artifacts(content: list[Value], marks: set[int]) -> None:
    """Turn ``/Tag <</MCID n>> BDC`` of the marks into ``/Artifact BMC``."""
    for place, item in enumerate(content):
        if isinstance(item, dict) and item.get("MCID") in marks:
            content[place - 1 : place + 2] = ["/Artifact", b"", b"BMC"]
