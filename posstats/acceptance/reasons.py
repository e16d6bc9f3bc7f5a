"""Why a requirement was judged as it was: a code and its values; the words are the reports'."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from posstats.errors import PosstatsError

Value = float | int | str | None


@dataclass(frozen=True)
class Reason:
    """A reason by its code.

    `within`, `exceeds`, `investigate` (found, limit); `no check points`; `too few points` (n,
    needed); `survey accuracy not
    stated`; `product value missing` (name); `quantity not available` (quantity, orientation);
    `nssda ratio` (ratio). Of an orientation: its name, or `asked`.
    """

    code: str
    values: Mapping[str, Value] = field(default_factory=dict)


class Unavailable(PosstatsError):  # noqa: N818 - no fault: the evidence does not say
    """A quantity that the evidence does not give, for the `reason`."""

    def __init__(self, reason: Reason) -> None:
        self.reason = reason
        super().__init__(reason.code)
