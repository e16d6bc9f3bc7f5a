"""Topic: which angles are corrected, in which form, and why."""

from posstats.contract.results import Regression, Results, Selection

from ..document import format as fmt
from ..document.content import Content, Paragraph, Part, filled
from ..document.rows import first
from ..document.table import Column, Table, p_column, pairs, prose_column, text_column
from .regression import share_column
from .view import decided_by_strip
from .words import BlockReport, Words

SHOWN_DECISIONS = 20


def topic(report: BlockReport) -> Part:
    """Rules and frame, and what was decided by them."""
    words, results = report.words, report.results
    content: list[Content] = [Paragraph(_text(words, results)), *filled([_frames(words, results)])]
    if decided_by_strip(results):
        content += filled([table_by_strip(words, results)])
    content += filled([table(words, results)])
    return Part("decisions", words.text("decisions.title"), tuple(content))


def _text(words: Words, results: Results) -> str:
    settings = results.settings
    said = words.text(
        "decisions.text",
        rules=settings.rules,
        scope=words.of("setting_value", settings.scope),
        frame=words.of("frame", settings.frame),
    )
    why = settings.frame_notice
    return words.sentences(
        [said, words.text("decisions.why", why=words.notice(why)) if why else ""]
    )


def _frames(words: Words, results: Results) -> Table:
    """The frames compared out of sample, where one was to be chosen."""
    compared = [
        (words.of("frame", row.frame), fmt.number(row.out_of_sample_px)) for row in results.frames
    ]
    titles = words.text("column.frame"), words.text("column.out_of_sample")
    return pairs("frames", words.text("frames.caption"), titles, compared)


def table(words: Words, results: Results) -> Table:
    """Which angles are corrected, in which form, and why; by strip only the corrected ones."""
    by_strip = decided_by_strip(results)
    chosen = [row for row in results.selection if row.correct or not by_strip]
    shown = chosen[:SHOWN_DECISIONS]
    columns = (
        text_column(words.text("column.angle"), [words.angle(row.angle) for row in shown]),
        text_column(words.text("column.frame"), [words.of("frame", row.frame) for row in shown]),
        text_column(words.text("column.scope"), [words.scope(row.scope) for row in shown]),
        text_column(words.text("column.is_corrected"), [words.yes(row.correct) for row in shown]),
        text_column(words.text("column.form"), [words.of("form", row.form) for row in shown]),
        prose_column(words.text("column.reason"), [words.reason(row.notices) for row in shown]),
    )
    corrected = frozenset(k for k, row in enumerate(shown) if row.correct and not by_strip)
    forms = words.text("decisions.forms")
    if not by_strip:
        return Table("decisions", words.text("decisions.caption"), columns, (forms,), corrected)
    notes = (forms, _where_the_others_are(words, len(shown), len(chosen)))
    return Table("decisions", words.text("decisions.caption_in_strips"), columns, notes)


def _where_the_others_are(words: Words, n_shown: int, n_chosen: int) -> str:
    said = [words.text("decisions.of_every_strip")]
    if n_shown < n_chosen:
        n, total = fmt.count(n_shown), fmt.count(n_chosen)
        said.append(words.text("decisions.shown", n=n, total=total))
    return words.sentences(said)


def table_by_strip(words: Words, results: Results) -> Table:
    """Decided form of every angle in every strip, with the R2 and p of its line."""
    kept = list(dict.fromkeys(row.scope for row in results.selection))
    columns: list[Column] = [text_column(words.text("column.strip"), kept)]
    for angle in dict.fromkeys(row.angle for row in results.selection):
        decided = [first(results.selection, angle=angle, scope=scope) for scope in kept]
        lines = [_line_of(results, row) if row else None for row in decided]
        forms = [words.of("form", row.form) if row else None for row in decided]
        head = words.angle(angle)
        columns += [
            share_column("R²", [line.r_squared if line else None for line in lines], head),
            p_column("p", [_tested_p(*pair) for pair in zip(decided, lines, strict=True)], head),
            text_column(words.text("column.form_in_group"), forms, head),
        ]
    note = words.text("decisions.no_line", sign=fmt.MISSING)
    caption = words.text("decisions.caption_by_strip")
    return Table("decisions_by_strip", caption, tuple(columns), (note,))


def _line_of(results: Results, decision: Selection) -> Regression | None:
    return first(results.regression, angle=decision.angle, frame=decision.frame,
                 scope=decision.scope)  # fmt: skip


def _tested_p(decision: Selection | None, line: Regression | None) -> float | None:
    if decision is None or line is None:
        return None
    return line.gls_p_value if decision.fit == "gls" else line.p_value
