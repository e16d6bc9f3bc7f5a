"""Rows of the contract from computed values."""

from collections.abc import Mapping
from typing import Any, TypeVar

import msgspec

T = TypeVar("T")


def record(kind: type[T], values: Mapping[str, object]) -> T:
    """A row of the contract; types are checked, NaN and infinity become None.

    Parameters
    ----------
    values
        Plain values, NumPy scalars and arrays, by the names of the row's fields.

    Raises
    ------
    msgspec.ValidationError
        If a value is missing or of another type: a fault of the caller.
    """
    return msgspec.convert({name: plain(value) for name, value in values.items()}, kind)


def plain(value: object) -> Any:
    """The same value in Python's own types; NaN and infinity become None."""
    if isinstance(value, Mapping):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    to_list = getattr(value, "tolist", None)  # NumPy scalars have it too
    if to_list is not None:
        return plain(to_list())
    if isinstance(value, float) and value - value != 0.0:
        return None
    return value
