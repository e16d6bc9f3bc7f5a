"""Topic: observations that the others contradict."""

from collections.abc import Sequence

from posstats.contract.adjustment import AdjustmentResults, ContradictedObservation

from ..document import format as fmt
from ..document.content import Paragraph, Part, filled
from ..document.table import Table, number_column, text_column
from .points import not_shown
from .units import unit_of
from .words import Words

SHOWN_BLUNDERS = 25


def topic(words: Words, results: AdjustmentResults) -> Part:
    """How blunders were looked for, and which were found."""
    said = [words.text("blunders.text")]
    if not results.snooping_complete:
        said.append(words.text("blunders.stopped"))
    shown = filled([table(words, results.blunders)])
    none = () if shown else (Paragraph(words.text("blunders.no_observation")),)
    content = (Paragraph(words.sentences(said)), *shown, *none)
    return Part("blunders", words.text("blunders.title"), content)


def table(words: Words, rows: Sequence[ContradictedObservation]) -> Table:
    """What was taken out, the largest first among image rays."""
    shown = rows[:SHOWN_BLUNDERS]
    columns = (
        text_column(
            words.text("bundle_column.observation"), [words.of("kind", r.kind) for r in shown]
        ),
        text_column(words.text("bundle_column.image"), [row.image for row in shown]),
        text_column(words.text("bundle_column.point"), [row.point for row in shown]),
        number_column("w", "", [row.w for row in shown]),
        text_column(words.text("bundle_column.size"), [_size(row) for row in shown]),
        text_column(words.text("bundle_column.unit"), [unit_of(row.unit).name for row in shown]),
        text_column(words.text("bundle_column.found_by"), [words.text(_how(row)) for row in shown]),
    )
    notes = not_shown(words, len(rows) - len(shown))
    return Table("blunders", words.text("blunders.caption"), columns, notes)


def _size(row: ContradictedObservation) -> str:
    """Measured minus adjusted, its components in a row."""
    unit = unit_of(row.unit)
    return ", ".join(fmt.number(unit.scaled(value)) for value in row.size)


def _how(row: ContradictedObservation) -> str:
    return f"found.{row.found_by}" if row.taken_out else f"held.{row.found_by}"
