"""The house: imports go down only, drawing stays in the reports, the command starts light."""

import ast
import subprocess
import sys
from collections.abc import Iterator
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from helpers import ROOT

FLOORS = {
    "posstats.errors": 0,
    "posstats.version": 0,
    "posstats.arrays": 0,
    "posstats.contract": 1,
    "posstats.settings": 2,
    "posstats.statistics": 3,
    "posstats.numerics.kernels": 1,
    "posstats.numerics.solvers": 2,
    "posstats.numerics.bundle": 3,
    "posstats.block": 4,
    "posstats.geometry.ground": 5,
    "posstats.geometry.stereo": 5,
    "posstats.geometry.coplanarity": 5,
    "posstats.formats": 6,
    "posstats.adjustment": 7,
    "posstats.acceptance": 7,
    "posstats.synthetic": 7,
    "posstats.analysis": 8,
    "posstats.papers": 8,
    "posstats.papers.drift": 9,
    "posstats.papers.wucaps": 9,
    "posstats.reports.document": 10,
    "posstats.reports.output": 10,
    "posstats.reports.typefaces": 11,
    "posstats.reports.figures": 12,
    "posstats.reports.pages": 12,
    "posstats.reports.archive": 13,
    "posstats.reports.block": 14,
    "posstats.reports.adjustment": 15,
    "posstats.reports.acceptance": 15,
    "posstats.reports.verification": 15,
    "posstats.reports.papers": 15,
    "posstats.reports.papers.drift": 16,
    "posstats.reports.papers.wucaps": 16,
    "posstats.reports.commands": 17,
}
"""Every room that holds code: packages, and the modules that lie at the top of `posstats`."""

FACE = "posstats"
NUMBERS = ("posstats.numerics", "posstats.statistics")
"""Rooms that know arrays and not blocks, with what they may stand on:"""
GROUND = ("posstats.arrays", "posstats.errors")
DRAWING = ("matplotlib", "jinja2", "weasyprint", "pikepdf", "fontTools", "babel", "click", "rich")
MOST_ROOMS = 12
NO_ROOMS = {"__init__", "__pycache__", "arrays", "errors", "locale", "settings", "version"}


def module_name(path: Path) -> str:
    """Name at run time: `reports` is a package of `posstats`."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    parts = parts[:-1] if parts[-1] == "__init__" else parts
    return ".".join(parts if parts[0] == FACE else (FACE, *parts))


FILES = {
    module_name(path): path
    for folder in ("posstats", "reports")
    for path in sorted((ROOT / folder).rglob("*.py"))
}


def room(name: str) -> str:
    """The package that a module lies in; a module at the top of `posstats` is its own."""
    is_package = FILES[name].stem == "__init__"
    package = name if is_package else name.rpartition(".")[0]
    return name if package == FACE else package


def imported(name: str) -> set[str]:
    """Names imported by a module at run time: those under TYPE_CHECKING do not count."""
    tree = ast.parse(FILES[name].read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            node.body = []
    return {each for node in ast.walk(tree) for each in imported_by(node, name)}


def imported_by(node: ast.AST, name: str) -> Iterator[str]:
    """What one statement of a module imports: modules where they are ours, else whole paths."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        package = name if FILES[name].stem == "__init__" else name.rpartition(".")[0]
        above = ".".join(package.split(".")[: 1 - node.level or None]) if node.level else ""
        source = ".".join(filter(None, (above, node.module)))
        for alias in node.names:
            inner = f"{source}.{alias.name}"
            yield inner if inner in FILES else source


IMPORTS = {name: imported(name) for name in FILES}
INSIDE = sorted(IMPORTS.keys() - {FACE})
OURS = {name: (found & FILES.keys()) - {name} for name, found in IMPORTS.items()}


def within(name: str, rooms: tuple[str, ...]) -> bool:
    return name.startswith(tuple(f"{each}." for each in rooms)) or name in rooms


def test_every_room_has_a_floor():
    packages = {room(name) for name in FILES}
    holders = {name for name in packages if not OURS[name] and FILES[name].stem == "__init__"}
    with_code = {room(name) for name in FILES if FILES[name].stem != "__init__"}
    assert with_code <= FLOORS.keys() <= packages
    assert packages - FLOORS.keys() - {FACE} <= holders  # packages of packages


def test_imports_go_down():
    up = [
        (name, target)
        for name in INSIDE
        for target in OURS[name]
        if room(target) != room(name) and FLOORS[room(target)] >= FLOORS[room(name)]
    ]
    assert not up


def test_no_files_and_no_rooms_import_in_a_circle():
    # an import of a module runs its package first, which may import the module: no circle
    files = {name: found - {name.rpartition(".")[0]} for name, found in OURS.items()}
    rooms: dict[str, set[str]] = {}
    for name, found in OURS.items():
        rooms.setdefault(room(name), set()).update(map(room, found))
    for name, found in rooms.items():
        found.discard(name)
    assert list(TopologicalSorter(files).static_order())
    assert list(TopologicalSorter(rooms).static_order())


def test_kernels_solvers_statistics_and_the_bundle_know_no_block():
    numbers = [name for name in FILES if within(name, NUMBERS)]
    assert not [
        (name, each)
        for name in numbers
        for each in OURS[name]
        if not within(each, (*NUMBERS, *GROUND))
    ]


def test_nobody_inside_imports_the_face():
    assert not [name for name in INSIDE if FACE in IMPORTS[name]]


def test_numbers_know_nothing_of_pages():
    above = ("posstats.reports", "posstats.templates", "reports", "templates", *DRAWING)
    below = [name for name in FILES if not within(name, ("posstats.reports",))]
    assert not [(name, each) for name in below for each in IMPORTS[name] if within(each, above)]


@pytest.mark.parametrize("folder", ["posstats", "reports"])
def test_a_newcomer_sees_few_rooms(folder):
    inside = {path.stem for path in (ROOT / folder).iterdir() if path.suffix in ("", ".py")}
    assert len(inside - NO_ROOMS) <= MOST_ROOMS


def test_the_command_starts_without_the_heavy_libraries():
    code = "import sys, posstats.reports.commands.cli; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.split()
    heavy = {"numpy", "scipy", "pandas", "numba", "matplotlib", "statsmodels", "babel", "msgspec"}
    assert not heavy & set(loaded)
