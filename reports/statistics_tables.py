"""Tables of angle errors, regressions, decisions, check points, observability and provenance."""

from collections.abc import Iterable, Sequence

from . import format as fmt
from .results_view import Results, Row, orientation_label, rows, scope_label
from .tables import Column, Table, count_column, number_column, p_column, text_column

_MODEL = "e(t) = a₀ + a₁ (t − t₀)"


def angle_summary(results: Results) -> Table:
    """How much each angle errs, and how well that is known."""
    summary = rows(results, "angle_error_summary")
    unit = fmt.angle_unit(row["rms_rad"] for row in summary)
    columns = [
        text_column("Angle", [row["angle"] for row in summary]),
        text_column("Frame", [row["frame"] for row in summary]),
        count_column("Images", [row["n"] for row in summary]),
    ]
    words = {"mean_rad": "mean", "rms_rad": "RMS", "max_abs_rad": "largest",
             "median_sigma_rad": "median std. dev."}  # fmt: skip
    for key, title in words.items():
        values = [row.get(key) for row in summary]
        columns.append(number_column(title, unit.name, [unit.scaled(v) for v in values]))
    if unit is not fmt.DEGREE:
        degrees = [fmt.DEGREE.scaled(row["rms_rad"]) for row in summary]
        columns.append(number_column("RMS", fmt.DEGREE.name, degrees))
    caption = (
        "Errors of the POS angles (POS minus estimated) over the images whose angles are "
        "determined. The standard deviation says how well one image's error is known."
    )
    return Table("angle_error_summary", caption, tuple(columns))


def ordinary_regression(results: Results) -> Table:
    """The regressions by ordinary least squares: coefficients, R2, F0 and p."""
    kept = _fitted(results)
    unit = fmt.rate_unit(row["slope_rad_per_s"] for row in kept)
    columns: tuple[Column, ...] = (
        *_who(kept),
        count_column("n", [row["n"] for row in kept]),
        count_column("clusters", [row["n_time_clusters"] for row in kept]),
        number_column("a₀", "mrad", [fmt.MILLIRADIAN.scaled(row["intercept_rad"]) for row in kept]),
        number_column("a₁", unit.name, [unit.scaled(row["slope_rad_per_s"]) for row in kept]),
        count_column("t₀", [row["time_origin_s"] for row in kept]),
        _share("R²", [row["r_squared"] for row in kept]),
        Column("F₀", tuple(_statistic(row["f_statistic"]) for row in kept)),
        p_column("p", [row["p_value"] for row in kept]),
    )
    columns = tuple(_with_unit(c, "s") if c.title == "t₀" else c for c in columns)
    caption = f"Regression of the angle errors on time by ordinary least squares: {_MODEL}."
    notes = (
        "R²: share of the errors' variation that the line explains. F₀ = (n − 2) R² / (1 − R²), "
        "with 1 and n − 2 degrees of freedom. Null hypothesis of p: the error does not change with "
        "time (a₁ = 0), errors of different images being independent.",
        "n: images; clusters: moments that are apart in time, as many as the line really rests on.",
        "omega, phi, kappa: ground frame; pitch, roll, yaw: about the axes of the image.",
        *_reasons(results),
    )
    return Table("regression_ols", caption, columns, notes, _block_rows(kept))


def generalised_regression(results: Results) -> Table:
    """Slopes by generalised least squares beside those of OLS, each with its interval."""
    kept = _fitted(results)
    rates = [row[key] for row in kept for key in ("slope_rad_per_s", "gls_slope_rad_per_s")]
    unit = fmt.rate_unit(rates)
    small = fmt.angle_unit(row["white_noise_sigma_rad"] for row in kept)
    columns = [
        *_who(kept),
        *_slopes(kept, unit, "gls_slope_rad_per_s", "gls_slope_ci95", "GLS"),
        p_column("p", [row.get("gls_p_value") for row in kept], "GLS"),
        *_slopes(kept, unit, "slope_rad_per_s", "slope_ci95", "OLS"),
    ]
    for key, title in (
        ("white_noise_sigma_rad", "white noise"),
        ("strip_effect_sigma_rad", "strip effect"),
    ):
        values = [small.scaled(row.get(key)) for row in kept]
        if fmt.present(values):
            columns.append(number_column(title, small.name, values, 2))
    caption = (
        "Slopes of the angle errors over time with 95 % confidence intervals: ordinary (OLS) "
        "beside generalised least squares (GLS), which allows for the errors' covariance."
    )
    notes = (
        "GLS: covariance of the angle errors as estimated, plus white noise and, for the block, a "
        "random constant per strip, with variances by restricted maximum likelihood; their "
        "standard deviations are in the last columns. Where the two differ, believe GLS.",
        "Null hypothesis of p: the slope is zero (t test).",
    )
    return Table("regression_gls", caption, tuple(columns), notes, _block_rows(kept))


def _slopes(
    kept: Sequence[Row], unit: fmt.Unit, slope: str, interval: str, group: str
) -> list[Column]:
    bounds = [row.get(interval) or (None, None) for row in kept]
    texts = [_interval(unit.scaled(low), unit.scaled(high)) for low, high in bounds]
    return [
        number_column("slope", unit.name, [unit.scaled(row.get(slope)) for row in kept], 3, group),
        Column("95\u00a0%\u00a0interval", tuple(texts), unit.name, group=group),
    ]


def _interval(low: float | None, high: float | None) -> str:
    if low is None or high is None:
        return fmt.MISSING
    decimals = max(0, 1 - fmt.exponent(high - low, 2)) if high > low else 2
    return f"{fmt.fixed(low, decimals)} to {fmt.fixed(high, decimals)}"


def decisions(results: Results) -> Table:
    """Which angles are corrected, in which form, and why."""
    chosen = rows(results, "selection")
    columns = (
        text_column("Angle", [row["angle"] for row in chosen]),
        text_column("Frame", [row["frame"] for row in chosen]),
        text_column("Scope", [scope_label(row.get("scope") or "block") for row in chosen]),
        text_column("Corrected", ["yes" if row["correct"] else "no" for row in chosen]),
        text_column("Form", [row["form"] for row in chosen]),
        text_column("Reason", [fmt.prose(row["reason"]) for row in chosen]),
    )
    corrected = frozenset(k for k, row in enumerate(chosen) if row["correct"])
    caption = "Decisions on the correction of the POS angles, each with its reason."
    notes = ("Forms: none; constant (a mean error is taken off); linear (the regression line).",)
    return Table("decisions", caption, columns, notes, corrected)


def check_points(results: Results, *, translation_removed: bool) -> Table:
    """Check-point differences of every orientation, mean shift removed or kept."""
    stated = rows(results, "check_points", translation_removed=translation_removed)
    kept = [row for row in stated if row["n"]]
    columns = [
        text_column(
            "Orientation", [orientation_label(results, row["orientation"]) for row in kept]
        ),
        count_column("Points", [row["n"] for row in kept]),
    ]
    for key, title in (("max", "maximum"), ("min", "minimum"), ("rmse", "RMSE")):
        for side, letter in (("horizontal", "H"), ("vertical", "V")):
            values = [row[f"{key}_{side}_m"] for row in kept]
            columns.append(number_column(letter, "m", values, group=title))
    if not translation_removed:
        for k, axis in enumerate(("east", "north", "up")):
            shift = [(row.get("shift_m") or (None,) * 3)[k] for row in kept]
            columns.append(number_column(axis, "m", shift, group="mean difference"))
    how = "removed" if translation_removed else "kept"
    caption = (
        "Differences at check points (forward intersection of all rays minus given coordinates), "
        f"mean difference {how}. H: horizontal; V: vertical (absolute values)."
    )
    name = f"check_points_shift_{how}"
    return Table(name, caption, tuple(columns), _check_notes(translation_removed))


def _check_notes(translation_removed: bool) -> tuple[str, ...]:
    if not translation_removed:
        return ("RMSE divides the sum of squares by n: nothing was estimated from the points.",)
    return (
        "The mean difference was estimated from these same points, so RMSE divides the sum of "
        "squares by n − 1. This shows the precision within the block; acceptance has to use the "
        "differences with the mean kept.",
    )


def observability(results: Results) -> Table:
    """What the tie points cannot tell, by scope; images whose angles stay undetermined."""
    kept = [row for row in rows(results, "observability") if row["unobservable"] or row["images"]]
    columns = (
        text_column("Scope", [scope_label(row["scope"]) for row in kept]),
        text_column("Not observable", [fmt.joined(row["unobservable"]) for row in kept]),
        text_column("Undetermined images", [_image_list(row["images"]) for row in kept]),
    )
    caption = (
        "What the tie points cannot observe: for each scope on its own, the motions that make no "
        "vertical parallax, and the images whose angles stay undetermined."
    )
    return Table("observability", caption, columns)


def inputs(results: Results) -> Table:
    """Input files with their SHA-256."""
    files = (results.get("block") or {}).get("inputs") or []
    columns = (
        text_column("File", [row["file"] for row in files]),
        text_column("SHA-256", [row["sha256"] for row in files]),
    )
    return Table("inputs", "Input files and their SHA-256 checksums.", columns)


def pairs(
    name: str, caption: str, titles: tuple[str, str], items: Iterable[tuple[str, str]]
) -> Table:
    """A table of names and values."""
    listed = list(items)
    columns = (
        text_column(titles[0], [key for key, _ in listed]),
        text_column(titles[1], [value for _, value in listed]),
    )
    return Table(name, caption, columns)


def _who(kept: Sequence[Row]) -> tuple[Column, Column]:
    """Angle (its name tells the frame) and scope."""
    return (
        text_column("Angle", [row["angle"] for row in kept]),
        text_column("Block or strip", [row["scope"] for row in kept]),
    )


def _fitted(results: Results) -> list[Row]:
    """Regressions that could be made: of the block first, then strip by strip."""
    made = [row for row in rows(results, "regression") if not row.get("reason")]
    return sorted(made, key=lambda row: row["scope"] != "block")


def _reasons(results: Results) -> list[str]:
    """One note per reason for which regressions could not be made, and the angles it holds for."""
    angles: dict[tuple[str, str], list[str]] = {}
    for row in rows(results, "regression"):
        if row.get("reason"):
            angles.setdefault((row["reason"], scope_label(row["scope"])), []).append(row["angle"])
    scopes: dict[tuple[str, str], list[str]] = {}
    for (why, scope), named in angles.items():
        scopes.setdefault((why, fmt.joined(named)), []).append(scope)
    return [
        f"Not fitted: {named} of {fmt.joined(where)}. Reason: {fmt.prose(why)}."
        for (why, named), where in scopes.items()
    ]


def _block_rows(kept: Sequence[Row]) -> frozenset[int]:
    return frozenset(k for k, row in enumerate(kept) if row["scope"] == "block")


def _statistic(value: float | None) -> str:
    """Four significant digits, but not more than three decimals."""
    return fmt.fixed(value, 3) if value is not None and abs(value) < 10.0 else fmt.number(value, 4)


def _share(title: str, values: Iterable[float | None]) -> Column:
    return Column(title, tuple(fmt.fixed(value, 3) for value in values))


def _with_unit(column: Column, unit: str) -> Column:
    return Column(column.title, column.cells, unit, column.align, column.group)


def _image_list(images: Sequence[str], shown: int = 12) -> str:
    if not images:
        return fmt.MISSING
    more = f" and {len(images) - shown} more" if len(images) > shown else ""
    return ", ".join(images[:shown]) + more
