"""Profiles and contract files: the standards' numbers, what contracts change, what is refused.

Oracle: the verified numbers of the standards, and the wrong values put in on purpose.
"""

import os
import re
import string
import time

import pytest
from click.testing import CliRunner
from helpers import ROOT

from posstats.acceptance import profile_reading as reading
from posstats.acceptance.product import Product
from posstats.acceptance.profile_files import (
    ProfileFormatError,
    load_contract,
    load_profile,
    profile_names,
    profile_of_files,
)
from posstats.acceptance.profile_values import PLACEHOLDERS
from posstats.acceptance.quantity_names import COUNTED_BEYOND, QUANTITIES
from posstats.errors import PosstatsError
from posstats.reports.commands.cli import cli

DOCS = ROOT / "docs"
OWN = "[[requirement]]\nid = 'a'\nquantity = 'rmse_h'\nlimit = 1\n"


def limits(name, **product):
    """Limit, and threshold if there is one, of every requirement that applies to a product."""
    stated = Product(**product)
    profile = load_profile(name)
    assert profile.product_findings(stated) == ()
    return {
        each.id: each.limit.evaluate(stated)
        if each.threshold is None
        else (each.limit.evaluate(stated), each.threshold.evaluate(stated))
        for each in profile.requirements_for(stated)
    }


def write(folder, **texts):
    for name, text in texts.items():
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    return folder / f"{next(iter(texts))}.toml"


def findings_of(path, **options):
    with pytest.raises(ProfileFormatError) as caught:
        load_contract(path, **options)
    return list(caught.value.findings)


def run(*arguments):
    return CliRunner().invoke(cli, ["profiles", *map(str, arguments)])


def test_the_profiles_are_known_by_name():
    assert profile_names() == ("asprs-2024", "gbt-24356", "jrc", "nssda", "orthophoto-scale")


@pytest.mark.parametrize("name", profile_names())
def test_a_profile_cites_every_number(name):
    profile = load_profile(name)
    assert profile.name == name
    assert all((profile.edition, profile.title, profile.source, profile.notes, profile.needs))
    assert (profile.changed, profile.added, profile.omitted) == ((), (), ())
    (file,) = profile.files
    tables = file.content.decode().split("[[requirement]]")[1:]
    assert len(tables) == len(profile.requirements)
    assert all('\nsource = "' in table for table in tables)
    for each in profile.requirements:
        assert each.measured is QUANTITIES[each.quantity]
        assert (each.threshold is not None) == (each.quantity in COUNTED_BEYOND)


def test_asprs_demands_what_edition_2_says():
    found = limits("asprs-2024", class_h_m=0.1, class_v_m=0.2)
    assert found == {
        "product_rmse_h": 0.1,
        "product_rmse_v": 0.2,
        "mean_error_h": 0.025,
        "mean_error_v": 0.05,
        "n_check_points": 30.0,
        "survey_h": 0.05,
        "survey_v": 0.1,
        "n_blunders_h": pytest.approx((0.0, 0.3)),
        "n_blunders_v": pytest.approx((0.0, 0.6)),
    }
    profile = load_profile("asprs-2024")
    by_id = {each.id: each for each in profile.requirements}
    assert by_id["product_rmse_h"].clause == "7.11"
    assert by_id["mean_error_v"].clause == "7.2"
    investigated = {each.id for each in profile.requirements if each.exceeding == "investigate"}
    assert investigated == {
        *("mean_error_h", "mean_error_v", "n_check_points", "n_blunders_h", "n_blunders_v")
    }
    optional = {each.id for each in profile.requirements if not each.mandatory}
    assert optional == {"mean_error_h", "mean_error_v", "n_check_points"}


def test_asprs_judges_a_horizontal_product_by_its_horizontal_class_alone():
    found = limits("asprs-2024", class_h_m=0.1)
    assert set(found) == {
        *("product_rmse_h", "mean_error_h", "n_check_points", "survey_h", "n_blunders_h")
    }
    (finding,) = load_profile("asprs-2024").product_findings(Product(gsd_m=0.1))
    assert finding == "profile asprs-2024 needs class_h or class_v of the product"


def test_the_statement_of_asprs_is_the_quoted_one():
    """Oracle: 7.16 as quoted, with its blanks as __."""
    quoted = (
        "This data set was tested to meet ASPRS Positional Accuracy Standards for Digital "
        "Geospatial Data, Edition 2, Version 2 (2024) for a __(cm) RMSE_H Horizontal Positional "
        "Accuracy Class. The tested horizontal positional accuracy was found to be "
        "RMSE_H = __(cm)."
    )
    profile = load_profile("asprs-2024")
    statement = profile.statement("horizontal")
    blank = statement.tested.format(class_cm="__", found_cm="__")
    assert blank.replace(" (cm)", "(cm)") == quoted
    assert statement.least_points == 30
    fewer = statement.tested_with_fewer.format(n_points="__", found_cm="__")
    for part in (
        " was tested as required by ",
        "Although the Standards call for a minimum of thirty (30) checkpoints, this test was "
        "performed using ONLY __ checkpoints",
    ):
        assert part in fewer
    assert " was produced to meet " in statement.produced
    vertical = profile.statement("vertical", "zh")  # no Chinese wording: the English one
    turned = vertical.tested.replace("RMSE_V", "RMSE_H").replace("ertical", "orizontal")
    assert turned.replace("Vorizontal", "Horizontal").replace("vorizontal", "horizontal") == (
        statement.tested
    )


@pytest.mark.parametrize("name", profile_names())
def test_statements_can_be_filled_in(name):
    numbers = dict.fromkeys(PLACEHOLDERS, "7")
    for each in load_profile(name).statements:
        for text in (each.tested, each.tested_with_fewer, each.produced):
            assert "{" not in text.format(**numbers)
            assert "_ " not in text


def test_nssda_needs_20_points_and_states_at_95_per_cent():
    found = limits("nssda", class_h_m=1.0, class_v_m=0.5)
    assert found == {"accuracy_h_95": 1.0, "accuracy_v_95": 0.5, "n_check_points": 20.0}
    profile = load_profile("nssda")
    statement = profile.statement("horizontal").tested
    assert statement.format(found_m="__") == (
        "Tested __ meters horizontal accuracy at 95% confidence level"
    )
    assert "sets no threshold" in profile.requirements[0].source
    assert profile.requirements[2].mandatory


def test_gbt_scores_what_is_limited_and_counts_beyond_twice_the_limit():
    found = limits("gbt-24356", class_h_m=0.5, class_v_m=0.3, lot_size=60)
    assert found == {
        "rmse_h": 0.5,
        "rmse_v": 0.3,
        "n_blunders_h": (0.0, 1.0),
        "n_blunders_v": (0.0, 0.6),
        "sample_size": 7.0,
    }
    profile = load_profile("gbt-24356")
    scored = {each.id for each in profile.requirements if each.basis_of_score}
    assert scored == {"rmse_h", "rmse_v"}
    assert profile.product_findings(Product(class_h_m=0.5)) == ()  # no lot: not assessed


def test_orthophotos_are_judged_by_scale_and_terrain():
    """Oracle: the table of 1:2000, 1:5000, 1:10000, flat and mountain, exact."""
    table = {2000: (1.00, 1.50), 5000: (2.50, 3.75), 10000: (5.00, 7.50)}
    for scale, (flat, mountain) in table.items():
        assert limits("orthophoto-scale", map_scale=scale, terrain="flat") == {"rmse_h_flat": flat}
        found = limits("orthophoto-scale", map_scale=scale, terrain="mountain")
        assert found == {"rmse_h_mountain": mountain}
    profile = load_profile("orthophoto-scale")
    assert profile.product_findings(Product(map_scale=1000.0)) == (
        "profile orthophoto-scale needs terrain of the product",
        "profile orthophoto-scale: found map_scale 1000, expected one of 2000, 5000, 10000",
    )
    assert "secondary" in profile.source


def test_jrc_limits_pixels_residuals_and_the_gsd():
    assert limits("jrc", gsd_m=0.2) == {
        "image_rms_px": 0.5,
        "largest_residual_h_over_rmse": 3.0,
        "rmse_h": 0.2,
    }


@pytest.fixture
def example(tmp_path):
    """The contract file of the documentation."""
    page = (DOCS / "acceptance.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"^```toml\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    return write(tmp_path, contract=text)


def test_the_contract_of_the_documentation_changes_what_it_says(example):
    profile, contract = load_contract(example)
    assert contract.number == "2026-117"
    assert contract.flight_date == "2026-05-14"
    assert contract.remarks == ""
    assert contract.product == Product(class_h_m=0.1, class_v_m=0.15, gsd_m=0.05)
    assert profile.name == "asprs-2024"
    assert profile.omitted == ("n_blunders_v",)
    assert profile.changed == ("n_check_points",)
    assert profile.added == ("parallax",)
    assert [file.name for file in profile.files] == ["contract.toml", "asprs-2024.toml"]
    assert profile.notes[:-1] == load_profile("asprs-2024").notes
    by_id = {each.id: each for each in profile.requirements}
    assert "n_blunders_v" not in by_id
    points = by_id["n_check_points"]
    assert (points.limit.constant, points.exceeding, points.mandatory) == (50.0, "fail", False)
    assert (points.clause, points.source) == ("4.2", "contract 2026-117, annex B")
    assert by_id["parallax"].limit.constant == 2 / 3
    assert by_id["parallax"].measured.unit == "px"
    assert list(by_id)[-1] == "parallax"
    assert profile.statement("horizontal").tested  # what it rests on is as in the standard


def test_the_documentation_lists_every_key_and_quantity():
    page = (DOCS / "acceptance.md").read_text(encoding="utf-8")
    named = set(re.findall(r"`([\w-]+)`", page))
    keys = {*reading.TOP_KEYS, *reading.REQUIREMENT_KEYS, *reading.STATEMENT_KEYS}
    tables = {"contract", "product", "requirement", "statement"}
    assert keys - tables - named == set()
    assert {*reading.CONTRACT_KEYS, *reading.PRODUCT_KEYS} - named == set()
    assert set(QUANTITIES) - named == set()
    assert set(profile_names()) - named == set()
    for name, quantity in QUANTITIES.items():
        (row,) = [
            row
            for row in page.splitlines()
            if row.startswith("| `") and f"`{name}`" in row and f"| {quantity.sense} |" in row
        ]
        assert f"| {quantity.unit} |" in row


def test_a_profile_can_be_read_again_from_what_is_embedded(example):
    profile, contract = load_contract(example)
    assert profile_of_files(profile.files) == (profile, contract)
    assert profile.files[0].content == example.read_bytes()
    assert len(profile.files[0].sha256) == 64


def test_files_extend_files_that_extend_a_profile(tmp_path):
    (tmp_path / "base").mkdir()
    (tmp_path / "base" / "contract.toml").write_text(
        "extends = 'jrc'\nomit = ['rmse_h', 'image_rms_px']\n[contract]\nclient = 'C'\n"
        "sensor = 'S'\n[product]\ngsd_m = 0.1\nclass_h_m = 0.3\n",
        encoding="utf-8",
    )
    path = write(
        tmp_path,
        contract="extends = 'base/contract.toml'\nname = 'ours'\nneeds = []\n[contract]\n"
        "sensor = 'T'\n[product]\ngsd_m = 0.2\n"
        "[[requirement]]\nid = 'rmse_h'\nquantity = 'rmse_h'\nlimit = '2 * gsd'\n"
        "[[requirement]]\nid = 'largest_residual_h_over_rmse'\nlimit = 2.5\n",
    )
    profile, contract = load_contract(path)
    names = ["contract.toml", "contract-2.toml", "jrc.toml"]
    assert [file.name for file in profile.files] == names
    assert (contract.client, contract.sensor) == ("C", "T")
    assert contract.product == Product(gsd_m=0.2, class_h_m=0.3)
    assert (profile.name, profile.title, profile.needs) == ("ours", load_profile("jrc").title, ())
    assert profile.omitted == ("image_rms_px",)
    ratio, rmse = profile.requirements
    assert (ratio.limit.constant, ratio.source, ratio.clause) == (2.5, "contract.toml", "")
    assert (rmse.limit.evaluate(contract.product), rmse.source) == (0.4, "contract.toml")


def test_a_contract_may_leave_the_profile_to_the_command(tmp_path):
    path = write(tmp_path, contract="omit = ['rmse_h']\n[contract]\nnumber = '7'\n")
    profile, contract = load_contract(path, base="jrc")
    assert (profile.name, profile.omitted, contract.number) == ("jrc", ("rmse_h",), "7")
    extending = write(tmp_path, other="extends = 'jrc'")
    assert load_contract(extending, base="jrc")[0].name == "jrc"
    (finding,) = findings_of(extending, base="nssda")
    assert finding == (
        "other.toml -> jrc.toml: extends another profile than nssda, which was asked for"
    )
    with pytest.raises(PosstatsError, match=r"no profile file 'nsda', and no profile"):
        load_contract(path, base="nsda")


def test_a_contract_of_parties_alone_has_no_profile(tmp_path):
    path = write(tmp_path, contract="[contract]\nnumber = '<b>7</b>'\nremarks = \"a\\nb\"\n")
    profile, contract = load_contract(path)
    assert profile is None
    assert (contract.number, contract.remarks) == ("<b>7</b>", "a\nb")
    with pytest.raises(ProfileFormatError, match=r"contract\.toml: found no requirement"):
        load_profile(path)


def test_a_file_of_its_own_is_a_profile(tmp_path):
    profile = load_profile(write(tmp_path, mine=OWN))
    assert (profile.name, profile.edition, profile.added) == ("mine", "", ())


def test_a_changed_basis_withholds_the_standards_words(tmp_path):
    path = write(
        tmp_path,
        contract="extends = 'asprs-2024'\nomit = ['survey_v']\n"
        "[[requirement]]\nid = 'product_rmse_h'\nlimit = '2 * class_h'\n"
        "[[requirement]]\nid = 'product_rmse_v'\nclause = '7.11 and 3'\nlimit = 'class_v'\n"
        "[[statement]]\ncomponent = 'vertical'\ntested = 'Found {found_m} m'\n",
    )
    profile = load_profile(path)
    assert profile.changed == ("product_rmse_h",)
    assert profile.statement("horizontal") is None
    (withheld,) = [each for each in profile.statements if each.component == "horizontal"]
    assert withheld.withheld_by == ("product_rmse_h",)
    assert profile.statement("vertical").tested == "Found {found_m} m"
    assert "withheld: the contract changes product_rmse_h" in run(path).output


def test_a_condition_of_the_profile_can_be_taken_off(tmp_path):
    path = write(
        tmp_path,
        contract="extends = 'orthophoto-scale'\nomit = ['rmse_h_mountain']\nscales = []\n"
        "[[requirement]]\nid = 'rmse_h_flat'\nterrain = 'any'\nwhen_given = 'scale'\n",
    )
    (requirement,) = load_profile(path).requirements
    assert (requirement.terrain, requirement.when_given) == (None, "scale")
    assert requirement.limit.text == "0.0005 * scale"
    assert "secondary source" in requirement.source  # its number is the profile's still
    assert load_profile(path).product_findings(Product(map_scale=1.0, terrain="mountain")) == ()


def test_a_limit_without_a_usable_value_for_the_product_is_a_finding(tmp_path):
    path = write(
        tmp_path,
        contract=OWN.replace("limit = 1", "limit = '1 / (gsd - class_h)'")
        + "[[requirement]]\nid = 'b'\nquantity = 'n_blunders_h'\nlimit = 0\n"
        "threshold = 'class_h - gsd'\n[product]\ngsd_m = 0.2\nclass_h_m = 0.2\n",
    )
    profile, contract = load_contract(path)
    assert profile.product_findings(contract.product) == (
        "requirement a, limit: found '1 / (gsd - class_h)': divides by zero",
    )
    assert profile.product_findings(Product(gsd_m=0.3, class_h_m=0.2)) == (
        "requirement b, threshold: found 'class_h - gsd': is -0.1, expected a value of at least 0",
    )
    assert profile.product_findings(Product()) == ()  # not stated: not assessed


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
        ("contract = 'x'\n" + OWN, "c.toml, contract: found 'x', expected a section"),
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
        ("[product]\nterrain = 3\n", "c.toml:2, product.terrain: found 3, expected one of flat, "),
        ("[requirement]\nid = 'a'\n", "c.toml:1, requirement: found {'id': 'a'}, expected tables"),
        ("requirement = [3]\n", "c.toml, requirement: found 3, expected a section"),
        ("[[requirement]]\nquantity='rmse_h'\nlimit=1", "c.toml:1, requirement.id: found nothing"),
        (OWN.replace("'a'", "'<b>a'"), "c.toml:2, requirement.id: found '<b>a', expected up to"),
        (OWN.replace("'a'", "7"), "c.toml:2, requirement.id: found 7, expected up to 60"),
        (OWN + OWN, "c.toml:6, requirement.id: found 'a' a second time, expected each id once"),
        (OWN + "limt = 2", "c.toml:5, requirement.limt: found an unknown key, expected limit?"),
        (OWN + "source = ' '", "c.toml:5, requirement.source: found ' ', expected text in quotes"),
        (OWN + "mandatory = 'no'", "c.toml:5, requirement.mandatory: found 'no', expected true or"),
        (OWN + "exceeding = 'fial'", "c.toml:5, requirement.exceeding: found 'fial', expected "),
        (OWN + "terrain = 'flt'", "c.toml:5, requirement.terrain: found 'flt', expected flat?"),
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
    start = time.perf_counter()
    (finding,) = findings_of(write(tmp_path, c=text))
    assert time.perf_counter() - start < 5.0
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


def test_a_file_with_byte_order_mark_and_windows_line_ends_is_read(tmp_path):
    path = tmp_path / "c.toml"
    path.write_bytes(b"\xef\xbb\xbf" + OWN.replace("\n", "\r\n").encode())
    assert load_profile(path).requirements[0].id == "a"


@pytest.mark.parametrize("name", ["nsdda", "", "none.toml", "../asprs-2024", "a\0b", "x" * 5000])
def test_a_profile_that_is_not_there_is_named(name):
    with pytest.raises(PosstatsError, match=r"no profile file '.*, and no profile of that"):
        load_profile(name)


def test_a_file_of_a_profiles_name_does_not_hide_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "jrc").write_text(OWN, encoding="utf-8")
    assert load_profile("jrc").name == "jrc"
    assert len(load_profile("./jrc").requirements) == 1


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


def test_the_command_refuses_a_bad_file_without_a_traceback(tmp_path, example):
    assert "omitted: n_blunders_v" in run(example).output
    result = run(write(tmp_path, c="nam = 'x'\n" + OWN))
    assert (result.exit_code, result.output) == (
        1,
        "Error: c.toml:1, nam: found an unknown key, expected name?\n",
    )
