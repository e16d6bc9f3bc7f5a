"""The content of ``comparison.json``; conclusions come in words of the report's catalogue."""

from collections.abc import Sequence

from posstats.contract.comparison import AreaShare, Comparison
from posstats.papers.drift.findings import CRITERIA
from posstats.papers.drift.reproduction import Reproduction
from posstats.papers.drift.seeds import repeated, share
from posstats.version import __version__

from ..conclusion import Conclusion
from .repeated import is_about


def results(run: Reproduction, found: Sequence[Conclusion], created: str) -> Comparison:
    """All numbers of the report.

    Parameters
    ----------
    run
        The three areas beside the published tables.
    found
        The conclusions, in English, whatever the language of the pages.
    created
        ISO 8601 time stamp.
    """
    return Comparison(
        posstats_version=__version__,
        created=created,
        simulated=True,
        seed=run.seed,
        rows=run.compared,
        conclusions=tuple(each.stated() for each in found),
        seed_shares=tuple(
            AreaShare(
                finding=name, area=area, n_seeds=len(repeated()[area]), share=share(name, area)
            )
            for name in CRITERIA
            for area in run.results
            if is_about(name, area)
        ),
    )
