"""Why a requirement was judged as it was: a code and its values; the words are the reports'."""

from dataclasses import dataclass

from posstats.contract.notice import Notice
from posstats.errors import PosstatsError


@dataclass(frozen=True, kw_only=True)
class Reason(Notice):
    """A notice on a requirement, by its code.

    `within`, `exceeds`, `investigate` (found, limit); `no check points`; `too few points` (n,
    needed); `survey accuracy not stated`; `product value missing` (name); `quantity not available`
    (quantity, orientation); `nssda ratio` (ratio).
    """


class Unavailable(PosstatsError):  # noqa: N818 - no fault: the evidence does not say
    """A quantity that the evidence does not give, for the `reason`."""

    def __init__(self, reason: Reason) -> None:
        self.reason = reason
        super().__init__(reason.code)
