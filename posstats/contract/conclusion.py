"""A conclusion of a paper, and whether the simulation bears it out."""

from dataclasses import dataclass
from typing import Annotated

from posstats.contract.about import about


@dataclass(frozen=True, kw_only=True)
class StatedConclusion:
    """A conclusion of a paper, tested."""

    text: Annotated[str, about("what the paper concludes")]
    holds: Annotated[bool, about("whether the simulation bears it out")]
    evidence: Annotated[str, about("the numbers that say so")]
