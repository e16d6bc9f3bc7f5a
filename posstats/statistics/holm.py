"""Several tests as one family: S. Holm's adjustment of p-values, for any dependence.

Scandinavian Journal of Statistics 6 (1979), 65-70. statsmodels' `multipletests` gives the same, but
collects garbage at every call (0.5 s).
"""

from collections.abc import Sequence


def holm(p_values: Sequence[float | None]) -> list[float | None]:
    """The adjusted p-values; None (no test) stays None and does not count."""
    adjusted = list(p_values)
    tested = sorted((p, k) for k, p in enumerate(p_values) if p is not None)
    largest = 0.0
    for rank, (p, k) in enumerate(tested):
        largest = max(largest, min(1.0, (len(tested) - rank) * p))
        adjusted[k] = largest
    return adjusted
