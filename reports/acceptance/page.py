"""The acceptance document as one self-contained HTML page: a pure function of its data."""

from collections.abc import Callable, Mapping
from importlib import resources
from typing import Any

import msgspec
from markupsafe import Markup

from posstats.contract.files import as_values
from posstats.contract.results import Results
from posstats.errors import PosstatsError

from ..document.catalogue import catalogue
from ..pages.garbage import garbage_kept
from ..typefaces import cjk, fonts
from . import templates as acceptance_templates
from .document import build
from .words import DOMAINS

SCHEMA = "posstats-acceptance/1"
BOX = "□"  # in figures, for a character that cannot be drawn


@garbage_kept()
def render_document(
    acceptance: Mapping[str, Any], results: Results, templates: Mapping[str, bytes]
) -> str:
    """Render the document as HTML: stylesheet, typefaces and figures inside, nothing loaded.

    Parameters
    ----------
    acceptance
        The dictionary of ``acceptance.json``.
    results
        What the analysis found.
    templates
        The user's templates and images by file name; empty for ours alone.

    Returns
    -------
    str
        The same for the same arguments, with the same version of posstats and the same typefaces.

    Raises
    ------
    PosstatsError
        If the data are not those of a document, a template cannot be rendered or would load
        something, or no typeface for Chinese is installed.
    """
    try:
        return _rendered(acceptance, results, templates)
    except (KeyError, TypeError, AttributeError, IndexError) as error:
        raise PosstatsError(
            f"these are not the data of an acceptance document: {error!r}"
        ) from error


def unshown(acceptance: Mapping[str, Any], results: Results) -> str:
    """Characters of names and ids that no typeface at hand can show."""
    return cjk.unshown(repr((acceptance, _named(results))))


def _rendered(
    acceptance: Mapping[str, Any], results: Results, templates: Mapping[str, bytes]
) -> str:
    acceptance, results = _mapped(acceptance, cjk.legible), _with_texts(results, cjk.legible)
    lost = unshown(acceptance, results)
    words = catalogue(acceptance["language"], *DOMAINS)
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


def _stylesheet(page_numbers: Markup) -> Markup:
    folder = resources.files("posstats.templates")
    sheets = [
        folder.joinpath(name).read_text(encoding="utf-8")
        for name in ("report.css", "acceptance.css")
    ]
    return Markup("\n".join([*sheets, page_numbers]))  # noqa: S704 - ours


def _named(results: Results) -> list[object]:
    """What of the results is shown as text."""
    return [results.warnings, *({row.strip for row in results.models})]


def _drawable(results: Results, lost: str) -> Results:
    """Results whose texts figures can draw."""
    boxes = dict.fromkeys(map(ord, lost), BOX)
    return _with_texts(results, lambda text: text.translate(boxes)) if lost else results


def _with_texts(results: Results, function: Callable[[str], str]) -> Results:
    """The results with every text changed by a function."""
    return msgspec.convert(_mapped(as_values(results), function), Results)


def _mapped(value: Any, function: Callable[[str], str]) -> Any:
    """Nested lists and dictionaries with every text changed by a function."""
    if isinstance(value, str):
        return function(value)
    if isinstance(value, Mapping):
        return {key: _mapped(each, function) for key, each in value.items()}
    if isinstance(value, list | tuple):
        return [_mapped(each, function) for each in value]
    return value
