"""TOML files read into frozen dataclasses, key by key: all findings, each with file and line.

What the annotations of a dataclass may say is in `toml_types`. Keys without a default must be
there. A number is finite, and no truth value; a whole number passes for a number.
"""

import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, Protocol, TypeVar, runtime_checkable

from posstats.errors import BlockFormatError
from posstats.formats.hints import nearest, shortened, shown
from posstats.formats.toml_lines import Place, line_of, lines_of, value_at
from posstats.formats.toml_types import Shape, made, needed, shapes

T = TypeVar("T")
Conflict = tuple[Place, str]
"""Place below the table that is checked, and what was found and expected there."""

_MOST_KEYS = 100  # of a table; to guess what thousands mean would take minutes


@runtime_checkable
class Checked(Protocol):
    """A table whose values are checked together, once each of them is right."""

    def conflicts(self) -> Iterable[Conflict]:
        """Values that contradict each other."""


@dataclass
class TomlDocument:
    """A parsed file (or a mapping, without `text`), and what was found wrong with it."""

    name: str
    values: Mapping[str, Any]
    text: str = ""
    findings: list[str] = field(default_factory=list)
    _refused: list[Place] = field(default_factory=list)

    def read(self, kind: type[T]) -> T | None:
        """The file as a dataclass; None if it is no TOML, or a key without a default is not right.

        Other keys that are wrong keep their default: see `findings`.
        """
        return None if self.findings else self._table(kind, self.values, ())

    def read_or_raise(self, kind: type[T], error: type[BlockFormatError] = BlockFormatError) -> T:
        """The file as a dataclass.

        Raises
        ------
        BlockFormatError
            Or an `error` of its kind, with every finding.
        """
        table = self.read(kind)
        if table is None or self.findings:
            raise error(self.findings)
        return table

    def refuse(self, place: Place, what: str) -> None:
        """A finding about the value at a place, with the line it stands on."""
        self._refused.append(place)
        line = line_of(place, self._lines)
        path = ".".join(shortened(str(part)) for part in place if not isinstance(part, int))
        where = f"{self.name}{'' if line is None else f':{line}'}{', ' if path else ''}{path}"
        self.findings.append(f"{where}: {what}")

    def is_right(self, place: Place) -> bool:
        """Whether nothing at or below a place was refused."""
        return all(refused[: len(place)] != place for refused in self._refused)

    def given(self, place: Place = ()) -> tuple[str, ...]:
        """The keys that the table at a place has in the file, right or not."""
        table = value_at(place, self.values)
        return tuple(table) if isinstance(table, Mapping) else ()

    def said(self, table: object, place: Place = ()) -> dict[str, Any]:
        """The values of a table that was read at a place, of the keys that are given and right."""
        return {
            key: getattr(table, key)
            for key in self.given(place)
            if hasattr(table, key) and self.is_right((*place, key))
        }

    @cached_property
    def _lines(self) -> dict[Place, int]:
        return lines_of(self.text, self.values)

    def _table(self, kind: type[T], values: Any, place: Place) -> T | None:
        if not isinstance(values, Mapping):
            self.refuse(place, f"found {shown(values)}, expected a table of keys and values")
            return made(kind, {})
        if len(values) > _MOST_KEYS:
            self.refuse(place, f"found {len(values)} keys, expected at most {_MOST_KEYS}")
            return made(kind, {})
        self._refuse_names(kind, values, place)
        read = {
            key: self._value(shape, values[key], (*place, key))
            for key, shape in shapes(kind).items()
            if key in values
        }
        table = made(kind, {key: value for key, value in read.items() if value is not None})
        if isinstance(table, Checked) and self.is_right(place):
            for below, what in table.conflicts():
                self.refuse((*place, *below), what)
        return table

    def _refuse_names(self, kind: type, values: Mapping[str, Any], place: Place) -> None:
        """A finding for every key that is unknown, and for every one that is missing."""
        known = shapes(kind)
        for key in values:
            if key not in known:
                self.refuse((*place, key), f"found an unknown key{nearest(str(key), known)}")
        for key in needed(kind):
            if key not in values:
                self.refuse((*place, key), f"found nothing, expected {known[key].expected()}")

    def _value(self, shape: Shape, found: Any, place: Place) -> Any:
        """What a key says; None, and a finding, if it is wrong."""
        if shape.table is not None:
            return self._one_or_more_tables(shape, shape.table, found, place)
        try:
            value = shape.converted(shape.prepared(found))
        except ValueError:
            self.refuse(place, f"found {shown(found)}, expected {shape.expected(found)}")
            return None
        faults = shape.faults(value)
        for what in faults:
            self.refuse(place, what)
        return None if faults else value

    def _one_or_more_tables(self, shape: Shape, kind: type[T], found: Any, place: Place) -> Any:
        """A table, or the tables of a list that can be made."""
        if not shape.is_list:
            return self._table(kind, found, place)
        values = shape.prepared(found)
        if not isinstance(values, list | tuple):
            self.refuse(place, f"found {shown(found)}, expected {shape.expected(found)}")
            return None
        least, most = shape.lengths
        if not least <= len(values) <= most:
            expected = f"at least {least}" if len(values) < least else f"at most {most}"
            self.refuse(place, f"found {len(values)} tables, expected {expected}")
            return None
        tables = [self._table(kind, each, (*place, k)) for k, each in enumerate(values)]
        return tuple(table for table in tables if table is not None)


def open_toml(content: bytes, name: str, longest_line: int | None = None) -> TomlDocument:
    """The content of a file, parsed; what keeps it from being TOML is among its `findings`.

    Parameters
    ----------
    name
        Of the file, for the findings.
    longest_line
        Characters that a line may have, None for any number.
    """
    findings: list[str] = []
    try:
        text = content.decode("utf-8-sig")
        if longest_line is None or not _has_long_line(text, longest_line, name, findings):
            return TomlDocument(name, tomllib.loads(text), text)
    except UnicodeDecodeError as error:
        line = content.count(b"\n", 0, error.start) + 1
        findings.append(f"{name}:{line}: found a file that is not UTF-8 text")
    except tomllib.TOMLDecodeError as error:
        findings.append(f"{name}: found no valid TOML: {error}")
    except RecursionError:
        findings.append(f"{name}: found lists within lists beyond all measure")
    except ValueError:
        findings.append(f"{name}: found a number of thousands of digits")
    return TomlDocument(name, {}, findings=findings)


def _has_long_line(text: str, longest: int, name: str, findings: list[str]) -> bool:
    """Whether a line is long beyond need, which is a finding: a key of many parts takes minutes."""
    for number, line in enumerate(text.split("\n"), start=1):
        if len(line) > longest:
            found = f"found a line of {len(line)} characters, expected at most {longest}"
            findings.append(f"{name}:{number}: {found}")
            return True
    return False
