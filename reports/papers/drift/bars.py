"""Groups of bars in the words of the report on the first paper."""

from collections.abc import Mapping, Sequence

from posstats.contract.results import Results

from ...block.bar_figures import Bars, bar_figure
from ...block.view import strips_with_models
from ...document import format as fmt
from ...document.drawing import Drawing
from ...figures import style
from .words import Words


def drawn(
    words: Words, results: Results, bars: Sequence[Bars], name: str, said: tuple[str, str]
) -> Drawing:
    """Bars per strip in millimetres.

    Parameters
    ----------
    results
        Whose strips are shown.
    bars
        Groups with their labels.
    name
        Identifier of the figure.
    said
        Title and caption.
    """
    names = (words.text("bars.strip"), words.text("bars.parallax"))
    figure = bar_figure(bars, strips_with_models(results), "mm", names)
    return style.finish(figure, name, *said)


def titles(words: Words, groups: Mapping[str, str]) -> dict[str, str]:
    """Titles of groups by the names that the results have for them."""
    return {name: words.of("bars", key) for name, key in groups.items()}


def percent(part: Bars, whole: Bars) -> str:
    """Mean parallax as a share of another, never parted from its sign."""
    if part.mean is None or not whole.mean:
        return fmt.MISSING
    return fmt.with_unit(100.0 * part.mean / whole.mean, "%")
