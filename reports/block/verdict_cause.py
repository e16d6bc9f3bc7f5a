"""Sentences of the verdict: the angle that parallax comes from, and its error over time."""

from posstats.contract.results import Regression

from ..document import format as fmt
from ..document.rows import first, rows
from .view import mean_over_models
from .words import BlockReport, Words

NEAR_RELATIVE = 1.5  # up to this multiple of relative orientation's, parallax needs no correction
SIGNIFICANT = 0.05
ALONE = 0.9  # share of the cause from which other angles need no word
STEADY = 3.0  # strip effect over white noise from which the strips are what differs


def cause(report: BlockReport) -> str:
    """Which angle the parallax comes from, by what holding it leaves."""
    words, numbers = report.words, report.results.verdict
    raw, relative = numbers.raw_px, numbers.relative_px
    if numbers.cause:
        return _named_cause(report, numbers.cause)
    if relative and raw is not None and raw / relative < NEAR_RELATIVE:
        return words.text("cause.none")
    every = _held(report, "angles")
    if relative and every is not None and every < NEAR_RELATIVE * relative:
        return words.text("cause.not_angles", every=fmt.with_unit(every, "px"))
    return words.text("cause.several")


def _named_cause(report: BlockReport, angle: str) -> str:
    words, share = report.words, report.results.verdict.cause_share
    held, every = _held(report, angle), _held(report, "angles")
    kind = "most" if share is not None and share < ALONE else "all"
    if held is None or every is None:
        return words.of("cause", kind, angle=words.angle(angle))
    values = {"held": fmt.with_unit(held, "px"), "every": fmt.with_unit(every, "px")}
    return words.of("cause", f"{kind}_by_holding", angle=words.angle(angle), **values)


def _held(report: BlockReport, what: str) -> float | None:
    """Mean parallax with POS angles held."""
    return mean_over_models(rows(report.results.error_sources, fixed=what))


def over_time(report: BlockReport) -> str:
    """Whether the error of the cause (or of every angle) follows time, by OLS and GLS."""
    words, name = report.words, report.results.verdict.cause
    if not name:
        return _shares(report)
    row = first(report.results.regression, angle=name, frame="ground", scope="block")
    if row is None or row.r_squared is None:
        if row and row.notice:
            return words.text("time.untested_why", why=words.notice(row.notice))
        return words.text("time.untested")
    evidence = _evidence(words, row)
    if row.p_value is None or row.p_value >= SIGNIFICANT:
        return _not_over_time(report, row, evidence)
    return words.text(
        "time.follows",
        error=fmt.angle(row.intercept_rad),
        rate=fmt.rate(row.slope_rad_per_s),
        evidence=evidence,
        surely=_surely(words, row),
    )


def _evidence(words: Words, row: Regression) -> str:
    values = {"r_squared": fmt.fixed(row.r_squared, 3), "p": fmt.p_phrase(row.p_value),
              "images": fmt.count(row.n)}  # fmt: skip
    return words.counted("time.evidence", row.n_time_clusters or 0, **values)


def _not_over_time(report: BlockReport, row: Regression, evidence: str) -> str:
    """Size and mean of an error without drift; whether strips differ, as by a misalignment."""
    words, results = report.words, report.results
    size = first(results.angle_error_summary, angle=row.angle, frame="ground")
    rms, mean = (size.rms_rad, size.mean_rad) if size else (None, None)
    steady = words.text("time.steady", rms=fmt.angle(rms), mean=fmt.angle(mean), evidence=evidence)
    strip, white = row.strip_effect_sigma_rad, row.white_noise_sigma_rad
    if strip is None or white is None or strip < STEADY * white:
        return steady
    was_tried = results.settings.frame_setting != "ground"
    differs = "time.strips_differ" if was_tried else "time.like_misalignment"
    return words.sentences([steady, words.text(differs, sigma=fmt.angle(strip))])


def _surely(words: Words, row: Regression) -> str:
    low, high = row.gls_slope_ci95 or (None, None)
    if low is None or high is None:
        return words.text("surely.unknown")
    unit = fmt.rate_unit([low, high])
    ends = words.interval(fmt.number(unit.scaled(low)), fmt.number(unit.scaled(high)))
    said = "surely.not" if low <= 0.0 <= high else "surely.yes"
    return words.text(said, ends=ends, unit=unit.name)


def _shares(report: BlockReport) -> str:
    tested = [
        f"{report.words.angle(row.angle)} {fmt.fixed(row.r_squared, 2)}"
        for row in rows(report.results.regression, frame="ground", scope="block")
        if not fmt.is_missing(row.r_squared)
    ]
    if not tested:
        return report.words.text("time.none_tested")
    return report.words.text("time.shares", shares=report.words.joined(tested))
