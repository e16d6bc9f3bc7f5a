"""The look of every figure, and its SVG text: vectors, text as text, ids of its own, same bytes."""

import io
from collections.abc import Sequence
from typing import Any

import matplotlib
from matplotlib.axes import Axes
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.figure import Figure
from matplotlib.markers import MarkerStyle
from matplotlib.path import Path
from matplotlib.ticker import FixedLocator, FuncFormatter, LogLocator, NullFormatter

from ..document import format as fmt
from ..document.drawing import Drawing
from ..document.format import shortened
from ..typefaces.fonts import FAMILY
from .svg import embeddable

# Okabe & Ito (2008), "Color Universal Design": told apart by colour-blind readers; the markers
# and hatches beside them carry the same distinction in grey print.
BLACK = "#1c2430"
BLUE = "#0072B2"
ORANGE = "#E69F00"
GREEN = "#009E73"
VERMILLION = "#D55E00"
PURPLE = "#CC79A7"
SKY = "#56B4E9"
GREY = "#6b7480"
LIGHT = "#d5dae0"

WIDTH_IN = 6.7  # 170 mm: the text width of A4

STRIP_COLOURS = (BLUE, VERMILLION, GREEN, ORANGE, PURPLE, SKY, BLACK)
STRIP_MARKERS = ("o", "s", "^", "D", "v", "P", "X")

_RC: dict[str, Any] = {
    "font.size": 8.0,
    "axes.titlesize": 8.5,
    "axes.labelsize": 8.0,
    "axes.edgecolor": GREY,
    "axes.linewidth": 0.7,
    "axes.labelcolor": BLACK,
    "axes.axisbelow": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.unicode_minus": True,
    "text.color": BLACK,
    "text.parse_math": False,  # an id such as a$b$ is no formula
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": BLACK,
    "ytick.labelcolor": BLACK,
    "xtick.labelsize": 7.5,
    "ytick.labelsize": 7.5,
    "grid.color": LIGHT,
    "grid.linewidth": 0.5,
    "legend.fontsize": 7.5,
    "legend.frameon": False,
    "hatch.linewidth": 0.5,
    "svg.fonttype": "none",
    "svg.hashsalt": "posstats",
}
_NO_METADATA = dict.fromkeys(("Date", "Creator", "Format", "Type"))


def style(families: Sequence[str] = (FAMILY,)) -> Any:
    """Context in which figures are made: the settings of the house, and no others.

    `families` are those of their texts, in the order of preference.
    """
    settings: dict[Any, Any] = {**matplotlib.rcParamsDefault, **_RC, "font.family": [*families]}
    del settings["backend"]  # not ours to choose; figures are drawn without one
    return matplotlib.rc_context(settings)


def new_figure(height_in: float, width_in: float = WIDTH_IN) -> Figure:
    """An empty figure of the text's width, laid out without overlaps."""
    return Figure(figsize=(width_in, height_in), layout="constrained")


def finish(figure: Figure, name: str, title: str, caption: str) -> Drawing:
    """Draw a figure as SVG that can stand in a page beside others.

    Texts stay texts; `title` becomes the alternative text.
    """
    stream = io.StringIO()
    # Figure.savefig would draw a figure of this layout twice.
    FigureCanvasSVG(figure).print_svg(stream, metadata=_NO_METADATA)  # type: ignore[no-untyped-call]
    share = figure.get_figwidth() / WIDTH_IN
    return Drawing(name, title, caption, embeddable(stream.getvalue(), name, title, share))


def dots(colour: str, size: float) -> dict[str, Any]:
    """Look of round dots of a size in points, each a stroke of no length with round ends.

    A circle would be eight curves, and pages hold hundreds of dots.
    """
    point = MarkerStyle(Path([(-1.0, 0.0), (1.0, 0.0)]), capstyle="round")
    return {"marker": point, "ls": "", "ms": 0.01, "mew": size, "color": colour}


def strip_style(strips: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Colour and marker of each strip; no two of the first 49 strips share both."""
    n_colours, n_markers = len(STRIP_COLOURS), len(STRIP_MARKERS)
    return {
        strip: (
            STRIP_COLOURS[k % n_colours],
            STRIP_MARKERS[(k + k // n_colours) % n_markers],
        )
        for k, strip in enumerate(strips)
    }


def log_axis(axis: Axes, values: Sequence[float]) -> None:
    """Logarithmic y-axis with plain numbers: few per decade over many, more within one."""
    axis.set_yscale("log")
    low, high = min(values), max(values)
    axis.set_ylim(low / 1.5, high * 1.5)
    steps: tuple[float, ...] = (1.0, 2.0, 3.0, 4.0, 6.0, 8.0)
    if high / low > 5.0:
        steps = (1.0,) if high / low > 3e3 else (1.0, 2.0, 5.0)
    axis.yaxis.set_major_locator(LogLocator(subs=steps, numticks=20))
    axis.yaxis.set_major_formatter(FuncFormatter(lambda value, _: fmt.number(value, 1)))
    axis.yaxis.set_minor_formatter(NullFormatter())
    axis.grid(axis="y")


def plain_ticks(axis: Axes) -> None:
    """Coordinates on both axes as whole numbers with thousands apart."""
    for side in (axis.xaxis, axis.yaxis):
        side.set_major_formatter(FuncFormatter(lambda value, _: fmt.count(value)))


def strip_ticks(axis: Axes, centres: Sequence[float], strips: Sequence[str], name: str) -> None:
    """Name of an axis, and strip ids: turned where they would touch, shortened where too long."""
    labels = [shortened(strip) for strip in strips]
    crowded = sum(len(label) + 2 for label in labels) > 90
    axis.xaxis.set_major_locator(FixedLocator(list(centres)))
    axis.set_xticks(
        list(centres), labels, rotation=90 if crowded else 0, fontsize=6.5 if crowded else 7.5
    )
    axis.tick_params(axis="x", length=0)
    axis.set_xlabel(name)


def legend_below(figure: Figure, axis: Axes, columns: int) -> None:
    """Legend under the axes, outside the data."""
    handles, labels = axis.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=min(columns, len(labels) or 1))
