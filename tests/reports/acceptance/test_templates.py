"""A user's templates: single blocks replaced, in a sandbox, on a page that loads nothing."""

import base64
import re
from dataclasses import replace

import acceptance_values as values
import pytest
from page_reading import read

from posstats.errors import PosstatsError
from posstats.reports.acceptance.page import render_document

PNG = base64.b64decode(
    "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mNkYPhfDwAChwGA60e6kgAAAABJRU5ErkJggg=="
)
SVG = b'<svg xmlns="http://www.w3.org/2000/svg" width="9" height="9"><path d="M0 0h9v9z"/></svg>'
CASE, RESULTS = values.acceptance(12), values.results()


def page(**files: str | bytes) -> str:
    named = {name.replace("__", "."): data for name, data in files.items()}
    named = {name: data.encode() if isinstance(data, str) else data for name, data in named.items()}
    return render_document(CASE, RESULTS, named)


def test_a_logo_and_a_letterhead_replace_ours():
    assert 'class="logo"' not in page()
    assert 'src="data:image/png;base64,' in page(logo__png=PNG)
    assert 'src="data:image/svg+xml;base64,' in page(logo__svg=SVG)
    text = page(letterhead__html__j2="<p>{{ report.delivered }}, {{ report.document_id }}</p>")
    block = CASE.block.name
    assert re.search(rf"<p>{block} .*, PA-3F2A-91C0-77DE</p>", text)


def test_a_whole_template_extends_ours_and_a_style_sheet_adds_to_it():
    mine = (
        '{% extends "posstats/acceptance.html.j2" %}'
        "{% block signatures %}{{ super() }}"
        "<p>Stamped in {{ report.created[:4] }}</p>{% endblock %}"
    )
    text = page(acceptance__html__j2=mine, style__css=".ruling > p { color: navy; }")
    assert "Stamped in 2026" in text
    assert ".ruling > p { color: navy; }" in text
    assert "Signatures" in text


def test_data_are_escaped_in_a_users_template_too():
    hostile = replace(CASE, contract=replace(CASE.contract, title=values.HOSTILE))
    files = {"letterhead.html.j2": b"<p>{{ report.subject }}</p>"}
    assert "script" not in read(render_document(hostile, RESULTS, files)).tags


@pytest.mark.parametrize(
    ("template", "message"),
    [
        ("{{ report.__class__.__mro__ }}", "unsafe"),
        ("{{ ''.__class__ }}", "unsafe"),
        ("{{ report.nothing }}", "nothing"),
        ("{% if %}", "letterhead.html.j2, line 1"),
        ("{{ report.subject | safe }}", "safe"),
        ("{% autoescape false %}{{ report.subject }}{% endautoescape %}", "autoescape"),
        ("{{ 'a' * 10**9 }}", "operator"),
        ("{{ 9 ** 9 ** 9 }}", "operator"),
        ("{% for k in range(10**9) %}{% endfor %}", "operator"),
        ("{% include '/etc/passwd' %}", "passwd"),
        ("{% include '../base.html.j2' %}", "base"),
        ("<script>1</script>", "<script>"),
        ("<img src='https://example.com/logo.png'>", "src="),
        ("<img src='file:///etc/passwd'>", "src="),
        ("<link rel=stylesheet href='x.css'>", "href="),
        ("<p onclick='x()'>", "onclick"),
        ("<a href='javascript:x()'>a</a>", "href of <a>"),
        ("<p style='background: url(x.png)'>", "style of <p>"),
        ("<style>@import 'x.css';</style>", "style sheet"),
        ("<iframe></iframe>", "<iframe>"),
    ],
)
def test_what_a_template_must_not_do_is_refused(template, message):
    with pytest.raises(PosstatsError, match=message):
        page(letterhead__html__j2=template)


@pytest.mark.parametrize(
    ("name", "data", "message"),
    [
        ("logo.png", b"no picture", "its name says"),
        ("logo.jpg", PNG, "its name says"),
        ("logo.png", PNG + b"\x00" * 2_000_000, "larger than 2 MB"),
        ("logo.svg", b"<svg><script/></svg>", "loads or runs"),
        ("logo.svg", b'<!DOCTYPE svg [<!ENTITY a "b">]><svg/>', "loads or runs"),
        ("logo.svg", b'<svg><image href="http://example.com/a.png"/></svg>', "loads or runs"),
        ("logo.svg", b"<svg", "no SVG"),
        ("logo.svg", b"<html/>", "no SVG"),
        ("run.exe", b"MZ", "neither a template"),
        ("letterhead.html.j2", b"\xff\xfe", "not UTF-8"),
    ],
)
def test_files_that_are_not_what_they_should_be_are_refused(name, data, message):
    with pytest.raises(PosstatsError, match=message):
        render_document(CASE, RESULTS, {name: data})


def test_a_style_sheet_that_loads_something_is_refused():
    with pytest.raises(PosstatsError, match="style sheet"):
        page(style__css="p { background: url(https://example.com/a.png) }")


def test_a_link_to_a_company_is_no_request():
    text = page(letterhead__html__j2='<a href="https://example.com/">Survey Ltd</a>')
    assert 'href="https://example.com/"' in text
