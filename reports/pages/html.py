"""The document as one self-contained HTML page."""

import re
from dataclasses import dataclass
from importlib import resources
from typing import TypedDict

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup, escape

from ..document.catalogue import Catalogue, catalogue
from ..document.drawing import Drawing
from ..document.numbering import ReportDocument
from ..document.table import Column
from ..typefaces import cjk, fonts

TEMPLATE = "report.html.j2"


class _WhiteSpace(TypedDict):
    trim_blocks: bool
    lstrip_blocks: bool
    keep_trailing_newline: bool


WHITE_SPACE = _WhiteSpace(trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True)


@dataclass(frozen=True)
class PageWords:
    """Words that the templates themselves need; `stop` stands after the number of a table."""

    language: str
    contents: str
    table: str
    figure: str
    stop: str


def render(document: ReportDocument) -> str:
    """Render a document as HTML: stylesheet, typefaces and figures inside, nothing loaded.

    Every text of the document is escaped; only figures, which escape their own texts, and the
    stylesheet pass as markup.

    Raises
    ------
    PosstatsError
        If the document is in Chinese and no typeface for it is installed.
    """
    environment = Environment(
        loader=PackageLoader("posstats.templates", ""),
        autoescape=True,
        undefined=StrictUndefined,
        **WHITE_SPACE,
    )
    words = catalogue(document.language, "document")
    dress(environment, words)
    faces = fonts.faces(document.text)
    if document.language == "zh":
        faces = (*faces, *cjk.faces(document.text + _every_text(words)))
    template = environment.get_template(TEMPLATE)
    return template.render(report=document, css=_stylesheet(words), faces=faces)


def _stylesheet(words: Catalogue) -> Markup:
    """The rules of all pages; Chinese ones have a typeface and page numbers of their own."""
    css = _sheet("report.css")
    if words.language == "zh":
        before, between, after = (
            f'"{words.text(f"page.{place}")}"' for place in ("before", "between", "after")
        )
        number = f"{before} counter(page) {between} counter(pages) {after}"
        css = f"{css}\n{_sheet('chinese.css')}@page {{ @bottom-right {{ content: {number}; }} }}\n"
    return Markup(css)  # noqa: S704 - ours


def _sheet(name: str) -> str:
    return resources.files("posstats.templates").joinpath(name).read_text(encoding="utf-8")


def _every_text(words: Catalogue) -> str:
    return "".join(form for forms in words.messages.values() for form in forms)


def dress(environment: Environment, words: Catalogue) -> None:
    """Give an environment what the common templates use."""
    environment.filters["svg"] = _svg
    environment.filters["cell_class"] = _cell_class
    environment.filters["typeset"] = _typeset
    environment.globals["words"] = page_words(words)
    environment.globals["say"] = words.text


def page_words(words: Catalogue) -> PageWords:
    """Words of the page itself in the language of a catalogue."""
    return PageWords(
        language={"zh": "zh-CN"}.get(words.language, words.language),
        contents=words.text("page.contents"),
        table=words.text("page.table"),
        figure=words.text("page.figure"),
        stop=words.text("page.stop"),
    )


def _cell_class(column: Column) -> Markup:
    """Attribute of the cells of a column; none for short words, the most frequent kind."""
    names = [str(column.align)] if column.align != "left" else []
    names += ["long"] if column.has_long_words else []
    return Markup(f' class="{" ".join(names)}"' if names else "")  # noqa: S704 - names of ours


def _typeset(text: str) -> Markup:
    """A text with true subscripts (RMSE_H) and its commands (in backquotes) set apart."""
    marked = re.sub(r"\bRMSE_(3D|[A-Z])(?![A-Za-z0-9])", r"RMSE<sub>\1</sub>", str(escape(text)))
    return Markup(re.sub(r"`([^`<>]+)`", r"<code>\1</code>", marked))  # noqa: S704 - escaped before


def _svg(drawing: Drawing) -> Markup:
    return Markup(drawing.svg)  # noqa: S704 - made by figure_style.finish, which escapes its texts
