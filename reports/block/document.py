"""The document of a block's report."""

from posstats.contract.results import Results

from ..document.drawing import Drawing
from ..document.front import Verdict
from ..document.numbering import ReportDocument, numbered
from . import figures, sections
from .key_figures import key_figures
from .verdict import is_coarse, paragraph


def build(results: Results, drawings: dict[str, Drawing] | None = None) -> ReportDocument:
    """Make the document of a block's report.

    Parameters
    ----------
    results
        What the analysis found, the only source of the report.
    drawings
        The figures of the results, if they have been drawn already.
    """
    opening, parts = sections.block_report(results, drawings or figures.draw(results))
    shown, numbered_parts = numbered(opening, parts)
    block = results.block
    return ReportDocument(
        language="en",
        title="Vertical parallax and POS angle errors",
        subject=block.name,
        subtitle=sections.subtitle(results),
        mark="Simulated data" if block.simulated else "",
        created=(results.created or "").partition("T")[0],
        version=results.posstats_version,
        verdict=Verdict(paragraph(results), "coarse" if is_coarse(results) else ""),
        key_figures=key_figures(results),
        opening=shown,
        sections=numbered_parts,
    )
