"""The document of a block's report."""

from ..document.key_figure import key_figures
from ..document.numbering import SIMULATED, ReportDocument, numbered
from ..figures.style import Drawing
from . import figures, sections
from .verdict import is_coarse, paragraph
from .view import Results


def build(results: Results, drawings: dict[str, Drawing] | None = None) -> ReportDocument:
    """Make the document of a block's report.

    Parameters
    ----------
    results
        The results dictionary (``results.json``), the only source of the report.
    drawings
        The figures of the results, if they have been drawn already.
    """
    opening, parts = sections.block_report(results, drawings or figures.draw(results))
    shown, numbered_parts = numbered(opening, parts)
    block = results["block"]
    return ReportDocument(
        title="Vertical parallax and POS angle errors",
        subject=str(block["name"]),
        subtitle=sections.subtitle(results),
        mark=SIMULATED if block.get("simulated") else "",
        created=str(results.get("created") or "").partition("T")[0],
        version=str(results.get("posstats_version") or ""),
        verdict=paragraph(results),
        coarse=is_coarse(results),
        key_figures=key_figures(results),
        opening=shown,
        sections=numbered_parts,
    )
