"""`posstats accept` from a block to a document that `posstats verify` accepts; and bad input."""

import json
import shutil
from pathlib import Path

import pikepdf
import pytest
from archive_conformance import problems
from archive_documents import remembering
from catalogues import OF
from click.testing import CliRunner
from needed import chinese_typeface
from small_scenario import small_block

from posstats.analysis.results import results
from posstats.analysis.steps import analyse
from posstats.contract.acceptance import ChosenStatement, JudgedRequirement
from posstats.contract.files import to_json
from posstats.formats.block_folder import read_block, write_block
from posstats.reports.acceptance import writing
from posstats.reports.acceptance.data import _filled
from posstats.reports.acceptance.units import Lengths, margin
from posstats.reports.archive.writing import render_archive
from posstats.reports.block.wording import with_words
from posstats.reports.commands import accept as accept_command
from posstats.reports.commands.accept import length_m
from posstats.reports.commands.cli import cli
from posstats.reports.document import format as fmt
from posstats.reports.document.format import METRE, MINUS
from posstats.reports.verification import pages
from posstats.settings import Settings

EPOCH = "1780000000"
SAID = OF["en", "verification"]
CONTRACT = """
extends = "asprs-2024"

[contract]
number = "2026-117"
client = "City of <b>Exampleton</b>"
contractor = "Example Survey Ltd"

[product]
class_h_m = 0.9
class_v_m = 1.5

[[requirement]]
id = "parallax_rms_px"
quantity = "parallax_rms_px"
limit = 1
source = "annex B"
"""


def run(*arguments):
    return CliRunner().invoke(cli, [str(each) for each in arguments], catch_exceptions=False)


@pytest.fixture(scope="module", autouse=True)
def documents_made_once():
    """Pages that were laid out already give their document again, but where a test says so."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(writing, "render_archive", remembering)
        patch.setattr(pages, "render_archive", remembering)
        yield


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    target = tmp_path_factory.mktemp("accept") / "flight"
    checks = {"n": 32, "distribution": "grid", "image_px": 0.3, "ground_m": 0.1}
    block = small_block(check_points=checks)
    write_block(block, target)
    (target / "adjusted.csv").unlink()  # a simulated block brings the truth
    (target.parent / "contract.toml").write_text(CONTRACT, encoding="utf-8")
    return target


@pytest.fixture(scope="module")
def analysed(folder) -> Path:
    analysis = analyse(read_block(folder), Settings(errors="bundle"))
    path = folder.parent / "results.json"
    path.write_text(to_json(with_words(results(analysis))), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def accepted(folder, analysed) -> Path:
    out = folder.parent / "accepted"
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", EPOCH)
        done = run("accept", analysed, "--contract", folder.parent / "contract.toml", "--out", out)
    assert done.exit_code == 0, done.output
    assert done.output.startswith("ACCEPTED: small (simulated)")
    return out


def values_in(out: Path) -> dict:
    return json.loads((out / "acceptance.json").read_text(encoding="utf-8"))


def test_the_data_say_what_was_found_and_in_which_words(accepted):
    values = values_in(accepted)
    assert values["schema"] == "posstats-acceptance/1"
    assert values["verdict"] == "accepted"
    assert values["orientation"] == "bundle"
    assert values["statement"].count("to meet ASPRS") == 2
    assert "a 90 (cm) RMSE_H" in values["statement"]
    rows = {row["id"]: row for row in values["requirements"]}
    assert {"clause", "quantity", "found", "limit", "unit", "verdict", "reason"} <= set(
        rows["product_rmse_h"]
    )
    assert rows["product_rmse_h"]["clause"] == "7.11"
    assert rows["parallax_rms_px"]["found"] < 1.0
    row = rows["product_rmse_h"]
    found = fmt.with_unit(row["found"], "m")
    within = OF["en", "acceptance"].text("reason.within", found=found, limit="0.900\u00a0m")
    assert row["reason"] == within
    measures = {row["name"]: row["iso_19157"] for row in values["accuracy"]["percentiles"]}
    assert measures == {"CE90": 44, "CE95": 45, "LE90": 35, "LE95": 36}
    assert len(values["check_points"]) == values["accuracy"]["n_given"] == 32


def test_the_document_is_one_for_the_archive_with_its_data_inside(accepted):
    data = (accepted / "acceptance.pdf").read_bytes()
    assert problems(data) == []
    with pikepdf.open(accepted / "acceptance.pdf") as pdf:
        names = set(pdf.attachments)
        outline = pdf.Root.Outlines.Count
    expected = {"results.json", "acceptance.json", "profile/contract.toml"}
    assert expected | {"profile/asprs-2024.toml", "tables/check_points.csv"} <= names
    assert outline >= 10


def test_texts_of_the_contract_are_text_on_the_page(accepted):
    page = (accepted / "acceptance.html").read_text(encoding="utf-8")
    assert "City of &lt;b&gt;Exampleton&lt;/b&gt;" in page
    assert "<b>Exampleton" not in page


def test_a_block_is_judged_and_its_document_verified_down_to_its_inputs(folder, tmp_path):
    """Verifying lays the pages out again: these are the same bytes."""
    done = run("accept", folder, "--profile", "asprs-2024", "--class-h", "90cm", "--class-v",
               "150 cm", "--out", tmp_path)  # fmt: skip
    assert done.exit_code == 0, done.output
    assert values_in(tmp_path)["orientation"] == "selected"
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(pages, "render_archive", render_archive)
        verified = run("verify", tmp_path / "acceptance.pdf", "--inputs", folder)
    assert verified.exit_code == 0, verified.output
    assert verified.output.count("PASS") == 7
    assert SAID.text("said.same_bytes") in verified.output
    other = tmp_path / "other"
    shutil.copytree(folder, other)
    points = (other / "ground_points.csv").read_text(encoding="utf-8")
    (other / "ground_points.csv").write_text(
        points.replace("check,0.1", "check,0.2"), encoding="utf-8"
    )
    swapped = run("verify", tmp_path / "acceptance.pdf", "--inputs", other)
    assert swapped.exit_code == 1
    assert SAID.text("said.input_differs", file="ground_points.csv") in swapped.output


def test_a_verdict_that_was_changed_in_the_data_is_found(accepted, tmp_path):
    values = values_in(accepted)
    changed = tmp_path / "changed.pdf"
    with pikepdf.open(accepted / "acceptance.pdf") as pdf:
        values["requirements"][0]["found"] *= 0.5
        text = json.dumps(values, indent=1, ensure_ascii=False) + "\n"
        pdf.attachments["acceptance.json"].get_file().obj.write(text.encode("utf-8"))
        pdf.save(changed)
    verified = run("verify", changed)
    assert verified.exit_code == 1


def test_the_same_inputs_make_the_same_bytes(folder, analysed, accepted, tmp_path, monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    run("accept", analysed, "--contract", folder.parent / "contract.toml", "--out", tmp_path,
        "--no-pdf")  # fmt: skip
    for name in ("acceptance.html", "acceptance.json"):
        assert (tmp_path / name).read_bytes() == (accepted / name).read_bytes()
    assert values_in(accepted)["created"].startswith("2026-05-28")


def data_alone(acceptance, results, templates, files, folder, *, pdf):
    """`write_document` without the pages."""
    (folder / "acceptance.json").write_text(to_json(acceptance), encoding="utf-8")
    return ""


@pytest.mark.parametrize(
    ("options", "code", "verdict"),
    [
        (["--profile", "asprs-2024", "--class", "1.5m"], 0, "accepted"),
        (["--profile", "asprs-2024", "--class", "10cm"], 3, "rejected"),
        (["--profile", "jrc", "--gsd", "90cm", "--orientation", "selected"], 4, "not assessable"),
        (["--profile", "jrc", "--gsd", "90cm", "--orientation", "bundle"], 0, "accepted"),
        (["--profile", "nssda", "--class", "2m"], 0, "accepted"),
        (["--profile", "gbt-24356", "--class", "2m"], 0, "accepted"),
        (["--profile", "orthophoto-scale", "--scale", "5000", "--terrain", "flat"], 0, "accepted"),
        (["--profile", "asprs-2024", "--class", "1.5m", "--orientation", "pos"], 3, "rejected"),
    ],
)
def test_the_exit_code_is_the_verdict(monkeypatch, analysed, tmp_path, options, code, verdict):
    monkeypatch.setattr(accept_command, "write_document", data_alone)
    done = run("accept", analysed, *options, "--out", tmp_path, "--no-pdf")
    assert done.exit_code == code, done.output
    assert values_in(tmp_path)["verdict"] == verdict
    assert done.output.startswith(verdict.upper())


def test_a_chinese_document_with_a_logo_verifies_too(folder, analysed, tmp_path):
    chinese_typeface()
    templates = tmp_path / "templates"
    templates.mkdir()
    logo = (
        '<svg xmlns="http://www.w3.org/2000/svg" width="40" height="20">'
        '<title>Example Survey Ltd</title><rect width="40" height="20"/></svg>'
    )
    (templates / "logo.svg").write_text(logo, encoding="utf-8")
    done = run("accept", analysed, "--contract", folder.parent / "contract.toml", "--language",
               "zh", "--templates", templates, "--out", tmp_path / "out")  # fmt: skip
    assert done.exit_code == 0, done.output
    said = OF["zh", "acceptance"]
    assert done.output.startswith(said.text("verdict.accepted"))
    assert said.text("terminal_orientation.bundle") in done.output
    for word in ("ACCEPTED", "simulated", "against", "document:", " pass ", "bundle"):
        assert word not in done.output.replace(str(tmp_path), "")
    assert "验收" in (tmp_path / "out" / "acceptance.html").read_text(encoding="utf-8")
    document = tmp_path / "out" / "acceptance.pdf"
    assert problems(document.read_bytes()) == []
    with pikepdf.open(document) as pdf:
        assert "templates/logo.svg" in pdf.attachments
    assert run("verify", document).exit_code == 0


def test_pages_of_templates_that_nobody_knows_are_not_believed(analysed, tmp_path):
    templates = tmp_path / "templates"
    templates.mkdir()
    (templates / "acceptance_summary.html.j2").write_text("<p>Accepted</p>", encoding="utf-8")
    done = run("accept", analysed, "--profile", "asprs-2024", "--class", "10cm", "--templates",
               templates, "--out", tmp_path / "out")  # fmt: skip
    assert done.exit_code == 3
    document = tmp_path / "out" / "acceptance.pdf"
    verified = run("verify", document)
    assert verified.exit_code == 1
    assert SAID.text("said.own_templates", files="acceptance_summary.html.j2") in verified.output
    assert run("verify", document, "--templates", templates).exit_code == 0


def test_a_length_needs_its_unit():
    assert length_m("10cm") == 0.1
    assert length_m(" 100 mm ") == 0.1
    assert length_m("0.1m") == 0.1
    for wrong in ("10", "cm", "10 km", "-1cm", "0cm", "1e3m", "nan m"):
        with pytest.raises(ValueError, match="is no length"):
            length_m(wrong)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ([], "(--profile, see posstats profiles)"),
        (["--profile", "asprs-2023", "--class", "10cm"], "asprs-2024?"),
        (["--profile", "asprs-2024"], "profile asprs-2024 needs class_h or class_v"),
        (["--profile", "asprs-2024", "--class", "10"], "'10' is no length"),
        (["--profile", "asprs-2024", "--class", "1m", "--class-h", "1m"], "either --class"),
        (["--profile", "jrc", "--gsd", "1m", "--orientation", "adjusted"],
         "bundle, selected, pos"),
        (["--profile", "orthophoto-scale", "--scale", "1000", "--terrain", "flat"],
         "expected one of 2000, 5000, 10000"),
        (["--profile", "jrc", "--gsd", "1m", "--templates", "/nowhere"], "is no folder"),
    ],
)  # fmt: skip
def test_what_cannot_be_judged_is_said(analysed, tmp_path, options, message):
    done = run("accept", analysed, *options, "--out", tmp_path / "out")
    assert done.exit_code in (1, 2)
    assert message in done.output
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"\x00\xff", "results.json is no"),
        (b"{", "results.json is no"),
        (b"[]", "results.json has schema null"),
        (b'{"schema": "posstats-adjustment/1"}', "version reads posstats-results/1"),
        (b'{"schema": "posstats-results/1"}', "results.json, posstats_version: found nothing"),
        (b"[" * 100_000, "results.json is no"),
    ],
)
def test_a_file_that_holds_no_results_is_named(tmp_path, content, message):
    path = tmp_path / "results.json"
    path.write_bytes(content)
    done = run(
        "accept", path, "--profile", "asprs-2024", "--class", "10cm", "--out", tmp_path / "o"
    )
    assert done.exit_code == 1
    assert message in done.output


@pytest.mark.parametrize("value", ["a", [1], {}])
def test_a_value_that_is_no_number_is_refused_without_a_traceback(analysed, tmp_path, value):
    values = json.loads(analysed.read_text(encoding="utf-8"))
    for row in values["check_point_residuals"]:
        row["dx_m"] = value
    path = tmp_path / "results.json"
    path.write_text(json.dumps(values), encoding="utf-8")
    done = run("accept", path, "--profile", "jrc", "--gsd", "1m", "--out", tmp_path / "out")
    assert done.exit_code == 1
    assert f"results.json, check_point_residuals[0].dx_m: found {json.dumps(value)}" in done.output
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("share", [1e-4, 1e-6, 1e-8])
def test_printed_digits_never_contradict_a_narrow_verdict(share):
    class_m = 1.0388
    chosen = ChosenStatement(
        component="horizontal", kind="tested", template="{class_cm} {found_cm}",
        class_m=class_m, found_m=class_m * (1.0 - share), n_points=40,
    )  # fmt: skip
    class_cm, found_cm = map(float, _filled(chosen).rstrip(".").split())
    assert found_cm <= class_cm
    row = JudgedRequirement(
        id="rmse_h", clause="", quantity="rmse_h", source="", mandatory=True, exceeding="fail",
        found=class_m * (1.0 + share), limit=class_m, limit_formula="class_h", unit="m",
        margin=-share * class_m, verdict="fail", reason_code="exceeds", reason_values={},
    )  # fmt: skip
    shown = margin(row, Lengths(METRE, 3))
    assert shown.startswith(MINUS) or share < 1e-7
    assert shown != "0.000\u00a0m" or share < 1e-7


def test_a_place_that_does_not_exist_is_named(tmp_path):
    done = run("accept", tmp_path / "none", "--profile", "jrc", "--gsd", "1m")
    assert done.exit_code == 1
    assert "none" in done.output
