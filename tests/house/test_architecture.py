"""The house: imports go down only, drawing stays in the reports, the command starts light."""

import ast
import subprocess
import sys
from graphlib import TopologicalSorter
from pathlib import Path

import pytest
from helpers import ROOT

PACKAGE = sorted((ROOT / "posstats").rglob("*.py"))
KERNELS = (
    "block_tridiagonal",
    "bundle.point_groups",
    "bundle.normals",
    "bundle.point_normals",
    "bundle.ground_points",
    "bundle.precision",
    "bundle.rays",
    "collinearity",
    "coplanarity",
    "coplanarity_normals",
    "image_levels",
    "kernel_algebra",
    "least_squares",
    "pair_adjustment",
    "pair_blunders",
    "pair_equations",
    "reml",
)


def module_name(path: Path) -> str:
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported(path: Path) -> set[str]:
    """Modules imported at run time: those under TYPE_CHECKING do not count."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            node.body = []
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return names


def test_no_module_of_the_package_imports_in_a_circle():
    names = {module_name(path) for path in PACKAGE}
    graph = {
        module_name(path): (imported(path) & names) - {"posstats"}
        for path in PACKAGE
        if module_name(path) != "posstats"
    }
    # an import of a module runs its package first, which may import the module: no circle
    for name, targets in graph.items():
        targets.discard(name.rpartition(".")[0])
    assert list(TopologicalSorter(graph).static_order())


@pytest.mark.parametrize("path", PACKAGE, ids=module_name)
def test_numbers_know_nothing_of_pages(path):
    above = ("reports", "posstats.reports", "templates", "posstats.templates")
    drawing = ("matplotlib", "jinja2", "weasyprint", "click", "rich")
    assert not [name for name in imported(path) if name.startswith((*above, *drawing))]


@pytest.mark.parametrize("name", KERNELS)
def test_kernels_know_arrays_and_not_blocks(name):
    known = imported(ROOT.joinpath("posstats", *name.split(".")).with_suffix(".py"))
    allowed = {f"posstats.{each}" for each in ("compiled", "errors", *KERNELS)}
    ours = {each for each in known if each.startswith("posstats.")}
    assert not {each for each in ours if not {each, each.rpartition(".")[0]} & allowed}


def test_the_command_starts_without_the_heavy_libraries():
    code = "import sys, posstats.reports.commands.cli; print(*sys.modules)"
    loaded = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True
    ).stdout.split()
    assert not {"numpy", "pandas", "numba", "matplotlib", "statsmodels"} & set(loaded)
