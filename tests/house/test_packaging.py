"""The wheel: one import name, with every data file, and nothing else."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest
from helpers import ROOT
from small_scenario import small_block

from posstats.formats.block_folder import write_block

SHIPPED = ("posstats", "reports", "templates", "pyproject.toml", "README.md", "LICENSE")
SUFFIXES = {".py", ".toml", ".csv", ".j2", ".css", ".po", ".typed"}


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    """Built from a copy, so that no stale build folder is shipped and the tree stays clean."""
    source = tmp_path_factory.mktemp("source")
    for name in SHIPPED:
        place = ROOT / name
        if place.is_dir():
            shutil.copytree(place, source / name, ignore=shutil.ignore_patterns("__pycache__"))
        else:
            shutil.copy(place, source)
    subprocess.run(
        [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", source, source],
        check=True,
        capture_output=True,
    )
    return next(source.glob("*.whl"))


def test_the_wheel_has_one_import_name(wheel):
    names = zipfile.ZipFile(wheel).namelist()
    assert {name.split("/")[0].split("-")[0] for name in names} == {"posstats"}
    assert not [name for name in names if "tests/" in name or "/test_" in name]


def test_the_wheel_holds_every_file_of_the_package(wheel):
    shipped = set(zipfile.ZipFile(wheel).namelist())
    places = {
        "posstats": "posstats",
        "reports": "posstats/reports",
        "templates": "posstats/templates",
    }
    for folder, place in places.items():
        for path in (ROOT / folder).rglob("*"):
            if path.is_file() and path.suffix in SUFFIXES:
                assert f"{place}/{path.relative_to(ROOT / folder)}" in shipped


def test_the_installed_wheel_simulates_and_reports_without_its_repository(wheel, tmp_path):
    """Kernels run as they are written: to compile them once more would take minutes."""
    zipfile.ZipFile(wheel).extractall(tmp_path / "site")
    few = {"flight": {"n_strips": 2, "images_per_strip": 4}, "tie_points": {"per_model": 12}}
    write_block(small_block(**few), tmp_path / "block")
    run = (
        "import sys, posstats; from posstats.reports.commands.cli import cli; "
        "assert 'site' in posstats.__file__; cli(sys.argv[1:])"
    )
    environment = os.environ | {"PYTHONPATH": str(tmp_path / "site"), "NUMBA_DISABLE_JIT": "1"}
    for arguments in (
        ["simulate", "--scenario", "area1-small", "--out", "area"],
        ["analyse", "block", "--out", "out", "--no-pdf", "--rules", "strict"],
    ):
        subprocess.run(
            [sys.executable, "-c", run, *arguments],
            cwd=tmp_path,
            env=environment,
            check=True,
            capture_output=True,
        )
    assert (tmp_path / "out" / "report.html").stat().st_size > 10_000
