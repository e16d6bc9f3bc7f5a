"""One profile or contract file: its keys read and checked, before files are put together."""

import tomllib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, fields
from typing import Any

from posstats.acceptance.product import GIVEN_NAMES, Product
from posstats.acceptance.profile import Contract, ProfileFile
from posstats.acceptance.profile_values import (
    any_text,
    count,
    date,
    filled_text,
    identifier,
    identifiers,
    language,
    needs,
    one_of,
    scales,
    texts,
    wording,
)
from posstats.acceptance.quantity_names import QUANTITIES
from posstats.formats.toml_section import TomlSection, line_of_section, shown

TOP_KEYS = (
    "extends",
    "name",
    "edition",
    "title",
    "source",
    "notes",
    "needs",
    "scales",
    "omit",
    "contract",
    "product",
    "requirement",
    "statement",
)
REQUIREMENT_KEYS = (
    "id",
    "clause",
    "quantity",
    "limit",
    "source",
    "mandatory",
    "exceeding",
    "threshold",
    "terrain",
    "when_given",
    "basis_of_score",
)
STATEMENT_KEYS = (
    "component",
    "language",
    "least_points",
    "tested",
    "tested_with_fewer",
    "produced",
    "rests_on",
)
ANY_TERRAIN = "any"
ALWAYS = "always"

CONTRACT_KEYS = tuple(each.name for each in fields(Contract) if each.name != "product")
PRODUCT_KEYS = tuple(each.name for each in fields(Product))
_COUNTS = ("lot_size", "sample_size")
_MAX_TABLES = 200
_MAX_KEYS = 100
_MAX_LINE = 10_000


@dataclass
class TableOfFile:
    """A table of a list ([[requirement]], [[statement]]): what could be read, and its section."""

    values: dict[str, Any]
    section: TomlSection


@dataclass
class FileContent:
    """What one file says, as far as it could be read; keys that it does not give are absent."""

    file: ProfileFile
    top: TomlSection
    head: dict[str, Any] = field(default_factory=dict)
    contract: dict[str, str] = field(default_factory=dict)
    product: dict[str, Any] = field(default_factory=dict)
    requirements: list[TableOfFile] = field(default_factory=list)
    statements: list[TableOfFile] = field(default_factory=list)


def parsed(file: ProfileFile, findings: list[str]) -> tuple[dict[str, Any], str]:
    """Tables and text of a file; empty, and a finding, if it is no TOML."""
    try:
        text = file.content.decode("utf-8-sig")
        if not _has_long_line(text, file.name, findings):
            return tomllib.loads(text), text
    except UnicodeDecodeError as error:
        line = file.content.count(b"\n", 0, error.start) + 1
        findings.append(f"{file.name}:{line}: found a file that is not UTF-8 text")
    except tomllib.TOMLDecodeError as error:
        findings.append(f"{file.name}: found no valid TOML: {error}")
    except RecursionError:
        findings.append(f"{file.name}: found lists within lists beyond all measure")
    except ValueError:
        findings.append(f"{file.name}: found a number of thousands of digits")
    return {}, ""


def _has_long_line(text: str, name: str, findings: list[str]) -> bool:
    """Whether a line is long beyond need, which is a finding: a key of many parts takes minutes."""
    for number, line in enumerate(text.splitlines(), start=1):
        if len(line) > _MAX_LINE:
            found = f"found a line of {len(line)} characters, expected at most {_MAX_LINE}"
            findings.append(f"{name}:{number}: {found}")
            return True
    return False


def _refuse_unknown(section: TomlSection, known: tuple[str, ...]) -> None:
    """A finding for every unknown key; a single one, and no more reading, if there are too many."""
    n = len(section.values)
    if n <= _MAX_KEYS:
        section.refuse_unknown(known)
        return
    line = line_of_section(section.source, section.name) if section.name else ""
    where = f"{section.file}{line}{', ' if section.name else ''}{section.name}"
    section.findings.append(f"{where}: found {n} keys, expected at most {_MAX_KEYS}")
    section.values = {}


def read_content(file: ProfileFile, findings: list[str]) -> FileContent:
    """Read one file; what is wrong with it is added to `findings`."""
    raw, text = parsed(file, findings)
    top = TomlSection(raw, "", text, findings, file=file.name)
    _refuse_unknown(top, TOP_KEYS)
    content = FileContent(file, top, _head(top))
    if "contract" in top.values:
        content.contract = _contract(top)
    if "product" in top.values:
        content.product = _product(top)
    content.requirements = _tables(top, "requirement", _requirement)
    content.statements = _tables(top, "statement", _statement)
    return content


def _head(top: TomlSection) -> dict[str, Any]:
    """The keys above the first table, those that are given and right."""
    read: Mapping[str, Callable[[TomlSection, str], Any]] = {
        "extends": filled_text,
        "name": identifier,
        "edition": filled_text,
        "title": filled_text,
        "source": filled_text,
        "notes": texts,
        "needs": needs,
        "scales": scales,
        "omit": identifiers,
    }
    return _given(top, read)


def _given(
    section: TomlSection, read: Mapping[str, Callable[[TomlSection, str], Any]]
) -> dict[str, Any]:
    """What the readers make of the keys that a section has, without those they refuse."""
    values = {key: reader(section, key) for key, reader in read.items() if key in section.values}
    return {key: value for key, value in values.items() if value is not None}


def _section(top: TomlSection, name: str, known: tuple[str, ...]) -> TomlSection:
    section = TomlSection(top.values[name], name, top.source, top.findings, file=top.file)
    _refuse_unknown(section, known)
    return section


def _contract(top: TomlSection) -> dict[str, str]:
    section = _section(top, "contract", CONTRACT_KEYS)
    readers = dict.fromkeys(CONTRACT_KEYS, any_text) | {"flight_date": date}
    return _given(section, readers)


def _product(top: TomlSection) -> dict[str, Any]:
    section = _section(top, "product", PRODUCT_KEYS)
    readers: dict[str, Callable[[TomlSection, str], Any]] = {
        key: count if key in _COUNTS else TomlSection.positive
        for key in PRODUCT_KEYS
        if key != "terrain"
    }
    values = _given(section, {**readers, "terrain": one_of("flat", "mountain")})
    lot, sample = values.get("lot_size"), values.get("sample_size")
    if lot is not None and sample is not None and sample > lot:
        section.refuse("sample_size", f"found {sample}, expected at most the lot_size, {lot}")
    return values


def _tables(
    top: TomlSection, name: str, read: Callable[[TomlSection], dict[str, Any]]
) -> list[TableOfFile]:
    """The tables of a list."""
    tables = top.values.get(name, [])
    if not isinstance(tables, list):
        top.refuse(name, f"found {shown(tables)}, expected tables that begin with [[{name}]]")
        return []
    if len(tables) > _MAX_TABLES:
        top.refuse(name, f"found {len(tables)} tables, expected at most {_MAX_TABLES}")
        return []
    sections = [
        TomlSection(table, name, top.source, top.findings, number, file=top.file)
        for number, table in enumerate(tables)
    ]
    return [
        TableOfFile(read(section), section)
        for section, table in zip(sections, tables, strict=True)
        if isinstance(table, dict)  # others are refused as sections
    ]


def _requirement(section: TomlSection) -> dict[str, Any]:
    """The keys of a requirement; limit and threshold as they stand, for want of their unit."""
    _refuse_unknown(section, REQUIREMENT_KEYS)
    if "id" not in section.values:
        section.refuse("id", "found nothing, expected the requirement's id")
    values = _given(
        section,
        {
            "id": identifier,
            "clause": any_text,
            "quantity": one_of(*QUANTITIES),
            "source": filled_text,
            "mandatory": TomlSection.flag,
            "exceeding": one_of("fail", "investigate"),
            "terrain": one_of("flat", "mountain", ANY_TERRAIN),
            "when_given": one_of(*GIVEN_NAMES, ALWAYS),
            "basis_of_score": TomlSection.flag,
        },
    )
    return values | {k: section.values[k] for k in ("limit", "threshold") if k in section.values}


def _statement(section: TomlSection) -> dict[str, Any]:
    _refuse_unknown(section, STATEMENT_KEYS)
    if "component" not in section.values:
        section.refuse("component", "found nothing, expected horizontal or vertical")
    return _given(
        section,
        {
            "component": one_of("horizontal", "vertical"),
            "language": language,
            "least_points": count,
            "tested": wording,
            "tested_with_fewer": wording,
            "produced": wording,
            "rests_on": identifiers,
        },
    )
