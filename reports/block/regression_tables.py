"""Tables of the regressions of angle errors on time, and of the decisions drawn from them."""

from collections.abc import Iterable, Sequence

from posstats.contract.results import Regression, Results, Selection

from ..document import format as fmt
from ..document.rows import first
from ..document.table import (
    Column,
    Table,
    count_column,
    number_column,
    p_column,
    prose_column,
    text_column,
)
from .view import decided_by_strip, scope_label

SHOWN_DECISIONS = 20
SHOWN_STRIP_LINES = 18  # from which lines strip by strip fill pages and tell no more

Bounds = tuple[float | None, float | None] | None

_MODEL = "e(t) = a₀ + a₁ (t − t₀)"


def ordinary_regression(results: Results) -> Table:
    """The regressions by ordinary least squares: coefficients, R2, F0 and p."""
    kept = _fitted(results, SHOWN_STRIP_LINES)
    unit = fmt.rate_unit(row.slope_rad_per_s for row in kept)
    columns: tuple[Column, ...] = (
        *_who(kept),
        count_column("n", [row.n for row in kept]),
        count_column("clusters", [row.n_time_clusters for row in kept]),
        number_column("a₀", "mrad", [fmt.MILLIRADIAN.scaled(row.intercept_rad) for row in kept]),
        number_column("a₁", unit.name, [unit.scaled(row.slope_rad_per_s) for row in kept]),
        count_column("t₀", [row.time_origin_s for row in kept]),
        _share("R²", [row.r_squared for row in kept]),
        Column("F₀", tuple(_statistic(row.f_statistic) for row in kept)),
        p_column("p", [row.p_value for row in kept]),
    )
    columns = tuple(_with_unit(c, "s") if c.title == "t₀" else c for c in columns)
    caption = f"Regression of the angle errors on time by ordinary least squares: {_MODEL}."
    notes = (
        "R²: share of the errors' variation that the line explains. F₀ = (n − 2) R² / (1 − R²), "
        "with 1 and n − 2 degrees of freedom. Null hypothesis of p: the error does not change with "
        "time (a₁ = 0), errors of different images being independent.",
        "n: images; clusters: moments that are apart in time, as many as the line really rests on.",
        "omega, phi, kappa: ground frame; pitch, roll, yaw: about the axes of the image.",
        *_not_shown(results, kept),
        *_reasons(results),
    )
    return Table("regression_ols", caption, columns, notes, _block_rows(kept))


def generalised_regression(results: Results) -> Table:
    """Slopes by generalised least squares beside those of OLS, each with its interval."""
    kept = _fitted(results, 0)
    rates = [rate for row in kept for rate in (row.slope_rad_per_s, row.gls_slope_rad_per_s)]
    unit = fmt.rate_unit(rates)
    small = fmt.angle_unit(row.white_noise_sigma_rad for row in kept)
    columns = [
        *_who(kept),
        *_slopes([(row.gls_slope_rad_per_s, row.gls_slope_ci95) for row in kept], unit, "GLS"),
        p_column("p", [row.gls_p_value for row in kept], "GLS"),
        *_slopes([(row.slope_rad_per_s, row.slope_ci95) for row in kept], unit, "OLS"),
    ]
    for title, sigmas in (
        ("white noise", [row.white_noise_sigma_rad for row in kept]),
        ("strip effect", [row.strip_effect_sigma_rad for row in kept]),
    ):
        if fmt.present(sigmas):
            columns.append(number_column(title, small.name, map(small.scaled, sigmas), 2))
    caption = (
        "Slopes of the angle errors over time with 95 % confidence intervals: ordinary (OLS) "
        "beside generalised least squares (GLS), which allows for the errors' covariance."
    )
    notes = (
        "GLS: covariance of the angle errors as estimated, plus white noise and, for the block, a "
        "random constant per strip, with variances by restricted maximum likelihood; their "
        "standard deviations are in the last columns. Where the two differ, believe GLS.",
        "Null hypothesis of p: the slope is zero (t test).",
        *_not_shown(results, kept),
    )
    return Table("regression_gls", caption, tuple(columns), notes, _block_rows(kept))


def _slopes(
    fits: Sequence[tuple[float | None, Bounds]], unit: fmt.Unit, group: str
) -> list[Column]:
    bounds = [interval or (None, None) for _, interval in fits]
    texts = [_interval(unit.scaled(low), unit.scaled(high)) for low, high in bounds]
    return [
        number_column("slope", unit.name, [unit.scaled(slope) for slope, _ in fits], 3, group),
        Column("95\u00a0%\u00a0interval", tuple(texts), unit.name, group=group),
    ]


def _interval(low: float | None, high: float | None) -> str:
    if low is None or high is None:
        return fmt.MISSING
    decimals = max(0, 1 - fmt.exponent(high - low, 2)) if high > low else 2
    return f"{fmt.fixed(low, decimals)} to {fmt.fixed(high, decimals)}"


def decisions(results: Results) -> Table:
    """Which angles are corrected, in which form, and why; by strip only the corrected ones."""
    chosen = results.selection
    by_strip = decided_by_strip(results)
    if by_strip:
        chosen = tuple(row for row in chosen if row.correct)
    shown = chosen[:SHOWN_DECISIONS]
    columns = (
        text_column("Angle", [row.angle for row in shown]),
        text_column("Frame", [row.frame for row in shown]),
        text_column("Scope", [scope_label(row.scope) for row in shown]),
        text_column("Corrected", ["yes" if row.correct else "no" for row in shown]),
        text_column("Form", [row.form for row in shown]),
        prose_column("Reason", [fmt.prose(row.reason) for row in shown]),
    )
    corrected = frozenset(k for k, row in enumerate(shown) if row.correct and not by_strip)
    which = "Corrections of POS angles in single strips" if by_strip else (
        "Decisions on the correction of the POS angles"
    )  # fmt: skip
    notes = ["Forms: none; constant (a mean error is taken off); linear (the regression line)."]
    if by_strip:
        hidden = f" {len(shown)} of {len(chosen)} are shown." if len(shown) < len(chosen) else ""
        notes.append(f"The reasons of every strip and angle: tables/selection.csv.{hidden}")
    return Table("decisions", f"{which}, each with its reason.", columns, tuple(notes), corrected)


def decisions_by_strip(results: Results) -> Table:
    """Decided form of every angle in every strip, with the R2 and p of its line."""
    chosen = results.selection
    kept = list(dict.fromkeys(row.scope for row in chosen))
    columns = [text_column("Strip", kept)]
    for angle in dict.fromkeys(row.angle for row in chosen):
        decided = [first(results.selection, angle=angle, scope=scope) for scope in kept]
        lines = [_line_of(results, row) if row else None for row in decided]
        columns += [
            _share("R²", [row.r_squared if row else None for row in lines], angle),
            p_column("p", [_tested_p(*pair) for pair in zip(decided, lines, strict=True)], angle),
            text_column("form", [row.form if row else None for row in decided], angle),
        ]
    caption = (
        "Decisions on the correction of the POS angles strip by strip: the form taken off, and R² "
        "and p of the line over time."
    )
    notes = (
        f"{fmt.MISSING}: no line can be fitted to the strip (fewer than three images). p: as the "
        "rules test it, before any adjustment for testing several angles.",
    )
    return Table("decisions_by_strip", caption, tuple(columns), notes)


def _line_of(results: Results, decision: Selection) -> Regression | None:
    return first(results.regression, angle=decision.angle, frame=decision.frame,
                 scope=decision.scope)  # fmt: skip


def _tested_p(decision: Selection | None, line: Regression | None) -> float | None:
    if decision is None or line is None:
        return None
    return line.gls_p_value if decision.fit == "gls" else line.p_value


def _who(kept: Sequence[Regression]) -> tuple[Column, Column]:
    """Angle (its name tells the frame) and scope."""
    return (
        text_column("Angle", [row.angle for row in kept]),
        text_column("Block or strip", [row.scope for row in kept]),
    )


def _fitted(results: Results, most: int) -> list[Regression]:
    """Regressions that could be made: the block's, then by strip if decided so or not too many."""
    made = [row for row in results.regression if not row.reason]
    block = [row for row in made if row.scope == "block"]
    by_strip = [row for row in made if row.scope != "block"]
    return block + (by_strip if decided_by_strip(results) or len(by_strip) <= most else [])


def _not_shown(results: Results, kept: Sequence[Regression]) -> tuple[str, ...]:
    made = [row for row in results.regression if not row.reason]
    return ("Strip by strip: tables/regression.csv.",) if len(kept) < len(made) else ()


def _reasons(results: Results) -> list[str]:
    """One note per reason for which regressions could not be made, and the angles it holds for."""
    angles: dict[tuple[str, str], list[str]] = {}
    for row in results.regression:
        if row.reason:
            angles.setdefault((row.reason, scope_label(row.scope)), []).append(row.angle)
    scopes: dict[tuple[str, str], list[str]] = {}
    for (why, scope), named in angles.items():
        scopes.setdefault((why, fmt.joined(named)), []).append(scope)
    return [
        f"Not fitted: {named} of {fmt.joined(where)}. Reason: {fmt.prose(why)}."
        for (why, named), where in scopes.items()
    ]


def _block_rows(kept: Sequence[Regression]) -> frozenset[int]:
    """Rows of the block, where rows of strips stand below them."""
    block = frozenset(k for k, row in enumerate(kept) if row.scope == "block")
    return block if len(block) < len(kept) else frozenset()


def _statistic(value: float | None) -> str:
    """Four significant digits, but not more than three decimals."""
    return fmt.fixed(value, 3) if value is not None and abs(value) < 10.0 else fmt.number(value, 4)


def _share(title: str, values: Iterable[float | None], group: str = "") -> Column:
    return Column(title, tuple(fmt.fixed(value, 3) for value in values), group=group)


def _with_unit(column: Column, unit: str) -> Column:
    return Column(column.title, column.cells, unit, column.align, column.group)
