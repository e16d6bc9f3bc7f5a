"""Bold outlines from regular ones, for typefaces that come in one weight.

Every point moves outwards along the bisector of its two edges, as FreeType's FT_Outline_Embolden
does; advance widths stay, as Chinese type is set on squares.
"""

import numpy as np
from fontTools.ttLib import TTFont

from posstats.arrays import Floats

STRENGTH = 1.0 / 56.0  # of the em, on either side of a stroke
SHARPEST = 2.0  # times the strength that the point of a corner may move


def embolden(font: TTFont) -> None:
    """Make the strokes of a font with TrueType outlines thicker, in place."""
    table = font["glyf"]
    distance = STRENGTH * font["head"].unitsPerEm
    for name in font.getGlyphOrder():
        glyph = table[name]
        if glyph.numberOfContours > 0:
            points = np.array(glyph.coordinates, dtype=float)
            moved = thickened(points, list(glyph.endPtsOfContours), distance)
            for k, (x, y) in enumerate(np.rint(moved).astype(int).tolist()):
                glyph.coordinates[k] = (x, y)
            glyph.recalcBounds(table)


def thickened(points: Floats, ends: list[int], distance: float) -> Floats:
    """Points (n, 2) of contours that end at indices `ends`, moved outwards by a distance."""
    contours = np.split(points, np.array(ends[:-1], dtype=int) + 1)
    outward = -np.sign(sum(_area(contour) for contour in contours)) or 1.0
    return np.concatenate([_moved(contour, outward * distance) for contour in contours])


def _moved(contour: Floats, distance: float) -> Floats:
    """Points moved to the left of the direction in which they follow each other."""
    after, before = _direction(contour, 1), _direction(contour, -1)
    normal = np.column_stack([-(after - before)[:, 1], (after - before)[:, 0]])
    cosine = -np.sum(after * before, axis=1)
    shift = normal / np.maximum(1.0 + cosine, 1.0 / SHARPEST)[:, None]
    moved: Floats = contour + distance * shift
    return moved


def _direction(contour: Floats, step: int) -> Floats:
    """Unit vectors (n, 2) to the next point (1) or the one before (-1) that lies elsewhere."""
    found = np.zeros_like(contour)
    for reach in range(1, len(contour)):
        missing = ~found.any(axis=1)
        if not missing.any():
            break
        towards = np.roll(contour, -step * reach, axis=0) - contour
        length = np.hypot(*towards.T)
        apart = missing & (length > 0.0)
        found[apart] = towards[apart] / length[apart, None]
    return found


def _area(contour: Floats) -> float:
    x, y = contour.T
    return float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2.0
