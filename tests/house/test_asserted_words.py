"""Tests assert codes, numbers and places: sentences are asserted where catalogues are tested.

A sentence copied into a test says the same twice, and stops every change of wording.
"""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from catalogues import DOMAINS, OF, called
from helpers import ROOT

MOST_WORDS = 3
WORD = re.compile(r"[(\[]*[^\W\d_]+(['’-][^\W\d_]+)*[)\],.;:?!]*")  # what is in quotes is a value
CONTENT = re.compile(r"[\n=<>{}|\\]")
"""Signs of what is written in files or code, and of patterns: these are no sentences."""
OF_CATALOGUES = re.compile(r"test_(catalogues?|words|wording|prose|asserted_words)\.py")
ASSERTING = re.compile(r"assert_\w+|refused|raises|warns")
"""Calls that compare what they are given."""
CODES = {name.partition(".")[2] for domain in DOMAINS for name in OF["en", domain].messages}
FILES = sorted((ROOT / "tests").rglob("test_*.py"))
SPEAKING = [path for path in FILES if not OF_CATALOGUES.fullmatch(path.name)]


def is_sentence(text: str) -> bool:
    """Whether a text has more words than an assertion needs to tell it from others."""
    words = [part for part in text.split() if WORD.fullmatch(part)]
    is_code = text.replace(" ", "_") in CODES
    return len(words) > MOST_WORDS and not is_code and not CONTENT.search(text)


def compared(function: ast.AST) -> Iterator[ast.AST]:
    """Expressions that a test compares."""
    for node in ast.walk(function):
        if isinstance(node, ast.Assert):
            yield node.test
        elif isinstance(node, ast.Call) and ASSERTING.fullmatch(called(node)):
            yield from (*node.args, *(keyword.value for keyword in node.keywords))


def cases(function: ast.FunctionDef, names: set[str]) -> Iterator[ast.AST]:
    """Literal values of the names in the parameters and the loops of a test."""
    for node in ast.walk(function):
        if isinstance(node, ast.Call) and called(node) == "parametrize":
            yield from columns(node.args[0], node.args[1], names)
        elif isinstance(node, ast.For):
            yield from columns(node.target, node.iter, names)


def columns(target: ast.AST, rows: ast.AST, names: set[str]) -> Iterator[ast.AST]:
    """Elements of literal rows that belong to the names."""
    targets = getattr(target, "elts", [target])
    held = [str(getattr(each, "id", getattr(each, "value", ""))) for each in targets]
    for row in getattr(rows, "elts", ()):
        cells = row.elts if len(held) > 1 and isinstance(row, ast.Tuple) else [row]
        yield from (cell for name, cell in zip(held, cells, strict=False) if name in names)


def texts(node: ast.AST) -> Iterator[str]:
    """Texts in an expression; values of f-strings are numbers in them."""
    if isinstance(node, ast.JoinedStr):
        parts = (getattr(part, "value", "") for part in node.values)
        yield "".join(part if isinstance(part, str) else "0" for part in parts)
    elif isinstance(node, ast.Constant) and isinstance(node.value, str):
        yield node.value
    elif not isinstance(node, ast.Subscript) or not isinstance(node.slice, ast.Constant):
        for child in ast.iter_child_nodes(node):
            yield from texts(child)


def sentences(code: str) -> list[str]:
    """Sentences that the tests of a module compare with what they get."""
    found = []
    for function in ast.walk(ast.parse(code)):
        if isinstance(function, ast.FunctionDef):
            nodes = list(compared(function))
            names = {n.id for node in nodes for n in ast.walk(node) if isinstance(n, ast.Name)}
            nodes += cases(function, names)
            found += [text for node in nodes for text in texts(node) if is_sentence(text)]
    return found


@pytest.mark.parametrize(
    ("line", "found"),
    [
        ("assert 'it was not tested' in page", True),
        ("assert f'at {n} points it was tested' in page", True),
        ("for word in ('not', 'it was not tested'):\n  assert word in page", True),
        ("with raises(ValueError, match='it was not tested'): f()", True),
        ("assert 'not tested' in page", False),
        ("assert point.status == 'fewer than two rays'", False),
        ("assert read('a = 1 # it was not tested')", False),
        ("page = 'it was not tested'", False),
    ],
)
def test_a_sentence_is_told_from_a_code_and_a_word(line, found):
    assert bool(sentences(f"def test():\n {line}".replace("\n  ", "\n   "))) == found


@pytest.mark.parametrize("path", SPEAKING, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_no_test_asserts_a_sentence(path: Path):
    assert not sentences(path.read_text(encoding="utf-8"))
