"""All message catalogues, and what the modules of the house say by code."""

import ast
import re
import string
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from helpers import ROOT

from posstats.reports.document.catalogue import LANGUAGES, catalogue

DOMAINS = tuple(sorted(path.stem for path in (ROOT / "reports/locale/en").rglob("*.po")))
OF = {
    (language, domain): catalogue(language, domain) for language in LANGUAGES for domain in DOMAINS
}
NUMBERS = sorted((ROOT / "posstats").rglob("*.py"))
REPORTS = sorted((ROOT / "reports").rglob("*.py"))
SAYING = {"Notice": "code", "listing": 0, "ImpossibleFitError": 1, "Reason": "code"}
"""Calls below the reports that say something, and the argument that is its code."""


def families(domain: str) -> set[str]:
    """Beginnings of the ids of a domain."""
    return {name.partition(".")[0] for name in OF["en", domain].messages}


def places(forms: tuple[str, ...]) -> set[str]:
    """Names of the values that forms of a message take."""
    return {name for form in forms for _, name, _, _ in string.Formatter().parse(form) if name}


def nodes(paths: list[Path]) -> Iterator[ast.AST]:
    """Everything in modules."""
    for path in paths:
        yield from _nodes(path)


@cache
def _nodes(path: Path) -> list[ast.AST]:
    return list(ast.walk(ast.parse(path.read_text(encoding="utf-8"))))


def texts(paths: list[Path]) -> set[str]:
    """Every text constant of modules, docstrings and parts of f-strings too."""
    return {n.value for n in nodes(paths) if isinstance(n, ast.Constant) and type(n.value) is str}


def beginnings(paths: list[Path]) -> set[str]:
    """Fixed beginnings of f-strings."""
    heads = (n.values[0] for n in nodes(paths) if isinstance(n, ast.JoinedStr) and n.values)
    return {str(head.value) for head in heads if isinstance(head, ast.Constant)}


def called(node: ast.AST) -> str:
    """Name of what a call calls."""
    function = node.func if isinstance(node, ast.Call) else None
    return getattr(function, "id", getattr(function, "attr", ""))


def codes(*calls: str) -> set[str]:
    """Codes that calls below the reports state as texts."""
    found: set[str] = set()
    for node in nodes(NUMBERS):
        if isinstance(node, ast.Call) and called(node) in calls:
            found |= {n.value for n in ast.walk(_code(node)) if _is_result(n, node)}
    return found


def _code(call: ast.Call) -> ast.AST:
    place = SAYING[called(call)]
    if isinstance(place, int):
        return call.args[place]
    return next(each.value for each in call.keywords if each.arg == place)


def _is_result(node: ast.AST, call: ast.Call) -> bool:
    """Whether a part of a code's expression is a code: no condition, no part of an f-string."""
    code = _code(call)
    options = [code.body, code.orelse] if isinstance(code, ast.IfExp) else [code]
    return node in options and isinstance(node, ast.Constant)


def combined() -> set[tuple[str, ...]]:
    """Domains that reports put into one catalogue."""
    lists = [n.elts for n in nodes(REPORTS) if isinstance(n, ast.Tuple)]
    lists += [n.args[1:] for n in nodes(REPORTS) if called(n) == "catalogue"]
    named = {tuple(getattr(n, "value", None) for n in each) for each in lists if len(each) > 1}
    return {each for each in named if set(each) <= set(DOMAINS)}


def templates() -> str:
    """The text of all templates."""
    return "".join(p.read_text(encoding="utf-8") for p in sorted(ROOT.glob("templates/**/*.j2")))


def named_in_templates() -> tuple[set[str], set[str]]:
    """Ids in templates, and beginnings of ids that are put together there."""
    ids = set(re.findall(r"say\([\"']([\w.]+)[\"']\)", templates()))
    return ids, set(re.findall(r'say\("([\w.]+\.)" ~', templates()))
