"""No words for people below the reports: codes and values there, catalogues speak."""

import ast
import re
from collections.abc import Iterator

import pytest
from catalogues import DOMAINS, NUMBERS, OF, called
from helpers import ROOT

FOUR_WORDS = re.compile(r"([A-Za-z][a-z']*[,;:]? +({}[,;:]? +)*){3}[A-Za-z]")
NOT_SPOKEN = {"about", "compile", "Meta", "append", "refuse"}
"""Calls whose texts no page shows: what a field holds, patterns, and what is collected for the
message of an exception."""
READERS = re.compile(r"formats/|acceptance/(profile|formula)|synthetic/scenario")
"""Modules that judge what users write: all that they say is the message of an exception."""
NO_PAGE = re.compile(r"# |.*found .*expected ")
"""Comments of files that are written, findings for the message of an exception."""
CODES = {
    name.partition(".")[2] for domain in DOMAINS for name in OF["en", domain].messages
}  # a text with an entry of its own is a code, with blanks for underscores
SPEAKERS = [path for path in NUMBERS if not READERS.search(path.as_posix())]


def is_message(node: ast.AST) -> bool:
    """Whether a part of a module speaks to a caller or a programmer, not to a reader of pages."""
    names = (called(node), getattr(node, "name", None) or "")
    return isinstance(node, ast.Raise) or any(
        name.endswith(("Error", "Warning")) or name in NOT_SPOKEN for name in names
    )


def is_docstring(node: ast.AST) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant)


def spoken(node: ast.AST) -> Iterator[str]:
    """Texts of a module but docstrings and messages; values of f-strings as ``{}``."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.JoinedStr):
            parts = (getattr(part, "value", "") for part in child.values)
            yield "".join(part if isinstance(part, str) else "{}" for part in parts)
        elif isinstance(child, ast.Constant):
            yield from [child.value] if isinstance(child.value, str) else []
        elif not is_message(child) and not is_docstring(child):
            yield from spoken(child)


def prose(code: str) -> set[str]:
    """Texts of a module that a person would read on a page."""
    said = {text for text in spoken(ast.parse(code)) if FOUR_WORDS.search(text)}
    return {t for t in said if not NO_PAGE.match(t) and t.replace(" ", "_") not in CODES}


@pytest.mark.parametrize(
    ("code", "found"),
    [
        ("say = 'the ground was not tested'", True),
        ("say = f'the ground of {block} was not tested'", True),
        ("yield_ = Notice(code='the ground was not tested')", True),
        ("say = 'fewer than two rays'", False),
        ("raise PosstatsError('the ground was not tested')", False),
        ("'the ground was not tested'", False),
        ("findings.append('the ground was not tested')", False),
    ],
)
def test_prose_is_told_from_codes_and_messages(code, found):
    assert bool(prose(code)) == found


@pytest.mark.parametrize("path", SPEAKERS, ids=lambda path: path.relative_to(ROOT).as_posix())
def test_no_prose_stands_below_the_reports(path):
    assert not prose(path.read_text(encoding="utf-8"))
