"""Which methods the figures of the second paper show, and how they mark control points."""

from posstats.contract.choices import ControlSubset
from posstats.papers.wucaps.experiment import METHODS, Method

from ...figures import style

SHOWN: tuple[Method, ...] = tuple(method for method in METHODS if method != "reference")
LOOK: dict[ControlSubset | None, tuple[str, str]] = {
    None: (style.BLACK, "o"),
    "none": (style.VERMILLION, "v"),
    "centre": (style.ORANGE, "D"),
    "corners": (style.BLUE, "s"),
    "all": (style.GREEN, "^"),
}
"""Colour and mark by control; None: direct georeferencing."""
