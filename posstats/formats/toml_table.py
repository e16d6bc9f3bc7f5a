"""Dataclasses that read and check their own TOML table.

A field's annotation, ``Annotated[type, Rule(...)]``, carries what its value must be; a field that
is itself a `Table` is a table within the table. All findings are collected before any is raised.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, dataclass, fields
from typing import Any, TypeVar, get_type_hints

from posstats.errors import BlockFormatError
from posstats.formats.toml_section import nearest

T = TypeVar("T")
TableT = TypeVar("TableT", bound="Table")


@dataclass(frozen=True)
class Rule:
    """What a value must be, in words, and the reader that returns it or raises ValueError."""

    expected: str
    read: Callable[[Any], Any]


def number(accepts: Callable[[float], bool] = math.isfinite) -> Callable[[Any], float]:
    """Reader of a finite number that `accepts` lets pass."""

    def read(value: Any) -> float:
        is_number = isinstance(value, int | float) and not isinstance(value, bool)
        if not (is_number and math.isfinite(value) and accepts(value)):
            raise ValueError
        return float(value)

    return read


def whole(smallest: int, largest: int | None = None) -> Callable[[Any], int]:
    """Reader of a whole number from `smallest` to `largest`."""

    def read(value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or value < smallest:
            raise ValueError
        if largest is not None and value > largest:
            raise ValueError
        return value

    return read


def text(value: Any) -> str:
    """Read a text that is not blank."""
    if not isinstance(value, str) or not value.strip():
        raise ValueError
    return value


def one_of(*choices: str) -> Rule:
    """The rule of a value that is one of some words."""

    def read(value: Any) -> str:
        if value not in choices:
            raise ValueError
        return str(value)

    return Rule(" or ".join(choices), read)


def several(read_one: Callable[[Any], T], count: int | None = None) -> Callable[[Any], Any]:
    """Reader of a list of `count` values; of one value or a list where `count` is None."""

    def read(value: Any) -> tuple[T, ...]:
        values = value if isinstance(value, list | tuple) else [value]
        listed = isinstance(value, list | tuple)
        if not values or (count is not None and not (listed and len(values) == count)):
            raise ValueError
        return tuple(read_one(one) for one in values)

    return read


class Table:
    """A table of a TOML file: the base of the dataclasses that `read_table` reads."""

    def conflicts(self) -> Iterable[str]:
        """Sentences on values that contradict each other."""
        return ()


def read_table(cls: type[TableT], content: Mapping[str, Any], name: str) -> TableT:
    """The dataclass `cls` of a mapping.

    Parameters
    ----------
    name
        Of the file, for the messages.

    Raises
    ------
    BlockFormatError
        With every finding: unknown keys (with the nearest known one), missing keys, values of
        the wrong type or size, contradictions.
    """
    findings: list[str] = []
    table = _read(cls, content, name, findings)
    if table is None or findings:
        raise BlockFormatError(findings)
    return table


def _read(cls: type[TableT], content: Any, where: str, findings: list[str]) -> TableT | None:
    """The dataclass of a table; None, and sentences added to `findings`, where it is wrong."""
    if not isinstance(content, Mapping):
        findings.append(f"{where}: found {content!r}, expected a table of keys and values")
        return None
    before = len(findings)
    hints = get_type_hints(cls, include_extras=True)
    findings.extend(
        f"{_place(where, key)}: found an unknown key{nearest(str(key), hints)}"
        for key in content
        if key not in hints
    )
    findings.extend(
        f"{_place(where, key)}: found nothing, expected {_expected(hints[key])}"
        for key in _required(cls)
        if key not in content
    )
    values = {
        key: _value(hint, content[key], _place(where, key), findings)
        for key, hint in hints.items()
        if key in content
    }
    if len(findings) > before:
        return None
    table = cls(**values)
    findings.extend(f"{where}: {sentence}" for sentence in table.conflicts())
    return table


def _required(cls: type[Table]) -> list[str]:
    return [
        one.name
        for one in fields(cls)  # type: ignore[arg-type]
        if one.default is MISSING and one.default_factory is MISSING
    ]


def _value(hint: Any, value: Any, where: str, findings: list[str]) -> Any:
    if _is_table(hint):
        return _read(hint, value, where, findings)
    try:
        return hint.__metadata__[0].read(value)
    except (ValueError, OverflowError):  # a whole number may be too large for a float
        findings.append(f"{where}: found {value!r}, expected {_expected(hint)}")
        return None


def _expected(hint: Any) -> str:
    if _is_table(hint):
        return "a table of keys and values"
    return str(hint.__metadata__[0].expected)


def _is_table(hint: Any) -> bool:
    return isinstance(hint, type) and issubclass(hint, Table)


def _place(where: str, key: str) -> str:
    """`file, table.key` of a key in `file` or in `file, table`."""
    return f"{where}{'.' if ', ' in where else ', '}{key}"
