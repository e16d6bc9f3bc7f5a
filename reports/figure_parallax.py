"""Figures of vertical parallax: by model, by angle held (error sources), by angle corrected."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from . import figure_style as style
from . import format as fmt
from .results_view import (
    FIXED,
    Results,
    first,
    orientation_label,
    rows,
    strips_with_models,
    verdict,
)

_MODEL_SERIES = (
    ("pos_px", "POS as delivered", style.VERMILLION, "o"),
    ("corrected_px", "after the selected correction", style.BLUE, "s"),
    ("independent_px", "relative orientation", style.GREEN, "^"),
)
_SOURCE_BARS = (
    ("angles", style.BLACK, ""),
    ("omega", style.VERMILLION, "////"),
    ("phi", style.SKY, "xxxx"),
    ("kappa", style.ORANGE, "\\\\\\\\"),
    ("none", style.GREEN, ""),
)
_CORRECTIONS = (
    ("omega", style.ORANGE, "D"),
    ("phi", style.SKY, "v"),
    ("kappa", style.PURPLE, "P"),
    ("selected", style.BLUE, "s"),
)


def by_model(results: Results) -> style.Drawing | None:
    """Parallax of every model in the order of flight, strips side by side."""
    models = rows(results, "models")
    values = fmt.present(model[key] for model in models for key, *_ in _MODEL_SERIES)
    values = [value for value in values if value > 0]
    if not values:
        return None
    figure = style.new_figure(3.1)
    axis = figure.add_subplot()
    place = {strip: k for k, strip in enumerate(strips_with_models(results))}
    ordered = sorted(models, key=lambda model: place.get(model["strip"], len(place)))
    chosen = verdict(results).get("corrected_angles")
    for key, label, colour, marker in _MODEL_SERIES:
        if key == "corrected_px" and not chosen:
            continue  # the same as the POS: it would hide it
        y = [np.nan if model[key] is None else model[key] for model in ordered]
        look: dict[str, Any] = {"marker": marker, "ls": "", "ms": 2.6, "mew": 0.7, "mfc": "none"}
        look = style.dots(colour, 2.8) if marker == "o" else look | {"color": colour}
        axis.plot(range(len(y)), y, label=label, **look)
    style.log_axis(axis, values)
    _strip_bands(axis, [model["strip"] for model in ordered])
    axis.set_ylabel("RMS vertical parallax, px")
    style.legend_below(figure, axis, 3)
    caption = (
        "RMS vertical parallax of every stereo model, in the order of flight (logarithmic scale; "
        "strips apart by shading). Relative orientation is what the images themselves allow."
    )
    return style.finish(figure, "models", "Vertical parallax of every stereo model", caption)


def error_sources(results: Results) -> style.Drawing | None:
    """Bars per strip: what relative orientation leaves with POS angles held."""
    sources = rows(results, "error_sources")
    known = {row["strip"] for row in sources if not fmt.is_missing(row["mean_px"])}
    kept = [strip for strip in strips_with_models(results) if strip in known]
    if not kept:
        return None
    figure = style.new_figure(2.9)
    axis = figure.add_subplot()
    width = 0.8 / len(_SOURCE_BARS)
    for k, (held, colour, hatch) in enumerate(_SOURCE_BARS):
        heights = [
            first(results, "error_sources", strip=s, fixed=held).get("mean_px") for s in kept
        ]
        x = np.arange(len(kept)) + (k - 2) * width
        axis.bar(x, [h or np.nan for h in heights], width, label=FIXED[held],
                 color="white" if hatch else colour, edgecolor=colour, hatch=hatch,
                 lw=0.7)  # fmt: skip
    _strip_axis(axis, kept)
    axis.set_ylabel("mean RMS vertical parallax, px")
    style.legend_below(figure, axis, 5)
    caption = (
        "Error sources: mean RMS vertical parallax per strip after relative orientation with POS "
        "angles of the right image held fixed. An angle whose holding keeps the parallax high "
        "carries the error; bars too low to be seen are in the table."
    )
    return style.finish(figure, "error_sources", "Vertical parallax with POS angles held", caption)


def corrected(results: Results) -> style.Drawing | None:
    """Parallax per strip: raw, each angle corrected alone, selected set, relative orientation."""
    kept = strips_with_models(results)
    series = [
        ("POS as delivered", style.VERMILLION, "o",
         _means(results, kept, "parallax", method="pos")),
        *(
            (orientation_label(results, name), colour, marker,
             _means(results, kept, "corrected_parallax", corrected=name))
            for name, colour, marker in _CORRECTIONS
        ),
        ("relative orientation", style.GREEN, "^",
         _means(results, kept, "parallax", method="independent")),
    ]  # fmt: skip
    values = [v for *_, means in series for v in fmt.present(means) if v > 0]
    if not values:
        return None
    figure = style.new_figure(3.1)
    axis = figure.add_subplot()
    for k, (label, colour, marker, means) in enumerate(series):
        x = np.arange(len(kept)) + (k - 2.5) * 0.11
        hollow = label.endswith("corrected") or label.startswith("selected")
        axis.plot(x, [np.nan if v is None else v for v in means], marker, label=label, color=colour,
                  mfc="white" if hollow else colour, ms=4.8, mew=1.1)  # fmt: skip
    style.log_axis(axis, values)
    _strip_axis(axis, kept)
    axis.set_ylabel("mean RMS vertical parallax, px")
    style.legend_below(figure, axis, 3)
    chosen = verdict(results).get("corrected_angles") or []
    words = f"Selected: {fmt.joined(chosen)}." if chosen else "No correction was selected."
    caption = (
        "Mean RMS vertical parallax per strip from the POS as delivered, with each angle corrected "
        "alone, with the selected corrections, and after relative orientation (logarithmic "
        f"scale). {words}"
    )
    return style.finish(figure, "corrected", "Vertical parallax after correction", caption)


def _means(results: Results, strips: Sequence[str], key: str, **which: str) -> list[float | None]:
    return [first(results, key, strip=strip, **which).get("mean_px") for strip in strips]


def _strip_axis(axis: Axes, strips: Sequence[str]) -> None:
    style.strip_ticks(axis, range(len(strips)), strips)
    axis.set_xlim(-0.6, len(strips) - 0.4)
    axis.grid(axis="y")
    for edge in range(len(strips) - 1):
        axis.axvline(edge + 0.5, color=style.LIGHT, lw=0.5)


def _strip_bands(axis: Axes, strip_of_model: Sequence[str]) -> None:
    """Every second strip on a grey ground, ids in the middle."""
    ids = list(dict.fromkeys(strip_of_model))
    starts = [strip_of_model.index(strip) for strip in ids] + [len(strip_of_model)]
    for k in range(0, len(ids), 2):
        axis.axvspan(starts[k] - 0.5, starts[k + 1] - 0.5, color=style.LIGHT, alpha=0.35, lw=0)
    centres = [(a + b - 1) / 2.0 for a, b in pairwise(starts)]
    style.strip_ticks(axis, centres, ids)
    axis.set_xlim(-0.5, len(strip_of_model) - 0.5)
