"""Compiled kernels: a cache on disk that notices every change; oracle: the values returned."""

import os
import subprocess
import sys
from importlib import import_module
from pkgutil import walk_packages

import pytest
from numba.extending import is_jitted

import posstats

INNER = """
from posstats.numerics.kernels.compiled import inner_kernel

@inner_kernel
def innermost(x):
    return {factor} * x
"""
MIDDLE = """
from innermost import innermost
from posstats.numerics.kernels.compiled import inner_kernel

@inner_kernel
def middle(x):
    return innermost(x) + 1.0
"""
OUTER = """
from middle import middle
from posstats.numerics.kernels.compiled import kernel

@kernel
def outer(x):
    return middle(x)

print(outer(10.0), outer.__name__, outer.__qualname__)
"""


@pytest.fixture
def run(tmp_path):
    """Write the three modules, run the outermost, and tell what it printed and what is cached."""

    def write_and_run(factor, cache="cache"):
        sources = {"innermost": INNER.format(factor=factor), "middle": MIDDLE, "outer": OUTER}
        for name, source in sources.items():
            path = tmp_path / f"{name}.py"
            if not path.exists() or path.read_text() != source:
                path.write_text(source)
        environment = os.environ | {"NUMBA_CACHE_DIR": str(tmp_path / cache)}
        done = subprocess.run(
            [sys.executable, "outer.py"],
            cwd=tmp_path,
            env=environment,
            capture_output=True,
            text=True,
            check=True,
        )
        compiled = {p: p.stat().st_mtime_ns for p in (tmp_path / cache).rglob("*.nbc")}
        return done.stdout.split(), compiled

    return write_and_run


def test_a_kernel_is_compiled_again_when_an_inner_kernel_of_another_file_changes(run):
    first, compiled = run(2.0)
    assert first == ["21.0", "outer", "outer"]
    again, unchanged = run(2.0)
    assert again == first
    assert unchanged == compiled
    assert len(compiled) == 1
    assert run(3.0)[0][0] == "31.0"


def test_without_a_cache_folder_kernels_still_work(run, tmp_path):
    (tmp_path / "file").write_text("")
    assert run(2.0, cache="file/below")[0][0] == "21.0"


def test_no_inner_function_stays_apart_from_its_kernel():
    """Otherwise the run that compiles and a run from the cache differ in the last digits."""
    modules = [
        import_module(found.name)
        for found in walk_packages(posstats.__path__, "posstats.")
        if found.name.startswith(("posstats.numerics", "posstats.geometry"))
    ]
    inner = {
        value
        for module in modules
        for value in vars(module).values()
        if is_jitted(value) and value.targetoptions.get("no_cpython_wrapper")
    }
    assert len(inner) > 10
    assert all(function.targetoptions.get("forceinline") for function in inner)
