"""Results as plain values and as text, whatever they are of; nothing heavy is imported here."""

import json
import platform
from importlib.metadata import version
from typing import Any

import numpy as np

RESULTS_SCHEMA = "posstats-results/1"
_PACKAGES = ("numpy", "scipy", "pandas", "statsmodels", "numba", "pyproj")


def to_json(values: dict[str, Any]) -> str:
    """The text of a file of results."""
    return json.dumps(values, indent=1, ensure_ascii=False, allow_nan=False) + "\n"


def plain(value: Any) -> Any:
    """Numbers, text, lists and dictionaries only; NaN and infinity become None."""
    if isinstance(value, dict):
        return {key: plain(each) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [plain(each) for each in value]
    if isinstance(value, np.ndarray):
        return plain(value.tolist())
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not np.isfinite(value):
        return None
    return value


def versions() -> dict[str, str]:
    """Python and the main libraries."""
    return {"python": platform.python_version()} | {name: version(name) for name in _PACKAGES}
