"""DejaVu Sans as a data URI: matplotlib's copy, cut down to the characters of one document."""

import base64
import io
from pathlib import Path

import matplotlib
from fontTools import subset
from fontTools.ttLib import TTFont

WEIGHTS = {"normal": "DejaVuSans.ttf", "bold": "DejaVuSans-Bold.ttf"}
ALWAYS = "".join(map(chr, range(0x20, 0x7F)))


def data_uri(text: str, weight: str) -> str:
    """The typeface with the glyphs of a text, as a ``data:`` URI.

    Parameters
    ----------
    text
        Characters to be shown; those the typeface lacks are left to the reader's other fonts.
    weight
        ``normal`` or ``bold``.
    """
    path = Path(matplotlib.get_data_path(), "fonts", "ttf", WEIGHTS[weight])
    options = subset.Options(hinting=False, layout_features=["kern"])
    options.drop_tables += ["FFTM", "GSUB"]  # FontForge's time stamp; substitutions, all unused
    font = TTFont(path, recalcTimestamp=False)
    cutter = subset.Subsetter(options)
    cutter.populate(text=text + ALWAYS)
    cutter.subset(font)
    stream = io.BytesIO()
    font.save(stream)
    return f"data:font/ttf;base64,{base64.b64encode(stream.getvalue()).decode('ascii')}"
