"""The examples in the docstrings of the public functions run, and print what they show."""

import doctest
import sys

import pytest
from small_scenario import scenario

import posstats
from posstats.formats.block_folder import write_block
from posstats.synthetic import load_scenario, simulate

FUNCTIONS = sorted(
    name
    for name in posstats.__all__
    if callable(getattr(posstats, name)) and not isinstance(getattr(posstats, name), type)
)


@pytest.fixture(scope="module")
def folder_with_a_block(tmp_path_factory):
    folder = tmp_path_factory.mktemp("examples")
    write_block(simulate(load_scenario(scenario())), folder / "block")
    return folder


def test_every_public_function_has_an_example():
    assert all(">>>" in (getattr(posstats, name).__doc__ or "") for name in FUNCTIONS)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_example_of(name, folder_with_a_block, monkeypatch):
    monkeypatch.chdir(folder_with_a_block)
    function = getattr(posstats, name)
    tests = doctest.DocTestFinder(recurse=False).find(
        function, name, module=sys.modules[function.__module__], globs={}
    )
    runner = doctest.DocTestRunner(optionflags=doctest.REPORT_ONLY_FIRST_FAILURE)
    for each in tests:
        result = runner.run(each)
        assert result.attempted > 0
        assert result.failed == 0
