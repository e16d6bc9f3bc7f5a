"""The templates of the acceptance document, single ones of which a user's folder replaces.

A user's templates run in Jinja2's sandbox with the document's frozen data and nothing else; the
page that comes out may load nothing and run nothing.
"""

import base64
import json
import re
from collections.abc import Mapping
from html.parser import HTMLParser
from xml.etree import ElementTree as ET

from jinja2 import (
    ChoiceLoader,
    DictLoader,
    PackageLoader,
    PrefixLoader,
    StrictUndefined,
    TemplateError,
    TemplateSyntaxError,
)
from jinja2.exceptions import SecurityError
from jinja2.nodes import ScopedEvalContextModifier
from jinja2.runtime import Context
from jinja2.sandbox import ImmutableSandboxedEnvironment
from markupsafe import Markup

from posstats.errors import PosstatsError

from ..document.catalogue import Catalogue
from ..pages import html as pages

PAGE = "acceptance.html.j2"
LOGOS = ("logo.svg", "logo.png", "logo.jpg", "logo.jpeg")
LARGEST_IMAGE = 2_000_000  # bytes

_KINDS = {
    ".png": ("image/png", b"\x89PNG\r\n\x1a\n"),
    ".jpg": ("image/jpeg", b"\xff\xd8\xff"),
    ".jpeg": ("image/jpeg", b"\xff\xd8\xff"),
}
_UNSAFE_SVG = re.compile(
    rb"<!DOCTYPE|<!ENTITY|<script|<foreignObject|<style|\son\w+\s*=|javascript:"
    rb"|href\s*=\s*[\"'](?!#|data:image/)|url\(\s*[\"']?(?!#)", re.IGNORECASE
)  # fmt: skip
_LOADING = {"src", "srcset", "poster", "data", "background", "xlink:href", "action", "formaction"}
_ACTIVE = {"script", "iframe", "object", "embed", "base", "form"}
_FETCHED_CSS = re.compile(r"@import|url\(\s*[\"']?(?!#|data:)", re.IGNORECASE)


class _Sandbox(ImmutableSandboxedEnvironment):
    """Jinja2's sandbox without arithmetic that makes texts or numbers of any size."""

    intercepted_binops = frozenset({"*", "**"})

    def call_binop(self, context: Context, operator: str, left: object, right: object) -> object:
        numbers = isinstance(left, int | float) and isinstance(right, int | float)
        if not numbers or operator == "**":
            raise SecurityError(f"the operator {operator} is for small numbers only")
        return super().call_binop(context, operator, left, right)


def environment(
    templates: Mapping[str, bytes], catalogue: Catalogue
) -> ImmutableSandboxedEnvironment:
    """The sandbox with our templates and those of the user before them.

    Parameters
    ----------
    templates
        The user's files by their names; one named as ours replaces it, and may extend or include
        ours as ``posstats/NAME``.
    catalogue
        Of the document's language.
    """
    ours = PackageLoader("posstats.templates", "")
    theirs = {name: _source(name, data) for name, data in templates.items() if _is_text(name)}
    made = _Sandbox(
        loader=ChoiceLoader([DictLoader(theirs), PrefixLoader({"posstats": ours}), ours]),
        autoescape=True,
        undefined=StrictUndefined,
        **pages.WHITE_SPACE,
    )
    del made.filters["safe"]
    for name, text in theirs.items():
        _refuse_unescaped(made, name, text)
    images = {name: image_uri(name, data) for name, data in templates.items()
              if not _is_text(name)}  # fmt: skip
    pages.dress(made, catalogue)
    made.globals |= {
        "images": images,
        "logo": next((images[name] for name in LOGOS if name in images), ""),
        "style": Markup(theirs.get("style.css", "").replace("</", "<\\/")),  # noqa: S704 - checked
    }
    return made


def page_number_css(catalogue: Catalogue, *marks: str) -> Markup:
    """Page number and marks (document id, simulated data) in the margin of every page.

    A browser prints them too; of the running header it knows nothing.
    """
    said = [catalogue.text(f"page.{place}") for place in ("before", "between", "after")]
    before, between, after = (_css_text(text) for text in said)
    left = _css_text(" · ".join(filter(None, marks)))
    return Markup(  # noqa: S704 - texts as CSS strings
        f"@page {{ @bottom-left {{ content: {left}; }} @bottom-right {{ content:"
        f" {before} counter(page) {between} counter(pages) {after}; }} }}"
    )


def render(made: ImmutableSandboxedEnvironment, **values: object) -> str:
    """The page; errors of templates say where they are.

    Raises
    ------
    PosstatsError
        If a template cannot be rendered.
    """
    try:
        return made.get_template(PAGE).render(**values)
    except TemplateSyntaxError as error:
        place = f"{error.name or 'template'}, line {error.lineno}"
        raise PosstatsError(f"{place}: {error.message}") from error
    except (TemplateError, TypeError, ValueError, OverflowError, RecursionError) as error:
        raise PosstatsError(f"a template cannot be rendered: {error}") from error


def assert_self_contained(page: str) -> None:
    """Refuse a page that would load or run something.

    Raises
    ------
    PosstatsError
        If it does.
    """
    reader = _Reader()
    reader.feed(page)
    if reader.findings:
        raise PosstatsError(
            "the templates make a page that is not self-contained: "
            + "; ".join(dict.fromkeys(reader.findings))
            + ". Images come from files in the folder: {{ images['NAME'] }}"
        )


def image_uri(name: str, data: bytes) -> str:
    """An image file as a ``data:`` URI, after a look at what it is.

    Raises
    ------
    PosstatsError
        If it is too large, not what its name says, or an SVG that loads or runs something.
    """
    suffix = name[name.rfind(".") :].lower()
    if len(data) > LARGEST_IMAGE:
        raise PosstatsError(f"{name} is larger than {LARGEST_IMAGE // 1_000_000} MB")
    if suffix == ".svg":
        return _data_uri("image/svg+xml", _safe_svg(name, data))
    kind, signature = _KINDS.get(suffix, ("", b""))
    if not kind:
        raise PosstatsError(
            f"{name} is neither a template (.j2, .css) nor an image (png, jpg, svg)"
        )
    if not data.startswith(signature):
        raise PosstatsError(f"{name} is not what its name says")
    return _data_uri(kind, data)


def _safe_svg(name: str, data: bytes) -> bytes:
    if _UNSAFE_SVG.search(data) or b"\x00" in data:
        raise PosstatsError(f"{name} loads or runs something; only plain pictures are shown")
    try:
        root = ET.fromstring(data)  # noqa: S314 - without DOCTYPE there are no entities
    except ET.ParseError as error:
        raise PosstatsError(f"{name} is no SVG: {error}") from error
    if not root.tag.endswith("svg"):
        raise PosstatsError(f"{name} is no SVG")
    return data


def _data_uri(kind: str, data: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(data).decode('ascii')}"


def _is_text(name: str) -> bool:
    return name.endswith((".j2", ".css"))


def _source(name: str, data: bytes) -> str:
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise PosstatsError(f"{name} is not UTF-8 text") from error


def _refuse_unescaped(made: ImmutableSandboxedEnvironment, name: str, text: str) -> None:
    """Names from the data are text wherever they appear."""
    if not name.endswith(".j2"):
        return
    try:
        found = made.parse(text, name).find(ScopedEvalContextModifier)
    except TemplateSyntaxError as error:
        raise PosstatsError(f"{name}, line {error.lineno}: {error.message}") from error
    if found is not None:
        raise PosstatsError(f"{name}, line {found.lineno}: autoescape cannot be turned off")


def _css_text(text: str) -> str:
    """A text as a CSS string that cannot end the style sheet."""
    safe = json.dumps(text, ensure_ascii=False)[1:-1].replace("\\\\", "\\5c ")
    return '"' + safe.replace("<", "\\3c ") + '"'


class _Reader(HTMLParser):
    """Looks for what a page would load or run."""

    def __init__(self) -> None:
        super().__init__()
        self.findings: list[str] = []
        self._in_style = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._in_style = tag == "style"
        if tag in _ACTIVE:
            self.findings.append(f"<{tag}>")
        for name, value in attrs:
            self._attribute(tag, name, (value or "").strip())

    def handle_endtag(self, tag: str) -> None:  # noqa: ARG002 - the parser calls it
        self._in_style = False

    def handle_data(self, data: str) -> None:
        if self._in_style and _FETCHED_CSS.search(data):
            self.findings.append("a style sheet that loads a file")

    def _attribute(self, tag: str, name: str, value: str) -> None:
        loads = name in _LOADING or (name == "href" and tag not in {"a", "area"})
        if loads and value and not value.startswith(("#", "data:")):
            self.findings.append(f'{name}="{value[:60]}"')
        if name.startswith("on") or value.lower().startswith(("javascript:", "vbscript:")):
            self.findings.append(f"{name} of <{tag}>")
        if name == "style" and _FETCHED_CSS.search(value):
            self.findings.append(f"style of <{tag}>")
