"""Topic: what the measurements do not determine, and warnings."""

from collections.abc import Sequence

from posstats.contract.adjustment import AdjustmentResults, Undetermined

from ..document.content import Bullets, Content, Paragraph, Part, filled
from ..document.table import Table, prose_column
from .words import Words

SHOWN_NAMES = 12


def topic(words: Words, results: AdjustmentResults) -> Part:
    """What is open, why, what would determine it; warnings."""
    open_unknowns = filled([table(words, results.observability)])
    first = Paragraph(
        words.text("bundle_limits.open" if open_unknowns else "bundle_limits.determined")
    )
    content = (first, *open_unknowns, *_warnings(words, results))
    return Part("limits", words.text("bundle_limits.title"), content)


def _warnings(words: Words, results: AdjustmentResults) -> tuple[Content, ...]:
    said = tuple(map(words.notice, results.notices))
    if not said:
        return (Paragraph(words.text("bundle_limits.no_warnings")),)
    return Paragraph(words.text("bundle_limits.warnings")), Bullets(said)


def table(words: Words, rows: Sequence[Undetermined]) -> Table:
    """What the measurements leave open; what is open alike in several strips in one row."""
    alike: dict[tuple[object, ...], list[Undetermined]] = {}
    for row in rows:
        key = (row.kind, row.scope == "block", row.names, row.reason_notice.code)
        alike.setdefault(key, []).append(row)
    first = [same[0] for same in alike.values()]
    columns = (
        prose_column(
            words.text("bundle_column.what"), [_subject(words, s) for s in alike.values()]
        ),
        prose_column(
            words.text("bundle_column.why"), [words.notice(r.reason_notice) for r in first]
        ),
        prose_column(
            words.text("bundle_column.remedy"), [words.notice(r.remedy_notice) for r in first]
        ),
    )
    return Table("observability", words.text("observability.caption"), columns)


def _subject(words: Words, same: Sequence[Undetermined]) -> str:
    """What is open, in all scopes in which it is open alike."""
    names, scopes = same[0].names, [row.scope for row in same]
    if same[0].kind == "parameter":
        parameters = words.joined(map(words.parameter, names))
        if scopes == ["block"]:
            return parameters
        strips = words.joined(scopes)
        return words.counted("open.of_strips", len(scopes), parameters=parameters, strips=strips)
    return words.first(names, SHOWN_NAMES)
