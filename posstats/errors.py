"""Errors raised by posstats; all derive from `PosstatsError`."""

from collections.abc import Iterable, Sequence

SHOWN_FINDINGS = 20


class PosstatsError(Exception):
    """Base of every error that posstats raises on purpose."""


class BlockFormatError(PosstatsError):
    """A block folder that cannot be accepted.

    Parameters
    ----------
    findings
        One sentence per finding, each with file, line and column where known.
        The message shows the first twenty; `findings` keeps all.
    """

    def __init__(self, findings: Sequence[str]) -> None:
        self.findings = tuple(findings)
        shown = list(self.findings[:SHOWN_FINDINGS])
        hidden = len(self.findings) - len(shown)
        if hidden:
            shown.append(f"... and {hidden} more")
        super().__init__("\n".join(shown))


class GeometryError(PosstatsError):
    """A geometric problem without a solution (degenerate model, unsolvable elements)."""


class UndeterminedError(GeometryError):
    """Unknowns that the observations do not determine.

    Parameters
    ----------
    images
        Indices of the images whose orientation is open.
    common
        Indices of the common unknowns that are open.
    """

    def __init__(self, images: Iterable[int], common: Iterable[int]) -> None:
        self.images = tuple(int(i) for i in images)
        self.common = tuple(int(i) for i in common)
        super().__init__(
            f"the normal equations are singular: {len(self.images)} images and"
            f" {len(self.common)} common parameters are not determined"
        )


class ConvergenceError(PosstatsError):
    """An iteration that did not converge."""
