"""Rows of a list of the contract, chosen by the values of their fields."""

from collections.abc import Iterable
from typing import TypeVar

T = TypeVar("T")


def rows(listed: Iterable[T], **conditions: object) -> list[T]:
    """The rows whose fields equal the conditions."""
    return [
        row
        for row in listed
        if all(getattr(row, name) == value for name, value in conditions.items())
    ]


def first(listed: Iterable[T], **conditions: object) -> T | None:
    """The first row that meets the conditions, or None."""
    return next(iter(rows(listed, **conditions)), None)
