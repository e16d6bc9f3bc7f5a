"""The paper's conclusions as sentences, each with what the simulation says of it."""

from collections.abc import Callable

from posstats.contract.results import Results
from posstats.papers.drift.comparison import TABLE3_AREA
from posstats.papers.drift.findings import AreaFindings, known, only_row
from posstats.papers.drift.published import printed_gain
from posstats.papers.drift.reproduction import Reproduction
from posstats.papers.drift.seeds import repeated, share, share_interval

from ...document import format as fmt
from ...document.content import Labelled, Paragraph, Part
from .. import seeds
from ..conclusion import Conclusion, evidence
from .repeated import OF_ONE_AREA
from .report import Report
from .words import Words

ORTHOPHOTO_H_M = 5.0
"""Horizontal RMSE for orthophotos at 1:10 000 of flat and hilly ground: 0.5 mm at map scale."""


def topic(words: Words, report: Report) -> Part:
    """Every conclusion with its evidence."""
    table = evidence(words, "evidence", words.text("conclusions.evidence_caption"),
                     words.text("conclusions.column"), report.conclusions)  # fmt: skip
    text = Paragraph(words.text("conclusions.text"))
    return Part("conclusions", words.text("conclusions.title"), (text, Labelled("B", table)))


def conclusions(words: Words, run: Reproduction) -> tuple[Conclusion, ...]:
    """Every conclusion of the paper that a simulation of its data can test."""
    return (
        _angles_dominate(words, run),
        _omega_is_the_source(words, run),
        _only_omega_is_linear(words, run),
        _omega_alone_is_chosen(words, run),
        _only_omega_helps(words, run),
        _check_points_improve(words, run),
        _gains(words, run),
        _orthophoto(words, run),
    )


def _angles_dominate(words: Words, run: Reproduction) -> Conclusion:
    def shown(found: AreaFindings) -> str:
        return _slashed(found.pos_mm, found.angles_mm, found.positions_mm, found.independent_mm)

    return _tested(words, run, "angles_dominate", shown)


def _omega_is_the_source(words: Words, run: Reproduction) -> Conclusion:
    def kept(found: AreaFindings) -> str:
        return f"{' / '.join(map(seeds.percent, found.kept_by.values()))}\u00a0%"

    return _tested(words, run, "omega_is_the_source", kept)


def _only_omega_is_linear(words: Words, run: Reproduction) -> Conclusion:
    found = run.findings[TABLE3_AREA]
    block = words.joined(_block_r_squared(results) for results in run.results.values())
    low, high = map(seeds.percent, share_interval(OF_ONE_AREA, TABLE3_AREA))
    n_seeds = len(repeated()[TABLE3_AREA])
    held = seeds.counted(words, [share(OF_ONE_AREA, TABLE3_AREA)], n_seeds)
    return _conclusion(
        words,
        OF_ONE_AREA,
        found.only_omega_is_linear,
        words.text(
            "shown.only_omega_is_linear",
            r_squared=fmt.fixed(found.strip_omega_r_squared, 3),
            phi=fmt.p_value(found.strip_phi_p),
            kappa=fmt.p_value(found.strip_kappa_p),
        ),
        words.text("shown.block_r_squared", block=block),
        words.text("seeds.held_interval", held=held, total=fmt.count(n_seeds), low=low, high=high),
    )


def _block_r_squared(results: Results) -> str:
    row = only_row(results.regression, angle="omega", scope="block", frame="ground")
    return fmt.fixed(row.r_squared, 3)


def _omega_alone_is_chosen(words: Words, run: Reproduction) -> Conclusion:
    none = words.text("shown.omega_alone_is_chosen")
    return _tested(words, run, "omega_alone_is_chosen", lambda found: words.angles(found) or none)


def _only_omega_helps(words: Words, run: Reproduction) -> Conclusion:
    def after(found: AreaFindings) -> str:
        parallax = _slashed(found.pos_mm, found.corrected_omega_mm, found.corrected_phi_mm,
                            found.corrected_kappa_mm)  # fmt: skip
        ratio = fmt.fixed(found.over_relative, 2)
        return words.text("shown.only_omega_helps", parallax=parallax, ratio=ratio)

    return _tested(words, run, "only_omega_helps", after)


def _check_points_improve(words: Words, run: Reproduction) -> Conclusion:
    def rmse(found: AreaFindings) -> str:
        before = _pair(found.pos_horizontal_m, found.pos_vertical_m)
        after = _pair(found.corrected_horizontal_m, found.corrected_vertical_m)
        return f"{before}\u00a0m → {after}\u00a0m"

    return _tested(words, run, "check_points_improve", rmse)


def _gains(words: Words, run: Reproduction) -> Conclusion:
    """The paper's range of improvement, against the simulation and against its own Table 4."""

    def gain(found: AreaFindings) -> str:
        printed = _pair(*printed_gain(found.area))
        return words.text("shown.gains_as_published", gain=_pair(*found.gain), printed=printed)

    rule = words.text("rule.gains_as_published")
    return _tested(words, run, "gains_as_published", gain, rule)


def _orthophoto(words: Words, run: Reproduction) -> Conclusion:
    def rmse(results: Results, orientation: str, *, removed: bool) -> float:
        row = only_row(results.check_points, orientation=orientation, translation_removed=removed)
        return known(row.rmse_horizontal_m)

    after = {area: rmse(each, "omega", removed=False) for area, each in run.results.items()}
    shown = {
        area: words.text(
            "shown.orthophoto",
            before=fmt.fixed(rmse(each, "pos", removed=False), 2),
            after=fmt.fixed(after[area], 2),
            removed=fmt.fixed(rmse(each, "omega", removed=True), 2),
        )
        for area, each in run.results.items()
    }
    return _conclusion(
        words,
        "orthophoto",
        max(after.values()) <= ORTHOPHOTO_H_M,
        words.text("heading.orthophoto_rmse"),
        *(words.line(words.area(area), each) for area, each in shown.items()),
        words.text("rule.orthophoto"),
    )


def _tested(
    words: Words,
    run: Reproduction,
    criterion: str,
    shown: Callable[[AreaFindings], str],
    *rules: str,
) -> Conclusion:
    """A conclusion that holds if its criterion holds in every area; evidence area by area."""
    areas = tuple(run.findings)
    shares = [share(criterion, area) for area in areas]
    n_seeds = len(repeated()[areas[0]])
    return _conclusion(
        words,
        criterion,
        all(getattr(found, criterion) for found in run.findings.values()),
        *(words.line(words.area(area), shown(run.findings[area])) for area in areas),
        *rules,
        seeds.held(words, shares, n_seeds, words.areas(areas)),
    )


def _conclusion(words: Words, name: str, holds: bool, *said: str) -> Conclusion:
    heading = words.of("heading", name)
    return Conclusion(words.of("title", name), words.of("claim", name), holds, (heading, *said))


def _slashed(*values_mm: float) -> str:
    return " / ".join(fmt.fixed(value, 4) for value in values_mm) + "\u00a0mm"


def _pair(horizontal: float, vertical: float) -> str:
    return f"{fmt.fixed(horizontal, 2)} / {fmt.fixed(vertical, 2)}"
