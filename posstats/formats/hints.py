"""How a finding shows what was found, and guesses what was meant."""

from collections.abc import Iterable
from difflib import get_close_matches

_SHOWN = 120


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
    close = _close(name, known)
    return f", expected {close}?" if close else f", expected one of {', '.join(known)}"


def one_of(found: object, known: Iterable[str]) -> str:
    """All of a few known words, and the one that was probably meant."""
    close = _close(found, known) if isinstance(found, str) else None
    return " or ".join(known) + (f"; {close}?" if close else "")


def _close(name: str, known: Iterable[str]) -> str | None:
    return next(iter(get_close_matches(name, known, n=1, cutoff=0.5)), None)
