"""The document as one self-contained HTML page."""

from importlib import resources

from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from . import fonts
from .document import ReportDocument
from .figure_style import Drawing
from .tables import Column

TEMPLATE = "report.html.j2"


def render(document: ReportDocument) -> str:
    """Render a document as HTML: stylesheet, typeface and figures inside, nothing loaded.

    Every text of the document is escaped; only figures, which escape their own texts, and the
    stylesheet pass as markup.
    """
    environment = Environment(
        loader=PackageLoader("posstats.templates", ""),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["svg"] = _svg
    environment.filters["cell_class"] = _cell_class
    css = resources.files("posstats.templates").joinpath("report.css").read_text(encoding="utf-8")
    uris = {weight: fonts.data_uri(document.text, weight) for weight in fonts.WEIGHTS}
    return environment.get_template(TEMPLATE).render(report=document, css=Markup(css), fonts=uris)  # noqa: S704


def _cell_class(column: Column) -> Markup:
    """Attribute of the cells of a column; none for short words, the most frequent kind."""
    names = [str(column.align)] if column.align != "left" else []
    names += ["long"] if column.has_long_words else []
    return Markup(f' class="{" ".join(names)}"' if names else "")  # noqa: S704 - names of ours


def _svg(drawing: Drawing) -> Markup:
    return Markup(drawing.svg)  # noqa: S704 - made by figure_style.finish, which escapes its texts
