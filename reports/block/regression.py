"""Topic: regression of the angle errors on time, in tables and figures."""

from collections.abc import Iterable, Sequence

from matplotlib.axes import Axes

from posstats.contract.results import ImageAngleErrors, Regression, Results, Selection

from ..document import format as fmt
from ..document.content import Content, Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.rows import first, rows
from ..document.table import (
    Column,
    Table,
    count_column,
    number_column,
    p_column,
    text_column,
)
from ..figures import style
from .line_figures import Lines, Panel, by_strip, draw_errors, fitted_lines, legend, times_in
from .view import angles, decided_by_strip, errors_of, used_errors
from .words import BlockReport, Words

SHOWN_STRIP_LINES = 18  # from which lines strip by strip fill pages and tell no more

Bounds = tuple[float | None, float | None] | None


def topic(report: BlockReport) -> Part:
    """Lines by ordinary and generalised least squares."""
    words, results = report.words, report.results
    said = [words.text("over_time.text")]
    if results.settings.frame == "camera":
        said.append(words.text("over_time.camera"))
    tables = filled([ordinary_table(words, results), generalised_table(words, results)])
    reasons = () if tables else tuple(Paragraph(said) for said in _reasons(words, results))
    content: tuple[Content, ...] = (
        Paragraph(words.sentences(said)),
        *tables,
        *reasons,
        *figures(words, results),
    )
    return Part("regression", words.text("over_time.title"), content)


def ordinary_table(words: Words, results: Results) -> Table:
    """The regressions by ordinary least squares: coefficients, R2, F0 and p."""
    kept = _fitted(results, SHOWN_STRIP_LINES)
    unit = fmt.rate_unit(row.slope_rad_per_s for row in kept)
    constants = [fmt.MILLIRADIAN.scaled(row.intercept_rad) for row in kept]
    columns = (
        *_who(words, kept),
        count_column("n", [row.n for row in kept]),
        count_column(words.text("column.clusters"), [row.n_time_clusters for row in kept]),
        number_column("a₀", "mrad", constants),
        number_column("a₁", unit.name, [unit.scaled(row.slope_rad_per_s) for row in kept]),
        Column("t₀", tuple(fmt.count(row.time_origin_s) for row in kept), "s"),
        share_column("R²", [row.r_squared for row in kept]),
        Column("F₀", tuple(_statistic(row.f_statistic) for row in kept)),
        p_column("p", [row.p_value for row in kept]),
    )
    notes = (
        words.text("ols.statistics"),
        words.text("ols.clusters"),
        words.text("ols.frames"),
        *_not_shown(words, results, kept),
        *_reasons(words, results),
    )
    return Table("regression_ols", words.text("ols.caption"), columns, notes, _block_rows(kept))


def generalised_table(words: Words, results: Results) -> Table:
    """Slopes by generalised least squares beside those of OLS, each with its interval."""
    kept = _fitted(results, 0)
    rates = [rate for row in kept for rate in (row.slope_rad_per_s, row.gls_slope_rad_per_s)]
    unit = fmt.rate_unit(rates)
    of_gls = [(row.gls_slope_rad_per_s, row.gls_slope_ci95) for row in kept]
    of_ols = [(row.slope_rad_per_s, row.slope_ci95) for row in kept]
    columns = (
        *_who(words, kept),
        *_slopes(words, of_gls, unit, "GLS"),
        p_column("p", [row.gls_p_value for row in kept], "GLS"),
        *_slopes(words, of_ols, unit, "OLS"),
        *_noise(words, kept),
    )
    notes = (
        words.text("gls.covariance"),
        words.text("gls.hypothesis"),
        *_not_shown(words, results, kept),
    )
    return Table("regression_gls", words.text("gls.caption"), columns, notes, _block_rows(kept))


def _slopes(
    words: Words, fits: Sequence[tuple[float | None, Bounds]], unit: fmt.Unit, group: str
) -> tuple[Column, Column]:
    bounds = [interval or (None, None) for _, interval in fits]
    texts = [_interval(words, unit.scaled(low), unit.scaled(high)) for low, high in bounds]
    slopes = [unit.scaled(slope) for slope, _ in fits]
    return (
        number_column(words.text("column.slope"), unit.name, slopes, 3, group),
        Column(words.text("column.interval"), tuple(texts), unit.name, group=group),
    )


def _interval(words: Words, low: float | None, high: float | None) -> str:
    if low is None or high is None:
        return fmt.MISSING
    decimals = max(0, 1 - fmt.exponent(high - low, 2)) if high > low else 2
    return words.interval(fmt.fixed(low, decimals), fmt.fixed(high, decimals))


def _noise(words: Words, kept: Sequence[Regression]) -> Iterable[Column]:
    """Estimated standard deviations of what GLS adds, where there are any."""
    unit = fmt.angle_unit(row.white_noise_sigma_rad for row in kept)
    sigmas = {
        "column.white_noise": [row.white_noise_sigma_rad for row in kept],
        "column.strip_effect": [row.strip_effect_sigma_rad for row in kept],
    }
    for title, values in sigmas.items():
        if fmt.present(values):
            yield number_column(words.text(title), unit.name, map(unit.scaled, values), 2)


def _who(words: Words, kept: Sequence[Regression]) -> tuple[Column, Column]:
    """Angle (its name tells the frame) and scope."""
    block = words.text("scope.block")
    scopes = [block if row.scope == "block" else row.scope for row in kept]
    return (
        text_column(words.text("column.angle"), [words.angle(row.angle) for row in kept]),
        text_column(words.text("column.block_or_strip"), scopes),
    )


def _fitted(results: Results, most: int) -> list[Regression]:
    """Regressions that could be made: the block's, then by strip if decided so or not too many."""
    made = [row for row in results.regression if row.notice is None]
    block = [row for row in made if row.scope == "block"]
    of_strips = [row for row in made if row.scope != "block"]
    return block + (of_strips if decided_by_strip(results) or len(of_strips) <= most else [])


def _not_shown(words: Words, results: Results, kept: Sequence[Regression]) -> tuple[str, ...]:
    made = [row for row in results.regression if row.notice is None]
    return (words.text("lines.of_strips"),) if len(kept) < len(made) else ()


def _reasons(words: Words, results: Results) -> list[str]:
    """One note per reason for which regressions could not be made, and the angles it holds for."""
    named: dict[tuple[str, str], list[str]] = {}
    for row in results.regression:
        if row.notice:
            why = words.notice(row.notice)
            named.setdefault((why, words.scope(row.scope)), []).append(words.angle(row.angle))
    scopes: dict[tuple[str, str], list[str]] = {}
    for (why, scope), of_angles in named.items():
        scopes.setdefault((why, words.joined(of_angles)), []).append(scope)
    return [
        words.text("lines.not_fitted", angles=of_angles, scopes=words.joined(where), why=why)
        for (why, of_angles), where in scopes.items()
    ]


def _block_rows(kept: Sequence[Regression]) -> frozenset[int]:
    """Rows of the block, where rows of strips stand below them."""
    block = frozenset(k for k, row in enumerate(kept) if row.scope == "block")
    return block if len(block) < len(kept) else frozenset()


def _statistic(value: float | None) -> str:
    """Four significant digits, but not more than three decimals."""
    return fmt.fixed(value, 3) if value is not None and abs(value) < 10.0 else fmt.number(value, 4)


def share_column(title: str, values: Iterable[float | None], group: str = "") -> Column:
    """A column of shares of one, such as R²."""
    return Column(title, tuple(fmt.fixed(value, 3) for value in values), group=group)


def figures(words: Words, results: Results) -> tuple[Drawing, ...]:
    """One figure per angle of the frame of the corrections, if its errors are in the results."""
    return known(*(_figure(words, results, a) for a in angles(results.settings.frame)))


def _figure(words: Words, results: Results, angle: str) -> Drawing | None:
    data, frame = used_errors(results, angle), results.settings.frame
    if not data:
        return None
    picture = style.new_figure(3.7)
    upper, lower = picture.subplots(2, 1, sharex=True, height_ratios=(2.2, 1.0))
    start, errors = min(row.time_s for row in data), errors_of(data, angle)
    lines = fitted_lines(results, frame, angle)
    labels = words.text("legend.ols"), words.text("legend.gls")
    panel = Panel(upper, fmt.angle_unit(errors), start, labels)
    draw_errors(panel, data, angle, lines, words.text("scope.strip", id="{strip}"))
    for row in rows(results.selection, frame=frame, angle=angle, form="constant"):
        _draw_constant(words, panel, results, row)
    panel.keep_large(errors)
    panel.label(words.text("axis.error_of", angle=words.angle(angle)))
    _draw_residuals(words, lower, panel, data, angle, lines)
    lower.set_xlabel(words.text("axis.time"))
    picture.align_ylabels([upper, lower])
    legend(picture, upper)
    caption = words.sentences([
        words.text("over_time.figure", angle=words.angle(angle), frame=words.of("frame", frame),
                   start=fmt.count(start)),
        words.text("over_time.fitted" if lines else "over_time.not_fitted"),
    ])  # fmt: skip
    title = words.text("over_time.figure_title", angle=words.angle(angle))
    return style.finish(picture, f"regression_{frame}_{angle}", title, caption)


def _draw_residuals(
    words: Words,
    axis: Axes,
    above: Panel,
    data: Sequence[ImageAngleErrors],
    angle: str,
    lines: Lines,
) -> None:
    """Errors less their OLS line, where its band is large enough to be seen."""
    residuals = _residuals(data, angle, lines)
    panel = Panel(axis, fmt.angle_unit(residuals.values()), above.start_s, above.labels)
    for _, part, look in by_strip([row for row in data if row.image in residuals]):
        errors = [residuals[row.image] for row in part]
        panel.points([row.time_s for row in part], errors, "_", look)
    for scope, (ols, gls) in lines.items():
        times = times_in(data, scope)
        if times and ols:
            panel.fit(times, ols, gls, zero=ols)
    if residuals:
        panel.keep_large(list(residuals.values()))
    panel.label(words.text("axis.residual"))


def _residuals(data: Sequence[ImageAngleErrors], angle: str, lines: Lines) -> dict[str, float]:
    """Errors of images less the OLS line of their scope."""
    residuals = {}
    for row, error in zip(data, errors_of(data, angle), strict=True):
        ols = lines.get("block", lines.get(row.strip, (None, None)))[0]
        if ols:
            residuals[row.image] = error - ols.value(row.time_s)
    return residuals


def _draw_constant(words: Words, panel: Panel, results: Results, decision: Selection) -> None:
    """The constant that is taken off the whole block."""
    fit = first(results.regression, frame=decision.frame, angle=decision.angle, scope="block")
    if decision.scope == "block" and fit and fit.constant_rad is not None:
        panel.axis.axhline(fit.constant_rad * panel.unit.per_si, color=style.GREEN, ls="-.", lw=1.3,
                           label=words.text("legend.constant"))  # fmt: skip
