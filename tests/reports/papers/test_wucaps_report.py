"""`posstats wucaps` as a whole: numbers that it has to reach, pages, files, bytes."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner
from page_reading import assert_shown_without_fault, pdf_pages, plain, read

from posstats.papers.wucaps.findings import RECOMMENDED
from posstats.papers.wucaps.seeds import repeated
from posstats.papers.wucaps.situations import SITUATIONS
from posstats.reports.commands import wucaps as wucaps_command
from posstats.reports.commands.cli import cli
from posstats.reports.commands.wucaps import SituationRun, run_situation
from posstats.reports.papers.wucaps.words import words_in


@pytest.fixture(scope="module")
def runs() -> dict[str, SituationRun]:
    """What `folder` computed."""
    return {}


def run_wucaps(out: Path, run_one, *options: str) -> str:
    """The command in this process, with a function that computes a situation."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SOURCE_DATE_EPOCH", "1750000000")
        patch.setattr(wucaps_command, "run_situation", run_one)
        run = CliRunner().invoke(cli, ["wucaps", "--out", str(out), *options])
    assert run.exit_code == 0, run.output
    return run.output


@pytest.fixture(scope="module")
def folder(tmp_path_factory, runs) -> Path:
    def run_one(situation, *arguments, **options):
        runs[situation] = run_situation(situation, *arguments, **options)
        return runs[situation]

    out = tmp_path_factory.mktemp("wucaps") / "out"
    told = run_wucaps(out, run_one)
    words = words_in("en")
    title = words.text("title.calibration_is_dispensable")
    assert f"5. {title}: {words.text('conclusions.holds')}" in told
    return out


@pytest.fixture(scope="module")
def numbers(folder):
    return json.loads((folder / "wucaps.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def page(folder) -> str:
    return (folder / "wucaps.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def pages(folder) -> list[str]:
    return pdf_pages(folder / "wucaps.pdf")


def only(numbers, situation, method, control=None):
    (row,) = (
        row
        for row in numbers["rows"]
        if (row["situation"], row["method"], row["control"]) == (situation, method, control)
    )
    return row


@pytest.mark.parametrize("situation", SITUATIONS)
def test_the_recommended_control_removes_the_errors(numbers, situation):
    row = only(numbers, situation, "weighted", RECOMMENDED[situation])
    assert row["horizontal_over_reference"] <= 2.0
    assert row["vertical_over_reference"] <= 2.2
    assert row["determined"]
    assert row["sigma0"] == pytest.approx(1.0, abs=0.03)


@pytest.mark.parametrize("situation", SITUATIONS)
def test_free_drifts_are_reported_as_not_determined_by_less_than_four_points(numbers, situation):
    central = only(numbers, situation, "free", "centre")
    assert not central["determined"]
    assert {f"gnss_{axis}_shift" for axis in "xyz"} <= set(central["undetermined"])
    weighted = only(numbers, situation, "weighted", "centre")
    assert central["predicted_vertical_m"] > 10.0 * weighted["predicted_vertical_m"]
    without = only(numbers, situation, "free", "none")
    assert not without["determined"]
    assert "vertical_m" not in without
    assert only(numbers, situation, "free", "corners")["determined"]


@pytest.mark.parametrize("situation", SITUATIONS)
def test_systematic_errors_show_where_nothing_takes_them_off(numbers, situation):
    pos, calibrated = (only(numbers, situation, name) for name in ("pos", "calibrated"))
    assert pos["parallax_mm"] > 5.0 * calibrated["parallax_mm"]
    assert calibrated["parallax_mm"] > 5.0 * numbers["relative_parallax_mm"][situation]
    assert only(numbers, situation, "bundle", "all")["sigma0"] > 5.0
    assert only(numbers, situation, "regression")["vertical_m"] == pos["vertical_m"]


@pytest.mark.parametrize("situation", SITUATIONS)
def test_the_stored_seeds_were_made_by_this_chain(numbers, situation):
    stored = repeated()[situation][0]
    for name, method, control in (
        ("reference", "reference", "all"),
        ("lines", "strip_lines", None),
        ("bundle", "bundle", RECOMMENDED[situation]),
        ("weighted_none", "weighted", "none"),
        ("both", "weighted_calibrated", RECOMMENDED[situation]),
    ):
        row = only(numbers, situation, method, control)
        for side in ("horizontal", "vertical"):
            found = row[f"{side}_m"]
            assert found == pytest.approx(getattr(stored, f"{name}_{side}_m"), rel=1e-4), name


def test_conclusions_carry_text_judgement_and_evidence(numbers):
    assert len(numbers["conclusions"]) == 6
    assert all(each["holds"] for each in numbers["conclusions"])
    assert len(numbers["beyond"]) == 3
    assert all(each["evidence"] for each in numbers["conclusions"] + numbers["beyond"])
    assert numbers["simulated"] is True
    assert {each["n_seeds"] for each in numbers["seed_shares"]} == {100}


def test_every_way_to_orient_is_there_once(numbers):
    places = [(row["situation"], row["method"], row["control"]) for row in numbers["rows"]]
    assert len(places) == len(set(places)) == 2 * (4 + 5 * 4 + 1)


def test_the_page_loads_nothing_and_repeats_no_id(page):
    parsed = read(page)
    assert "script" not in parsed.tags
    assert all(link.startswith(("#", "data:")) for link in parsed.links)
    assert len(parsed.ids) == len(set(parsed.ids))


def test_numbers_of_the_page_are_readable(page):
    text = plain(" ".join(read(page.split("</style>", 1)[1]).texts))
    assert not re.search(r"\b(None|nan|NaN|inf|null)\b", text)
    assert not re.search(r"\d\.\d{6,}", text)
    assert words_in("en").terrain("mountain") in text
    assert not re.search(r"(?<!wucaps-)\bmountain\b", text, re.IGNORECASE)


@pytest.mark.parametrize("width", [400, 1280])
def test_a_browser_shows_the_page_without_fault(page, tmp_path, width):
    assert_shown_without_fault(page, width, tmp_path)


def test_every_pdf_page_is_numbered_and_marked_as_simulated(pages):
    assert len(pages) >= 8
    for number, text in enumerate(pages, start=1):
        assert f"page {number} of {len(pages)}" in text
        assert "Simulated data" in text


def test_the_same_seed_and_date_give_the_same_bytes(folder, runs, tmp_path):
    """One situation is computed anew; that equal pages give equal PDFs is tested for the other."""
    anew = []

    def run_one(situation, *arguments, **options):
        if anew:
            return runs[situation]
        anew.append(situation)
        return run_situation(situation, *arguments, **options)

    run_wucaps(tmp_path / "again", run_one, "--no-pdf")
    assert not (tmp_path / "again" / "wucaps.pdf").exists()
    for name in ("wucaps.html", "wucaps.json"):
        assert (folder / name).read_bytes() == (tmp_path / "again" / name).read_bytes(), name
