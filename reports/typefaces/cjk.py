"""A typeface for Chinese, found by fontconfig: for the page, cut down, and for figures."""

import re
import shutil
import subprocess
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache

from fontTools.ttLib import TTFont, TTLibError
from matplotlib import font_manager

from posstats.errors import PosstatsError

from ..document.letters import is_cjk
from . import fonts
from .embolden import embolden

FAMILY = "posstats CJK"
DEBIAN_PACKAGES = "fonts-noto-cjk or fonts-wqy-microhei"
PREFERRED = "Noto Sans CJK SC,Source Han Sans SC"  # else the Japanese shapes of a family may come
REPLACEMENT = "\ufffd"
SPACES = " \u00a0\u3000"  # else another font would be taken for those between Chinese words

_PROBE = "中文验收检查点限差"
_WEIGHTS = {"normal": 80, "bold": 200}  # as fontconfig counts
_ACTING = re.compile(
    "[\x00-\x08\x0b-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff\ufff9-\ufffb]"
)
_UNSEEN = {"Cc", "Cf", "Cs", "Co", "Cn", "Zl", "Zp"}


class MissingFontError(PosstatsError):
    """No typeface for Chinese is installed."""


@dataclass(frozen=True)
class FontFile:
    """A face of a font file; `cff` tells the kind of its outlines."""

    path: str
    index: int
    cff: bool
    characters: frozenset[int]

    def face(self, text: Iterable[str], weight: str) -> fonts.Face:
        """The face with the glyphs of a text, for the page."""
        kind = "opentype" if self.cff else "truetype"
        with self._cut(text) as font:
            return fonts.Face(FAMILY, weight, fonts.uri(font), kind)

    def bold_face(self, text: Iterable[str]) -> fonts.Face | None:
        """A bold face made from this one; none from outlines that are not TrueType's."""
        if self.cff:
            return None
        with self._cut(text) as font:
            embolden(font)
            return fonts.Face(FAMILY, "bold", fonts.uri(font))

    def _cut(self, text: Iterable[str]) -> TTFont:
        font = TTFont(self.path, fontNumber=self.index, recalcTimestamp=False, lazy=True)
        return fonts.cut(font, {*text, *SPACES})


@cache
def font_file(weight: str = "normal") -> FontFile:
    """The face that fontconfig chooses for simplified Chinese.

    Raises
    ------
    MissingFontError
        If there is none, or fontconfig itself is not installed.
    """
    found = _matched(weight)
    if found is None or not found.characters.issuperset(map(ord, _PROBE)):
        raise MissingFontError(
            "No typeface for Chinese was found by fontconfig (fc-match). On Debian or Ubuntu: "
            f"sudo apt-get install fontconfig and one of {DEBIAN_PACKAGES}."
        )
    return found


def faces(text: str) -> tuple[fonts.Face, ...]:
    """The faces for the characters of a text that DejaVu Sans lacks; none if it has all.

    Raises
    ------
    MissingFontError
        If the text has Chinese characters and no typeface for them is installed.
    """
    foreign = lacking(text)
    if not any(is_cjk(letter) for letter in foreign):
        return ()
    regular, bold = font_file(), font_file("bold")
    heavy = regular.bold_face(foreign) if bold == regular else bold.face(foreign, "bold")
    return (regular.face(foreign, "normal"), *((heavy,) if heavy else ()))


def lacking(text: Iterable[str]) -> set[str]:
    """Characters of a text that can be seen and that DejaVu Sans lacks."""
    known = fonts.characters()
    return {each for each in set(text) if ord(each) not in known and _is_seen(each)}


def unshown(text: Iterable[str]) -> str:
    """Characters of a text that neither DejaVu Sans nor the Chinese typeface has, in order."""
    foreign = lacking(text)
    try:
        known = font_file().characters if foreign else frozenset()
    except MissingFontError:
        known = frozenset()
    return "".join(sorted(each for each in foreign if ord(each) not in known))


def legible(text: str) -> str:
    """A text without characters that turn the text around them or cannot be written down."""
    return _ACTING.sub(REPLACEMENT, text)


def figure_families(text: Iterable[str]) -> tuple[str, ...]:
    """Families for figures that hold a text; the Chinese one is made known to matplotlib.

    It goes by a name of ours, which no other figure asks for.
    """
    if not any(is_cjk(each) for each in lacking(text)):
        return (fonts.FAMILY,)
    found, listed = font_file(), font_manager.fontManager.ttflist
    if not any(entry.name == FAMILY for entry in listed):
        for weight in (400, 700):
            listed.append(font_manager.FontEntry(  # type: ignore[no-untyped-call,unused-ignore]
                fname=found.path, index=found.index, name=FAMILY, weight=weight))  # fmt: skip
    return (fonts.FAMILY, FAMILY)


def _matched(weight: str) -> FontFile | None:
    command = shutil.which("fc-match")
    if command is None:
        return None
    pattern = f"{PREFERRED},sans-serif:lang=zh-cn:weight={_WEIGHTS[weight]}"
    run = subprocess.run(  # noqa: S603 - a pattern of ours
        [command, "-f", "%{file}\n%{index}\n", pattern],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    path, index, *_ = [*run.stdout.splitlines(), "", ""]
    return _opened(path, int(index) & 0xFFFF) if path and index.isdecimal() else None


def _opened(path: str, index: int) -> FontFile | None:
    try:
        with TTFont(path, fontNumber=index, lazy=True) as font:
            return FontFile(path, index, "glyf" not in font, frozenset(font.getBestCmap()))
    except (OSError, TTLibError):
        return None


def _is_seen(letter: str) -> bool:
    return not letter.isspace() and unicodedata.category(letter) not in _UNSEEN
