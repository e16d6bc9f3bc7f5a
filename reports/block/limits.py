"""Topic: what the data cannot tell, and warnings."""

from collections.abc import Sequence

from posstats.contract.results import Observability, Results

from ..document import format as fmt
from ..document.content import Bullets, Content, Paragraph, Part, filled
from ..document.rows import rows
from ..document.table import Table, text_column
from .words import BlockReport, Words

SHOWN_IMAGES = 12


def topic(report: BlockReport) -> Part:
    """What stays open, and what the analysis warns of."""
    words, results = report.words, report.results
    text = words.sentences([words.text("limits.text"), _less_known_than_stated(words, results)])
    content = (
        Paragraph(text),
        *filled([table(words, results.observability)]),
        *_warnings(words, results),
    )
    return Part("limits", words.text("limits.title"), content)


def _warnings(words: Words, results: Results) -> tuple[Content, ...]:
    if not results.notices:
        return (Paragraph(words.text("limits.no_warnings")),)
    said = tuple(map(words.notice, results.notices))
    return Paragraph(words.text("limits.warnings")), Bullets(said)


def _less_known_than_stated(words: Words, results: Results) -> str:
    """Angles that the tie points give less well than the POS claims to know them."""
    stated = results.settings.angle_rad
    loose = [
        words.text(
            "limits.only_to", angle=words.angle(row.angle), sigma=fmt.angle(row.median_sigma_rad)
        )
        for row in rows(results.angle_error_summary, frame="ground")
        if stated and row.median_sigma_rad and row.median_sigma_rad > stated
    ]
    if not loose:
        return ""
    return words.text("limits.blind", found=words.joined(loose), stated=fmt.angle(stated))


def table(words: Words, scopes: Sequence[Observability]) -> Table:
    """What the tie points cannot tell, by scope; images whose angles stay undetermined."""
    kept = [row for row in scopes if row.rotations or row.images]
    open_rotations = [words.rotations(row.rotations) or fmt.MISSING for row in kept]
    columns = (
        text_column(words.text("column.scope"), [words.scope(row.scope) for row in kept]),
        text_column(words.text("column.unobservable"), open_rotations),
        text_column(words.text("column.undetermined"), [_listed(words, r.images) for r in kept]),
    )
    return Table("observability", words.text("limits.caption"), columns)


def _listed(words: Words, images: Sequence[str]) -> str:
    return words.first(images, SHOWN_IMAGES) or fmt.MISSING
