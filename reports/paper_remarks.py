"""What is to be said of the paper's numbers, and of its way of analysis."""

import numpy as np

from posstats.experiment.comparison import TABLE3_AREA
from posstats.experiment.findings import ALPHA, STRIP
from posstats.experiment.published import consistent_residual_df, published, recomputed
from posstats.experiment.reproduction import Reproduction
from posstats.experiment.seeds import repeated

from . import format as fmt
from . import paper_tables
from .content import Bullets, Labelled, Paragraph, Part
from .results_view import first, rows


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
        _heights(run),
    )
    table = Labelled("G", paper_tables.printed_regression(df))
    return Part(
        "printed",
        "What the published numbers say of themselves",
        (Paragraph(text), table, Bullets(rest)),
    )


def _crossing(run: Reproduction, df: int) -> str:
    """The three printed lines cross zero together, where omega explains next to nothing."""
    times = sorted(each.zero_crossing_t for each in recomputed(df))
    results = run.results[TABLE3_AREA]
    exposures = [row["time_s"] for row in rows(results, "images", strip=STRIP)]
    omega = first(results, "angle_error_summary", angle="omega", frame="ground")
    (line,) = published(3, angle="omega")
    rms_rad = line["slope_per_t"] * float(np.std(exposures))
    mm_per_rad = run.findings[TABLE3_AREA].pos_mm / abs(omega["mean_rad"])
    (strip,) = published(2, area=TABLE3_AREA, strip=STRIP)
    return (
        f"The three lines of Table 3 cross zero at nearly the same time (t = {fmt.count(times[0])} "
        f"to {fmt.count(times[-1])}), so they describe errors whose mean is near zero. If t is in "
        f"seconds and y in radians, omega then errs by {fmt.angle(rms_rad, 2)} (RMS) over a strip, "
        f"which makes {fmt.with_unit(rms_rad * mm_per_rad, 'mm', 1)} of parallax, not the "
        f"{strip['pos_mean_mm']} mm of Table 2. The published tables cannot all come from one "
        "linear error: the simulation adds a large constant to reach Table 2."
    )


def _heights(run: Reproduction) -> str:
    (printed,) = published(4, area=2, orientation="pos")
    found = run.findings[2]
    return (
        f"In area 2 the published vertical RMSE from the POS ({printed['rmse_vertical_m']} m) is "
        f"larger than the horizontal one ({printed['rmse_horizontal_m']} m). An omega error that "
        "makes the parallax of Table 2 tilts the models far less: simulated, "
        f"{fmt.with_unit(found.pos_vertical_m, 'm', 2)} vertically beside "
        f"{fmt.with_unit(found.pos_horizontal_m, 'm', 2)} horizontally. Something else than omega "
        "was in the published heights."
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
            Bullets((_too_sure(run), _observable(run), _mean_removed(run), _one_model(run))),
        ),
    )


def _too_sure(run: Reproduction) -> str:
    tested = [
        row
        for results in run.results.values()
        for row in rows(results, "regression", frame="ground")
        if row["angle"] != "omega"
    ]
    ordinary = sum(row["p_value"] < ALPHA for row in tested)
    general = sum(row["gls_p_value"] < ALPHA for row in tested)
    kappa = first(run.results[1], "regression", angle="kappa", scope="block", frame="ground")
    found = repeated()[TABLE3_AREA]
    ols, gls = (
        fmt.fixed(100.0 * float(np.mean([getattr(each, name) for each in found])), 1)
        for name in ("ols_covers", "gls_covers")
    )
    return (
        "Ordinary least squares takes the errors of different images as independent. They are not: "
        "neighbours share tie points, and their estimated errors are correlated. In this run the "
        f"true drift of phi and kappa is zero, and of their {len(tested)} lines OLS calls "
        f"{ordinary} significant at the 5 % level, GLS {general}; for kappa over the block of area "
        f"1 OLS gives {fmt.p_phrase(kappa['p_value'])}, GLS {fmt.p_phrase(kappa['gls_p_value'])}. "
        f"Over {len(found)} seeds the 95 % intervals of the three slopes of strip 1 hold the "
        f"simulated drift in {ols} % (OLS) and {gls} % (GLS) of all cases. OLS does nearly as well "
        "here because the noise of the POS itself, independent from image to image, is several "
        "times larger than what the tie points add. With fewer tie points or a better POS its "
        "95 % intervals may hold the truth in only a quarter of all cases (docs/method.md)."
    )


def _observable(run: Reproduction) -> str:
    omega = {
        area: first(results, "angle_error_summary", angle="omega", frame="ground")
        for area, results in run.results.items()
    }
    sigmas = fmt.joined(
        f"{fmt.fixed(1e6 * row['median_sigma_rad'], 1)}\u00a0µrad in area {area}"
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
    row = first(run.results[TABLE3_AREA], "check_points", orientation="pos",
                translation_removed=False)  # fmt: skip
    shift = float(np.hypot(*row["shift_m"][:2]))
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
        f"{fmt.fixed(max(ratio), 2)}. The paper's areas held more than one kind of error, and its "
        "tables do not say which."
    )
