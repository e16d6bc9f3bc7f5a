"""The document of the report on the second paper."""

from collections.abc import Sequence

from posstats.papers.wucaps.findings import RECOMMENDED
from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.seeds import repeated
from posstats.version import __version__

from ...document import format as fmt
from ...document.front import Verdict
from ...document.key_figure import KeyFigure
from ...document.numbering import ReportDocument, numbered
from ..drift.conclusions import Conclusion
from .sections import opening, sections
from .words import CONTROL, TERRAIN


def build(
    run: Reproduction,
    found: Sequence[Conclusion],
    beyond: Sequence[Conclusion],
    created: str,
    versions: Sequence[tuple[str, str]],
) -> ReportDocument:
    """Make the document.

    Parameters
    ----------
    run
        Both situations.
    found, beyond
        Of `wucaps_conclusions`.
    created
        ISO 8601 time stamp.
    versions
        Packages and their versions.
    """
    first_page, parts = numbered(opening(found), sections(run, found, beyond, versions))
    return ReportDocument(
        language="en",
        title="A published experiment on known truth",
        subject="POS errors removed in the bundle block adjustment",
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
    flights = [each.flights.flight for each in run.runs.values()]
    n_images = sum(len(flight.orientations) for flight in flights)
    n_strips = sum(len(flight.orientations.strips) for flight in flights)
    n_rows = sum(len(each.rows) for each in run.runs.values())
    return (
        f"2 blocks · {fmt.count(n_images)} images · {fmt.count(n_strips)} strips · "
        f"{n_rows} ways to orient them"
    )


def _verdict(run: Reproduction, found: Sequence[Conclusion]) -> str:
    failed = [str(k) for k, each in enumerate(found, start=1) if not each.holds]
    held = len(found) - len(failed)
    except_for = f" (not: {fmt.joined(failed)})" if failed else ""
    parts = []
    for situation, each in run.findings.items():
        control = CONTROL[RECOMMENDED[situation]]
        horizontal, vertical = each.ratios(each.recommended)
        parts.append(
            f"{fmt.number(horizontal)} times (horizontal) and {fmt.number(vertical)} times "
            f"(vertical) in the {TERRAIN[situation]} block ({control})"
        )
    return (
        "The photographs of the paper (section 2) are not public, so its two situations are "
        "simulated with known errors of GNSS and IMU. "
        f"{held} of the paper's {len(found)} conclusions hold{except_for}. With shifts and drifts "
        "as weighted observations and the control points that the paper recommends, the RMSE of "
        "the check points is, of that without systematic errors and with all control points, "
        f"{fmt.joined(parts)}. This is the run of seed {run.seed}; section 6 says how often each "
        f"finding comes out over {len(repeated()['flat'])} seeds."
    )


def _key_figures(run: Reproduction) -> tuple[KeyFigure, ...]:
    figures = []
    for situation, each in run.findings.items():
        best = _pair(each.reference_horizontal_m, each.reference_vertical_m)
        name = each.recommended
        figures.append(
            KeyFigure(
                f"{TERRAIN[situation].capitalize()}, calibrated POS",
                _pair(each.calibrated_horizontal_m, each.calibrated_vertical_m),
                "m",
                "check points, RMSE H / V",
            )
        )
        figures.append(
            KeyFigure(
                f"{TERRAIN[situation].capitalize()}, adjusted",
                _pair(getattr(each, f"{name}_horizontal_m"), getattr(each, f"{name}_vertical_m")),
                "m",
                f"control {CONTROL[RECOMMENDED[situation]]}; at best {best}\u00a0m",
            )
        )
    return tuple(figures)


def _pair(horizontal: float, vertical: float) -> str:
    return f"{fmt.number(horizontal, 2)} / {fmt.number(vertical, 2)}"
