"""Values of profile files, as types: they refuse what a page could not show as it is."""

import datetime
import string
import unicodedata
from collections.abc import Iterable
from typing import Annotated

from msgspec import Meta

from posstats.acceptance.product import GIVEN_NAMES
from posstats.formats.hints import nearest, shown
from posstats.formats.toml_types import Before, Check, repeated

PLACEHOLDERS = ("class_m", "class_cm", "found_m", "found_cm", "n_points")

_MAX_TEXT = 5_000
_MAX_TEXTS = 200
_TURNING = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Characters that make the text after them run the other way: a page would not say what it says."""


def _text_faults(value: str) -> Iterable[str]:
    """What keeps a text from being shown: markup is text like any other."""
    if len(value) > _MAX_TEXT:
        yield f"found {len(value)} characters, expected at most {_MAX_TEXT}"
        return
    for character in value:
        control = unicodedata.category(character) == "Cc" and character not in "\n\t"
        if control or character in _TURNING:
            yield f"found the control character U+{ord(character):04X}, expected text"
            return


def _texts_faults(values: tuple[str, ...]) -> Iterable[str]:
    if len(values) > _MAX_TEXTS:
        yield f"found {len(values)} texts, expected at most {_MAX_TEXTS}"
        return
    for value in values:
        yield from _text_faults(value)


def _wording_faults(value: str) -> Iterable[str]:
    """Placeholders that are not known and plain: an attribute, an index, a format."""
    try:
        parts = list(string.Formatter().parse(value))
    except ValueError as error:
        yield f"found braces that are not a placeholder ({error})"
        return
    for _, name, form, conversion in parts:
        if name is not None and (name not in PLACEHOLDERS or form or conversion):
            yield f"found {shown(f'{{{name}}}')}{nearest(name, PLACEHOLDERS)} in braces"
            return


def alternatives(value: str) -> tuple[str, ...]:
    """The names of ``class_h or class_v``."""
    return tuple(value.split(" or "))


def _needs_faults(values: tuple[str, ...]) -> Iterable[str]:
    for value in values:
        for name in alternatives(value):
            if name not in GIVEN_NAMES:
                yield f"found {shown(name)}{nearest(name, GIVEN_NAMES)}"


def named(known: Iterable[str]) -> Check:
    """One of many words; a finding names the nearest."""
    words = tuple(known)

    def faults(value: str) -> Iterable[str]:
        if value not in words:
            yield f"found {shown(value)}{nearest(value, words)}"

    return Check(faults)


def _iso_date(value: object) -> object:
    return value.isoformat() if isinstance(value, datetime.date) else value


Text = Annotated[str, Check(_text_faults)]
"""Possibly empty."""
FilledText = Annotated[Text, Meta(pattern=r"\S", description="text in quotes")]
Texts = Annotated[tuple[str, ...], Meta(description="a list of texts"), Check(_texts_faults)]
Date = Annotated[Text, Before(_iso_date)]
"""A date of TOML as ISO 8601, or any text."""
Id = Annotated[
    str,
    Meta(
        pattern=r"^\w[\w.-]{0,59}\Z",
        description="up to 60 letters, digits, _ - and ., beginning with a letter, a digit or _",
    ),
]
Ids = Annotated[Texts, Check(repeated)]
Needs = Annotated[Texts, Check(_needs_faults)]
"""Alternatives as ``["class_h or class_v", "terrain"]``."""
Language = Annotated[
    str, Meta(pattern=r"^[a-z]{2}\Z", description='two small letters, such as "zh"')
]
Scales = Annotated[
    tuple[Annotated[int, Meta(ge=1, le=1_000_000_000)], ...],
    Meta(description="a list of denominators (whole numbers)"),
]
Wording = Annotated[Text, Check(_wording_faults)]
