"""The contract as JSON: one function writes every file, one reads it."""

import json
import math
from pathlib import Path
from typing import Any, Protocol, TypeVar

import msgspec

from posstats.errors import PosstatsError


class _Document(Protocol):
    """A file of the contract: it names its schema."""

    @property
    def schema(self) -> str: ...


D = TypeVar("D", bound=_Document)


def to_json(document: object) -> str:
    """The text of a file; NaN and infinity become null."""
    return json.dumps(as_values(document), indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def as_values(document: object) -> Any:
    """A document, or a part of one, in dictionaries and lists; NaN and infinity become None."""
    return _finite(msgspec.to_builtins(document))


def from_json(text: str | bytes, kind: type[D], name: str) -> D:
    """Read a file of the contract.

    Parameters
    ----------
    text
        The content of the file.
    kind
        The dataclass of the document; its default of ``schema`` is the one expected.
    name
        Of the file, for messages.

    Raises
    ------
    PosstatsError
        If it is no JSON, of another schema, or a key is missing or of another type; one sentence.
    """
    try:
        values = msgspec.json.decode(text)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise PosstatsError(f"{name} is no JSON: {error}") from error
    return from_values(values, kind, name)


def from_values(values: object, kind: type[D], name: str) -> D:
    """The same from values that are decoded already."""
    expected = str(kind.__dataclass_fields__["schema"].default)  # type: ignore[attr-defined]
    found = values.get("schema") if isinstance(values, dict) else None
    if found != expected:
        raise PosstatsError(f"{name} has schema {found!r}; this version reads {expected!r}")
    try:
        return msgspec.convert(values, kind)
    except msgspec.ValidationError as error:
        raise PosstatsError(f"{name}: {error}") from error


def read_json(path: Path, kind: type[D]) -> D:
    """Read a file of the contract from disk; errors as of `from_json`, and `OSError`."""
    return from_json(path.read_bytes(), kind, path.name)


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(each) for each in value]
    return value
