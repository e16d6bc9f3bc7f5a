"""Vertical parallax of the strips: POS, assessed orientation, relative orientation."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from posstats.acceptance.evidence import model_parallax_px
from posstats.contract.choices import JudgedOrientation
from posstats.contract.results import ModelParallax, Results

from ..block.bar_figures import Bars, bar_figure
from ..block.view import strips_with_models
from ..document import format as fmt
from ..document.content import Content, Paragraph, Part, known
from ..document.drawing import Drawing
from ..document.table import Column, Table, count_column, text_column
from .material import Material, finished, section
from .words import Words

Reader = Callable[[ModelParallax], float | None]


@dataclass(frozen=True)
class Series:
    """Parallax (px) of the models from one orientation: of every strip, and of the block."""

    title: str
    of_strip: dict[str, list[float]]
    of_block: list[float]


def parallax(material: Material) -> Part:
    """What parallax the assessed orientation leaves."""
    words, results = material.words, material.results
    if not results.models:
        return section(words, "parallax", [Paragraph(words.text("parallax.none"))])
    orientation = material.acceptance.orientation
    shown = series(words, results, orientation)
    table = parallax_table(words, results, shown, orientation)
    content: list[Content] = [Paragraph(words.text("parallax.intro")), table]
    content += known(parallax_figure(words, shown))
    return section(words, "parallax", content)


def series(words: Words, results: Results, orientation: JudgedOrientation) -> list[Series]:
    """POS, assessed orientation if its parallax is known, relative orientation."""
    readers: dict[str, Reader] = {words.orientation("pos"): lambda model: model.pos_px}
    if fmt.present(model_parallax_px(model, orientation) for model in results.models):
        readers[words.orientation(orientation)] = lambda model: model_parallax_px(
            model, orientation
        )
    readers[words.text("orientation.relative")] = lambda model: model.independent_px
    return [_series(results, title, reader) for title, reader in readers.items()]


def parallax_table(
    words: Words, results: Results, shown: Sequence[Series], orientation: JudgedOrientation
) -> Table:
    """Mean and largest model of every strip, and of the block."""
    strips = list(shown[0].of_strip)
    counts = [sum(model.strip == strip for model in results.models) for strip in strips]
    columns = [
        text_column(words.text("column.strip"), [*strips, words.text("row.block")]),
        count_column(words.text("column.models"), [*counts, len(results.models)]),
    ]
    for each in shown:
        columns += _mean_and_largest(words, each)
    notes = [words.text("note.parallax")]
    if words.orientation(orientation) not in {each.title for each in shown}:
        notes.append(
            words.text("note.parallax_missing", orientation=words.orientation(orientation))
        )
    strong = frozenset({len(strips)})
    return Table("parallax", words.text("table.parallax"), tuple(columns), tuple(notes), strong)


def parallax_figure(words: Words, shown: Sequence[Series]) -> Drawing | None:
    """Mean vertical parallax per strip."""
    groups = [_bars(each) for each in shown]
    if not groups[-1].of_strip:
        return None
    names = words.text("axis.strip"), words.text("axis.parallax")
    figure = bar_figure(groups, list(shown[0].of_strip), "px", names)
    return finished(words, figure, "parallax_by_strip")


def _series(results: Results, title: str, reader: Reader) -> Series:
    of_strip = {
        strip: fmt.present(reader(model) for model in results.models if model.strip == strip)
        for strip in strips_with_models(results)
    }
    return Series(title, of_strip, fmt.present(map(reader, results.models)))


def _mean_and_largest(words: Words, shown: Series) -> tuple[Column, Column]:
    groups = [*shown.of_strip.values(), shown.of_block]
    means = [_mean(part) for part in groups]
    largest = [max(part, default=None) for part in groups]
    decimals = fmt.shared_decimals([*means, *largest])
    mean, most = (
        Column(words.text(name), tuple(fmt.fixed(value, decimals) for value in values), "px",
               group=shown.title)
        for name, values in (("column.mean_of_models", means), ("column.largest", largest))
    )  # fmt: skip
    return mean, most


def _mean(values: Sequence[float]) -> float | None:
    return sum(values) / len(values) if values else None


def _bars(shown: Series) -> Bars:
    means = {strip: _mean(part) for strip, part in shown.of_strip.items()}
    every = [value for part in shown.of_strip.values() for value in part]
    drawn = {strip: mean for strip, mean in means.items() if mean is not None and mean > 0.0}
    return Bars(shown.title, drawn, _mean(every))
