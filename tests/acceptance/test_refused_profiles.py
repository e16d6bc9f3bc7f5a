"""Profiles and contract files that are refused, and what is said then.

Oracle: the wrong values put in on purpose.
"""

import os
import re

import pytest
from profile_texts import OWN, findings_of, write

from posstats.acceptance.profile_files import (
    load_profile,
)
from posstats.errors import PosstatsError

R = "[[requirement]]\nid = 'a'\n"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("extend = 'jrc'\n" + OWN, "c.toml:1, extend: found an unknown key, expected extends?"),
        ("extends = 3\n" + OWN, "c.toml:1, extends: found 3, expected text in quotes"),
        ("extends = ''\n" + OWN, "c.toml:1, extends: found '', expected text in quotes"),
        ("extends = 'jcr'", "c.toml:1, extends: found no file 'jcr' and no profile, expected jrc?"),
        ("extends = 'a.toml'", "c.toml:1, extends: found no file 'a.toml' and no profile"),
        ('extends = "a\\u0000b"', "c.toml:1, extends: found no file 'a\\x00b' and no profile"),
        (f"extends = '{'x' * 5000}'", "c.toml:1, extends: found no file 'xxx"),
        ("extends = '.'", "found a folder, expected a TOML file"),
        ("extends = 'c.toml'", "c.toml:1, extends: found a circle: c.toml -> c.toml"),
        ("extends = 'jrc'\nomit = ['rmse_x']", "c.toml:2, omit: found 'rmse_x', expected rmse_h?"),
        ("omit = ['a']\n", "c.toml:1, omit: found 'a', but nothing that is extended"),
        ("extends = 'jrc'\nomit = 'rmse_h'", "c.toml:2, omit: found 'rmse_h', expected a list"),
        ("extends='jrc'\nomit = ['rmse_h','rmse_h']", "c.toml:2, omit: found 'rmse_h' twice"),
        ("name = 'a b'\n" + OWN, "c.toml:1, name: found 'a b', expected up to 60 letters"),
        ("name = 'a'\n", "c.toml:1, name: found no requirement, expected [[requirement]] or ext"),
        ("notes = 'a'\n" + OWN, "c.toml:1, notes: found 'a', expected a list of texts"),
        ("notes = ['\\u001b']\n".replace("'", '"') + OWN, "c.toml:1, notes: found the control"),
        ("needs = ['gsd or clas_h']\n" + OWN, "c.toml:1, needs: found 'clas_h', expected class_h?"),
        ("scales = [2000.0]\n" + OWN, "c.toml:1, scales: found [2000.0], expected a list of den"),
        ("scales = [0]\n" + OWN, "c.toml:1, scales: found [0], expected a list of denominators"),
        ("contract = 'x'\n" + OWN, "c.toml:1, contract: found 'x', expected a table"),
        ("[contract]\nclent = 'x'\n", "c.toml:2, contract.clent: found an unknown key, expected"),
        ("[contract]\nclient = 7\n", "c.toml:2, contract.client: found 7, expected text in quotes"),
        ('[contract]\nclient = "\\u202e"\n', "c.toml:2, contract.client: found the control char"),
        (f"[contract]\nclient = '{'x' * 5001}'", "c.toml:2, contract.client: found 5001 charact"),
        ("[product]\nclass_h = 1\n", "c.toml:2, product.class_h: found an unknown key, expected"),
        ("[product]\nclass_h_m = -1\n", "c.toml:2, product.class_h_m: found -1, expected a pos"),
        ("[product]\nclass_h_m = 0\n", "c.toml:2, product.class_h_m: found 0, expected a pos"),
        ("[product]\nclass_h_m = nan\n", "c.toml:2, product.class_h_m: found nan, expected a pos"),
        ("[product]\nclass_h_m = inf\n", "c.toml:2, product.class_h_m: found inf, expected a pos"),
        ("[product]\nclass_h_m = '10cm'\n", "c.toml:2, product.class_h_m: found '10cm', expected"),
        ("[product]\ngsd_m = true\n", "c.toml:2, product.gsd_m: found True, expected a positive"),
        ("[product]\nmap_scale = '1:2000'\n", "c.toml:2, product.map_scale: found '1:2000'"),
        ("[product]\nlot_size = 2.5\n", "c.toml:2, product.lot_size: found 2.5, expected a whole"),
        ("[product]\nlot_size = 9\nsample_size = 10", "c.toml:3, product.sample_size: found 10, "),
        ("[product]\nterrain = 'hilly'\n", "c.toml:2, product.terrain: found 'hilly', expected "),
        ("[product]\nterrain = 3\n", "c.toml:2, product.terrain: found 3, expected flat or mount"),
        ("[requirement]\nid = 'a'\n", "c.toml:1, requirement: found {'id': 'a'}, expected tables"),
        ("requirement = [3]\n", "c.toml:1, requirement: found 3, expected a table"),
        ("[[requirement]]\nquantity='rmse_h'\nlimit=1", "c.toml:1, requirement.id: found nothing"),
        (OWN.replace("'a'", "'<b>a'"), "c.toml:2, requirement.id: found '<b>a', expected up to"),
        (OWN.replace("'a'", "7"), "c.toml:2, requirement.id: found 7, expected up to 60"),
        (OWN + OWN, "c.toml:6, requirement.id: found 'a' a second time, expected each id once"),
        (OWN + "limt = 2", "c.toml:5, requirement.limt: found an unknown key, expected limit?"),
        (OWN + "source = ' '", "c.toml:5, requirement.source: found ' ', expected text in quotes"),
        (OWN + "mandatory = 'no'", "c.toml:5, requirement.mandatory: found 'no', expected true or"),
        (OWN + "exceeding = 'fial'", "c.toml:5, requirement.exceeding: found 'fial', expected "),
        (OWN + "terrain = 'flt'", "c.toml:5, requirement.terrain: found 'flt', expected flat or "),
        (OWN + "when_given = 'class'", "c.toml:5, requirement.when_given: found 'class', expected"),
        (OWN + "threshold = 1", "c.toml:5, requirement.threshold: found one for rmse_h, expected "),
        (R + "limit = 1", "c.toml:1, requirement.quantity: found nothing, expected the quantity"),
        (R + "quantity = 'rmse_h'", "c.toml:1, requirement.limit: found nothing, expected the lim"),
        (R + "quantity = 'rsme_h'\nlimit = 1", "c.toml:3, requirement.quantity: found 'rsme_h', "),
        (R + "quantity = 'n_blunders_h'\nlimit = 0", "c.toml:1, requirement.threshold: found noth"),
        (R + "quantity = 'quadrant_share'\nlimit = 10", "c.toml:4, requirement.limit: found 10, e"),
        (
            R + "quantity = 'n_check_points'\nlimit = 3\nbasis_of_score = true",
            "c.toml:5, requirement.basis_of_score: found true for n_check_points, expected a quan",
        ),
        (R + "quantity='rmse_h'\nlimit=0\nbasis_of_score=true", "c.toml:5, requirement.basis_of"),
        (OWN.replace("1", "-1"), "c.toml:4, requirement.limit: found -1: expected a number from 0"),
        (OWN.replace("1", "nan"), "c.toml:4, requirement.limit: found nan: expected a number fr"),
        (OWN.replace("1", "true"), "c.toml:4, requirement.limit: found True: expected a number or"),
        (OWN.replace("1", "'10 cm'"), "c.toml:4, requirement.limit: found '10 cm': is in cm, exp"),
        (OWN.replace("1", "'clas_h'"), "c.toml:4, requirement.limit: found 'clas_h': found an unk"),
        (OWN.replace("1", "'1/0'"), "c.toml:4, requirement.limit: found '1/0': divides by zero"),
        (OWN.replace("1", "'10**10**10'"), "c.toml:4, requirement.limit: found '10**10**10': hol"),
        (OWN.replace("1", "\"__import__('os')\""), 'c.toml:4, requirement.limit: found "__import'),
        (OWN.replace("1", f"0x{'f' * 5000}"), "c.toml:4, requirement.limit: found a number of th"),
        (OWN.replace("1", "1" * 5000), "c.toml: found a number of thousands of digits"),
        ("a = " + "[" * 5000, "c.toml: found lists within lists beyond all measure"),
        ("name = 'a'\nname = 'b'\n", "c.toml: found no valid TOML: Cannot overwrite a value"),
        (
            "extends = 'jrc'\n[[requirement]]\nid = 'rmse_hh'\nlimit = 1\n",
            "c.toml:3, requirement.id: found 'rmse_hh', expected rmse_h? (a new one needs quantity",
        ),
        (
            "extends = 'jrc'\n[[requirement]]\nid = 'rmse_h'\nquantity = 'n_check_points'\n",
            "c.toml:2, requirement.limit: found nothing, expected the limit of 'rmse_h'",
        ),
        (
            "extends = 'jrc'\nomit = ['rmse_h']\n[[requirement]]\nid = 'rmse_h'\nlimit = 1\n",
            "c.toml:4, requirement.id: found 'rmse_h', which omit leaves out",
        ),
        (
            "extends = 'orthophoto-scale'\nomit = ['rmse_h_flat', 'rmse_h_mountain']\n",
            "c.toml:2, omit: found no requirement, expected [[requirement]] or extends",
        ),
        (OWN + "[[statement]]\ntested = 'x'", "c.toml:5, statement.component: found nothing, exp"),
        (
            OWN + "[[statement]]\ncomponent = 'vertical'\nlanguage = 'Chinese'",
            "c.toml:7, statement.language: found 'Chinese', expected two small letters",
        ),
        (
            OWN + "[[statement]]\ncomponent = 'vertical'\nrests_on = ['b']",
            "c.toml:7, statement.rests_on: found 'b', expected one of a",
        ),
        (
            OWN + "[[statement]]\ncomponent = 'vertical'\ntested_with_fewer = 'x'",
            "c.toml:5, statement.least_points: found 1, expected more: tested_with_fewer is given",
        ),
        (
            OWN + "[[statement]]\ncomponent = 'vertical'\n" * 2,
            "c.toml:8, statement.component: found vertical and en a second time",
        ),
        (
            "a." * 15_000 + "a = 1",
            "c.toml:1: found a line of 30005 characters, expected at most 10",
        ),
        ("".join(f"k{k} = 1\n" for k in range(9000)), "c.toml: found 9000 keys, expected at most"),
        ("[contract]\n" + "".join(f"k{k} = 1\n" for k in range(101)), "c.toml:1, contract: found "),
        (OWN * 201, "c.toml:1, requirement: found 201 tables, expected at most 200"),
    ],
    ids=lambda value: value[:40] if value.startswith("c.toml") else "",
)
def test_a_wrong_value_is_one_finding(tmp_path, text, expected):
    (finding,) = findings_of(write(tmp_path, c=text))
    assert expected in finding
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
    assert finding == ("c.toml:1, extends: found a circle: a.toml -> b.toml -> c.toml -> a.toml")


def test_a_chain_of_files_ends(tmp_path):
    texts = {f"c{k}": f"extends = 'c{k + 1}.toml'" for k in range(12)}
    path = write(tmp_path, **texts, c12=OWN)
    assert findings_of(path) == ["c0.toml: extends more than 10 files"]


def test_files_that_are_no_text_files_are_refused(tmp_path):
    path = tmp_path / "c.toml"
    path.write_bytes(b"name = 'a'\nedition = '\xff\xfe'\n")
    assert findings_of(path) == ["c.toml:2: found a file that is not UTF-8 text"]
    assert findings_of(tmp_path)[0].endswith("found a folder, expected a TOML file")
    os.mkfifo(tmp_path / "pipe")
    assert findings_of(tmp_path / "pipe") == ["pipe: found a device or pipe, expected a TOML file"]
    assert findings_of("/dev/zero") == ["zero: found a device or pipe, expected a TOML file"]


def test_a_large_file_is_refused_by_its_size(tmp_path):
    path = tmp_path / "large.toml"
    with path.open("wb") as file:
        file.truncate(100_000_000)
    assert findings_of(path) == ["large.toml: found more than 100000 bytes, expected fewer"]


@pytest.mark.parametrize("name", ["nsdda", "", "none.toml", "../asprs-2024", "a\0b", "x" * 5000])
def test_a_profile_that_is_not_there_is_named(name):
    with pytest.raises(PosstatsError, match=r"no profile file '.*, and no profile of that"):
        load_profile(name)
