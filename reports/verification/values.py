"""Comparison of values as JSON has them."""

import math
from collections.abc import Iterator

from posstats.contract.notice import Notice

from .answers import said

TOLERANCE = 1e-6  # relative, between versions of the libraries
SMALLEST = 1e-12  # differences below it are none, whatever the unit


def differences(
    stated: object, found: object, tolerance: float = 0.0, path: str = ""
) -> Iterator[Notice]:
    """Where two values differ.

    Parameters
    ----------
    tolerance
        Relative, of numbers.
    """
    if isinstance(stated, dict) and isinstance(found, dict):
        for key in sorted(stated.keys() | found.keys(), key=str):
            inner = f"{path}.{key}" if path else str(key)
            yield from differences(stated.get(key), found.get(key), tolerance, inner)
    elif isinstance(stated, list) and isinstance(found, list | tuple):
        if len(stated) != len(found):
            yield said("length_differs", path=path, n_stated=len(stated), n_found=len(found))
        for place, (one, other) in enumerate(zip(stated, found, strict=False), 1):
            yield from differences(one, other, tolerance, f"{path}[{place}]")
    elif not _is_same(stated, found, tolerance):
        yield said("value_differs", path=path, stated=_short(stated), found=_short(found))


def _is_same(stated: object, found: object, tolerance: float) -> bool:
    if isinstance(stated, bool) or isinstance(found, bool):
        return stated is found
    if isinstance(stated, int | float) and isinstance(found, int | float):
        room = SMALLEST if tolerance else 0.0
        return stated == found or math.isclose(stated, found, rel_tol=tolerance, abs_tol=room)
    return type(stated) is type(found) and bool(stated == found)


def _short(value: object) -> str:
    text = str(value)
    return text if len(text) <= 40 else f"{text[:37]}..."
