"""Topic: where this analysis differs from the paper's."""

import numpy as np

from posstats.papers.drift.comparison import TABLE3_AREA
from posstats.papers.drift.findings import ALPHA, known, only_row
from posstats.papers.drift.reproduction import Reproduction
from posstats.papers.drift.seeds import repeated

from ...document import format as fmt
from ...document.content import Bullets, Paragraph, Part
from ...document.rows import rows
from .columns import compared
from .repeated import n_seeds
from .report import Report
from .words import Words


def topic(words: Words, report: Report) -> Part:
    """What this package would say otherwise."""
    run = report.run
    said = (
        _too_sure(words, run),
        _observable(words, run),
        words.text("differences.same_dimensions"),
        _mean_removed(words, run),
        _one_model(words, run),
    )
    text = Paragraph(words.text("differences.text"))
    return Part("differences", words.text("differences.title"), (text, Bullets(said)))


def _too_sure(words: Words, run: Reproduction) -> str:
    tested = [
        row
        for results in run.results.values()
        for row in rows(results.regression, frame="ground")
        if row.angle != "omega"
    ]
    kappa = only_row(run.results[TABLE3_AREA].regression, angle="kappa", scope="block",
                     frame="ground")  # fmt: skip
    ols, gls = _coverage("ols_covers"), _coverage("gls_covers")
    n_intervals = 3 * len(repeated()[TABLE3_AREA])
    return words.text(
        "differences.too_sure",
        total=n_seeds(),
        ols=_percent(ols),
        gls=_percent(gls),
        error=_percent(float(np.sqrt(ols * (1.0 - ols) / n_intervals))),
        lines=str(len(tested)),
        ordinary=str(sum(known(row.p_value) < ALPHA for row in tested)),
        general=str(sum(known(row.gls_p_value) < ALPHA for row in tested)),
        ols_p=fmt.p_phrase(kappa.p_value),
        gls_p=fmt.p_phrase(kappa.gls_p_value),
    )


def _coverage(name: str) -> float:
    """Share of the intervals of all seeds that hold the simulated drift."""
    return float(np.mean([getattr(each, name) for each in repeated()[TABLE3_AREA]]))


def _percent(share: float) -> str:
    return fmt.fixed(100.0 * share, 1)


def _observable(words: Words, run: Reproduction) -> str:
    sigmas = []
    for area, results in run.results.items():
        row = only_row(results.angle_error_summary, angle="omega", frame="ground")
        sigma = fmt.fixed(1e6 * known(row.median_sigma_rad), 1)
        sigmas.append(words.text("differences.sigma", sigma=sigma, area=str(area)))
    return words.text("differences.observable", sigmas=words.joined(sigmas))


def _mean_removed(words: Words, run: Reproduction) -> str:
    row = only_row(run.results[TABLE3_AREA].check_points, orientation="pos",
                   translation_removed=False)  # fmt: skip
    shift = float(np.hypot(*known(row.shift_m)[:2]))
    return words.text("differences.mean_removed", shift=fmt.with_unit(shift, "m"))


def _one_model(words: Words, run: Reproduction) -> str:
    ratios = [
        each.ratio
        for each in compared(run, 4)
        if each.quantity.startswith("rmse") and each.ratio is not None
    ]
    least, most = fmt.fixed(min(ratios), 2), fmt.fixed(max(ratios), 2)
    return words.text("differences.one_model", least=least, most=most)
