"""What the topics of the report on the second paper are made of."""

from collections.abc import Sequence
from dataclasses import dataclass

from posstats.papers.wucaps.reproduction import Reproduction

from ..conclusion import Conclusion


@dataclass(frozen=True, eq=False)
class Report:
    """Both situations, the paper's conclusions tested, and what it leaves open."""

    run: Reproduction
    conclusions: Sequence[Conclusion]
    beyond: Sequence[Conclusion]
