"""How often a finding comes out when a paper's experiment is repeated with other seeds."""

from collections.abc import Sequence

from ..document import format as fmt
from .words import Words


def held(words: Words, shares: Sequence[float], n_seeds: int, where: str = "") -> str:
    """In how many of the seeds a finding holds.

    Parameters
    ----------
    shares
        Of the seeds, in one or several places.
    n_seeds
        Repetitions.
    where
        The places, where there are several.
    """
    values = {"held": counted(words, shares, n_seeds), "total": fmt.count(n_seeds)}
    if len(shares) == 1:
        return words.text("seeds.held", **values)
    return words.text("seeds.held_where", where=where, **values)


def counted(words: Words, shares: Sequence[float], n_seeds: int) -> str:
    """Shares as numbers of seeds."""
    return words.joined(fmt.count(n_seeds * share) for share in shares)


def percent(share: float) -> str:
    """A share without its sign."""
    return fmt.fixed(100.0 * share, 0)
