"""Topic: additional parameters, the cameras they change, what was dropped, correlations."""

from collections.abc import Sequence

from posstats.contract.adjustment import (
    AdditionalParameter,
    AdjustedCamera,
    AdjustmentResults,
    Correlation,
    DroppedParameter,
    Element,
)

from ..document import format as fmt
from ..document.content import Paragraph, Part, filled
from ..document.table import (
    Column,
    Table,
    aligned_column,
    number_column,
    p_column,
    text_column,
)
from .units import scaled, unit_of
from .words import Words

SHOWN_CORRELATIONS = 25
_ELEMENTS: tuple[Element, ...] = ("omega", "phi", "kappa", "x", "y", "z")


def topic(words: Words, results: AdjustmentResults) -> Part:
    """Errors of the POS and of the image."""
    title = words.text("parameters.title")
    if not results.parameters:
        return Part("parameters", title, (Paragraph(words.text("parameters.none")),))
    tables = (
        table(words, results.parameters, of_cameras=bool(results.cameras)),
        camera_table(words, results.cameras),
        dropped_table(words, results.dropped),
        correlation_table(words, results.correlations),
    )
    text = Paragraph(words.text("parameters.text"))
    return Part("parameters", title, (text, *filled(tables)))


def table(words: Words, rows: Sequence[AdditionalParameter], *, of_cameras: bool) -> Table:
    """Additional parameters and their tests; `of_cameras`: interior orientations are among them."""
    units = [unit_of(row.unit) for row in rows]
    sigmas = scaled([row.sigma for row in rows], units)
    columns = (
        text_column(
            words.text("bundle_column.parameter"), [words.parameter(row.name) for row in rows]
        ),
        text_column(words.text("bundle_column.scope"), [words.scope(row.scope) for row in rows]),
        Column(words.text("bundle_column.value"), _to_sigma(rows, units)),
        number_column(words.text("bundle_column.sigma"), "", sigmas, 2),
        text_column(words.text("bundle_column.unit"), [unit.name for unit in units]),
        aligned_column("t", "", [row.t for row in rows]),
        p_column("p", [row.p for row in rows]),
        text_column(
            words.text("bundle_column.significant"), [words.yes(r.significant) for r in rows]
        ),
        text_column(
            words.text("bundle_column.known_from"), [words.text(_source(row)) for row in rows]
        ),
    )
    notes = [words.text("parameters.signs")]
    if of_cameras:
        notes.append(words.text("parameters.interior"))
    if any(row.prior_released for row in rows):
        notes.append(words.text("parameters.freed"))
    strong = frozenset(k for k, row in enumerate(rows) if row.significant)
    return Table("parameters", words.text("parameters.caption"), columns, tuple(notes), strong)


def _to_sigma(rows: Sequence[AdditionalParameter], units: Sequence[fmt.Unit]) -> tuple[str, ...]:
    """Values with the decimals that two digits of their standard deviations have."""
    values = scaled([row.value for row in rows], units)
    sigmas = scaled([row.sigma for row in rows], units)
    return tuple(
        fmt.number(value)
        if sigma is None or not 1e-4 < abs(sigma) < 1e6
        else fmt.fixed(value, fmt.shared_decimals([sigma], 2))
        for value, sigma in zip(values, sigmas, strict=True)
    )


def _source(row: AdditionalParameter) -> str:
    """What a parameter is known from."""
    if not row.determined:
        return "source.prior" if row.prior_sigma is not None else "source.hardly"
    return "source.freed" if row.prior_released else "source.measurements"


def camera_table(words: Words, rows: Sequence[AdjustedCamera]) -> Table:
    """Stated and adjusted interior orientation."""
    stated = [(r.stated_principal_distance_px, *r.stated_principal_point_px) for r in rows]
    adjusted = [(r.principal_distance_px, *r.principal_point_px) for r in rows]
    columns = (
        text_column(words.text("bundle_column.camera"), [row.camera for row in rows]),
        *_interior(words, stated, words.text("cameras.stated")),
        *_interior(words, adjusted, words.text("cameras.adjusted")),
    )
    notes = (words.text("cameras.note"),)
    return Table("cameras", words.text("cameras.caption"), columns, notes)


def _interior(
    words: Words, values_px: Sequence[tuple[float, float, float]], group: str
) -> tuple[Column, ...]:
    """Principal distance, column and row: thousands of pixels, of which hundredths count."""
    titles = (words.text(f"bundle_column.{name}") for name in ("distance", "column", "row"))
    return tuple(
        Column(title, tuple(fmt.fixed(value[k], 2) for value in values_px), "px", group=group)
        for k, title in enumerate(titles)
    )


def dropped_table(words: Words, rows: Sequence[DroppedParameter]) -> Table:
    """Parameters that were dropped, in order."""
    columns = (
        text_column(
            words.text("bundle_column.parameter"), [words.parameter(row.name) for row in rows]
        ),
        text_column(words.text("bundle_column.scope"), [words.scope(row.scope) for row in rows]),
        text_column(
            words.text("bundle_column.reason"), [words.of("dropped", row.reason) for row in rows]
        ),
    )
    return Table("dropped", words.text("dropped.caption"), columns)


def correlation_table(words: Words, rows: Sequence[Correlation]) -> Table:
    """Correlations above 0.95, the strongest first."""
    found = sorted(rows, key=lambda row: -abs(row.value))
    shown = found[:SHOWN_CORRELATIONS]
    columns = (
        text_column(
            words.text("bundle_column.parameter"),
            [_named(words, row.first, row.first_scope) for row in shown],
        ),
        text_column(
            words.text("bundle_column.with"),
            [_named(words, row.second, row.second_scope) for row in shown],
        ),
        aligned_column(words.text("bundle_column.correlation"), "", [row.value for row in shown]),
    )
    n_more = len(found) - len(shown)
    notes = (words.text("correlations.more", n=fmt.count(n_more)),) if n_more else ()
    return Table("correlations", words.text("correlations.caption"), columns, notes)


def _named(words: Words, name: str, scope: str) -> str:
    """A parameter with its scope, or an element of an image."""
    for element in _ELEMENTS:
        if name == element:
            return words.text("correlations.of_image", element=words.element(element), image=scope)
    parameter = words.parameter(name)
    if scope == "block":
        return parameter
    return words.text("correlations.of_scope", parameter=parameter, scope=words.scope(scope))
