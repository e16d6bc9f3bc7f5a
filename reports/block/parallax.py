"""Topic: vertical parallax of strips and models."""

from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from posstats.contract.results import ModelParallax, Results, StripParallax

from ..document import format as fmt
from ..document.content import Content, Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.rows import first
from ..document.table import (
    Column,
    Table,
    aligned_column,
    count_column,
    text_column,
)
from ..figures import style
from .view import mean_over_models, strips_with_models
from .words import BlockReport, Words

SHOWN_MODELS = 15
METHODS = ("pos", "independent", "dependent")

_SERIES: dict[str, tuple[Callable[[ModelParallax], float | None], str, str]] = {
    "pos": (lambda model: model.pos_px, style.VERMILLION, "o"),
    "corrected": (lambda model: model.corrected_px, style.BLUE, "s"),
    "relative": (lambda model: model.independent_px, style.GREEN, "^"),
}


def topic(report: BlockReport) -> Part:
    """What parallax is, and how large it is."""
    words, results = report.words, report.results
    units = ("px", "mm") if results.units.mm else ("px",)
    said = [words.text("parallax.text")]
    if not results.units.mm:
        said.append(words.text("parallax.no_pixel_size"))
    content: tuple[Content, ...] = (
        Paragraph(words.sentences(said)),
        *filled(by_strip(words, results, unit) for unit in units),
        *known(figure(words, results)),
        *filled([by_model(words, results.models)]),
    )
    return Part("parallax", words.text("parallax.title"), content)


def by_strip(words: Words, results: Results, unit: str) -> Table:
    """Maximum, minimum and mean parallax of the strips in one unit (``px`` or ``mm``)."""
    kept = strips_with_models(results)
    found = [first(results.parallax, strip=s) for s in kept]
    n_models = [row.n_models if row else None for row in found]
    columns = [
        text_column(words.text("column.strip"), [*kept, words.text("scope.block")]),
        count_column(words.text("column.models"), [*n_models, sum(fmt.present(n_models))]),
    ]
    for method in METHODS:
        part = [first(results.parallax, strip=s, method=method) for s in kept]
        if any(row and not fmt.is_missing(row.mean_px) for row in part):
            columns += _extremes(words, part, unit, words.of("method", method))
    caption = words.of("parallax_caption", unit)
    note = words.text("parallax.methods")
    return Table(f"parallax_{unit}", caption, tuple(columns), (note,), frozenset({len(kept)}))


def _extremes(
    words: Words, part: Sequence[StripParallax | None], unit: str, group: str
) -> list[Column]:
    values = {
        name: [_number(row, f"{name}_{unit}") for row in part] for name in ("max", "min", "mean")
    }
    block = {
        "max": max(fmt.present(values["max"]), default=None),
        "min": min(fmt.present(values["min"]), default=None),
        "mean": mean_over_models(part, unit),
    }
    decimals = fmt.shared_decimals([v for column in values.values() for v in column])
    return [
        Column(
            words.of("extreme", name),
            tuple(fmt.fixed(value, decimals) for value in [*column, block[name]]),
            unit,
            group=group,
        )
        for name, column in values.items()
    ]


def _number(row: StripParallax | None, name: str) -> float | None:
    value: float | None = getattr(row, name, None)
    return value


def by_model(words: Words, models: Sequence[ModelParallax]) -> Table:
    """The models of largest POS parallax (all, if there are few; then without a solution last)."""
    ranked = sorted(models, key=lambda m: -(m.pos_px if m.pos_px is not None else float("-inf")))
    shown = ranked if len(models) <= 2 * SHOWN_MODELS else ranked[:SHOWN_MODELS]
    columns = (
        text_column(words.text("column.left"), [m.left for m in shown]),
        text_column(words.text("column.right"), [m.right for m in shown]),
        text_column(words.text("column.strip"), [m.strip for m in shown]),
        count_column(words.text("column.points"), [m.n_points for m in shown]),
        count_column(words.text("column.rejected"), [m.n_rejected for m in shown]),
        aligned_column(words.text("column.pos"), "px", [m.pos_px for m in shown]),
        aligned_column(words.text("column.corrected"), "px", [m.corrected_px for m in shown]),
        aligned_column(words.text("column.relative"), "px", [m.independent_px for m in shown]),
    )
    total, n = fmt.count(len(models)), fmt.count(len(shown))
    caption = (
        words.text("models.caption") if len(shown) == len(models)
        else words.text("models.largest", n=n, total=total)
    )  # fmt: skip
    notes = (words.text("models.rejected"), words.text("models.missing", sign=fmt.MISSING))
    return Table("models", caption, columns, notes)


def figure(words: Words, results: Results) -> Drawing | None:
    """Parallax of every model in the order of flight, strips side by side."""
    found = (value(model) for model in results.models for value, *_ in _SERIES.values())
    values = [value for value in fmt.present(found) if value > 0]
    if not values:
        return None
    picture = style.new_figure(3.1)
    axis = picture.add_subplot()
    place = {strip: k for k, strip in enumerate(strips_with_models(results))}
    ordered = sorted(results.models, key=lambda model: place.get(model.strip, len(place)))
    for name in _SERIES:
        if name == "corrected" and not results.verdict.corrected_angles:
            continue  # the same as the POS: it would hide it
        _dots(words, axis, ordered, name)
    style.log_axis(axis, values)
    _strip_bands(axis, [model.strip for model in ordered], words.text("axis.strip"))
    axis.set_ylabel(words.text("axis.model_parallax"))
    style.legend_below(picture, axis, 3)
    caption = words.text("models.figure")
    return style.finish(picture, "models", words.text("models.figure_title"), caption)


def _dots(words: Words, axis: Axes, ordered: Sequence[ModelParallax], name: str) -> None:
    value, colour, marker = _SERIES[name]
    known_px = [value(model) for model in ordered]
    y = [np.nan if each is None else each for each in known_px]
    look: dict[str, Any] = {"marker": marker, "ls": "", "ms": 2.6, "mew": 0.7, "mfc": "none"}
    look = style.dots(colour, 2.8) if marker == "o" else look | {"color": colour}
    axis.plot(range(len(y)), y, label=words.of("legend", name), **look)


def _strip_bands(axis: Axes, strip_of_model: Sequence[str], name: str) -> None:
    """Every second strip on a grey ground, ids in the middle."""
    ids = list(dict.fromkeys(strip_of_model))
    starts = [strip_of_model.index(strip) for strip in ids] + [len(strip_of_model)]
    for k in range(0, len(ids), 2):
        axis.axvspan(starts[k] - 0.5, starts[k + 1] - 0.5, color=style.LIGHT, alpha=0.35, lw=0)
    centres = [(a + b - 1) / 2.0 for a, b in pairwise(starts)]
    style.strip_ticks(axis, centres, ids, name)
    axis.set_xlim(-0.5, len(strip_of_model) - 0.5)
