"""On which lines of a TOML file its tables and keys stand."""

import re
from collections.abc import Mapping
from typing import Any

Place = tuple[str | int, ...]
"""The keys that lead to a value; of a list of tables the number of the table, from 0."""

_PART = re.compile(r"""\s*(?:"([^"]*)"|'([^']*)'|([\w-]+))\s*""")


def lines_of(text: str, values: Mapping[str, Any]) -> dict[Place, int]:
    """Line, from 1, of every table and key that begins one; `values` is the text as parsed."""
    lines: dict[Place, int] = {}
    last: dict[Place, int] = {}  # number of the last table of each list
    inside: Place = ()
    for number, line in enumerate(text.split("\n"), start=1):
        opening = re.match(r"\s*(\[{0,2})", line)
        brackets = opening[1] if opening else ""
        parts, rest = _dotted(line[opening.end() if opening else 0 :])
        if not parts or not rest.startswith("]" if brackets else "="):
            continue
        start = () if brackets else inside
        place = (*_within(start, parts[:-1], last), parts[-1])
        if value_at(place, values) is None:
            continue  # looks like one, inside a text or a list
        lines.setdefault(place, number)
        if brackets == "[[":
            last[place] = last.get(place, -1) + 1
            place = (*place, last[place])
            lines[place] = number
        inside = place if brackets else inside
    return lines


def line_of(place: Place, lines: Mapping[Place, int]) -> int | None:
    """Line of a key, else of the table it belongs to; None if neither begins a line."""
    for length in range(len(place), 0, -1):
        names = tuple(part for part in place[:length] if isinstance(part, str))
        for candidate in (place[:length], names):  # a single table may stand for a list
            if candidate in lines:
                return lines[candidate]
    return None


def value_at(place: Place, values: Any) -> Any:
    """The value at a place; None if there is none."""
    try:
        for part in place:
            values = values[part]
    except (LookupError, TypeError):
        return None
    return values


def _dotted(text: str) -> tuple[tuple[str, ...], str]:
    """The parts of a key at the beginning of a text, and what follows it."""
    parts: list[str] = []
    while part := _PART.match(text):
        parts.append(next(each for each in part.groups() if each is not None))
        text = text[part.end() :]
        if not text.startswith("."):
            return tuple(parts), text
        text = text[1:]
    return (), text


def _within(place: Place, parts: tuple[str, ...], last: Mapping[Place, int]) -> Place:
    """A place and further parts of a key; of a list of tables the last one."""
    for part in parts:
        place = (*place, part)
        place = (*place, last[place]) if place in last else place
    return place
