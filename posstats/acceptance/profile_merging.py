"""Files put together: a contract's keys replace those of the profile that it extends."""

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import PurePath
from typing import Any

from posstats.acceptance.formula import Formula, FormulaError, limit_formula
from posstats.acceptance.product import Product
from posstats.acceptance.profile import Contract, Profile, Requirement, Statement
from posstats.acceptance.profile_reading import ALWAYS, ANY_TERRAIN, FileContent, TableOfFile
from posstats.acceptance.profile_values import alternatives
from posstats.acceptance.quantity_names import COUNTED_BEYOND, QUANTITIES
from posstats.formats.hints import nearest

_NUMBERS = ("quantity", "limit", "threshold")
_HEAD = ("name", "edition", "title", "source", "needs", "scales")


@dataclass
class _Merged:
    """What the files so far say together."""

    requirements: dict[str, Requirement] = field(default_factory=dict)
    statements: dict[tuple[str, str], Statement] = field(default_factory=dict)
    head: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    changed: dict[str, None] = field(default_factory=dict)
    added: dict[str, None] = field(default_factory=dict)
    omitted: dict[str, None] = field(default_factory=dict)
    named: set[str] = field(default_factory=set)


def merged(contents: Sequence[FileContent]) -> tuple[Profile | None, Contract]:
    """Profile and contract of files, the one that extends all others first.

    The profile is None if no file has a requirement, or if there are findings: what is wrong is
    added to those of the files.
    """
    state = _Merged()
    base_first = list(reversed(contents))
    for number, content in enumerate(base_first):
        _extend(state, content, is_base=number == 0)
    if not any(content.findings for content in contents):
        _refuse_emptiness(state, contents[0])
    if any(content.findings for content in contents):
        return None, Contract()
    product, contract = Product(), Contract()
    for content in base_first:
        product = product.updated(Product(**content.product.values))
        contract = replace(contract, **content.contract.values)
    contract = replace(contract, product=product)
    return (_profile(state, contents) if state.requirements else None), contract


def _profile(state: _Merged, contents: Sequence[FileContent]) -> Profile:
    head = {"edition": "", "title": "", "source": ""} | state.head
    head.setdefault("name", PurePath(contents[0].file.name).stem)
    return Profile(
        **head,
        requirements=tuple(state.requirements.values()),
        notes=tuple(state.notes),
        statements=tuple(state.statements.values()),
        files=tuple(content.file for content in contents),
        changed=tuple(state.changed),
        added=tuple(state.added),
        omitted=tuple(state.omitted),
    )


def _extend(state: _Merged, content: FileContent, is_base: bool) -> None:
    """Add a file to those that it extends."""
    state.head |= {key: content.top.values[key] for key in _HEAD if key in content.top.values}
    if "needs" in content.top.values:
        state.head["needs"] = tuple(map(alternatives, content.top.values["needs"]))
    state.notes += content.top.values.get("notes", ())
    touched = _omit(state, content)
    given: set[str] = set()
    for table in content.requirements:
        id_ = table.values.get("id")
        if id_ is None or _is_repeated(table, id_, given, content):
            continue
        old = state.requirements.get(id_)
        new = _requirement(table, old, state, content.file.name)
        state.named.add(id_)
        if new is not None and _put(state, old, new, is_base):
            touched.add(id_)
    _withhold(state, touched)
    _add_statements(state, content)


def _put(state: _Merged, old: Requirement | None, new: Requirement, is_base: bool) -> bool:
    """Take a requirement in; whether it demands something else than the one it replaces."""
    state.requirements[new.id] = new
    state.omitted.pop(new.id, None)
    if old is None:
        state.added |= {} if is_base else {new.id: None}
        return False
    changes = not new.demands_the_same_as(old)
    state.changed |= {new.id: None} if changes else {}
    return changes


def _omit(state: _Merged, content: FileContent) -> set[str]:
    """Leave out what a file omits; the ids."""
    omitted = set()
    for id_ in content.top.values.get("omit", ()):
        if id_ in state.requirements:
            del state.requirements[id_]
            state.omitted[id_] = None
            state.changed.pop(id_, None)
            state.added.pop(id_, None)
            omitted.add(id_)
        else:
            known = nearest(id_, state.requirements) if state.requirements else ""
            content.top.refuse("omit", f"found {id_!r}{known or ', but nothing that is extended'}")
    return omitted


def _is_repeated(table: TableOfFile, id_: str, given: set[str], content: FileContent) -> bool:
    """Whether a file speaks of a requirement twice, which is a finding."""
    if id_ in given:
        table.refuse("id", f"found {id_!r} a second time, expected each id once")
        return True
    given.add(id_)
    if id_ in content.top.values.get("omit", ()):
        table.refuse("id", f"found {id_!r}, which omit leaves out")
        return True
    return False


def _requirement(
    table: TableOfFile, old: Requirement | None, state: _Merged, file_name: str
) -> Requirement | None:
    """The requirement of a table, or what it makes of the one of the same id."""
    values = dict(table.values)
    if not _is_complete(table, old, state):
        return None
    quantity = values.get("quantity", old.quantity if old else "")
    if quantity not in QUANTITIES:
        return None  # refused when it was read
    values |= _formulas(values, table, quantity)
    unconditional = {"terrain": ANY_TERRAIN, "when_given": ALWAYS}
    values |= {key: None for key, word in unconditional.items() if values.get(key) == word}
    if old is None or any(key in values for key in _NUMBERS):
        values = {"source": file_name, "clause": ""} | values
    if old is not None and quantity not in COUNTED_BEYOND:
        values = {"threshold": None} | values
    if not table.is_right:
        return None
    new = Requirement(**values) if old is None else replace(old, **values)
    _refuse_contradictions(new, table)
    return new


def _is_complete(table: TableOfFile, old: Requirement | None, state: _Merged) -> bool:
    """Whether a table has what it must have; what is missing is a finding."""
    given = table.given
    if old is None and state.requirements and "quantity" not in given:
        known = nearest(table.values["id"], state.requirements)
        table.refuse(
            "id", f"found {table.values['id']!r}{known} (a new one needs quantity and limit)"
        )
        return False
    missing = [key for key in ("quantity", "limit") if old is None and key not in given]
    if old is not None and table.values.get("quantity", old.quantity) != old.quantity:
        missing = [] if "limit" in given else ["limit"]
    for key in missing:
        table.refuse(key, f"found nothing, expected the {key} of {table.values['id']!r}")
    return not missing


def _formulas(values: dict[str, Any], table: TableOfFile, quantity: str) -> dict[str, Formula]:
    """Limit and threshold of a table, those that are given and right."""
    units = {"limit": QUANTITIES[quantity].unit, "threshold": COUNTED_BEYOND.get(quantity, "1")}
    formulas = {}
    for key in units:
        if key in values:
            try:
                formulas[key] = limit_formula(values[key], units[key])
            except FormulaError as error:
                table.refuse(key, f"found {error.found}: {error.reason}")
    return formulas


def _refuse_contradictions(new: Requirement, table: TableOfFile) -> None:
    counted = new.quantity in COUNTED_BEYOND
    if counted and new.threshold is None:
        table.refuse("threshold", "found nothing, expected the residual (m) that counts as one")
    if not counted and new.threshold is not None:
        known = " and ".join(COUNTED_BEYOND)
        table.refuse("threshold", f"found one for {new.quantity}, expected it for {known} only")
    limit, largest = new.limit.constant, new.measured.largest
    if limit is not None and largest is not None and limit > largest:
        table.refuse("limit", f"found {limit:g}, expected at most {largest:g} (a share)")
    if new.basis_of_score and (limit == 0.0 or new.measured.sense == "at least"):
        what = "a quantity that is to be at most a limit above 0"
        table.refuse("basis_of_score", f"found true for {new.quantity}, expected {what}")


def _withhold(state: _Merged, touched: set[str]) -> None:
    """Withhold the statements that claim what a file has changed or omitted."""
    for key, statement in state.statements.items():
        by = [id_ for id_ in statement.rests_on if id_ in touched or id_ in statement.withheld_by]
        state.statements[key] = replace(statement, withheld_by=tuple(by))


def _add_statements(state: _Merged, content: FileContent) -> None:
    given: set[tuple[str, str]] = set()
    for table in content.statements:
        if "component" not in table.values or not table.is_right:
            continue
        statement = Statement(**table.values)
        key = (statement.component, statement.language)
        if key in given:
            table.refuse("component", f"found {' and '.join(key)} a second time")
        given.add(key)
        for id_ in statement.rests_on:
            if id_ not in state.named:
                table.refuse("rests_on", f"found {id_!r}{nearest(id_, sorted(state.named))}")
        if statement.tested_with_fewer and statement.least_points == 1:
            table.refuse("least_points", "found 1, expected more: tested_with_fewer is given")
        state.statements[key] = statement


def _refuse_emptiness(state: _Merged, content: FileContent) -> None:
    """A finding if a file that has the parts of a profile leaves no requirement."""
    parts: list[str] = [
        key for key in ("name", "needs", "scales", "omit") if key in content.top.values
    ]
    parts += ["statement"] if content.statements else []
    if parts and not state.requirements:
        content.top.refuse(parts[-1], "found no requirement, expected [[requirement]] or extends")
