"""Topic: scenarios, seeds, settings and software of the first paper's reproduction."""

from posstats.contract.results import AnalysisSettings
from posstats.papers.drift.areas import area_seed
from posstats.papers.drift.comparison import TABLE3_AREA

from ...document.content import Part
from .. import provenance
from .report import Report
from .words import Words

_SETTINGS = ("rules", "scope", "errors", "frame", "robust")


def topic(words: Words, report: Report) -> Part:
    """How to make the numbers again."""
    run = report.run
    results = run.results[TABLE3_AREA]
    text = words.text("provenance.text", seed=str(run.seed))
    seeds = [_seed(words, area, area_seed(run.seed, area)) for area in run.results]
    settings = [
        (words.of("setting", name), words.known("setting_value", str(value)))
        for name, value in _chosen(results.settings).items()
    ]
    return provenance.topic(words, text, [*seeds, *settings], results.versions.items(), "HI")


def _chosen(settings: AnalysisSettings) -> dict[str, object]:
    return {name: getattr(settings, name) for name in _SETTINGS}


def _seed(words: Words, area: int, seed: int) -> tuple[str, str]:
    return (
        words.text("provenance.seed", area=str(area)),
        words.text("provenance.seeds", area=str(area), seed=str(seed)),
    )
