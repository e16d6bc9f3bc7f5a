"""Topic: parallax after the correction of the POS angles."""

from posstats.contract.results import Results
from posstats.numerics.kernels.rotation import ANGLE_NAMES

from ..document.content import Content, Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.rows import rows
from ..document.table import Table
from ..figures import style
from .bar_figures import bar_figure, corrections
from .strip_table import strip_table
from .view import strips_with_models
from .words import BlockReport, Words

CORRECTED = (*ANGLE_NAMES, "selected")


def topic(report: BlockReport) -> Part:
    """Parallax with each angle corrected alone, and with the selected set."""
    words, results = report.words, report.results
    said = [words.text("corrected_parallax.text")]
    forms = {row.form for row in results.selection if row.correct}
    if results.settings.frame == "camera" or "constant" in forms:
        said.append(words.text("corrected_parallax.of_another_kind"))
    content: tuple[Content, ...] = (
        Paragraph(words.sentences(said)),
        *known(figure(words, results)),
        *filled([table(words, results)]),
    )
    return Part("corrected", words.text("corrected_parallax.title"), content)


def table(words: Words, results: Results) -> Table:
    """Mean parallax per strip after the correction of each angle and of the selected set."""
    titles = _titles(words, results)
    made = {titles[n]: rows(results.corrected_parallax, corrected=n) for n in CORRECTED}
    made = {title: part for title, part in made.items() if part}
    ends = {titles[n]: rows(results.parallax, method=n) for n in ("pos", "independent")}
    return strip_table(words, results, "corrected_parallax", made, ends)


def figure(words: Words, results: Results) -> Drawing | None:
    """Bars per strip: raw, each angle corrected alone, selected set, relative orientation."""
    bars = corrections(results, "px", _titles(words, results))
    if not any(group.of_strip for group in bars):
        return None
    names = words.text("axis.strip"), words.text("axis.mean_parallax")
    picture = bar_figure(bars, strips_with_models(results), "px", names)
    chosen = results.verdict.corrected_angles
    which = (
        words.text("corrected_parallax.selected", angles=words.joined(map(words.angle, chosen)))
        if chosen else words.text("corrected_parallax.none_selected")
    )  # fmt: skip
    caption = words.sentences([words.text("corrected_parallax.figure"), which])
    title = words.text("corrected_parallax.figure_title")
    return style.finish(picture, "corrected", title, caption)


def _titles(words: Words, results: Results) -> dict[str, str]:
    """Orientations in the order of showing: the POS, its corrections, relative orientation."""
    chosen = results.verdict.corrected_angles
    names = ("pos", *CORRECTED, "independent")
    return {name: words.orientation(name, chosen) for name in names}
