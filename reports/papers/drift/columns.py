"""Columns and cells that hold printed beside simulated numbers."""

from collections.abc import Callable, Iterable
from typing import Literal

from posstats.contract.comparison import Compared
from posstats.papers.drift.reproduction import Reproduction

from ...document import format as fmt
from ...document.table import Column

Source = Literal["published", "simulated", "ratio"]

SOURCES: tuple[Source, ...] = ("published", "simulated", "ratio")
MM_DECIMALS = 4  # as the paper prints them


def compared(run: Reproduction, table: int, **conditions: object) -> list[Compared]:
    """Printed numbers of a table, with their reproduction."""
    return [
        each
        for each in run.compared
        if each.table == table and all(getattr(each, k) == v for k, v in conditions.items())
    ]


def cell(source: Source, each: Compared, shown: Callable[[float | None], str]) -> str:
    """The printed or the simulated number, or their ratio."""
    if source == "ratio":
        return fmt.fixed(each.ratio, 2)
    return shown(each.published if source == "published" else each.reproduced)


def millimetres(title: str, values: Iterable[float], group: str = "") -> Column:
    """Parallaxes with the decimals of the paper."""
    return Column(title, tuple(fmt.fixed(v, MM_DECIMALS) for v in values), "mm", group=group)
