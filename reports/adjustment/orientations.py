"""Topic: how well the orientations and points are known, and how far the POS is from them."""

from collections.abc import Sequence

from posstats.contract.adjustment import AdjustmentResults, OrientationElement

from ..document import format as fmt
from ..document.content import Content, Paragraph, Part, filled
from ..document.table import Column, Table, number_column, text_column
from .units import scaled, unit_of
from .words import Words


def topic(words: Words, results: AdjustmentResults) -> Part:
    """Adjusted orientations and points."""
    said = [words.text("orientations.text")]
    sigma_m = results.points.median_sigma_m
    if sigma_m is not None:
        x, y, z = (fmt.with_unit(value, "m", 2) for value in sigma_m)
        said.append(
            words.text("orientations.points", n=fmt.count(results.points.n_tie), x=x, y=y, z=z)
        )
    content: tuple[Content, ...] = (
        Paragraph(words.sentences(said)),
        *filled([table(words, results.orientations)]),
    )
    return Part("orientations", words.text("orientations.title"), content)


def table(words: Words, rows: Sequence[OrientationElement]) -> Table:
    """Standard deviations of the elements, and POS minus adjusted."""
    units = [unit_of(row.unit) for row in rows]

    def column(title: str, group: str, values: Sequence[float]) -> Column:
        return number_column(words.text(title), "", scaled(values, units), group=words.text(group))

    columns = (
        text_column(
            words.text("bundle_column.element"), [words.element(row.element) for row in rows]
        ),
        text_column(words.text("bundle_column.unit"), [unit.name for unit in units]),
        column("bundle_column.median", "head.sigma", [row.median_sigma for row in rows]),
        column("bundle_column.largest", "head.sigma", [row.max_sigma for row in rows]),
        column("bundle_column.mean", "head.pos", [row.pos_mean for row in rows]),
        column("bundle_column.rms_short", "head.pos", [row.pos_rms for row in rows]),
    )
    return Table("orientations", words.text("orientations.caption"), columns)
