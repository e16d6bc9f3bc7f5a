"""Profiles and contract files that are refused, and what is said then.

Oracle: the wrong values put in on purpose.
"""

import os
import re
from pathlib import Path

import pytest
from finding_parts import assert_finding
from profile_texts import OWN, findings_of, write

from posstats.acceptance.profile_files import (
    load_profile,
)
from posstats.errors import PosstatsError

R = "[[requirement]]\nid = 'a'\n"


@pytest.mark.parametrize(
    ("text", "where", "found", "expected"),
    [
        ("extend = 'jrc'\n" + OWN, "c.toml:1, extend", "an unknown key", "extends?"),
        ("extends = 3\n" + OWN, "c.toml:1, extends", "3", "text in quotes"),
        ("extends = ''\n" + OWN, "c.toml:1, extends", "''", "text in quotes"),
        ("extends = 'jcr'", "c.toml:1, extends", "no file 'jcr'", "jrc?"),
        ("extends = 'a.toml'", "c.toml:1, extends", "no file 'a.toml'", "one of asprs-2024,"),
        ('extends = "a\\u0000b"', "c.toml:1, extends", "no file 'a\\x00b'", "one of asprs-2024,"),
        (
            f"extends = '{'x' * 5000}'",
            "c.toml:1, extends",
            "no file 'xxxxxxxxxxxxxxxxxxxxx",
            "one of asprs-2024,",
        ),
        ("extends = 'c.toml'", "c.toml:1, extends", "a circle: c.toml ->", ""),
        ("extends = 'jrc'\nomit = ['rmse_x']", "c.toml:2, omit", "'rmse_x'", "rmse_h?"),
        ("omit = ['a']\n", "c.toml:1, omit", "'a', but nothing", ""),
        ("extends = 'jrc'\nomit = 'rmse_h'", "c.toml:2, omit", "'rmse_h'", "a list of"),
        (
            "extends='jrc'\nomit = ['rmse_h','rmse_h']",
            "c.toml:2, omit",
            "'rmse_h' twice",
            "each once",
        ),
        ("name = 'a b'\n" + OWN, "c.toml:1, name", "'a b'", "up to 60 letters,"),
        ("name = 'a'\n", "c.toml:1, name", "no requirement", "[[requirement]] or extends"),
        ("notes = 'a'\n" + OWN, "c.toml:1, notes", "'a'", "a list of"),
        (
            "notes = ['\\u001b']\n".replace("'", '"') + OWN,
            "c.toml:1, notes",
            "the control character",
            "text",
        ),
        ("needs = ['gsd or clas_h']\n" + OWN, "c.toml:1, needs", "'clas_h'", "class_h?"),
        ("scales = [2000.0]\n" + OWN, "c.toml:1, scales", "[2000.0]", "a list of"),
        ("scales = [0]\n" + OWN, "c.toml:1, scales", "[0]", "a list of"),
        ("contract = 'x'\n" + OWN, "c.toml:1, contract", "'x'", "a table of"),
        ("[contract]\nclent = 'x'\n", "c.toml:2, contract.clent", "an unknown key", "client?"),
        ("[contract]\nclient = 7\n", "c.toml:2, contract.client", "7", "text in quotes"),
        (
            '[contract]\nclient = "\\u202e"\n',
            "c.toml:2, contract.client",
            "the control character",
            "text",
        ),
        (
            f"[contract]\nclient = '{'x' * 5001}'",
            "c.toml:2, contract.client",
            "5001 characters",
            "at most 5000",
        ),
        ("[product]\nclass_h = 1\n", "c.toml:2, product.class_h", "an unknown key", "class_h_m?"),
        ("[product]\nclass_h_m = -1\n", "c.toml:2, product.class_h_m", "-1", "a positive number"),
        ("[product]\nclass_h_m = 0\n", "c.toml:2, product.class_h_m", "0", "a positive number"),
        ("[product]\nclass_h_m = nan\n", "c.toml:2, product.class_h_m", "nan", "a positive number"),
        ("[product]\nclass_h_m = inf\n", "c.toml:2, product.class_h_m", "inf", "a positive number"),
        (
            "[product]\nclass_h_m = '10cm'\n",
            "c.toml:2, product.class_h_m",
            "'10cm'",
            "a positive number",
        ),
        ("[product]\ngsd_m = true\n", "c.toml:2, product.gsd_m", "True", "a positive number"),
        (
            "[product]\nmap_scale = '1:2000'\n",
            "c.toml:2, product.map_scale",
            "'1:2000'",
            "a positive number",
        ),
        ("[product]\nlot_size = 2.5\n", "c.toml:2, product.lot_size", "2.5", "a whole number"),
        (
            "[product]\nlot_size = 9\nsample_size = 10",
            "c.toml:3, product.sample_size",
            "10",
            "at most the",
        ),
        (
            "[product]\nterrain = 'hilly'\n",
            "c.toml:2, product.terrain",
            "'hilly'",
            "flat or mountain",
        ),
        ("[product]\nterrain = 3\n", "c.toml:2, product.terrain", "3", "flat or mountain"),
        ("[requirement]\nid = 'a'\n", "c.toml:1, requirement", "{'id': 'a'}", "tables that begin"),
        ("requirement = [3]\n", "c.toml:1, requirement", "3", "a table of"),
        (
            "[[requirement]]\nquantity='rmse_h'\nlimit=1",
            "c.toml:1, requirement.id",
            "nothing",
            "up to 60 letters,",
        ),
        (OWN.replace("'a'", "'<b>a'"), "c.toml:2, requirement.id", "'<b>a'", "up to 60 letters,"),
        (OWN.replace("'a'", "7"), "c.toml:2, requirement.id", "7", "up to 60 letters,"),
        (OWN + OWN, "c.toml:6, requirement.id", "'a' a second", "each id once"),
        (OWN + "limt = 2", "c.toml:5, requirement.limt", "an unknown key", "limit?"),
        (OWN + "source = ' '", "c.toml:5, requirement.source", "' '", "text in quotes"),
        (OWN + "mandatory = 'no'", "c.toml:5, requirement.mandatory", "'no'", "true or false"),
        (
            OWN + "exceeding = 'fial'",
            "c.toml:5, requirement.exceeding",
            "'fial'",
            "fail or investigate;",
        ),
        (OWN + "terrain = 'flt'", "c.toml:5, requirement.terrain", "'flt'", "flat or mountain"),
        (OWN + "when_given = 'class'", "c.toml:5, requirement.when_given", "'class'", "class_v?"),
        (
            OWN + "threshold = 1",
            "c.toml:5, requirement.threshold",
            "one for rmse_h",
            "it for n_blunders_h",
        ),
        (R + "limit = 1", "c.toml:1, requirement.quantity", "nothing", "the quantity of"),
        (R + "quantity = 'rmse_h'", "c.toml:1, requirement.limit", "nothing", "the limit of"),
        (
            R + "quantity = 'rsme_h'\nlimit = 1",
            "c.toml:3, requirement.quantity",
            "'rsme_h'",
            "rmse_h?",
        ),
        (
            R + "quantity = 'n_blunders_h'\nlimit = 0",
            "c.toml:1, requirement.threshold",
            "nothing",
            "the residual (m)",
        ),
        (
            R + "quantity = 'quadrant_share'\nlimit = 10",
            "c.toml:4, requirement.limit",
            "10",
            "at most 0.25 (a",
        ),
        (
            R + "quantity = 'n_check_points'\nlimit = 3\nbasis_of_score = true",
            "c.toml:5, requirement.basis_of_score",
            "true for n_check_points",
            "a quantity that",
        ),
        (
            R + "quantity='rmse_h'\nlimit=0\nbasis_of_score=true",
            "c.toml:5, requirement.basis_of_score",
            "true for rmse_h",
            "a quantity that",
        ),
        (OWN.replace("1", "-1"), "c.toml:4, requirement.limit", "-1", "a number from 0"),
        (OWN.replace("1", "nan"), "c.toml:4, requirement.limit", "nan", "a number from 0"),
        (OWN.replace("1", "true"), "c.toml:4, requirement.limit", "True", "a number or"),
        (
            OWN.replace("1", "'10 cm'"),
            "c.toml:4, requirement.limit",
            "'10 cm': is in",
            "m, which may",
        ),
        (
            OWN.replace("1", "'clas_h'"),
            "c.toml:4, requirement.limit",
            "'clas_h': found an",
            "class_h?",
        ),
        (OWN.replace("1", "'1/0'"), "c.toml:4, requirement.limit", "'1/0': divides by zero", ""),
        (
            OWN.replace("1", "'10**10**10'"),
            "c.toml:4, requirement.limit",
            "'10**10**10': holds more than",
            "",
        ),
        (
            OWN.replace("1", "\"__import__('os')\""),
            "c.toml:4, requirement.limit",
            "\"__import__('os')\": cannot be",
            "numbers, class_h, class_v,",
        ),
        (
            OWN.replace("1", f"0x{'f' * 5000}"),
            "c.toml:4, requirement.limit",
            "a number of",
            "a number from 0",
        ),
        (OWN.replace("1", "1" * 5000), "c.toml", "a number of", ""),
        ("a = " + "[" * 5000, "c.toml", "lists within lists", ""),
        ("name = 'a'\nname = 'b'\n", "c.toml", "no valid TOML:", ""),
        (
            "extends = 'jrc'\n[[requirement]]\nid = 'rmse_hh'\nlimit = 1\n",
            "c.toml:3, requirement.id",
            "'rmse_hh'",
            "rmse_h? (a new",
        ),
        (
            "extends = 'jrc'\n[[requirement]]\nid = 'rmse_h'\nquantity = 'n_check_points'\n",
            "c.toml:2, requirement.limit",
            "nothing",
            "the limit of",
        ),
        (
            "extends = 'jrc'\nomit = ['rmse_h']\n[[requirement]]\nid = 'rmse_h'\nlimit = 1\n",
            "c.toml:4, requirement.id",
            "'rmse_h', which omit",
            "",
        ),
        (
            "extends = 'orthophoto-scale'\nomit = ['rmse_h_flat', 'rmse_h_mountain']\n",
            "c.toml:2, omit",
            "no requirement",
            "[[requirement]] or extends",
        ),
        (
            OWN + "[[statement]]\ntested = 'x'",
            "c.toml:5, statement.component",
            "nothing",
            "horizontal or vertical",
        ),
        (
            OWN + "[[statement]]\ncomponent = 'vertical'\nlanguage = 'Chinese'",
            "c.toml:7, statement.language",
            "'Chinese'",
            "two small letters,",
        ),
        (
            OWN + "[[statement]]\ncomponent = 'vertical'\nrests_on = ['b']",
            "c.toml:7, statement.rests_on",
            "'b'",
            "one of a",
        ),
        (
            OWN + "[[statement]]\ncomponent = 'vertical'\ntested_with_fewer = 'x'",
            "c.toml:5, statement.least_points",
            "1",
            "more: tested_with_fewer is",
        ),
        (
            OWN + "[[statement]]\ncomponent = 'vertical'\n" * 2,
            "c.toml:8, statement.component",
            "vertical and en",
            "",
        ),
        (
            "a." * 15_000 + "a = 1",
            "c.toml:1",
            "a line of 30005",
            "at most 10000",
        ),
        ("".join(f"k{k} = 1\n" for k in range(9000)), "c.toml", "9000 keys", "at most 100"),
        (
            "[contract]\n" + "".join(f"k{k} = 1\n" for k in range(101)),
            "c.toml:1, contract",
            "101 keys",
            "at most 100",
        ),
        (OWN * 201, "c.toml:1, requirement", "201 tables", "at most 200"),
    ],
    ids=lambda value: value if value.startswith("c.toml") else "",
)
def test_a_wrong_value_is_one_finding(tmp_path, text, where, found, expected):
    (finding,) = findings_of(write(tmp_path, c=text))
    assert_finding(finding, where, found, expected)
    assert len(finding) < 700


@pytest.mark.parametrize(
    "wording",
    ["{class_cm.__class__}", "{found_m[0]}", "{found_m!r}", "{found_m:>999999999}", "{}", "{0}",
     "{found", "found}", "{clas_m}"],
)  # fmt: skip
def test_a_wording_holds_plain_placeholders_only(tmp_path, wording):
    text = f"{OWN}[[statement]]\ncomponent = 'vertical'\ntested = '{wording}'\n"
    (finding,) = findings_of(write(tmp_path, c=text))
    assert finding.startswith("c.toml:7, statement.tested: found ")


def test_all_findings_of_all_files_are_collected(tmp_path):
    path = write(
        tmp_path,
        contract="extends = 'base.toml'\nfoo = 1\n[product]\ngsd_m = 'x'\n"
        "[[requirement]]\nid = 'b'\nlimit = 'x'\nquantity = 'rmse_h'\nmandatory = 3\n",
        base=OWN.replace("1", "'1 +'"),
    )
    found = sorted(re.sub(r": found.*", "", finding) for finding in findings_of(path))
    assert found == [
        "base.toml:4, requirement.limit",
        "contract.toml:2, foo",
        "contract.toml:4, product.gsd_m",
        "contract.toml:7, requirement.limit",
        "contract.toml:9, requirement.mandatory",
    ]


def test_a_circle_of_files_is_named(tmp_path):
    path = write(tmp_path, a="extends = 'b.toml'", b="extends = 'c.toml'", c="extends = './a.toml'")
    (finding,) = findings_of(path)
    circle = "a.toml -> b.toml -> c.toml -> a.toml"
    assert_finding(finding, "c.toml:1, extends", f"a circle: {circle}")


def test_a_chain_of_files_ends(tmp_path):
    texts = {f"c{k}": f"extends = 'c{k + 1}.toml'" for k in range(12)}
    path = write(tmp_path, **texts, c12=OWN)
    (finding,) = findings_of(path)
    assert_finding(finding, "c0.toml", "extends more than 10")


def test_files_that_are_no_text_files_are_refused(tmp_path):
    path = tmp_path / "c.toml"
    path.write_bytes(b"name = 'a'\nedition = '\xff\xfe'\n")
    extending = write(tmp_path, d="extends = '.'")
    os.mkfifo(tmp_path / "pipe")
    for refused, where, found, expected in (
        (path, "c.toml:2", "a file that", ""),
        (tmp_path, tmp_path.name, "a folder", "a TOML file"),
        (extending, tmp_path.name, "a folder", "a TOML file"),
        (tmp_path / "pipe", "pipe", "a device or", "a TOML file"),
        (Path("/dev/zero"), "zero", "a device or", "a TOML file"),
    ):
        (finding,) = findings_of(refused)
        assert_finding(finding, where, found, expected)


def test_a_large_file_is_refused_by_its_size(tmp_path):
    path = tmp_path / "large.toml"
    with path.open("wb") as file:
        file.truncate(100_000_000)
    (finding,) = findings_of(path)
    assert_finding(finding, "large.toml", "more than 100000", "fewer")


@pytest.mark.parametrize("name", ["nsdda", "", "none.toml", "../asprs-2024", "a\0b", "x" * 5000])
def test_a_profile_that_is_not_there_is_named(name):
    with pytest.raises(PosstatsError, match="no profile file"):
        load_profile(name)
