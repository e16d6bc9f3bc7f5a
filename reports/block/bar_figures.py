"""Figures of vertical parallax: by model, by angle held (error sources), by angle corrected."""

import math
import textwrap
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from posstats.contract.results import ModelParallax, Results

from ..document import format as fmt
from ..document.drawing import Drawing
from ..document.rows import rows
from ..figures import style
from .view import (
    FIXED,
    GROUND_ANGLES,
    StripMean,
    mean_in,
    mean_over_models,
    orientation_label,
    strips_with_models,
)

AXES = ("strip", "mean RMS vertical parallax")

CORRECTED = "after the selected correction"

_MODEL_SERIES: tuple[tuple[Callable[[ModelParallax], float | None], str, str, str], ...] = (
    (lambda model: model.pos_px, "POS as delivered", style.VERMILLION, "o"),
    (lambda model: model.corrected_px, CORRECTED, style.BLUE, "s"),
    (lambda model: model.independent_px, "relative orientation", style.GREEN, "^"),
)


def by_model(results: Results) -> Drawing | None:
    """Parallax of every model in the order of flight, strips side by side."""
    models = results.models
    values = fmt.present(value(model) for model in models for value, *_ in _MODEL_SERIES)
    values = [value for value in values if value > 0]
    if not values:
        return None
    figure = style.new_figure(3.1)
    axis = figure.add_subplot()
    place = {strip: k for k, strip in enumerate(strips_with_models(results))}
    ordered = sorted(models, key=lambda model: place.get(model.strip, len(place)))
    chosen = results.verdict.corrected_angles
    for value, label, colour, marker in _MODEL_SERIES:
        if label == CORRECTED and not chosen:
            continue  # the same as the POS: it would hide it
        known = [value(model) for model in ordered]
        y = [np.nan if each is None else each for each in known]
        look: dict[str, Any] = {"marker": marker, "ls": "", "ms": 2.6, "mew": 0.7, "mfc": "none"}
        look = style.dots(colour, 2.8) if marker == "o" else look | {"color": colour}
        axis.plot(range(len(y)), y, label=label, **look)
    style.log_axis(axis, values)
    _strip_bands(axis, [model.strip for model in ordered])
    axis.set_ylabel("RMS vertical parallax, px")
    style.legend_below(figure, axis, 3)
    caption = (
        "RMS vertical parallax of every stereo model, in the order of flight (logarithmic scale; "
        "strips apart by shading). Relative orientation is what the images themselves allow."
    )
    return style.finish(figure, "models", "Vertical parallax of every stereo model", caption)


def error_sources(results: Results) -> Drawing | None:
    """Bars per strip: what relative orientation leaves with POS angles held."""
    caption = (
        "Error sources: mean RMS vertical parallax per strip after relative orientation with POS "
        "angles of the right image held (logarithmic scale; the numbers are means over all "
        "models). Grey is what remains with none held. An angle whose bars reach those of all "
        "three carries the error; one whose bars stay grey does no harm."
    )
    bars = held_angles(results, "px")
    if not any(group.of_strip for group in bars):
        return None
    figure = bar_figure(bars, strips_with_models(results), "px")
    return style.finish(figure, "error_sources", "Vertical parallax with POS angles held", caption)


def corrected(results: Results) -> Drawing | None:
    """Bars per strip: raw, each angle corrected alone, selected set, relative orientation."""
    chosen = results.verdict.corrected_angles
    words = f"Selected: {fmt.joined(chosen)}." if chosen else "No correction was selected."
    caption = (
        "Mean RMS vertical parallax per strip from the POS as delivered, with each angle corrected "
        "alone, with the selected corrections, and after relative orientation (logarithmic "
        "scale; the numbers are means over all models). Grey is what relative orientation "
        f"leaves. {words}"
    )
    bars = corrections(results, "px", (*GROUND_ANGLES, "selected"))
    if not any(group.of_strip for group in bars):
        return None
    figure = bar_figure(bars, strips_with_models(results), "px")
    return style.finish(figure, "corrected", "Vertical parallax after correction", caption)


@dataclass(frozen=True)
class Bars:
    """Mean parallax per strip of one orientation, and over all its models."""

    label: str
    of_strip: dict[str, float]
    mean: float | None


def held_angles(results: Results, unit: str) -> list[Bars]:
    """Relative orientation with POS angles held, none of them last; `unit` is px or mm."""
    return [
        _bars(label, rows(results.error_sources, fixed=name), unit) for name, label in FIXED.items()
    ]


def corrections(results: Results, unit: str, corrected: Sequence[str]) -> list[Bars]:
    """The POS as delivered, corrections of it, relative orientation; `unit` is px or mm."""
    made = [
        _bars(orientation_label(name, results.verdict.corrected_angles),
              rows(results.corrected_parallax, corrected=name), unit)
        for name in corrected
    ]  # fmt: skip
    ends = {"pos": "POS as delivered", "independent": "relative orientation"}
    pos, relative = (
        _bars(label, rows(results.parallax, method=name), unit) for name, label in ends.items()
    )
    return [pos, *made, relative]


def _bars(label: str, per_strip: Sequence[StripMean], unit: str) -> Bars:
    means = {row.strip: mean_in(row, unit) for row in per_strip}
    # Zero, the parallax of data without errors, has no place on a logarithmic scale.
    known = {strip: mean for strip, mean in means.items() if mean is not None and mean > 0.0}
    return Bars(label, known, mean_over_models(per_strip, unit))


def bar_figure(
    groups: Sequence[Bars], strips: Sequence[str], unit: str, names: tuple[str, str] = AXES
) -> Figure:
    """Groups of bars side by side, one bar per strip, on a logarithmic scale.

    Up to the height of the last group, which has to be the one that no POS angle can spoil, bars
    are grey: what is above it is, on this scale, the factor that the POS angles cost.

    Parameters
    ----------
    groups
        In the order of showing, at least one with values; those without are left out.
    strips
        In the order of showing; those without values are left out.
    unit
        Of the heights.
    names
        Of the axes; that of the heights is followed by their unit.
    """
    shown = [group for group in groups if group.of_strip]
    strips = [strip for strip in strips if any(strip in group.of_strip for group in shown)]
    labels = [fmt.shortened(strip) for strip in strips]
    figure = style.new_figure(2.25 + 0.05 * max(len(label) for label in labels))
    axis = figure.add_subplot()
    style.log_axis(axis, [height for group in shown for height in group.of_strip.values()])
    pitch = len(strips) + max(1.0, 0.15 * len(strips))
    for k, group in enumerate(shown):
        _group(axis, k * pitch, group, groups[-1], strips, unit)
    _strip_labels(axis, labels, [k * pitch for k in range(len(shown))], names[0])
    axis.set_xlim(-0.8, (len(shown) - 1) * pitch + len(strips) - 0.2)
    axis.set_ylabel(f"{names[1]}, {unit}")
    return figure


def _group(
    axis: Axes, left: float, group: Bars, least: Bars, strips: Sequence[str], unit: str
) -> None:
    floor = axis.get_ylim()[0]
    known = [strip for strip in strips if strip in group.of_strip]
    top = np.array([group.of_strip[strip] for strip in known])
    grey = np.minimum(top, [least.of_strip.get(strip, floor) for strip in known])
    x = left + np.array([strips.index(strip) for strip in known])
    axis.bar(x, grey - floor, 0.8, bottom=floor, color=style.LIGHT, edgecolor=style.GREY, lw=0.4)
    axis.bar(x, top - grey, 0.8, bottom=grey, color=style.VERMILLION)
    heading = f"{textwrap.fill(group.label, 12)}\n{fmt.with_unit(group.mean, unit)}"
    axis.text(left + (len(strips) - 1) / 2.0, 1.02, heading, transform=axis.get_xaxis_transform(),
              ha="center", va="bottom")  # fmt: skip


def _strip_labels(axis: Axes, labels: list[str], lefts: Sequence[float], name: str) -> None:
    """Ids under the bars of every group; where there is no room for all, under some."""
    longest = max(len(label) for label in labels)
    turned = longest > 3
    room_pt = 72.0 * style.WIDTH_IN / (len(lefts) * (len(labels) + 1.0))
    step = math.ceil((8.5 if turned else 4.5 * longest + 3.0) / room_pt)
    places = [left + k for left in lefts for k in range(0, len(labels), step)]
    axis.set_xticks(places, labels[::step] * len(lefts), rotation=90 if turned else 0,
                    fontsize=6.5 if turned else 7.5)  # fmt: skip
    axis.tick_params(axis="x", length=0)
    axis.set_xlabel(name)


def _strip_bands(axis: Axes, strip_of_model: Sequence[str]) -> None:
    """Every second strip on a grey ground, ids in the middle."""
    ids = list(dict.fromkeys(strip_of_model))
    starts = [strip_of_model.index(strip) for strip in ids] + [len(strip_of_model)]
    for k in range(0, len(ids), 2):
        axis.axvspan(starts[k] - 0.5, starts[k + 1] - 0.5, color=style.LIGHT, alpha=0.35, lw=0)
    centres = [(a + b - 1) / 2.0 for a, b in pairwise(starts)]
    style.strip_ticks(axis, centres, ids)
    axis.set_xlim(-0.5, len(strip_of_model) - 0.5)
