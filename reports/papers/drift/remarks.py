"""What is to be said of the paper's numbers, and of its way of analysis."""

import numpy as np

from posstats.papers.drift.comparison import TABLE3_AREA
from posstats.papers.drift.findings import ALPHA, STRIP, known, only_row
from posstats.papers.drift.published import (
    consistent_residual_df,
    implied_scatter,
    impossible_vertical_rmse,
    published,
    recomputed,
)
from posstats.papers.drift.reproduction import Reproduction
from posstats.papers.drift.seeds import repeated

from ...document import format as fmt
from ...document.content import Bullets, Labelled, Paragraph, Part
from ...document.rows import rows
from . import tables as paper_tables

_SAME_DIMENSIONS = (
    "The paper concludes that positions hardly matter because independent and dependent "
    "orientation leave the same parallax. They always do, whatever errs: both free the same five "
    "dimensions of a model. So conclusion 1 is tested here by what only a simulation can do, "
    "errors of angles and of positions each alone."
)


def printed_numbers(run: Reproduction) -> Part:
    """What the published numbers say of themselves."""
    consistent = consistent_residual_df()
    (df,) = consistent
    text = (
        "Equation 4 of the paper with one regressor is the overall F test of a straight line. Of "
        f"all residual degrees of freedom from 1 to 1000 only n − 2 = {df} gives every printed R² "
        f"and p from the printed F₀: Table 3 is one strip of n = {df + 2} images, F(1, {df}), and "
        "only area 1 has such strips."
    )
    odd = published(2, area=1, strip="2")[0]
    rest = (
        f"The mean printed for strip 2 of area 1 ({odd['pos_mean_mm']} mm) is below the minimum "
        f"({odd['pos_min_mm']} mm): one of the two is a misprint.",
        _crossing(run, df),
        _scatter(run),
        _impossible(),
        _heights(run),
    )
    table = Labelled("G", paper_tables.printed_regression(df))
    return Part(
        "printed",
        "What the published numbers say of themselves",
        (Paragraph(text), table, Bullets(rest)),
    )


def _crossing(run: Reproduction, df: int) -> str:
    """The three printed lines cross zero close together, where omega explains next to nothing."""
    times = sorted(each.zero_crossing_t for each in recomputed(df))
    results = run.results[TABLE3_AREA]
    exposures = [row.time_s for row in rows(results.images, strip=STRIP)]
    omega = only_row(results.angle_error_summary, angle="omega", frame="ground")
    (line,) = published(3, angle="omega")
    largest_rad = line["slope_per_t"] * (times[-1] - times[0])
    mm_per_rad = run.findings[TABLE3_AREA].pos_mm / abs(known(omega.mean_rad))
    (strip,) = published(2, area=TABLE3_AREA, strip=STRIP)
    return (
        f"The three lines of Table 3 cross zero close together (t = {fmt.count(times[0])} to "
        f"{fmt.count(times[-1])}; in seconds of the day 15:50 to 16:19; a strip of 60 images takes "
        f"about {fmt.count(max(exposures) - min(exposures))} s here). If the strip was flown then, "
        f"and y is in radians, the mean error of omega was at most {fmt.angle(largest_rad, 2)}, "
        f"which makes {fmt.with_unit(largest_rad * mm_per_rad, 'mm', 2)} of parallax, not the "
        f"{strip['pos_mean_mm']} mm of Table 2. The published tables then cannot all come from one "
        "linear error: the simulation adds a large constant to reach Table 2."
    )


def _scatter(run: Reproduction) -> str:
    """What the printed lines imply for the scatter of phi and kappa."""
    results = run.results[TABLE3_AREA]
    exposures = [row.time_s for row in rows(results.images, strip=STRIP)]
    implied = fmt.joined(
        f"{fmt.with_unit(1e3 * implied_scatter(angle, float(np.std(exposures))), 'mrad', 2)} for "
        f"{angle}"
        for angle in ("phi", "kappa")
    )
    return (
        "By the same reading (seconds and radians) slope and R² of the printed lines imply a "
        f"scatter of {implied}, some two hundred times what is simulated. Scatter of that size "
        "would itself make more parallax than Table 2 holds. So the simulated R² and p of phi and "
        "kappa can agree with the published ones only in not being significant."
    )


def _impossible() -> str:
    """Rows of Table 4 that no removal of the mean can give."""
    cases = fmt.joined(
        f"{row['rmse_vertical_m']} m, {paper_tables.ORIENTATIONS[row['orientation']]}, where it "
        f"is at least {fmt.with_unit(least, 'm')}"
        for row, least in impossible_vertical_rmse()
    )
    return (
        "In area 3 of Table 4 the vertical RMSE is smaller than 13 differences of mean zero with "
        f"the printed smallest and largest magnitude can have ({cases}). Either the mean was not "
        "removed from the heights, or a number is misprinted; vertical minima and RMSE are "
        "compared with this in mind."
    )


def _heights(run: Reproduction) -> str:
    (printed,) = published(4, area=2, orientation="pos")
    found = run.findings[2]
    return (
        f"In area 2 the published vertical RMSE from the POS ({printed['rmse_vertical_m']} m) is "
        f"larger than the horizontal one ({printed['rmse_horizontal_m']} m). An omega error that "
        "makes the parallax of Table 2 tilts the models far less: simulated, "
        f"{fmt.with_unit(found.pos_vertical_m, 'm', 2)} vertically beside "
        f"{fmt.with_unit(found.pos_horizontal_m, 'm', 2)} horizontally. Under the assumption "
        "of section 2, something else than omega was in the published heights."
    )


def differences(run: Reproduction) -> Part:
    """Where this analysis differs from the paper's."""
    text = (
        "The tables above follow the paper. Where this package would say something else, it is "
        "said here."
    )
    return Part(
        "differences",
        "Where this analysis differs from the paper's",
        (
            Paragraph(text),
            Bullets(
                (
                    _too_sure(run),
                    _observable(run),
                    _SAME_DIMENSIONS,
                    _mean_removed(run),
                    _one_model(run),
                )
            ),
        ),
    )


def _too_sure(run: Reproduction) -> str:
    tested = [
        row
        for results in run.results.values()
        for row in rows(results.regression, frame="ground")
        if row.angle != "omega"
    ]
    ordinary = sum(known(row.p_value) < ALPHA for row in tested)
    general = sum(known(row.gls_p_value) < ALPHA for row in tested)
    kappa = only_row(run.results[1].regression, angle="kappa", scope="block", frame="ground")
    found = repeated()[TABLE3_AREA]
    shares = [
        float(np.mean([getattr(each, name) for each in found]))
        for name in ("ols_covers", "gls_covers")
    ]
    ols, gls = (fmt.fixed(100.0 * share, 1) for share in shares)
    n_intervals = 3 * len(found)
    error = fmt.fixed(100.0 * float(np.sqrt(shares[0] * (1.0 - shares[0]) / n_intervals)), 1)
    return (
        "Ordinary least squares takes the errors of different images as independent. They are not: "
        "neighbours share tie points, and their estimated errors are correlated. In this "
        "experiment that does little harm: over "
        f"{len(found)} seeds the 95 % intervals of the three slopes of strip 1 hold the simulated "
        f"drift in {ols} % (OLS) and {gls} % (GLS) of all cases (standard error {error} %), "
        "because the noise of the POS itself, independent from image to image, is several times "
        "larger than what the tie points add. Of the "
        f"{len(tested)} lines of phi and kappa, whose true drift is zero, OLS calls {ordinary} "
        f"significant at the 5 % level, GLS {general} (kappa over the block of area 1: OLS "
        f"{fmt.p_phrase(kappa.p_value)}, GLS {fmt.p_phrase(kappa.gls_p_value)}). But with "
        "fewer tie points or a better POS OLS is far too sure of itself: along a strip its 95 % "
        "intervals then hold the truth in only a quarter of all cases (docs/method.md of the "
        "package). So the block's report believes GLS where the two differ."
    )


def _observable(run: Reproduction) -> str:
    omega = {
        area: only_row(results.angle_error_summary, angle="omega", frame="ground")
        for area, results in run.results.items()
    }
    sigmas = fmt.joined(
        f"{fmt.fixed(1e6 * known(row.median_sigma_rad), 1)}\u00a0µrad in area {area}"
        for area, row in omega.items()
    )
    return (
        "Tie points show angle errors only where these make vertical parallax. A common rotation "
        "of a strip about its base axis makes none, and the tilt of all images along the flight is "
        "known only against the direction of the bases between the GNSS positions. Here side "
        "overlap and positions good to centimetres fix both (median standard deviation of omega "
        f"{sigmas}); with a single strip, or worse positions, the line of Table 3 would contain "
        "what cannot be seen."
    )


def _mean_removed(run: Reproduction) -> str:
    row = only_row(run.results[TABLE3_AREA].check_points, orientation="pos",
                   translation_removed=False)  # fmt: skip
    shift = float(np.hypot(*known(row.shift_m)[:2]))
    return (
        "The paper removes the mean difference before it judges check points. In area 1 the "
        f"constant part of the omega error shifts the whole block by {fmt.with_unit(shift, 'm')}, "
        "which Table 4 does not show. An acceptance has to keep the mean."
    )


def _one_model(run: Reproduction) -> str:
    ratio = [
        each.ratio
        for each in run.compared
        if each.table == 4 and each.quantity.startswith("rmse") and each.ratio is not None
    ]
    return (
        "One constant, one drift and white noise in omega do not reproduce Table 4: the ratios of "
        f"simulated to published RMSE go from {fmt.fixed(min(ratio), 2)} to "
        f"{fmt.fixed(max(ratio), 2)}; and the published strip means of areas 1 and 2 do not grow "
        "as a drift would make them. The paper's areas held more than one kind of error, and its "
        "tables do not say which."
    )
