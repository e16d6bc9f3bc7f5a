"""The paper's conclusions as sentences, each with what the simulation says of it."""

from collections.abc import Callable
from dataclasses import dataclass

from posstats.contract.results import Results
from posstats.papers.drift.comparison import TABLE3_AREA
from posstats.papers.drift.findings import AreaFindings, known, only_row
from posstats.papers.drift.published import printed_gain
from posstats.papers.drift.reproduction import Reproduction
from posstats.papers.drift.seeds import repeated, share, share_interval

from ...document import format as fmt

ORTHOPHOTO_H_M = 5.0
"""Horizontal RMSE for orthophotos at 1:10 000 of flat and hilly ground: 0.5 mm at map scale."""


@dataclass(frozen=True)
class Conclusion:
    """What the paper concludes, whether the simulation bears it out, and by which numbers.

    `title` is the conclusion in a few words, `evidence` one statement per line.
    """

    title: str
    text: str
    holds: bool
    evidence: tuple[str, ...]


def conclusions(run: Reproduction) -> tuple[Conclusion, ...]:
    """Every conclusion of the paper that a simulation of its data can test."""
    return (
        _angles_dominate(run),
        _omega_is_the_source(run),
        _only_omega_is_linear(run),
        _omega_alone_is_chosen(run),
        _only_omega_helps(run),
        _check_points_improve(run),
        _gains(run),
        _orthophoto(run),
    )


def _angles_dominate(run: Reproduction) -> Conclusion:
    return _tested(
        run, "angles_dominate",
        "Angle errors, not position errors, cause the vertical parallax",
        "Errors of the angles cause the vertical parallax, errors of the positions hardly any.",
        "Holds if the errors of the POS angles alone make the parallax of the POS within 10 %, and "
        "those of its positions, image noise apart, less than a third of it. Mean parallax from "
        "the POS / by its angles alone / by its positions alone / after relative orientation:",
        lambda f: _slashed(f.pos_mm, f.angles_mm, f.positions_mm, f.independent_mm),
    )  # fmt: skip


def _omega_is_the_source(run: Reproduction) -> Conclusion:
    def kept(found: AreaFindings) -> str:
        percent = [fmt.fixed(100.0 * share, 0) for share in found.kept_by.values()]
        return f"{' / '.join(percent)}\u00a0%"

    return _tested(
        run, "omega_is_the_source",
        "Omega is the main source of it (Figure 1)",
        "Omega is the main source of the parallax: relative orientation with omega held leaves "
        "about as much as with all three angles held, with phi or kappa held about as little as "
        "with none.",
        "Holds if holding all three angles adds 10 % or more, and of what it adds omega alone "
        "keeps over 90 %, phi and kappa each less than 10 %. Omega / phi / kappa keep:",
        kept,
    )  # fmt: skip


def _only_omega_is_linear(run: Reproduction) -> Conclusion:
    found = run.findings[TABLE3_AREA]
    block = fmt.joined(_block_r_squared(results) for results in run.results.values())
    low, high = share_interval("only_omega_is_linear", TABLE3_AREA)
    return Conclusion(
        "Over a strip of area 1 omega is linear in time, phi and kappa show no drift (Table 3)",
        "The error of omega is linear in time with R² near 1; the errors of phi and kappa show no "
        "such relation.",
        found.only_omega_is_linear,
        (
            "Holds if R² of omega is above 0.95 and p of phi and kappa above 0.05 in strip 1 of "
            "area 1, which says that no drift was seen, not that there is none.",
            f"R² of omega {fmt.fixed(found.strip_omega_r_squared, 3)}, p of phi "
            f"{fmt.p_value(found.strip_phi_p)}, p of kappa {fmt.p_value(found.strip_kappa_p)}.",
            f"Over the blocks of areas 1, 2 and 3 R² of omega is {block}; in single strips of "
            "areas 2 and 3 the drift is too small beside the noise for that (Table 3b).",
            f"{_seeds('only_omega_is_linear', (TABLE3_AREA,))} (95 % interval of this share "
            f"{fmt.fixed(100.0 * low, 0)} to {fmt.fixed(100.0 * high, 0)} %)",
        ),
    )


def _block_r_squared(results: Results) -> str:
    row = only_row(results.regression, angle="omega", scope="block", frame="ground")
    return fmt.fixed(row.r_squared, 3)


def _omega_alone_is_chosen(run: Reproduction) -> Conclusion:
    return _tested(
        run, "omega_alone_is_chosen",
        "Omega alone is to be corrected",
        "By the tests of the regression, omega is to be corrected, phi and kappa are not.",
        "Holds if the rules “paper” choose omega alone for the block. Chosen:",
        lambda f: f.corrected_angles.replace("+", " and ") or "none",
    )  # fmt: skip


def _only_omega_helps(run: Reproduction) -> Conclusion:
    def after(found: AreaFindings) -> str:
        values = _slashed(found.pos_mm, found.corrected_omega_mm, found.corrected_phi_mm,
                          found.corrected_kappa_mm)  # fmt: skip
        return f"{values}; omega: {fmt.fixed(found.over_relative, 2)} × relative orientation"

    return _tested(
        run, "only_omega_helps",
        "Only the correction of omega reduces the parallax (Figure 3)",
        "Correcting omega by its line reduces the parallax markedly, correcting phi or kappa by "
        "theirs does not.",
        "Holds if with omega corrected it falls by 10 % or more, to at most 1.6 times what "
        "relative orientation leaves, and with phi or kappa corrected by less than 10 %. Mean "
        "parallax from the POS / with omega / phi / kappa corrected:",
        after,
    )  # fmt: skip


def _check_points_improve(run: Reproduction) -> Conclusion:
    def rmse(found: AreaFindings) -> str:
        before = _metres(found.pos_horizontal_m, found.pos_vertical_m)
        return f"{before} → {_metres(found.corrected_horizontal_m, found.corrected_vertical_m)}"

    return _tested(
        run, "check_points_improve",
        "With omega corrected, check points fit better, horizontally and vertically (Table 4)",
        "With omega corrected, check points are intersected more accurately, horizontally and "
        "vertically.",
        "Holds if both RMSE fall. RMSE H / V, mean difference removed, before → after:",
        rmse,
    )  # fmt: skip


def _gains(run: Reproduction) -> Conclusion:
    """The paper's range of improvement, against the simulation and against its own Table 4."""
    return Conclusion(
        "The gain at check points is 0.5 to 1.0 times (H) and 1.0 to 2.0 times (V)",
        "The accuracy at check points improves by 0.5 to 1.0 times horizontally and by 1.0 to 2.0 "
        "times vertically.",
        all(found.gains_as_published for found in run.findings.values()),
        (
            "Read as RMSE before over after, minus 1; holds if it is in these ranges in every "
            "area. Gain H / V, simulated (and by the paper's own Table 4):",
            *(
                f"area {area}: {_pair(*found.gain)} ({_pair(*printed_gain(area))})"
                for area, found in run.findings.items()
            ),
            "The paper's own table leaves the ranges too: horizontally in area 2, vertically in "
            "area 1.",
            _seeds("gains_as_published", tuple(run.findings)) + ".",
        ),
    )


def _pair(horizontal: float, vertical: float) -> str:
    return f"{fmt.fixed(horizontal, 2)} / {fmt.fixed(vertical, 2)}"


def _orthophoto(run: Reproduction) -> Conclusion:
    def rmse(results: Results, orientation: str, *, removed: bool) -> float:
        row = only_row(results.check_points, orientation=orientation, translation_removed=removed)
        return known(row.rmse_horizontal_m)

    after = {area: rmse(each, "omega", removed=False) for area, each in run.results.items()}
    return Conclusion(
        "The corrected POS is sufficient for orthophotos at 1:10 000 without block adjustment",
        "Without block adjustment, the corrected POS is accurate enough for orthophotos at "
        "1:10 000.",
        max(after.values()) <= ORTHOPHOTO_H_M,
        (
            "Holds if the horizontal RMSE, mean difference kept, is at most 5.0\u00a0m: 0.5 mm at "
            "map scale, usual for flat and hilly ground; the paper names no limit.",
            "RMSE before → after (after, mean removed as in the paper):",
            *(
                f"area {area}: {fmt.fixed(rmse(each, 'pos', removed=False), 2)} → "
                f"{fmt.fixed(after[area], 2)}\u00a0m "
                f"({fmt.fixed(rmse(each, 'omega', removed=True), 2)}\u00a0m)"
                for area, each in run.results.items()
            ),
            "A block that meets the limit before correction proves nothing for it.",
        ),
    )


def _tested(
    run: Reproduction,
    criterion: str,
    title: str,
    text: str,
    heading: str,
    shown: Callable[[AreaFindings], str],
) -> Conclusion:
    """A conclusion that holds if its criterion holds in every area; evidence area by area."""
    return Conclusion(
        title,
        text,
        all(getattr(found, criterion) for found in run.findings.values()),
        (
            heading,
            *(f"area {area}: {shown(found)}" for area, found in run.findings.items()),
            _seeds(criterion, tuple(run.findings)) + ".",
        ),
    )


def _seeds(criterion: str, areas: tuple[int, ...]) -> str:
    n = len(repeated()[areas[0]])
    held = fmt.joined(fmt.fixed(n * share(criterion, area), 0) for area in areas)
    where = f" (areas {fmt.joined(map(str, areas))})" if len(areas) > 1 else ""
    return f"Holds for {held} of {n} seeds{where}"


def _slashed(*values_mm: float) -> str:
    return " / ".join(fmt.fixed(value, 4) for value in values_mm) + "\u00a0mm"


def _metres(horizontal: float, vertical: float) -> str:
    return f"{fmt.fixed(horizontal, 2)} / {fmt.fixed(vertical, 2)}\u00a0m"
