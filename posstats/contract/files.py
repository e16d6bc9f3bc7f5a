"""The contract as JSON: one function writes every file, one reads it."""

import codecs
import json
import math
import re
from pathlib import Path
from typing import Any, Protocol, TypeVar

import msgspec

from posstats.errors import PosstatsError

_LONGEST = 60
_MISSING = re.compile(r"Object missing required field `(.+)`")
_EXPECTED = re.compile(r"Expected `(.+?)`( of length \d+)?")
_STEP = re.compile(r"([^.\[\]]+)(?=[.\[]|$)|\[(?:(\d+)|\.\.\.)\]")
_TYPES = {
    "float": "a number",
    "int": "a whole number",
    "str": "text",
    "bool": "true or false",
    "null": "null",
    "array": "a list",
    "object": "an object",
}


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
    content = text.encode() if isinstance(text, str) else text
    try:
        values = msgspec.json.decode(content.removeprefix(codecs.BOM_UTF8))
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise PosstatsError(f"{name} is no JSON: {error}") from error
    return from_values(values, kind, name)


def from_values(values: object, kind: type[D], name: str) -> D:
    """The same from values that are decoded already."""
    expected = str(kind.__dataclass_fields__["schema"].default)  # type: ignore[attr-defined]
    found = values.get("schema") if isinstance(values, dict) else None
    if found != expected:
        raise PosstatsError(f"{name} has schema {_shown(found)}; this version reads {expected}")
    try:
        return msgspec.convert(values, kind)
    except msgspec.ValidationError as error:
        place, found, wanted = _mismatch(str(error), values)
        raise PosstatsError(f"{name}, {place}: found {found}, expected {wanted}") from error


def read_json(path: Path, kind: type[D]) -> D:
    """Read a file of the contract from disk; errors as of `from_json`, and `OSError`."""
    return from_json(path.read_bytes(), kind, path.name)


def _mismatch(message: str, values: object) -> tuple[str, str, str]:
    """Key, what was found and what was expected, of a message of msgspec."""
    what, _, place = message.partition(" - at `$")
    path = place.rstrip("`").lstrip(".")
    if missing := _MISSING.fullmatch(what):
        return f"{path}{'.' if path else ''}{missing[1]}", "nothing", "it"
    found = _shown(_value_at(path, values))
    if expected := _EXPECTED.match(what):
        return path, found, f"{_type_in_words(expected[1])}{expected[2] or ''}"
    return path, found, "a known word"


def _type_in_words(types: str) -> str:
    return " or ".join(_TYPES.get(each, each) for each in types.split(" | "))


def _value_at(path: str, values: Any) -> object:
    """The value at ``key[3].key``; of a mapping that is indexed by ``[...]``, the mapping."""
    for key, index in _STEP.findall(path):
        if not key and not index:
            break
        values = values[key] if key else values[int(index)]
    return values


def _shown(value: object) -> str:
    """A value as JSON writes it: of a long one its beginning."""
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= _LONGEST else f"{text[: _LONGEST - 3]}..."


def _finite(value: Any) -> Any:
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(each) for each in value]
    return value
