"""Topic: what the published numbers say of themselves."""

import numpy as np

from posstats.papers.drift.comparison import TABLE3_AREA
from posstats.papers.drift.findings import STRIP, known, only_row
from posstats.papers.drift.published import (
    consistent_residual_df,
    implied_scatter,
    impossible_vertical_rmse,
    published,
    recomputed,
)
from posstats.papers.drift.reproduction import Reproduction

from ...document import format as fmt
from ...document.content import Bullets, Labelled, Paragraph, Part
from ...document.rows import rows
from ...document.table import Column, Table, text_column
from .report import Report
from .words import Words


def topic(words: Words, report: Report) -> Part:
    """Degrees of freedom of Table 3, and numbers that contradict each other."""
    run = report.run
    (df,) = consistent_residual_df()
    text = words.text("printed.text", df=str(df), n=str(df + 2))
    contradictions = (
        _misprint(words),
        _crossing(words, run, df),
        _scatter(words, run),
        _impossible(words),
        _heights(words, run),
    )
    return Part(
        "printed",
        words.text("printed.title"),
        (Paragraph(text), Labelled("G", table(words, df)), Bullets(contradictions)),
    )


def table(words: Words, df_resid: int) -> Table:
    """Table 3 recomputed from its own F0."""
    printed = recomputed(df_resid)
    group = words.text("printed.recomputed")
    columns = (
        text_column(
            words.text("angle_column.title"), [words.angle(each.angle) for each in printed]
        ),
        Column("R²", tuple(fmt.fixed(each.r_squared, 5) for each in printed), group=group),
        Column("p", tuple(_long_p(each.p_value) for each in printed), group=group),
        Column(
            words.text("printed.crossing"), tuple(fmt.count(e.zero_crossing_t) for e in printed)
        ),
    )
    return Table("printed_regression", words.text("printed.caption", df=str(df_resid)), columns)


def _long_p(value: float) -> str:
    return fmt.fixed(value, 5) if value > 1e-5 else fmt.scientific(value, 2)


def _misprint(words: Words) -> str:
    (odd,) = published(2, area=1, strip="2")
    mean, least = fmt.as_printed(odd.pos_mean_mm), fmt.as_printed(odd.pos_min_mm)
    return words.text("printed.misprint", mean=mean, least=least)


def _crossing(words: Words, run: Reproduction, df: int) -> str:
    """The three printed lines cross zero close together, where omega explains next to nothing."""
    times = sorted(each.zero_crossing_t for each in recomputed(df))
    omega = only_row(run.results[TABLE3_AREA].angle_error_summary, angle="omega", frame="ground")
    (line,) = published(3, angle="omega")
    largest_rad = line.slope_per_t * (times[-1] - times[0])
    mm_per_rad = run.findings[TABLE3_AREA].pos_mm / abs(known(omega.mean_rad))
    (strip,) = published(2, area=TABLE3_AREA, strip=STRIP)
    exposures = _exposures(run)
    return words.text(
        "printed.cross",
        first=fmt.count(times[0]),
        last=fmt.count(times[-1]),
        taken=fmt.count(max(exposures) - min(exposures)),
        largest=fmt.angle(largest_rad, 2),
        parallax=fmt.with_unit(largest_rad * mm_per_rad, "mm", 2),
        printed=fmt.as_printed(strip.pos_mean_mm),
    )


def _exposures(run: Reproduction) -> list[float]:
    """Times of the strip that stands for Table 3."""
    return [row.time_s for row in rows(run.results[TABLE3_AREA].images, strip=STRIP)]


def _scatter(words: Words, run: Reproduction) -> str:
    """What the printed lines imply for the scatter of phi and kappa."""
    spread = float(np.std(_exposures(run)))
    implied = words.joined(
        words.text(
            "printed.scatter_of",
            scatter=fmt.with_unit(1e3 * implied_scatter(angle, spread), "mrad", 2),
            angle=words.angle(angle),
        )
        for angle in ("phi", "kappa")
    )
    return words.text("printed.scatter", implied=implied)


def _impossible(words: Words) -> str:
    """Rows of Table 4 that no removal of the mean can give."""
    cases = words.joined(
        words.text(
            "printed.case",
            rmse=fmt.as_printed(row.rmse_vertical_m),
            orientation=words.of("oriented", row.orientation),
            least=fmt.with_unit(least, "m"),
        )
        for row, least in impossible_vertical_rmse()
    )
    return words.text("printed.impossible", cases=cases)


def _heights(words: Words, run: Reproduction) -> str:
    (printed,) = published(4, area=2, orientation="pos")
    found = run.findings[2]
    return words.text(
        "printed.heights",
        vertical=fmt.as_printed(printed.rmse_vertical_m),
        horizontal=fmt.as_printed(printed.rmse_horizontal_m),
        simulated_vertical=fmt.with_unit(found.pos_vertical_m, "m", 2),
        simulated_horizontal=fmt.with_unit(found.pos_horizontal_m, "m", 2),
    )
