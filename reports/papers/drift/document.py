"""The document of the report on the paper's reproduction."""

from collections.abc import Sequence

from posstats.papers.drift.reproduction import Reproduction
from posstats.papers.drift.seeds import repeated
from posstats.version import __version__

from ...document import format as fmt
from ...document.front import Verdict
from ...document.key_figure import KeyFigure
from ...document.numbering import ReportDocument, numbered
from .conclusions import Conclusion
from .sections import Figures, opening, sections


def build(
    run: Reproduction, found: Sequence[Conclusion], figures: Figures, created: str
) -> ReportDocument:
    """Make the document.

    Parameters
    ----------
    run
        The three areas and their comparison with the published tables.
    found
        The conclusions of `paper_conclusions.conclusions`.
    figures
        Figures 1, 2 and 3 by area.
    created
        ISO 8601 time stamp.
    """
    first_page, parts = numbered(opening(found), sections(run, found, figures))
    return ReportDocument(
        language="en",
        title="A published experiment, repeated on known truth",
        subject="POS angle errors in three test areas",
        subtitle=_subtitle(run),
        mark="Simulated data",
        created=created.partition("T")[0],
        version=__version__,
        verdict=Verdict(_verdict(run, found)),
        key_figures=_key_figures(run),
        opening=first_page,
        sections=parts,
    )


def _subtitle(run: Reproduction) -> str:
    blocks = [results.block for results in run.results.values()]
    counted = {"n_images": "images", "n_strips": "strips", "n_models": "stereo models",
               "n_tie_points": "tie points"}  # fmt: skip
    return " · ".join(
        f"{fmt.count(sum(getattr(block, key) for block in blocks))} {words}"
        for key, words in counted.items()
    )


def _verdict(run: Reproduction, found: Sequence[Conclusion]) -> str:
    failed = [k for k, each in enumerate(found, start=1) if not each.holds]
    held = len(found) - len(failed)
    except_for = f" ({_which(failed)})" if failed else ""
    n_seeds = len(repeated()[1])
    means = fmt.joined(
        f"{fmt.fixed(each.ratio, 2)} in area {each.area}"
        for each in run.compared
        if (each.quantity, each.strip) == ("pos_mean_mm", None)
    )
    return (
        "The photographs of the paper (section 2) are not public, so its three test areas are "
        "simulated with known errors and analysed by the same chain as any block. "
        f"{held} of the paper's {len(found)} conclusions hold{except_for}. The mean parallax from "
        f"the POS is fitted: it comes out at {means} of the published one. Regression, error "
        "sources, effect of the correction and check points are predicted, with the reservations "
        "of Table C, and stand beside the published numbers below. "
        f"This is the run of seed {run.seed}; how often each finding comes out over {n_seeds} "
        "seeds is in section 8, where our analysis differs from the paper's in section 10."
    )


def _which(failed: Sequence[int]) -> str:
    which = fmt.joined(map(str, failed))
    return f"not: number {which}" if len(failed) == 1 else f"not: numbers {which}"


def _key_figures(run: Reproduction) -> tuple[KeyFigure, ...]:
    keyed = {(e.table, e.area, e.strip, e.angle, e.quantity): e for e in run.compared}
    line = keyed[3, 1, "1", "omega", "r_squared"]
    raw = keyed[2, 1, None, None, "pos_mean_mm"]
    relative = keyed[2, 1, None, None, "independent_mean_mm"]
    found = run.findings[1]
    return (
        _figure("POS, area 1", raw.reproduced, 4, "mm", raw.published),
        _figure("Relative orientation, area 1", relative.reproduced, 4, "mm", relative.published),
        _figure("R² of omega, one strip", line.reproduced, 4, "", line.published),
        KeyFigure(
            "Omega corrected, area 1",
            fmt.fixed(found.corrected_omega_mm, 4),
            "mm",
            f"{fmt.fixed(found.over_relative, 2)} × relative orientation",
        ),
    )


def _figure(
    label: str, value: float | None, decimals: int, unit: str, published: float
) -> KeyFigure:
    remark = f"published {fmt.fixed(published, decimals)}{f' {unit}' if unit else ''}"
    return KeyFigure(label, fmt.fixed(value, decimals), unit, remark)
