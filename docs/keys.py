"""Tables of keys in these pages, made from the dataclasses of `posstats.contract`.

``python docs/keys.py`` writes them anew between the marks ``<!-- keys: NAME -->`` and
``<!-- end of keys -->`` of every page; ``python docs/keys.py --check`` says which are out of date.
"""

import inspect
import re
import sys
import types
from collections.abc import Iterator
from dataclasses import fields, is_dataclass
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from msgspec import UnsetType

PAGES = Path(__file__).parent
DOCUMENTS = {
    "acceptance": "Acceptance",
    "adjustment": "AdjustmentResults",
    "comparison": "Comparison",
    "results": "Results",
    "wucaps": "Wucaps",
}
MARKED = re.compile(r"(<!-- keys: (\w+) -->\n).*?(<!-- end of keys -->)", re.DOTALL)
UNNAMED = (type(None), UnsetType)
_PLAIN = {str: "text", float: "number", int: "whole number", bool: "`true`, `false`"}


def tables(document: type) -> str:
    """A table of the document's keys, then a section for every kind of row in it."""
    parts = [_table(document)]
    parts += [
        f"### {heading}\n\n{inspect.cleandoc(kind.__doc__ or '')}\n\n{_table(kind)}"
        for kind, heading in _kinds(document)
    ]
    return "\n".join(parts)


def _kinds(document: type) -> list[tuple[type, str]]:
    """Every dataclass inside, and the keys that hold it; a kind that comes twice stands once."""
    found: dict[type, list[str]] = {}
    for path, kind in _inside(document, ""):
        found.setdefault(kind, []).append(path)
    return [(kind, ", ".join(paths)) for kind, paths in found.items()]


def _inside(document: type, above: str) -> Iterator[tuple[str, type]]:
    for name, hint in _hints(document).items():
        kind = _dataclass_in(hint)
        if kind is not None:
            yield f"{above}{name}", kind
            yield from _inside(kind, f"{above}{name}.")


def _table(kind: type) -> str:
    lines = ["| key | type | value |", "|---|---|---|"]
    for name, hint in _hints(kind).items():
        bare, text = _described(hint)
        lines.append(f"| `{name}` | {_type(bare)} | {text} |")
    return "\n".join(lines) + "\n"


def _hints(kind: type) -> dict[str, Any]:
    """Types of the fields in the order in which they are written."""
    hints = get_type_hints(kind, include_extras=True)
    return {field.name: hints[field.name] for field in fields(kind)}


def _described(hint: Any) -> tuple[Any, str]:
    if get_origin(hint) is Annotated:
        bare, *notes = get_args(hint)
        return bare, next((str(each.description) for each in notes if each.description), "")
    return hint, ""


def _type(hint: Any) -> str:
    """A type in the words of a reader of JSON."""
    hint, _ = _described(hint)
    if get_origin(hint) in (Union, types.UnionType):
        parts = [_type(each) for each in get_args(hint) if each not in UNNAMED]
        optional = type(None) in get_args(hint)
        return ", ".join([*dict.fromkeys(parts), *(["`null`"] if optional else [])])
    if get_origin(hint) is Literal:
        return ", ".join(f"`{each}`" for each in get_args(hint))
    if get_origin(hint) is tuple:
        members = get_args(hint)
        if members[-1] is Ellipsis:
            return f"list of {_type(members[0])}"
        return f"`[{', '.join(['…'] * len(members))}]`"
    if is_dataclass(hint):
        return "object"
    return _PLAIN.get(hint, "object")


def _dataclass_in(hint: Any) -> type | None:
    """The dataclass that a key holds, or a list of."""
    hint, _ = _described(hint)
    if is_dataclass(hint) and isinstance(hint, type):
        return hint
    inside = (_dataclass_in(each) for each in get_args(hint) if each is not Ellipsis)
    return next((kind for kind in inside if kind is not None), None)


def written(page: str) -> str:
    """A page with its tables made anew."""

    def anew(match: re.Match[str]) -> str:
        module = import_module(f"posstats.contract.{match[2]}")
        return f"{match[1]}\n{tables(getattr(module, DOCUMENTS[match[2]]))}\n{match[3]}"

    return MARKED.sub(anew, page)


def main() -> int:
    """Write the pages, or with --check say which are out of date."""
    check, stale = "--check" in sys.argv[1:], 0
    for path in sorted(PAGES.glob("*.md")):
        page = path.read_text(encoding="utf-8")
        if (new := written(page)) != page:
            stale += 1
            print(f"{path.name}: {'out of date: make docs' if check else 'written'}")
            if not check:
                path.write_text(new, encoding="utf-8")
    return stale if check else 0


if __name__ == "__main__":
    sys.exit(main())
