"""Topic: which angle carries the error, by holding POS angles in relative orientation."""

from posstats.contract.results import Results

from ..document.content import Content, Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.rows import rows
from ..document.table import Table
from ..figures import style
from .bar_figures import bar_figure, held_angles
from .strip_table import strip_table
from .view import HELD, strips_with_models
from .words import BlockReport, Words


def topic(report: BlockReport) -> Part:
    """Parallax with angles held, as bars and in a table."""
    words, results = report.words, report.results
    content: tuple[Content, ...] = (
        Paragraph(words.text("error_sources.text")),
        *known(figure(words, results)),
        *filled([table(words, results)]),
    )
    return Part("sources", words.text("error_sources.title"), content)


def table(words: Words, results: Results) -> Table:
    """Mean parallax per strip with POS angles of the right image held."""
    held = {words.of("held", n): rows(results.error_sources, fixed=n) for n in HELD}
    return strip_table(words, results, "error_sources", held, {})


def figure(words: Words, results: Results) -> Drawing | None:
    """Bars per strip: what relative orientation leaves with POS angles held."""
    bars = held_angles(results, "px", {name: words.of("held", name) for name in HELD})
    if not any(group.of_strip for group in bars):
        return None
    names = words.text("axis.strip"), words.text("axis.mean_parallax")
    picture = bar_figure(bars, strips_with_models(results), "px", names)
    title = words.text("error_sources.figure_title")
    return style.finish(picture, "error_sources", title, words.text("error_sources.figure"))
