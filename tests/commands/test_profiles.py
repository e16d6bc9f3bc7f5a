"""`posstats profiles` lists profiles and prints them with their sources."""

import string

import pytest
from click.testing import CliRunner
from finding_parts import assert_finding
from profile_texts import OWN, documented_contract, write

from posstats.acceptance.profile_files import (
    load_profile,
    profile_names,
)
from posstats.reports.commands.cli import cli


def run(*arguments):
    return CliRunner().invoke(cli, ["profiles", *map(str, arguments)])


def test_the_command_lists_the_profiles():
    lines = run().output.splitlines()
    assert [line.split()[0] for line in lines] == list(profile_names())
    assert all(load_profile(line.split()[0]).title in line for line in lines)


@pytest.mark.parametrize("name", profile_names())
def test_the_command_prints_a_profile_with_its_sources(name):
    profile = load_profile(name)
    output = run(name).output
    flat = " ".join(output.split())
    for requirement in profile.requirements:
        assert requirement.id in flat
        assert requirement.limit.text in flat
        assert requirement.source in flat
    assert all(note in flat for note in (*profile.notes, profile.source, profile.edition))
    assert all(statement.tested in flat for statement in profile.statements)
    assert max(map(len, output.splitlines())) <= 100
    assert set(output) <= set(string.printable)


def test_the_command_says_what_a_contract_changes(tmp_path):
    assert "omitted: n_blunders_v" in run(documented_contract(tmp_path)).output
    changed = "[[requirement]]\nid = 'product_rmse_h'\nlimit = '2 * class_h'\n"
    output = run(write(tmp_path, changed=f"extends = 'asprs-2024'\n{changed}")).output
    assert any("withheld" in line and "product_rmse_h" in line for line in output.splitlines())


def test_the_command_refuses_a_bad_file_without_a_traceback(tmp_path):
    result = run(write(tmp_path, c="nam = 'x'\n" + OWN))
    assert result.exit_code == 1
    error, finding = result.output.removesuffix("\n").split(": ", 1)
    assert error == "Error"
    assert_finding(finding, "c.toml:1, nam", "an unknown key", "name?")
