"""What computed: versions of Python and the main libraries."""

import platform
from importlib.metadata import version

_PACKAGES = ("numpy", "scipy", "pandas", "statsmodels", "numba", "pyproj")


def versions() -> dict[str, str]:
    """Python and the main libraries."""
    return {"python": platform.python_version()} | {name: version(name) for name in _PACKAGES}
