"""Key figures: a few numbers that stand below the verdict."""

from dataclasses import dataclass


@dataclass(frozen=True)
class KeyFigure:
    """One number of the verdict, with what it is and a remark."""

    label: str
    value: str
    unit: str
    remark: str
