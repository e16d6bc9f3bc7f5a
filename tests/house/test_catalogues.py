"""Message catalogues: complete, alike in both languages, all of it used, one word per code."""

import ast
import re
from typing import get_args

import matplotlib
import pytest
from catalogues import (
    DOMAINS,
    NUMBERS,
    OF,
    REPORTS,
    beginnings,
    called,
    codes,
    combined,
    families,
    named_in_templates,
    nodes,
    places,
    texts,
)

from posstats.analysis.observability import ROTATIONS
from posstats.contract.status import ModelStatus, PointStatus
from posstats.reports.document.catalogue import name_in

MAY_BE_EMPTY = {"page.after", "sentence.between"}
SPOKEN_BELOW = {"notice", "value", "rotation", "status"}
"""Families whose keys are codes of `posstats`; those of the others are named in the reports."""
FAMILY_CALLS = {"of", "known", "marked"}


@pytest.mark.parametrize("domain", DOMAINS)
def test_both_languages_have_the_same_ids_with_the_same_places(domain):
    english, chinese = OF["en", domain].messages, OF["zh", domain].messages
    assert set(english) == set(chinese)
    for name, forms in english.items():
        assert places(forms) == places(chinese[name]), name


@pytest.mark.parametrize("domain", DOMAINS)
def test_no_message_is_empty_but_those_that_are_meant_so(domain):
    for language in ("en", "zh"):
        messages = OF[language, domain].messages
        assert {name for name, forms in messages.items() if not all(forms)} <= MAY_BE_EMPTY


@pytest.mark.parametrize("domain", DOMAINS)
def test_chinese_is_no_copy_of_english(domain):
    """An entry with a word of four letters or more is translated."""
    for name, forms in OF["zh", domain].messages.items():
        if any(re.search(r"[a-z]{4,} [a-z]{2,}", form) for form in forms):
            assert re.search(r"[一-鿿]", "".join(forms)), name


@pytest.mark.parametrize("domain", DOMAINS)
def test_chinese_has_no_english_punctuation_between_chinese(domain):
    for name, forms in OF["zh", domain].messages.items():
        for form in forms:
            assert not re.search(r"[一-鿿][,;:?!()]|[,;:?!()][一-鿿]", form), name
            assert not re.search(r"[一-鿿]\.(?!\w)", form), name


def test_an_id_stands_in_one_domain_of_a_document_only():
    for domains in combined():
        ids = [name for domain in domains for name in OF["en", domain].messages]
        assert len(ids) == len(set(ids)), domains


@pytest.mark.parametrize("domain", DOMAINS)
def test_no_message_is_unused(domain):
    """Ids are named in reports and templates, or their family is asked by a code of `posstats`."""
    ids, heads = named_in_templates()
    ids |= texts(REPORTS)
    heads |= {head for head in beginnings(REPORTS) if head.endswith(".")} | _asked_families()
    below = {text.replace(" ", "_") for text in texts(NUMBERS)}
    heads_below = tuple(head for head in beginnings(NUMBERS) if head.endswith("_"))
    for name in OF["en", domain].messages:
        family, _, key = name.partition(".")
        if family in SPOKEN_BELOW and name not in ids:
            last = key.rpartition(".")[2] if family == "value" else key
            assert last in below or last.startswith(heads_below), name
        else:
            assert name in ids or name.startswith(tuple(heads)), name


def _asked_families() -> set[str]:
    """Families that reports ask by a key, ``words.of("verdict", key)``.

    Where the family is a variable, all texts of the room may be its name, also with ``_lead``.
    """
    asked = set()
    for path in REPORTS:
        keys = [n.args[0] for n in nodes([path]) if called(n) in FAMILY_CALLS and n.args]
        asked |= {n.value for n in keys if isinstance(n, ast.Constant)}
        if not all(isinstance(n, ast.Constant) for n in keys):
            room = texts(sorted(path.parent.glob("*.py")))
            asked |= room | {f"{text}_lead" for text in room}
    return {f"{family}." for family in asked}


@pytest.mark.parametrize("domain", DOMAINS)
def test_every_message_named_in_a_report_is_there(domain):
    known = set().union(*(OF["en", each].messages for each in DOMAINS))
    pattern = re.compile(rf"({'|'.join(sorted(families(domain)))})\.[a-z]\w*")
    files = {"py", "po", "css", "json", "svg", "png", "csv", "toml", "pdf", "html"}
    named = {text for text in texts(REPORTS) | named_in_templates()[0] if pattern.fullmatch(text)}
    named -= set(matplotlib.rcParams)
    assert {text for text in named if text.rpartition(".")[2] not in files} <= known


@pytest.mark.parametrize("language", ["en", "zh"])
def test_every_code_below_the_reports_has_words(language):
    messages = set().union(*(OF[language, domain].messages for domain in DOMAINS))
    said = {
        "notice": codes("Notice", "listing", "ImpossibleFitError"),
        "reason": codes("Reason") - {"asked"},
        "rotation": set(ROTATIONS),
        "status": {*get_args(ModelStatus), *get_args(PointStatus)},
    }
    assert len(said["notice"]) > 30
    for family, keys in said.items():
        assert {name_in(family, key) for key in keys} <= messages
