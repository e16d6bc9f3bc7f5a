"""Bars of mean vertical parallax: by angle held (error sources), by angle corrected."""

import math
import textwrap
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from posstats.contract.results import Results

from ..document import format as fmt
from ..document.rows import rows
from ..figures import style
from .view import StripMean, mean_in, mean_over_models


@dataclass(frozen=True)
class Bars:
    """Mean parallax per strip of one orientation, and over all its models."""

    label: str
    of_strip: dict[str, float]
    mean: float | None


def held_angles(results: Results, unit: str, titles: Mapping[str, str]) -> list[Bars]:
    """Relative orientation with POS angles held, one group for every title; `unit` is px or mm.

    `titles` are those of the groups, by what is held, none of them last.
    """
    return [
        _bars(title, rows(results.error_sources, fixed=held), unit)
        for held, title in titles.items()
    ]


def corrections(results: Results, unit: str, titles: Mapping[str, str]) -> list[Bars]:
    """The POS, corrections of it, relative orientation, one group for every title.

    `titles` are those of the groups: ``pos``, the angles corrected, ``independent``.
    """
    return [
        _bars(title, rows(results.parallax, method=name)
              or rows(results.corrected_parallax, corrected=name), unit)
        for name, title in titles.items()
    ]  # fmt: skip


def _bars(label: str, per_strip: Sequence[StripMean], unit: str) -> Bars:
    means = {row.strip: mean_in(row, unit) for row in per_strip}
    # Zero, the parallax of data without errors, has no place on a logarithmic scale.
    known = {strip: mean for strip, mean in means.items() if mean is not None and mean > 0.0}
    return Bars(label, known, mean_over_models(per_strip, unit))


def bar_figure(
    groups: Sequence[Bars], strips: Sequence[str], unit: str, names: tuple[str, str]
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
