"""Typefaces as data URIs, cut down to the characters of one document; DejaVu Sans is always one."""

import base64
import io
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import matplotlib
from fontTools import subset
from fontTools.ttLib import TTFont

FAMILY = "DejaVu Sans"
WEIGHTS = {"normal": "DejaVuSans.ttf", "bold": "DejaVuSans-Bold.ttf"}
ALWAYS = "".join(map(chr, range(0x20, 0x7F)))


@dataclass(frozen=True)
class Face:
    """One typeface of a page: the values of an ``@font-face`` rule."""

    family: str
    weight: str
    uri: str
    format: str = "truetype"


def faces(text: str) -> tuple[Face, ...]:
    """DejaVu Sans in both weights, with the glyphs of a text."""
    return tuple(Face(FAMILY, weight, data_uri(text, weight)) for weight in WEIGHTS)


def data_uri(text: str, weight: str) -> str:
    """DejaVu Sans (matplotlib's copy) with the glyphs of a text, as a ``data:`` URI.

    Parameters
    ----------
    text
        Characters to be shown; those the typeface lacks are left to the reader's other fonts.
    weight
        ``normal`` or ``bold``.
    """
    with TTFont(_path(weight), recalcTimestamp=False) as font:
        return uri(cut(font, text + ALWAYS))


@cache
def characters() -> frozenset[int]:
    """Code points that DejaVu Sans can show."""
    with TTFont(_path("normal"), lazy=True) as font:
        return frozenset(font.getBestCmap())


def cut(font: TTFont, text: Iterable[str]) -> TTFont:
    """A typeface cut down, in place, to the glyphs of a text."""
    options = subset.Options(hinting=False, layout_features=["kern"])
    options.drop_tables += ["FFTM", "GSUB"]  # FontForge's time stamp; substitutions, all unused
    cutter = subset.Subsetter(options)
    cutter.populate(text="".join(sorted(set(text))))
    cutter.subset(font)
    return font


def uri(font: TTFont) -> str:
    """A typeface as a ``data:`` URI."""
    stream = io.BytesIO()
    font.save(stream)
    return f"data:font/ttf;base64,{base64.b64encode(stream.getvalue()).decode('ascii')}"


def _path(weight: str) -> Path:
    return Path(matplotlib.get_data_path(), "fonts", "ttf", WEIGHTS[weight])
