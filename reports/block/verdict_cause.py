"""Sentences of the verdict: the angle that parallax comes from, and its error over time."""

from posstats.contract.results import Regression, Results

from ..document import format as fmt
from ..document.rows import first, rows
from .view import mean_over_models

NEAR_RELATIVE = 1.5  # up to this multiple of relative orientation's, parallax needs no correction
SIGNIFICANT = 0.05
ALONE = 0.9  # share of the cause from which other angles need no word
STEADY = 3.0  # strip effect over white noise from which the strips are what differs


def cause(results: Results) -> str:
    """Which angle the parallax comes from, by what holding it leaves."""
    numbers = results.verdict
    name, raw, relative = numbers.cause, numbers.raw_px, numbers.relative_px
    if name:
        held = mean_over_models(rows(results.error_sources, fixed=name))
        every = mean_over_models(rows(results.error_sources, fixed="angles"))
        share = numbers.cause_share
        most = share is not None and share < ALONE
        text = f"{'Most of it comes' if most else 'The parallax comes'} from {name}"
        if held is not None and every is not None:
            text += (
                f": relative orientation with {name} held at its POS value leaves "
                f"{fmt.with_unit(held, 'px')}, with all three angles held "
                f"{fmt.with_unit(every, 'px')}"
            )
        return f"{text}."
    if relative and raw is not None and raw / relative < NEAR_RELATIVE:
        return "This is about as good as the images allow, and no angle stands out."
    every = mean_over_models(rows(results.error_sources, fixed="angles"))
    if relative and every is not None and every < NEAR_RELATIVE * relative:
        return (
            "It does not come from the angles: with all three held at their POS values, relative "
            f"orientation still brings it down to {fmt.with_unit(every, 'px')}."
        )
    return "It cannot be laid to one angle alone: held one by one, several keep the parallax high."


def over_time(results: Results) -> str:
    """Whether the error of the cause (or of every angle) follows time, by OLS and GLS."""
    name = results.verdict.cause
    if not name:
        return _shares(results)
    row = first(results.regression, angle=name, frame="ground", scope="block")
    if row is None or row.r_squared is None:
        why = row and row.reason
        return f"Whether its error follows time could not be tested{f' ({why})' if why else ''}."
    evidence = (
        f"R² = {fmt.fixed(row.r_squared, 3)}, {fmt.p_phrase(row.p_value)}, "
        f"{row.n} images {_stretches(row)}"
    )
    if row.p_value is None or row.p_value >= SIGNIFICANT:
        return _not_over_time(results, row, evidence)
    middle = f"Its error is {fmt.angle(row.intercept_rad)} at mid-time"
    change = fmt.rate(row.slope_rad_per_s)
    return f"{middle} and follows time: it changes by {change} ({evidence}); {_surely(row)}."


def _stretches(row: Regression) -> str:
    n = row.n_time_clusters
    return "in one stretch of time" if n == 1 else f"in {fmt.count(n)} separate stretches of time"


def _not_over_time(results: Results, row: Regression, evidence: str) -> str:
    """Size and mean of an error without drift; whether strips differ, as by a misalignment."""
    size = first(results.angle_error_summary, angle=row.angle, frame="ground")
    rms, mean = (size.rms_rad, size.mean_rad) if size else (None, None)
    text = (
        f"Its error is {fmt.angle(rms)} (RMS), {fmt.angle(mean)} "
        f"on average, and does not follow time ({evidence})."
    )
    strip, white = row.strip_effect_sigma_rad, row.white_noise_sigma_rad
    if strip is None or white is None or strip < STEADY * white:
        return text
    text += (
        f" It differs from strip to strip (standard deviation {fmt.angle(strip)}) far more than "
        "within the strips"
    )
    if results.settings.frame_setting != "ground":
        return f"{text}."
    return (
        f"{text}: a misalignment of the camera, constant about the camera's axes, would look like "
        "this (to test it: --frame auto --rules strict)."
    )


def _surely(row: Regression) -> str:
    low, high = row.gls_slope_ci95 or (None, None)
    if low is None or high is None:
        return "with correlated errors allowed for, no interval can be given"
    unit = fmt.rate_unit([low, high])
    ends = f"{fmt.number(unit.scaled(low))} to {fmt.number(unit.scaled(high))}"
    zero = "includes zero, so a drift is not proven" if low <= 0.0 <= high else "excludes zero"
    return (
        f"with correlated errors allowed for, the 95 % interval of this rate, "
        f"({ends})\u00a0×\u00a0{unit.name}, {zero}"
    )


def _shares(results: Results) -> str:
    tested = [
        f"{row.angle} {fmt.fixed(row.r_squared, 2)}"
        for row in rows(results.regression, frame="ground", scope="block")
        if not fmt.is_missing(row.r_squared)
    ]
    if not tested:
        return "Whether the angle errors follow time could not be tested."
    return f"A line over time explains this share (R²) of the angle errors: {fmt.joined(tested)}."
