"""The kept mutants fit the source that they change."""

import importlib.util
import sys

import pytest
from helpers import ROOT


def load():
    file = ROOT / "benchmarks" / "mutants.py"
    spec = importlib.util.spec_from_file_location("mutants", file)
    module = importlib.util.module_from_spec(spec)
    sys.modules["mutants"] = module  # its dataclass looks there
    spec.loader.exec_module(module)
    return module


mutants = load()
KEPT = mutants.read()


@pytest.mark.parametrize("mutant", KEPT, ids=lambda mutant: mutant.name)
def test_the_text_of_a_mutant_is_found_once_and_its_tests_exist(mutant):
    assert mutant.count() == 1
    assert mutant.old != mutant.new
    assert mutant.tests
    assert all((ROOT / test.partition("::")[0]).exists() for test in mutant.tests)


def test_names_are_told_apart():
    assert len({mutant.name for mutant in KEPT}) == len(KEPT)


def test_a_mutant_is_put_into_the_copy_only(tmp_path):
    """And what was compiled of the file is gone there, so that nothing runs without the mutant."""
    mutant = KEPT[0]
    before = (ROOT / mutant.file).read_text()
    copy = tmp_path / mutant.file
    compiled = copy.parent / "__pycache__" / f"{copy.stem}.kernel-1.nbi"
    compiled.parent.mkdir(parents=True)
    compiled.write_text("")
    copy.write_text(before)
    mutant.put_into(tmp_path)
    assert copy.read_text() == before.replace(mutant.old, mutant.new)
    assert not compiled.exists()
    assert (ROOT / mutant.file).read_text() == before
