"""Requirements of ISO 19005-3, level A, that a program can check; a validator is not to be had.

Clauses are those of ISO 19005-2, which part 3 repeats, or of ISO 32000-1 where it refers to it.
"""

import io
import re
import xml.etree.ElementTree as ET
from collections.abc import Iterator

import pikepdf
from pikepdf import Name

NS = {
    "rdf": "http://www.w3.org/1999/02/22-rdf-syntax-ns#",
    "dc": "http://purl.org/dc/elements/1.1/",
    "pdfaid": "http://www.aiim.org/pdfa/ns/id/",
    "xmp": "http://ns.adobe.com/xap/1.0/",
    "pdf": "http://ns.adobe.com/pdf/1.3/",
}
STRUCTURE = {
    *("Document", "Part", "Art", "Sect", "Div", "BlockQuote", "Caption", "TOC", "TOCI", "Index"),
    *("NonStruct", "Private", "H", "H1", "H2", "H3", "H4", "H5", "H6", "P", "L", "LI", "Lbl"),
    *("LBody", "Table", "TR", "TH", "TD", "THead", "TBody", "TFoot", "Span", "Quote", "Note"),
    *("Reference", "BibEntry", "Code", "Link", "Annot", "Figure", "Formula", "Form"),
}


def problems(data: bytes) -> list[str]:
    """All that is wrong with a document for the archive."""
    pdf = pikepdf.open(io.BytesIO(data), attempt_recovery=False)
    checks = (_file, _metadata, _catalog, _fonts, _graphics, _files, _structure, _actions)
    return [problem for check in checks for problem in check(pdf, data)]


def _dictionaries(pdf) -> Iterator[pikepdf.Object]:
    """Every dictionary or stream, direct ones included."""
    stack = list(pdf.objects)
    while stack:
        value = stack.pop()
        if isinstance(value, pikepdf.Dictionary | pikepdf.Stream):
            yield value
            inner = value.stream_dict if isinstance(value, pikepdf.Stream) else value
            children = [inner.get(key) for key in inner.keys()]  # noqa: SIM118 - no mapping
        elif isinstance(value, pikepdf.Array):
            children = list(value)
        else:
            continue
        stack += [c for c in children if isinstance(c, pikepdf.Object) and not c.is_indirect]


def _file(pdf, data) -> Iterator[str]:
    if not re.match(rb"%PDF-1\.[0-7]\n%[\x80-\xff]{4}", data):  # 6.1.2
        yield "file header"
    if len(pdf.trailer.get("/ID", [])) != 2:  # 6.1.3
        yield "file identifier"
    if "/Encrypt" in pdf.trailer or pdf.get_warnings() or pdf.check_pdf_syntax():
        yield "encrypted or faulty syntax"
    for each in _dictionaries(pdf):
        if isinstance(each, pikepdf.Stream) and {"/F", "/FFilter"} & set(each.keys()):  # 6.1.7
            yield "a stream outside of the file"
        if each.get("/Filter") in (Name.LZWDecode, Name.Crypt):
            yield "a forbidden filter"


def _metadata(pdf, data) -> Iterator[str]:
    if "/Filter" in pdf.Root.Metadata:
        yield "metadata are packed"
    root = ET.fromstring(pdf.Root.Metadata.read_bytes())  # noqa: S314 - made here
    about = root.findall(".//rdf:Description", NS)
    found = {key: value for each in about for key, value in each.attrib.items()}
    for name, value in (("part", "3"), ("conformance", "A")):  # 6.6.4
        if found.get(f"{{{NS['pdfaid']}}}{name}") != value:
            yield f"pdfaid:{name}"
    info = pdf.trailer.Info
    pairs = (
        ("/Title", root.findtext(".//dc:title/rdf:Alt/rdf:li", None, NS)),
        ("/Author", root.findtext(".//dc:creator/rdf:Seq/rdf:li", None, NS)),
        ("/Creator", root.findtext(".//xmp:CreatorTool", None, NS)),
        ("/Producer", found.get(f"{{{NS['pdf']}}}Producer")),
        ("/CreationDate", _pdf_date(root.findtext(".//xmp:CreateDate", None, NS))),
        ("/ModDate", _pdf_date(root.findtext(".//xmp:ModifyDate", None, NS))),
    )
    stated = {key: str(value) for key, value in info.items()}
    yield from (f"{key} is not that of XMP" for key, value in pairs if stated.get(key) != value)


def _pdf_date(text: str) -> str:
    return "D:" + re.sub(r"[-:T]", "", text[:19]) + text[19:].replace(":", "'")


def _catalog(pdf, data) -> Iterator[str]:
    root = pdf.Root
    intents = [each for each in root.get("/OutputIntents", []) if each.S == Name.GTS_PDFA1]
    if len(intents) != 1 or intents[0].DestOutputProfile.read_bytes()[36:40] != b"acsp":  # 6.2.3
        yield "output intent"
    if root.get("/MarkInfo", {}).get("/Marked") is not True:  # 6.7.2
        yield "not marked as tagged"
    if not root.get("/Lang") or not root.get("/Outlines"):  # 6.7.4
        yield "no language, or no bookmarks"
    if root.get("/ViewerPreferences", {}).get("/DisplayDocTitle") is not True:
        yield "the title is not shown"
    if {"/OpenAction", "/AA", "/Requirements", "/OCProperties", "/NeedsRendering"} & set(
        root.keys()
    ):
        yield "a forbidden key of the catalog"


def _fonts(pdf, data) -> Iterator[str]:
    fonts = [each for each in _dictionaries(pdf) if each.get("/Type") == Name.Font]
    if not fonts:
        yield "no fonts"
    for font in fonts:
        if font.Subtype == Name.Type0:
            if font.Encoding != Name("/Identity-H") or "/ToUnicode" not in font:  # 6.2.11.7
                yield f"{font.BaseFont} has no map to Unicode"
        elif font.Subtype == Name.CIDFontType2:
            if "/FontFile2" not in font.FontDescriptor or font.get("/CIDToGIDMap") is None:
                yield f"{font.BaseFont} is not embedded"  # 6.2.11.4
        else:
            yield f"{font.BaseFont}: {font.Subtype}"


def _graphics(pdf, data) -> Iterator[str]:
    for each in _dictionaries(pdf):
        if each.get("/Subtype") == Name.Image and each.get("/Interpolate", False):  # 6.2.8
            yield "an image with interpolation"
        if each.get("/Subtype") == Name.PS or "/Alternates" in each or "/OPI" in each:
            yield "a forbidden object"
        if {"/TR", "/HTP"} & set(each.keys()) and each.get("/Type") == Name.ExtGState:
            yield "a transfer function"
        if "/BM" in each and each.BM not in (Name.Normal, Name.Compatible):
            yield "a blend mode"


def _files(pdf, data) -> Iterator[str]:
    """ISO 19005-3, 6.8."""
    tree = list(pikepdf.NameTree(pdf.Root.Names.EmbeddedFiles).items())
    associated = [each.objgen for each in pdf.Root.get("/AF", [])]
    if sorted(associated) != sorted(each.objgen for _, each in tree):
        yield "associated files are not the embedded ones, each once"
    raw = [bytes(each) for each in list(pdf.Root.Names.EmbeddedFiles.Names)[::2]]
    if raw != sorted(raw):
        yield "the tree of names is not sorted"
    for name, each in tree:
        stream = each.EF.F
        if not (each.get("/UF") and each.get("/F") and str(each.get("/Desc", ""))):
            yield f"{name} has no name or description"
        if each.get("/AFRelationship") is None or not re.match(
            r"/\w+/", str(stream.get("/Subtype"))
        ):
            yield f"{name} has no relationship or type"
        if (
            stream.Params.get("/Size") != len(stream.read_bytes())
            or "/ModDate" not in stream.Params
        ):
            yield f"{name} has other parameters"


def _structure(pdf, data) -> Iterator[str]:
    root = pdf.Root.StructTreeRoot
    reached = {each.objgen: each for each in _below(root)}
    elements = [each for each in reached.values() if "/S" in each]
    ids = {bytes(each.ID) for each in elements if "/ID" in each}
    tree = [bytes(each) for each in list(root.get("/IDTree", {}).get("/Names", []))[::2]]
    if tree != sorted(ids):
        yield "ids of elements are not in their tree"
    for each in elements:
        kind = str(each.S)[1:]
        if kind not in STRUCTURE:
            yield f"structure type {kind}"
        if kind == "Figure" and not str(each.get("/Alt", "")):
            yield "a figure without alternative text"
        if kind == "TH" and "/Scope" not in each.A:
            yield "a header cell without scope"
        if kind == "TD" and {bytes(one) for one in each.A.get("/Headers", [])} - ids:
            yield "a cell with unknown headers"
    parents = dict(pikepdf.NumberTree(root.ParentTree).items())
    for page in pdf.pages:
        yield from _page_structure(page, parents[int(page.StructParents)], reached)
    for each in _dictionaries(pdf):
        if each.get("/Subtype") == Name.Form and b"MCID" in each.read_bytes():
            yield "content of a form that no element refers to"


def _below(node) -> Iterator[pikepdf.Object]:
    kids = node.get("/K", [])
    for kid in kids if isinstance(kids, pikepdf.Array) else [kids]:
        if isinstance(kid, pikepdf.Dictionary):
            yield kid
            yield from _below(kid)


def _page_structure(page, parents, reached) -> Iterator[str]:
    """All content is in an element or an artifact: 14.8.2.2."""
    depth = 0
    for operands, operator in pikepdf.parse_content_stream(page):
        name = str(operator)
        if name in ("BMC", "BDC"):
            depth += 1
            if name == "BDC":
                element = parents[int(operands[1].MCID)]
                if not isinstance(element, pikepdf.Dictionary) or element.objgen not in reached:
                    yield "marked content outside of the structure"
            elif operands[0] != Name.Artifact:
                yield "content without element"
        elif name == "EMC":
            depth -= 1
        if name == "TJ" and _draws_no_glyph(operands[0]):  # 6.2.11.8
            yield "a character without glyph"
        if name in {"TJ", "Tj", "Do", "f", "f*", "S", "s", "B", "b", "sh"} and not depth:
            yield f"unmarked content ({name})"
    if page.get("/Tabs") != Name.S:
        yield "order of tabs"


def _draws_no_glyph(parts) -> bool:
    codes = b"".join(bytes(each) for each in parts if isinstance(each, pikepdf.String))
    return b"\0\0" in {codes[at : at + 2] for at in range(0, len(codes), 2)}


def _actions(pdf, data) -> Iterator[str]:
    for each in _dictionaries(pdf):
        forbidden = {"/JS", "/AA", "/URI"} & set(each.keys())
        if forbidden or ("/A" in each and each.get("/Type") != Name.StructElem):
            yield "an action"
        if each.get("/Type") == Name.Annot:
            flags = int(each.get("/F", 0))
            if not flags & 4 or flags & 0b100011:  # 6.3.2: printed; not hidden, invisible, no view
                yield "an annotation that is not printed"
            if each.Subtype not in (Name.Link, Name.Widget):
                yield f"an annotation of type {each.Subtype}"
