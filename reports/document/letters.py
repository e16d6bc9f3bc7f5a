"""Widths of letters."""

import unicodedata


def is_cjk(letter: str) -> bool:
    """Whether a character belongs to Chinese, Japanese or Korean writing."""
    return unicodedata.east_asian_width(letter) in "WF" and ord(letter) < 0x1F000


def width(text: str) -> int:
    """Width of a text in Latin letters; Chinese ones take two."""
    return sum(2 if is_cjk(letter) else 1 for letter in text)
