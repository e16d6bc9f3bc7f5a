"""Statistics and acceptance reports for POS (GNSS/INS) orientations of aerial photographs.

The names below are imported when they are first used, so that ``posstats --help`` stays fast.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from posstats.version import __version__

if TYPE_CHECKING:
    from posstats.analysis.regression import fit_drift
    from posstats.analysis.steps import analyse
    from posstats.block.image_pairs import stereo_models
    from posstats.block.model import Block
    from posstats.errors import BlockFormatError, ConvergenceError, GeometryError, PosstatsError
    from posstats.formats.block_folder import read_block
    from posstats.geometry.stereo.relative_orientation import orient
    from posstats.settings import Settings

_HOME = {
    "Block": "block.model",
    "BlockFormatError": "errors",
    "ConvergenceError": "errors",
    "GeometryError": "errors",
    "PosstatsError": "errors",
    "Settings": "settings",
    "analyse": "analysis.steps",
    "fit_drift": "analysis.regression",
    "orient": "geometry.stereo.relative_orientation",
    "read_block": "formats.block_folder",
    "stereo_models": "block.image_pairs",
}

__all__ = [
    "Block",
    "BlockFormatError",
    "ConvergenceError",
    "GeometryError",
    "PosstatsError",
    "Settings",
    "__version__",
    "analyse",
    "fit_drift",
    "orient",
    "read_block",
    "stereo_models",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"posstats.{_HOME[name]}"), name)
