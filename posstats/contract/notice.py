"""Something to be said in a report, as a code and values; catalogues hold the words."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Annotated

from posstats.contract.about import about

Value = str | int | float | bool | None | tuple[str | int | float | None, ...]


@dataclass(frozen=True, kw_only=True)
class Notice:
    """A reason, warning or remark.

    Values are counts (``n``: the one that decides on singular or plural), numbers with the unit in
    their name, ids, or codes: ``why`` is the code of another notice on the same values.
    """

    code: Annotated[str, about("what is said, such as `strips_of_one_image`")]
    values: Annotated[Mapping[str, Value], about("what is put in, by name; SI units")] = field(
        default_factory=dict
    )


def listing(code: str, ids: Iterable[object], most: int = 5, **values: Value) -> tuple[Notice, ...]:
    """One notice on things by their ids, or none: their number `n`, and the first `most`."""
    names = tuple(str(each) for each in ids)
    if not names:
        return ()
    return (Notice(code=code, values={"n": len(names), "ids": names[:most], **values}),)
