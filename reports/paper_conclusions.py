"""The paper's conclusions as sentences, each with what the simulation says of it."""

from collections.abc import Callable
from dataclasses import dataclass

from posstats.experiment.comparison import Compared
from posstats.experiment.findings import AreaFindings
from posstats.experiment.reproduction import Reproduction
from posstats.experiment.seeds import repeated, share

from . import format as fmt
from .results_view import Results, first

ORTHOPHOTO_H_M = 5.0
"""Horizontal RMSE for orthophotos at 1:10 000 of flat and hilly ground: 0.5 mm at map scale."""

_PUBLISHED_GAINS = {"horizontal": (0.5, 1.0), "vertical": (1.0, 2.0)}


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
    """Every conclusion of the paper that its data can test."""
    return (
        _angles_dominate(run),
        _omega_is_the_source(run),
        _only_omega_is_linear(run),
        _omega_alone_is_chosen(run),
        _only_omega_helps(run),
        _check_points_improve(run),
        _gains(run),
        _orthophoto(run),
        _not_for_mapping(run),
    )


def _angles_dominate(run: Reproduction) -> Conclusion:
    return _tested(
        run, "angles_dominate",
        "Angle errors, not position errors, cause the vertical parallax",
        "Errors of the angles cause the vertical parallax, errors of the positions hardly any: "
        "correcting the angles alone (independent pairs) leaves no more than correcting the base "
        "as well (dependent pairs).",
        "Mean parallax from the POS / independent / dependent pairs:",
        lambda f: _slashed(f.pos_mm, f.independent_mm, f.dependent_mm),
    )  # fmt: skip


def _omega_is_the_source(run: Reproduction) -> Conclusion:
    def kept(found: AreaFindings) -> str:
        percent = [fmt.fixed(100.0 * share, 0) for share in found.kept_by.values()]
        return f"{' / '.join(percent)}\u00a0%"

    return _tested(
        run, "omega_is_the_source",
        "Omega is the main source of it (Figure 1)",
        "Omega is the main source of the parallax: relative orientation with omega held leaves as "
        "much as with all three angles held, with phi or kappa held as little as with none.",
        "Of what holding all three adds, omega / phi / kappa held alone keep:",
        kept,
    )  # fmt: skip


def _only_omega_is_linear(run: Reproduction) -> Conclusion:
    found = run.findings[1]
    return Conclusion(
        "The error of omega is linear in time, phi and kappa are not (Table 3, Figure 2)",
        "The error of omega is linear in time with R² near 1; the errors of phi and kappa do not "
        "follow time.",
        found.only_omega_is_linear,
        (
            f"Strip 1 of area 1: R² of omega {fmt.fixed(found.strip_omega_r_squared, 3)}, p of "
            f"phi {fmt.p_value(found.strip_phi_p)}, p of kappa {fmt.p_value(found.strip_kappa_p)}.",
            "Holds if R² is above 0.95 and both p are above 0.05.",
            _seeds("only_omega_is_linear", (1,)),
        ),
    )


def _omega_alone_is_chosen(run: Reproduction) -> Conclusion:
    return _tested(
        run, "omega_alone_is_chosen",
        "Omega alone is to be corrected",
        "By the tests of the regression, omega is to be corrected, phi and kappa are not.",
        "Chosen by the rules “paper”:",
        lambda f: f.corrected_angles.replace("+", " and ") or "none",
    )  # fmt: skip


def _only_omega_helps(run: Reproduction) -> Conclusion:
    def after(found: AreaFindings) -> str:
        values = _slashed(found.pos_mm, found.corrected_omega_mm, found.corrected_phi_mm,
                          found.corrected_kappa_mm)  # fmt: skip
        return f"{values}; omega corrected: {_over_relative(found)}"

    return _tested(
        run, "only_omega_helps",
        "Only the correction of omega reduces the parallax (Figure 3)",
        "Correcting omega by its line reduces the parallax markedly, correcting phi or kappa by "
        "theirs does not.",
        "Mean parallax from the POS / with omega / phi / kappa corrected:",
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
        "RMSE H / V, mean difference removed, before → after:",
        rmse,
    )  # fmt: skip


def _gains(run: Reproduction) -> Conclusion:
    """The paper's range of improvement, against the simulation and against its own Table 4."""
    gains = {area: (_gain(run, area, "reproduced"), _gain(run, area, "published"))
             for area in run.results}  # fmt: skip
    within = all(
        low <= simulated[side] <= high
        for simulated, _ in gains.values()
        for side, (low, high) in _PUBLISHED_GAINS.items()
    )
    return Conclusion(
        "The gain at check points is 0.5 to 1.0 times (H) and 1.0 to 2.0 times (V)",
        "The accuracy at check points improves by 0.5 to 1.0 times horizontally and by 1.0 to 2.0 "
        "times vertically (RMSE before over after, minus 1).",
        within,
        (
            "Gain H / V, simulated (and by the paper's own Table 4):",
            *(
                f"area {area}: {_pair(simulated)} ({_pair(printed)})"
                for area, (simulated, printed) in gains.items()
            ),
            "The gain follows from the size of the omega error beside all others, which was not "
            "fitted.",
        ),
    )


def _gain(run: Reproduction, area: int, source: str) -> dict[str, float]:
    keyed = {(e.orientation, e.quantity): e for e in run.compared if (e.table, e.area) == (4, area)}

    def rmse(orientation: str, side: str) -> float:
        found: Compared = keyed[orientation, f"rmse_{side}_m"]
        return float(getattr(found, source))

    return {
        side: rmse("pos", side) / rmse("omega_corrected", side) - 1.0 for side in _PUBLISHED_GAINS
    }


def _pair(gain: dict[str, float]) -> str:
    return f"{fmt.fixed(gain['horizontal'], 1)} / {fmt.fixed(gain['vertical'], 1)}"


def _orthophoto(run: Reproduction) -> Conclusion:
    def rmse(results: Results, orientation: str, *, removed: bool) -> float:
        row = first(results, "check_points", orientation=orientation, translation_removed=removed)
        return float(row["rmse_horizontal_m"])

    after = {area: rmse(each, "omega", removed=False) for area, each in run.results.items()}
    return Conclusion(
        "The corrected POS does for orthophotos at 1:10 000 without block adjustment",
        "Without block adjustment, the corrected POS is accurate enough for orthophotos at "
        "1:10 000 (horizontal RMSE of 5.0 m).",
        max(after.values()) <= ORTHOPHOTO_H_M,
        (
            "Horizontal RMSE with the mean difference kept, before → after (after, mean removed "
            "as in the paper):",
            *(
                f"area {area}: {fmt.fixed(rmse(each, 'pos', removed=False), 2)} → "
                f"{fmt.fixed(after[area], 2)}\u00a0m "
                f"({fmt.fixed(rmse(each, 'omega', removed=True), 2)}\u00a0m)"
                for area, each in run.results.items()
            ),
        ),
    )


def _not_for_mapping(run: Reproduction) -> Conclusion:
    return _tested(
        run, "more_than_relative_is_left",
        "Other errors remain: it does not quite do for stereo plotting",
        "Other errors remain, so the corrected POS does not quite do for stereo plotting, which "
        "needs models as free of parallax as relative orientation makes them.",
        "Mean parallax with omega corrected:",
        _over_relative,
    )  # fmt: skip


def _over_relative(found: AreaFindings) -> str:
    ratio = fmt.fixed(found.corrected_omega_mm / found.independent_mm, 2)
    return f"{ratio} times what relative orientation leaves"


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
            _seeds(criterion, tuple(run.findings)),
        ),
    )


def _seeds(criterion: str, areas: tuple[int, ...]) -> str:
    n = len(repeated()[areas[0]])
    held = fmt.joined(fmt.fixed(n * share(criterion, area), 0) for area in areas)
    where = f" (areas {fmt.joined(map(str, areas))})" if len(areas) > 1 else ""
    return f"Holds for {held} of {n} seeds{where}."


def _slashed(*values_mm: float) -> str:
    return " / ".join(fmt.fixed(value, 4) for value in values_mm) + "\u00a0mm"


def _metres(horizontal: float, vertical: float) -> str:
    return f"{fmt.fixed(horizontal, 2)} / {fmt.fixed(vertical, 2)}\u00a0m"
