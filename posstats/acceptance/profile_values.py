"""Values of profile files: readers of one key, which refuse what a page could not show as it is."""

import datetime
import re
import string
import unicodedata
from collections.abc import Callable

from posstats.acceptance.product import GIVEN_NAMES
from posstats.formats.toml_section import TomlSection, nearest, shown

PLACEHOLDERS = ("class_m", "class_cm", "found_m", "found_cm", "n_points")

_MAX_TEXT = 5_000
_MAX_TEXTS = 200
_MAX_COUNT = 1_000_000_000
_ID = re.compile(r"\w[\w.-]{0,59}")
_LANGUAGE = re.compile(r"[a-z]{2}")
_TURNING = frozenset("\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069")
"""Characters that make the text after them run the other way: a page would not say what it says."""


def one_of(*known: str) -> Callable[[TomlSection, str], str | None]:
    """Reader of one of some words; a finding names the nearest."""
    expected = ", ".join(known)

    def read(section: TomlSection, key: str) -> str | None:
        value = section.values[key]
        if isinstance(value, str) and value in known:
            return value
        hint = nearest(value, known) if isinstance(value, str) else ""
        section.refuse(key, f"found {shown(value)}{hint or f', expected one of {expected}'}")
        return None

    return read


def count(section: TomlSection, key: str) -> int | None:
    """Read a whole number of at least 1."""
    value = section.values[key]
    is_count = isinstance(value, int) and not isinstance(value, bool)
    if is_count and 1 <= value <= _MAX_COUNT:
        return int(value)
    section.refuse(key, f"found {shown(value)}, expected a whole number from 1 to {_MAX_COUNT}")
    return None


def any_text(section: TomlSection, key: str) -> str | None:
    """Read text, possibly empty, that a page can show as it is: markup is text like any other."""
    value = section.values[key]
    if not isinstance(value, str):
        section.refuse(key, f"found {shown(value)}, expected text in quotes")
        return None
    fault = _text_fault(value)
    if fault:
        section.refuse(key, fault)
        return None
    return value


def _text_fault(value: str) -> str:
    """What keeps a text from being shown; "" if nothing does."""
    if len(value) > _MAX_TEXT:
        return f"found {len(value)} characters, expected at most {_MAX_TEXT}"
    for character in value:
        control = unicodedata.category(character) == "Cc" and character not in "\n\t"
        if control or character in _TURNING:
            return f"found the control character U+{ord(character):04X}, expected text"
    return ""


def filled_text(section: TomlSection, key: str) -> str | None:
    """Read text that is not blank."""
    value = any_text(section, key)
    if value is not None and not value.strip():
        section.refuse(key, f"found {shown(value)}, expected text in quotes")
        return None
    return value


def date(section: TomlSection, key: str) -> str | None:
    """Read a date of TOML as ISO 8601, or any text."""
    value = section.values[key]
    return value.isoformat() if isinstance(value, datetime.date) else any_text(section, key)


def identifier(section: TomlSection, key: str) -> str | None:
    """Read an id: no blanks, no markup."""
    value = section.values[key]
    if isinstance(value, str) and _ID.fullmatch(value):
        return value
    expected = "up to 60 letters, digits, _ - and ., beginning with a letter, a digit or _"
    section.refuse(key, f"found {shown(value)}, expected {expected}")
    return None


def language(section: TomlSection, key: str) -> str | None:
    """Read the code of a language (ISO 639-1)."""
    value = section.values[key]
    if isinstance(value, str) and _LANGUAGE.fullmatch(value):
        return value
    section.refuse(key, f'found {shown(value)}, expected two small letters, such as "zh"')
    return None


def texts(section: TomlSection, key: str) -> tuple[str, ...] | None:
    """Read a list of texts that can be shown."""
    value = section.values[key]
    if not isinstance(value, list) or not all(isinstance(each, str) for each in value):
        section.refuse(key, f"found {shown(value)}, expected a list of texts")
        return None
    fault = "" if len(value) <= _MAX_TEXTS else f"found {len(value)} texts, expected fewer"
    fault = fault or next(filter(None, map(_text_fault, value)), "")
    if fault:
        section.refuse(key, fault)
        return None
    return tuple(value)


def identifiers(section: TomlSection, key: str) -> tuple[str, ...] | None:
    """Read a list of ids, each once."""
    values = texts(section, key)
    twice = sorted({each for each in values or () if (values or ()).count(each) > 1})
    if twice:
        section.refuse(key, f"found {shown(twice[0])} twice, expected each once")
        return None
    return values


def needs(section: TomlSection, key: str) -> tuple[tuple[str, ...], ...] | None:
    """Read alternatives as ``["class_h or class_v", "terrain"]``."""
    values = texts(section, key)
    alternatives = tuple(tuple(each.split(" or ")) for each in values or ())
    unknown = [name for names in alternatives for name in names if name not in GIVEN_NAMES]
    if values is None or unknown:
        for name in unknown:
            section.refuse(key, f"found {shown(name)}{nearest(name, GIVEN_NAMES)}")
        return None
    return alternatives


def scales(section: TomlSection, key: str) -> tuple[int, ...] | None:
    """Read a list of denominators of map scales."""
    value = section.values[key]
    good = isinstance(value, list) and all(
        isinstance(each, int) and not isinstance(each, bool) and 1 <= each <= _MAX_COUNT
        for each in value
    )
    if good:
        return tuple(value)
    section.refuse(key, f"found {shown(value)}, expected a list of denominators (whole numbers)")
    return None


def wording(section: TomlSection, key: str) -> str | None:
    """Read a statement whose placeholders are known and plain: no attribute, index or format."""
    value = any_text(section, key)
    if value is None:
        return None
    try:
        parts = list(string.Formatter().parse(value))
    except ValueError as error:
        section.refuse(key, f"found braces that are not a placeholder ({error})")
        return None
    for _, name, form, conversion in parts:
        if name is not None and (name not in PLACEHOLDERS or form or conversion):
            shown_name = shown(f"{{{name}}}")
            section.refuse(key, f"found {shown_name}{nearest(name, PLACEHOLDERS)} in braces")
            return None
    return value
