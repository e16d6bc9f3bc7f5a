"""Findings of an experiment that was repeated with many seeds, stored as ``seeds.csv``.

The first column is the seed, the others are the fields of the paper's findings.
"""

import csv
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict
from importlib.resources import files
from pathlib import Path
from typing import TYPE_CHECKING, TypeVar

from msgspec import convert

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

Case = TypeVar("Case")
Findings = TypeVar("Findings")


def stored(
    package: str, kind: type[Findings], case: Callable[[Findings], Case]
) -> dict[Case, tuple[Findings, ...]]:
    """The findings of a package's ``seeds.csv`` by case, one per seed, in the order of seeds."""
    text = (files(package) / "seeds.csv").read_text(encoding="utf-8")
    found: dict[Case, list[Findings]] = {}
    for row in csv.DictReader(text.splitlines()):
        each = convert(row, kind, strict=False)
        found.setdefault(case(each), []).append(each)
    return {case: tuple(each) for case, each in found.items()}


def share_of(found: Sequence[object], criterion: str) -> float:
    """Share of the findings for which a criterion, by its name, holds."""
    return sum(bool(getattr(each, criterion)) for each in found) / len(found)


def write(found: Iterable[tuple[int, "DataclassInstance"]], path: Path) -> None:
    """Write pairs of seed and findings, one at least, as the file that `stored` reads."""
    rows = [{"seed": seed} | _rounded(each) for seed, each in found]
    with path.open("w", encoding="utf-8", newline="") as stream:
        writer = csv.DictWriter(stream, list(rows[0]), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def _rounded(findings: "DataclassInstance") -> dict[str, object]:
    values = asdict(findings).items()
    return {key: f"{value:.9g}" if isinstance(value, float) else value for key, value in values}
