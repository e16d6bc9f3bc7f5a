"""The acceptance document as one self-contained HTML page: a pure function of its data."""

from collections.abc import Callable, Mapping
from importlib import resources
from typing import TypeVar

from markupsafe import Markup

from posstats.contract.acceptance import Acceptance
from posstats.contract.files import as_values, from_values
from posstats.contract.results import Results

from ..document.catalogue import catalogue
from ..pages.garbage import garbage_kept
from ..typefaces import cjk, fonts
from . import templates as acceptance_templates
from .document import build
from .words import DOMAINS

BOX = "□"  # in figures, for a character that cannot be drawn

D = TypeVar("D", Acceptance, Results)


@garbage_kept()
def render_document(
    acceptance: Acceptance, results: Results, templates: Mapping[str, bytes]
) -> str:
    """Render the document as HTML: stylesheet, typefaces and figures inside, nothing loaded.

    Parameters
    ----------
    templates
        The user's templates and images by file name; empty for ours alone.

    Returns
    -------
    str
        The same for the same arguments, with the same version of posstats and the same typefaces.

    Raises
    ------
    PosstatsError
        If a template cannot be rendered or would load something, or no typeface for Chinese is
        installed.
    """
    acceptance, results = _mapped(acceptance, cjk.legible), _mapped(results, cjk.legible)
    lost = unshown(acceptance, results)
    words = catalogue(acceptance.language, *DOMAINS)
    environment = acceptance_templates.environment(templates, words)
    document = build(acceptance, _drawable(results, lost), lost)
    marks = acceptance_templates.page_number_css(words, document.document_id, document.mark)
    values = {"report": document, "css": _stylesheet(marks)}
    # The text tells which glyphs to embed; so it is made twice.
    text = acceptance_templates.render(environment, faces=(), **values)
    if templates:
        acceptance_templates.assert_self_contained(text)
    faces = (*fonts.faces(text), *cjk.faces(text))
    return acceptance_templates.render(environment, faces=faces, **values)


def unshown(acceptance: Acceptance, results: Results) -> str:
    """Characters of names and ids that no typeface at hand can show."""
    shown = acceptance, results.warnings, {model.strip for model in results.models}
    return cjk.unshown(repr(shown))


def _stylesheet(page_numbers: Markup) -> Markup:
    folder = resources.files("posstats.templates")
    sheets = [
        folder.joinpath(name).read_text(encoding="utf-8")
        for name in ("report.css", "acceptance.css")
    ]
    return Markup("\n".join([*sheets, page_numbers]))  # noqa: S704 - ours


def _drawable(results: Results, lost: str) -> Results:
    """Results whose texts figures can draw."""
    boxes = dict.fromkeys(map(ord, lost), BOX)
    return _mapped(results, lambda text: text.translate(boxes)) if lost else results


def _mapped(document: D, function: Callable[[str], str]) -> D:
    """A document with every text changed by a function."""
    values = _with_texts(as_values(document), function)
    return from_values(values, type(document), "document")


def _with_texts(value: object, function: Callable[[str], str]) -> object:
    if isinstance(value, str):
        return function(value)
    if isinstance(value, dict):
        return {key: _with_texts(each, function) for key, each in value.items()}
    if isinstance(value, list):
        return [_with_texts(each, function) for each in value]
    return value
