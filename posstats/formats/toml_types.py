"""What the annotation of a dataclass's field demands of a key of a TOML file.

A type, ``Literal`` words, the limits of `msgspec.Meta`, whose description is what a finding
expects in words. A dataclass is a table within the table, a tuple of dataclasses a list of tables.
`Before` and `Check` do what types cannot.
"""

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import MISSING, dataclass, fields, is_dataclass
from functools import cache
from types import UnionType
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin, get_type_hints

import msgspec

from posstats.formats.hints import one_of, shown

T = TypeVar("T")

_MOST_BITS = 1024  # of a whole number: a float holds no more
_EXPECTED: Mapping[object, str] = {
    str: "text in quotes",
    bool: "true or false",
    int: "a whole number",
    float: "a finite number",
}


Number = Annotated[
    float, msgspec.Meta(ge=-1e9, le=1e9, description="a finite number of at most 1e+09 in size")
]
Positive = Annotated[
    float, msgspec.Meta(ge=1e-9, le=1e9, description="a positive number from 1e-09 to 1e+09")
]
"""Sizes beyond these (m, px, degrees) are slips of the pen, and would overflow as weights."""


Count = Annotated[
    int, msgspec.Meta(ge=1, le=1_000_000_000, description="a whole number from 1 to 1000000000")
]


@dataclass(frozen=True)
class Before:
    """Annotation: `change` is applied to the value of the file before its type is checked."""

    change: Callable[[Any], Any]


@dataclass(frozen=True)
class Check:
    """Annotation: `faults` says what is wrong with a value of the right type."""

    faults: Callable[[Any], Iterable[str]]


class Needed:
    """Annotation: the key must be there, although the field has a default."""


NEEDED = Needed()
ONE_OR_MORE = Before(lambda value: value if isinstance(value, list | tuple) else [value])
"""One value stands for a list of one."""


def repeated(values: Iterable[object]) -> Iterable[str]:
    """A fault if a list has a value twice."""
    listed = list(values)
    twice = [value for k, value in enumerate(listed) if value in listed[:k]]
    if twice:
        yield f"found {shown(twice[0])} twice, expected each once"


@dataclass(frozen=True)
class Shape:
    """The annotation of a field, taken apart.

    Attributes
    ----------
    hint
        The annotation, without None.
    plain
        The type in it.
    marks
        What is annotated.
    table
        The dataclass of the table or of the tables; None for other values.
    """

    hint: Any
    plain: Any
    marks: tuple[object, ...]
    table: type | None

    @property
    def is_list(self) -> bool:
        """Whether it is a list of tables, or of values."""
        return get_origin(self.plain) is tuple

    @property
    def lengths(self) -> tuple[int, float]:
        """Smallest and largest length of a list."""
        limits = [mark for mark in self.marks if isinstance(mark, msgspec.Meta)]
        least = max((each.min_length or 0 for each in limits), default=0)
        return least, min((each.max_length or math.inf for each in limits), default=math.inf)

    def prepared(self, value: Any) -> Any:
        """The value of a file as the type expects it."""
        for mark in self.marks:
            if isinstance(mark, Before):
                value = mark.change(value)
        return value

    def converted(self, value: Any) -> Any:
        """A value, no table, as its type.

        Raises
        ------
        ValueError
            If it is of another type, or beyond its limits.
        """
        return value if self.plain is object else msgspec.convert(_finite(value), self.hint)

    def faults(self, value: Any) -> list[str]:
        """What is wrong with a value of the right type."""
        checks = [mark for mark in self.marks if isinstance(mark, Check)]
        return [what for check in checks for what in check.faults(value)]

    def expected(self, found: object = None) -> str:
        """What a finding says that was expected."""
        for mark in self.marks:
            if isinstance(mark, msgspec.Meta) and mark.description:
                return mark.description
        if get_origin(self.plain) is Literal:
            return one_of(found, get_args(self.plain))
        if self.is_list:
            return "a list" if self.table is None else "a list of tables"
        return _EXPECTED.get(self.plain, "a table of keys and values")


def shapes(kind: type) -> Mapping[str, Shape]:
    """The fields of a dataclass, by name."""
    return _shapes(kind)


def needed(kind: type) -> list[str]:
    """Names of the keys that must be there."""
    without_default = _without_default(kind)
    return [
        name
        for name, shape in shapes(kind).items()
        if name in without_default or NEEDED in shape.marks
    ]


def _without_default(kind: type) -> list[str]:
    return [
        each.name
        for each in fields(kind)
        if each.default is MISSING and each.default_factory is MISSING
    ]


def made(kind: type[T], values: Mapping[str, Any]) -> T | None:
    """The dataclass of the values that are right; None if one without a default is not."""
    return kind(**values) if set(_without_default(kind)) <= set(values) else None


@cache
def _shapes(kind: type) -> Mapping[str, Shape]:
    return {name: _shape(hint) for name, hint in get_type_hints(kind, include_extras=True).items()}


def _shape(hint: Any) -> Shape:
    if get_origin(hint) in (Union, UnionType):
        (hint,) = (each for each in get_args(hint) if each is not type(None))
    plain, *marks = get_args(hint) if get_origin(hint) is Annotated else (hint,)
    one = get_args(plain)[0] if get_origin(plain) is tuple else plain
    table = one if isinstance(one, type) and is_dataclass(one) else None
    return Shape(hint, plain, tuple(marks), table)


def _finite(value: Any) -> Any:
    """Plain numbers of a value; ValueError for one that is not finite."""
    if isinstance(value, list | tuple):
        return [_finite(each) for each in value]
    if isinstance(value, float):
        if not math.isfinite(value):
            raise ValueError(value)
        return float(value)  # of NumPy
    if isinstance(value, int) and value.bit_length() > _MOST_BITS:
        raise ValueError
    return value
