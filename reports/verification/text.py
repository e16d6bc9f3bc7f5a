"""The text of pages as WeasyPrint writes them: glyphs of fonts with a map to Unicode."""

import re
from collections.abc import Iterator

import pikepdf

from ..archive.file import UnreadableArchiveError
from ..archive.reading import decoded

LARGEST_PAGE_BYTES = 20_000_000
DEEPEST = 8

_GLYPHS = re.compile(rb"<([0-9A-Fa-f]{4})>\s*<((?:[0-9A-Fa-f]{4})+)>")

Maps = dict[str, dict[int, str]]


def page_texts(pdf: pikepdf.Pdf) -> list[str]:
    """The text of every page without spaces, in the order in which it is drawn.

    Raises
    ------
    UnreadableArchiveError
        If text is drawn in another way than WeasyPrint does.
    """
    return ["".join(_texts(page.Contents, page.Resources, 0)) for page in pdf.pages]


def _texts(stream: pikepdf.Object, resources: pikepdf.Object, depth: int) -> Iterator[str]:
    if depth > DEEPEST:
        raise UnreadableArchiveError("drawings are nested too deep")
    decoded(stream, LARGEST_PAGE_BYTES)
    maps = _maps(resources)
    glyphs: dict[int, str] = {}
    for instruction in pikepdf.parse_content_stream(stream, "Tf Tj TJ ' \" Do"):
        operator, operands = str(instruction.operator), instruction.operands
        if operator == "Tf":
            glyphs = maps[str(operands[0])]
        elif operator == "TJ":
            yield from (_text(bytes(part), glyphs) for part in _strings(operands[0]))
        elif operator == "Do":
            drawn = resources.XObject[str(operands[0])]
            if drawn.Subtype == pikepdf.Name.Form:
                yield from _texts(drawn, drawn.get("/Resources", resources), depth + 1)
        else:
            raise UnreadableArchiveError(f"text drawn with {operator}")


def _strings(parts: pikepdf.Object) -> Iterator[pikepdf.String]:
    return (part for part in parts if isinstance(part, pikepdf.String))


def _text(glyphs: bytes, characters: dict[int, str]) -> str:
    codes = (int.from_bytes(glyphs[at : at + 2], "big") for at in range(0, len(glyphs), 2))
    return "".join("".join(characters[code] for code in codes).split())


def _maps(resources: pikepdf.Object) -> Maps:
    fonts = resources.get("/Font", pikepdf.Dictionary())
    return {name: _characters(font) for name, font in fonts.items()}


def _characters(font: pikepdf.Object) -> dict[int, str]:
    pairs = _GLYPHS.findall(decoded(font.ToUnicode, LARGEST_PAGE_BYTES))
    return {int(code, 16): bytes.fromhex(text.decode()).decode("utf-16-be") for code, text in pairs}
