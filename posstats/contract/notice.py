"""Something to be said in a report, as a code and values; catalogues hold the words."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated

from posstats.contract.about import about

Value = str | int | float | bool | None | tuple[str | int | float | None, ...]


@dataclass(frozen=True, kw_only=True)
class Notice:
    """A reason, warning or remark."""

    code: Annotated[str, about("what is said, such as `r2_too_small`")]
    values: Annotated[Mapping[str, Value], about("what is put in, by name; SI units")] = field(
        default_factory=dict
    )
