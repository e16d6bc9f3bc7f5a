"""Contract files: what they change, and how files extend files."""

import re
from dataclasses import fields

import pytest
from finding_parts import assert_finding
from profile_texts import DOCS, OWN, documented_contract, findings_of, write

from posstats.acceptance import profile_reading as reading
from posstats.acceptance.product import Product
from posstats.acceptance.profile import Parties
from posstats.acceptance.profile_files import (
    ProfileFormatError,
    load_contract,
    load_profile,
    profile_names,
    profile_of_files,
)
from posstats.acceptance.quantity_names import QUANTITIES
from posstats.errors import PosstatsError


@pytest.fixture
def example(tmp_path):
    return documented_contract(tmp_path)


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
    read = (reading.ProfileTable, reading.RequirementTable, reading.StatementTable)
    keys = {each.name for table in read for each in fields(table)}
    tables = {"contract", "product", "requirement", "statement"}
    assert keys - tables - named == set()
    assert {each.name for table in (Parties, Product) for each in fields(table)} - named == set()
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
    assert_finding(finding, "other.toml -> jrc.toml", "extends another profile")
    assert "nssda" in finding
    with pytest.raises(PosstatsError, match="no profile file 'nsda'"):
        load_contract(path, base="nsda")


def test_a_contract_of_parties_alone_has_no_profile(tmp_path):
    path = write(tmp_path, contract="[contract]\nnumber = '<b>7</b>'\nremarks = \"a\\nb\"\n")
    profile, contract = load_contract(path)
    assert profile is None
    assert (contract.number, contract.remarks) == ("<b>7</b>", "a\nb")
    with pytest.raises(ProfileFormatError, match=r"contract\.toml: .*no requirement"):
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
    (limit,) = profile.product_findings(contract.product)
    assert_finding(limit, "requirement a, limit", "'1 / (gsd - class_h)': divides")
    (threshold,) = profile.product_findings(Product(gsd_m=0.3, class_h_m=0.2))
    assert_finding(threshold, "requirement b, threshold", "'class_h - gsd': is -0.1", "a value of")
    assert profile.product_findings(Product()) == ()  # not stated: not assessed


def test_a_file_with_byte_order_mark_and_windows_line_ends_is_read(tmp_path):
    path = tmp_path / "c.toml"
    path.write_bytes(b"\xef\xbb\xbf" + OWN.replace("\n", "\r\n").encode())
    assert load_profile(path).requirements[0].id == "a"


def test_a_file_of_a_profiles_name_does_not_hide_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "jrc").write_text(OWN, encoding="utf-8")
    assert load_profile("jrc").name == "jrc"
    assert len(load_profile("./jrc").requirements) == 1
