"""Topic: errors of the POS angles, and how well they are known."""

from collections.abc import Sequence

from posstats.contract.results import AngleErrorSummary, Results

from ..document import format as fmt
from ..document.content import Paragraph, Part, filled
from ..document.table import Table, count_column, number_column, text_column
from .words import BlockReport, Words

SHOWN_IMAGES = 12


def topic(report: BlockReport) -> Part:
    """How the errors are estimated, and their sizes."""
    words, results = report.words, report.results
    said = [words.text("angle_errors.text"), words.of("angle_errors_by", results.settings.errors)]
    text = Paragraph(words.sentences([*said, _unused(words, results)]))
    tables = filled([table(words, results.angle_error_summary)])
    return Part("angles", words.text("angle_errors.title"), (text, *tables))


def _unused(words: Words, results: Results) -> str:
    """Images whose angles are not determined, by name if they are few."""
    unused = [row.image for row in results.angle_errors if not row.used]
    if not unused:
        return ""
    n, total = fmt.count(len(unused)), fmt.count(len(results.angle_errors))
    if len(unused) > SHOWN_IMAGES:
        return words.text("angle_errors.unused", n=n, total=total)
    names = words.text("list.between").join(unused)
    return words.text("angle_errors.unused_named", n=n, total=total, names=names)


def table(words: Words, summary: Sequence[AngleErrorSummary]) -> Table:
    """How much each angle errs, and how well that is known."""
    unit = fmt.angle_unit(row.rms_rad for row in summary)
    sizes = {
        "column.mean": [row.mean_rad for row in summary],
        "column.rms": [row.rms_rad for row in summary],
        "column.largest": [row.max_abs_rad for row in summary],
        "column.median_sigma": [row.median_sigma_rad for row in summary],
    }
    columns = [
        text_column(words.text("column.angle"), [words.angle(row.angle) for row in summary]),
        text_column(words.text("column.frame"), [words.of("frame", row.frame) for row in summary]),
        count_column(words.text("column.images"), [row.n for row in summary]),
        *(
            number_column(words.text(title), unit.name, map(unit.scaled, values))
            for title, values in sizes.items()
        ),
    ]
    if unit is not fmt.DEGREE:
        degrees = map(fmt.DEGREE.scaled, sizes["column.rms"])
        columns.append(number_column(words.text("column.rms"), fmt.DEGREE.name, degrees))
    return Table("angle_error_summary", words.text("angle_errors.caption"), tuple(columns))
