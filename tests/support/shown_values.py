"""What documents show, read back: cells of tables as numbers, arrows and marks of figures."""

import math
import re
import xml.etree.ElementTree as ET
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from posstats.reports.document.content import Paragraph
from posstats.reports.document.numbering import NumberedFigure, NumberedTable, ReportDocument
from posstats.reports.document.table import Column, Table

DIGITS = str.maketrans("⁻⁰¹²³⁴⁵⁶⁷⁸⁹−", "-0123456789-")
PER_SI = {"°": math.degrees(1.0), "mrad": 1e3, "µrad": 1e6, "nrad/s": 1e9, "mm": 1e3, "cm": 1e2}
"""Of units other than SI's; of a power of ten of a unit the inverse power."""
MISSING = "–"
NUMBER = re.compile(r"-?[\d.]+(?:e-?\d+)?")


def items_of(document: ReportDocument) -> list[object]:
    """Everything in a document, in the order of reading."""
    return [*document.opening, *(item for part in document.sections for item in part.items)]


def tables_of(document: ReportDocument) -> dict[str, Table]:
    """Tables by name."""
    return {i.table.name: i.table for i in items_of(document) if isinstance(i, NumberedTable)}


def svgs_of(document: ReportDocument) -> dict[str, str]:
    """SVG texts of figures by name."""
    return {i.drawing.name: i.drawing.svg for i in items_of(document)
            if isinstance(i, NumberedFigure)}  # fmt: skip


def paragraphs_of(document: ReportDocument) -> list[str]:
    """Texts of paragraphs."""
    return [i.text for i in items_of(document) if isinstance(i, Paragraph)]


def numbers(text: str) -> list[tuple[float, float]]:
    """Numbers in a text, each with half of its last digit."""
    plain = re.sub(r"(?<=\d)[\u202f](?=\d)", "", text)
    plain = re.sub(r"\u00a0×\u00a010([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", r"e\1", plain).translate(DIGITS)
    found = []
    for word in NUMBER.findall(plain):
        mantissa, _, power = word.partition("e")
        decimals = len(mantissa.partition(".")[2])
        found.append((float(word), 0.5 * 10.0 ** (int(power or 0) - decimals)))
    return found


def per_si(unit: str) -> float:
    """How many of a column's unit one SI unit is."""
    if power := re.match(r"10([⁻⁰¹²³⁴⁵⁶⁷⁸⁹]+)", unit):
        return 10.0 ** -int(power[1].translate(DIGITS))
    return PER_SI.get(unit, 1.0)


def assert_cell(cell: str, *values: float | None, factor: float = 1.0) -> None:
    """A cell shows these values times a factor, to its last digit; a dash where there are none."""
    if all(value is None for value in values):
        assert cell == MISSING
        return
    shown = numbers(cell)
    assert len(shown) == len(values), cell
    for (number, half), value in zip(shown, values, strict=True):
        assert abs(number - value * factor) <= half * (1.0 + 1e-9), (cell, value * factor)


def assert_column(column: Column, values: Sequence[float | None], unit: str | None = None) -> None:
    """Every cell of a column shows its value; `unit` where another column names it."""
    assert len(column.cells) == len(values), column.title
    for cell, value in zip(column.cells, values, strict=True):
        assert_cell(cell, value, factor=per_si(column.unit if unit is None else unit))


def arrows(svg: str, colour: str) -> list[tuple[np.ndarray, np.ndarray]]:
    """Tails and tips (2,) of the single arrows of a colour: shafts that a head follows; y upwards.

    The outline of a head goes beyond its corner by half a line, more where it is sharp.
    """
    found, ink = [], colour.lower()
    drawn = ET.fromstring(svg)  # noqa: S314 - our own figure
    paths = list(drawn.iter("{http://www.w3.org/2000/svg}path"))
    for shaft, head in pairwise(paths):
        looks = [path.get("style", "").lower() for path in (shaft, head)]
        is_shaft = "fill: none" in looks[0] and f"stroke: {ink}" in looks[0]
        if not is_shaft or f"fill: {ink}" not in looks[1]:
            continue
        one, corner, other = _places(head)[:3]
        along = corner - 0.5 * (one + other)
        sharpness = np.hypot(*(corner - one)) / (0.5 * np.hypot(*(other - one)))
        width = re.search(r"stroke-width: ([\d.]+)", looks[1])  # 1 where not said
        beyond = 0.5 * float(width[1] if width else 1.0) * sharpness
        found.append((_places(shaft)[0], corner + beyond * along / np.hypot(*along)))
    return found


def _places(path: ET.Element) -> np.ndarray:
    """(k, 2) points of a path, y upwards."""
    places = re.findall(r"(-?[\d.]+) (-?[\d.]+)", path.get("d", ""))
    return np.array(places, dtype=float) * [1.0, -1.0]


def on_ground(places: np.ndarray, drawn: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Offset (2,) and turn (2, 2) with places = offset + drawn @ turn, by least squares."""
    design = np.column_stack([np.ones(len(drawn)), drawn])
    solved = np.linalg.lstsq(design, places, rcond=None)[0]
    return solved[0], solved[1:]
