"""One section of a TOML file: typed reading of its keys, findings with line and key."""

import math
import re
from collections.abc import Iterable
from dataclasses import dataclass
from difflib import get_close_matches
from typing import Any, cast

FILE = "block.toml"
_LARGEST = 1e9
_SMALLEST = 1e-9
"""Sizes beyond these (m, px, degrees) are slips of the pen, and would overflow as weights."""
_SHOWN = 120


@dataclass
class TomlSection:
    """One table of a TOML file; its readers add what is wrong to `findings`.

    The keys above the first section have the name "".
    """

    values: Any
    name: str
    source: str
    findings: list[str]
    occurrence: int = 0
    parent_key: str | None = None
    file: str = FILE

    def __post_init__(self) -> None:
        if not isinstance(self.values, dict):
            found = shown(self.values)
            self.findings.append(f"{self.file}, {self.name}: found {found}, expected a section")
            self.values = {}

    def refuse(self, key: str, what: str) -> None:
        """A finding about a key, with the line it stands on."""
        if self.name:
            line = _line_of_key(self.source, self.name, self.occurrence, self.parent_key or key)
        else:
            line = line_of_section(self.source, key)
        path = ".".join(part for part in (self.name, self.parent_key, shortened(key)) if part)
        self.findings.append(f"{self.file}{line}, {path}: {what}")

    def refuse_unknown(self, known: tuple[str, ...]) -> None:
        """A finding for every key that is not `known`."""
        for key in self.values:
            if key not in known:
                self.refuse(key, f"found an unknown key{nearest(key, known)}")

    def text(self, key: str) -> str | None:
        """Text that is not empty, None if absent."""
        value = self.values.get(key)
        if value is None or (isinstance(value, str) and value):
            return value
        self.refuse(key, f"found {shown(value)}, expected text in quotes")
        return None

    def flag(self, key: str) -> bool:
        """A truth value, false if absent."""
        value = self.values.get(key, False)
        if not isinstance(value, bool):
            self.refuse(key, f"found {shown(value)}, expected true or false")
        return value is True

    def choice(self, key: str, known: tuple[str, ...], default: str | None = None) -> str:
        """One of the `known` words; absent without `default` is a finding."""
        value = self.values.get(key, default)
        if value in known:
            return cast(str, value)
        found = "nothing" if value is None else shown(value)
        self.refuse(key, f"found {found}, expected {' or '.join(known)}")
        return known[0]

    def number(self, key: str) -> float | None:
        """A finite number, None if absent."""
        value = self.values.get(key)
        if value is None or _is_number(value):
            return None if value is None else float(value)
        self.refuse(key, f"found {shown(value)}, expected a finite number{_too_large(value)}")
        return None

    def positive(self, key: str, required: bool = False) -> float | None:
        """A finite number above zero, None if absent."""
        value = self.values.get(key)
        if (value is None and not required) or (_is_number(value) and value >= _SMALLEST):
            return None if value is None else float(value)
        found = "nothing" if value is None else shown(value)
        too_small = f" of at least {_SMALLEST:g}" if _is_number(value) and value > 0 else ""
        self.refuse(key, f"found {found}, expected a positive number{too_small}{_too_large(value)}")
        return None

    def numbers(self, key: str, count: int, default: tuple[float, ...]) -> tuple[float, ...]:
        """`count` finite numbers, `default` if absent."""
        value = self.values.get(key)
        if value is None:
            return default
        if isinstance(value, list) and len(value) == count and all(map(_is_number, value)):
            return tuple(float(number) for number in value)
        self.refuse(key, f"found {shown(value)}, expected {count} finite numbers in brackets")
        return default


def _is_number(value: object) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    return abs(value) <= _LARGEST  # false for NaN


def _too_large(value: object) -> str:
    is_large = isinstance(value, int | float) and _LARGEST < abs(value) < math.inf
    return f" of at most {_LARGEST:g}" if is_large else ""


def line_of_section(text: str, name: str) -> str:
    """`:line` of a section or top-level key, empty if it is not found."""
    pattern = re.compile(rf"^\s*(\[+\s*)?[\"']?{re.escape(name)}[\"']?\s*[\]=.]", re.MULTILINE)
    found = pattern.search(text)
    return f":{text.count(chr(10), 0, found.end()) + 1}" if found else ""


def _line_of_key(text: str, section: str, number: int, key: str) -> str:
    """`:line` of a key of the `number`-th section of that name, else of the section, else empty."""
    heading = re.compile(r"^\s*\[+\s*([^\]]*?)\s*\]+")
    assignment = re.compile(rf"^\s*[\"']?{re.escape(key)}[\"']?\s*[.=]")
    inside, count, start = False, -1, ""
    for line, content in enumerate(text.splitlines(), start=1):
        title = heading.match(content)
        if title:
            count += title[1] == section
            inside = title[1].split(".")[0] == section and count == number
            start = f":{line}" if inside and title[1] == section else start
        elif inside and assignment.match(content):
            return f":{line}"
    return start


def shown(value: object) -> str:
    """A value as it is shown in a finding: of a long one its beginning."""
    try:
        return shortened(repr(value))
    except ValueError:  # of a whole number with more digits than Python writes
        return "a number of thousands of digits"


def shortened(text: str) -> str:
    """A text of at most 120 characters: of a longer one its beginning."""
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."


def nearest(name: str, known: Iterable[str]) -> str:
    """The known key that was probably meant, else all of them."""
    close = get_close_matches(name, known, n=1, cutoff=0.5)
    return f", expected {close[0]}?" if close else f", expected one of {', '.join(known)}"
