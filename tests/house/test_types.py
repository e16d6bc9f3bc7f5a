"""Types of the reports: `Any` stands at the edges of untyped libraries and nowhere else."""

import ast
from pathlib import Path

from helpers import ROOT

EDGES = {
    "archive/mending.py": "objects of pydyf, which has no types",
    "archive/signing.py": "objects of pyHanko, which has no types",
    "archive/writing.py": "modules of WeasyPrint, imported late, and its attachments",
    "block/line_figures.py": "looks and legend handles of matplotlib",
    "block/parallax.py": "looks: keyword arguments of matplotlib",
    "figures/plan_view.py": "looks: keyword arguments of matplotlib",
    "figures/style.py": "looks and settings of matplotlib",
    "pages/pdf.py": "modules of WeasyPrint, imported late",
    "verification/signature.py": "objects of pyHanko, which has no types",
}
"""Files of `reports/` that hand values of untyped libraries on, with what these are."""


def uses(path: Path) -> int:
    """How often a file says `Any`, its import apart."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    return sum(isinstance(node, ast.Name) and node.id == "Any" for node in ast.walk(tree))


def test_any_stands_at_the_edges_of_untyped_libraries_only():
    reports = ROOT / "reports"
    found = {str(path.relative_to(reports)): uses(path) for path in reports.rglob("*.py")}
    loose = {name: n for name, n in found.items() if n and name not in EDGES}
    stale = {name for name in EDGES if not found.get(name)}
    assert not loose
    assert not stale
