"""`posstats paper` as a whole: numbers that it has to reach, pages, files, bytes."""

import json
import os
import re
import signal
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from page_reading import assert_shown_without_fault, pdf_pages, plain, read

from posstats.block.image_pairs import stereo_models
from posstats.contract.files import read_json
from posstats.contract.results import Results
from posstats.errors import PosstatsError
from posstats.papers.drift.areas import AREAS, area_scenario, area_seed, true_causes
from posstats.papers.drift.findings import AreaFindings, find
from posstats.papers.drift.published import published
from posstats.papers.drift.seeds import repeated
from posstats.reports.commands import paper as paper_command
from posstats.reports.papers.drift import figures as paper_figures
from posstats.reports.papers.drift import running
from posstats.reports.papers.drift.words import words_in
from posstats.synthetic import simulate

COMMAND = Path(sys.executable).with_name("posstats")
EPOCH = "1750000000"


def run_paper(out: Path, *options: str) -> str:
    environment = os.environ | {"SOURCE_DATE_EPOCH": EPOCH}
    command = [COMMAND, "paper", "--out", out, *options]
    run = subprocess.run(command, env=environment, capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    return run.stdout


@pytest.fixture(scope="module")
def folder(tmp_path_factory) -> Path:
    out = tmp_path_factory.mktemp("paper") / "out"
    told = run_paper(out)
    assert f"8. {words_in('en').text('title.orthophoto')}: " in told
    return out


@pytest.fixture(scope="module")
def results(folder):
    return {a: read_json(folder / f"area{a}" / "results.json", Results) for a in AREAS}


@pytest.fixture(scope="module")
def comparison(folder):
    return json.loads((folder / "comparison.json").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def causes():
    blocks = {area: simulate(area_scenario(area), area_seed(1, area)) for area in AREAS}
    return {area: true_causes(block, stereo_models(block)) for area, block in blocks.items()}


@pytest.fixture(scope="module")
def findings(results, causes):
    return {a: find(a, results[a], area_scenario(a), causes[a]) for a in AREAS}


@pytest.fixture(scope="module")
def page(folder) -> str:
    return (folder / "paper.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def pages(folder) -> list[str]:
    return pdf_pages(folder / "paper.pdf")


def chosen(rows, **conditions):
    return [row for row in rows if all(row[key] == value for key, value in conditions.items())]


@pytest.mark.parametrize("area", AREAS)
@pytest.mark.parametrize("method", ["pos", "independent", "dependent"])
def test_mean_parallax_is_near_the_published_one(comparison, area, method):
    (row,) = chosen(comparison["rows"], table=2, area=area, strip=None,
                    quantity=f"{method}_mean_mm")  # fmt: skip
    assert 0.8 <= row["ratio"] <= 1.25
    assert row["basis"] == "fitted"


def test_one_strip_of_area_1_regresses_like_table_3(findings):
    assert findings[1].strip_omega_r_squared > 0.95
    assert min(findings[1].strip_phi_p, findings[1].strip_kappa_p) > 0.05


@pytest.mark.parametrize("area", AREAS)
def test_the_rules_choose_omega_alone_and_only_it_helps(findings, results, area):
    found = findings[area]
    assert results[area].verdict.corrected_angles == ("omega",)
    assert results[area].verdict.cause == "omega"
    assert found.corrected_omega_mm <= 1.6 * found.independent_mm
    assert found.corrected_omega_mm < 0.9 * found.pos_mm
    assert min(found.corrected_phi_mm, found.corrected_kappa_mm) > 0.9 * found.pos_mm


@pytest.mark.parametrize("area", AREAS)
def test_check_points_fit_better_with_omega_corrected(comparison, area):
    for side in ("horizontal", "vertical"):
        before, after = (
            chosen(comparison["rows"], table=4, area=area, orientation=name,
                   quantity=f"rmse_{side}_m")[0]["reproduced"]
            for name in ("pos", "omega_corrected")
        )  # fmt: skip
        assert after < before


@pytest.mark.parametrize("area", AREAS)
def test_the_stored_seeds_were_made_by_this_chain(findings, area):
    stored = repeated()[area][0]
    for field in fields(AreaFindings):
        ours, theirs = getattr(findings[area], field.name), getattr(stored, field.name)
        assert ours == theirs if isinstance(ours, str) else ours == pytest.approx(theirs, rel=1e-5)


def test_every_published_number_is_compared_once(comparison):
    places = [tuple(row[k] for k in ("table", "area", "strip", "angle", "orientation", "quantity"))
              for row in comparison["rows"]]  # fmt: skip
    assert len(places) == len(set(places))
    n_printed = {1: 3 * 11, 2: 18 * 9 + 9, 3: 3 * 5, 4: 6 * 7}
    assert {t: len(chosen(comparison["rows"], table=t)) for t in n_printed} == n_printed


def test_reproduced_strip_statistics_are_those_of_the_models(comparison, results):
    """Table 2 against the models' own values, not against the rows it is made from."""
    for area, pixel_mm in ((1, 0.012), (2, 0.012), (3, 0.009)):
        for strip in {row.strip for row in published(2, area=area)}:
            models = [row for row in results[area].models if row.strip == strip]
            rms_mm = np.array([model.pos_px for model in models]) * pixel_mm
            expected = {"max": rms_mm.max(), "min": rms_mm.min(), "mean": rms_mm.mean()}
            for name, value in expected.items():
                (row,) = chosen(comparison["rows"], table=2, area=area, strip=strip,
                                quantity=f"pos_{name}_mm")  # fmt: skip
                assert row["reproduced"] == pytest.approx(value, rel=1e-9)


def test_ratios_are_reproduced_over_published_and_missing_where_units_are_unknown(comparison):
    for row in comparison["rows"]:
        if row["quantity"] in ("intercept", "slope_per_t") or row["published"] == 0:
            assert row["ratio"] is None
        else:
            assert row["ratio"] == pytest.approx(row["reproduced"] / row["published"])


def test_conclusions_carry_text_judgement_and_evidence(comparison):
    judged = {each["text"][:20]: each["holds"] for each in comparison["conclusions"]}
    assert len(judged) == 8
    assert sum(judged.values()) == 7
    assert all(each["evidence"] for each in comparison["conclusions"])
    assert comparison["simulated"] is True
    assert {each["n_seeds"] for each in comparison["seed_shares"]} == {100}


def test_every_area_has_its_results_tables_and_figures(folder):
    for area in AREAS:
        part = folder / f"area{area}"
        assert (part / "corrected_orientations.csv").is_file()
        assert len(list((part / "tables").glob("*.csv"))) >= 10
        assert len(list((part / "figures").glob("*.svg"))) == 8
        assert not list(part.glob("*.pdf"))


def test_the_page_has_all_tables_and_figures_of_the_paper(page):
    tables = re.findall(r"<strong>Table (\w+)\.</strong>", page)
    assert [t for t in tables if t[0].isdigit()] == ["1", "2a", "2b", "2c", "3a", "3b", "4"]
    letters = [t for t in tables if not t[0].isdigit()]
    assert letters == [chr(ord("A") + k) for k in range(len(letters))]
    figures = re.findall(r"<strong>Figure (\w+)\.</strong>", page)
    assert figures == [f"{number}{letter}" for number in "123" for letter in "abc"]


def test_the_page_loads_nothing_and_repeats_no_id(page):
    parsed = read(page)
    assert "script" not in parsed.tags
    assert all(link.startswith(("#", "data:")) for link in parsed.links)
    assert len(parsed.ids) == len(set(parsed.ids))


def test_numbers_of_the_page_are_readable(page):
    text = plain(" ".join(read(page.split("</style>", 1)[1]).texts))
    assert not re.search(r"\b(None|nan|NaN|inf|null)\b", text)
    assert not re.search(r"\d\.\d{6,}", text)


@pytest.mark.parametrize("width", [400, 1280])
def test_a_browser_shows_the_page_without_fault(page, tmp_path, width):
    assert_shown_without_fault(page, width, tmp_path)


def test_every_pdf_page_is_numbered_and_marked_as_simulated(pages):
    assert len(pages) >= 10
    for number, text in enumerate(pages, start=1):
        assert f"page {number} of {len(pages)}" in text
        assert "Simulated data" in text


def test_a_table_that_breaks_over_pages_repeats_its_head(pages):
    """Table 3b has a line for every angle of every strip: more than a page holds."""
    heads = [number for number, text in enumerate(pages) if re.search(r"F₀\s+p\s+GLS p", text)]
    assert len(heads) >= 2
    assert heads == list(range(heads[0], heads[0] + len(heads)))
    assert sum("Table 3b." in text for text in pages) == 1


def test_the_contents_name_the_page_of_every_section(pages):
    listed = re.findall(r"^\s*(\d+)\s+(\S.*?)[ .]+(\d+)$", pages[0], re.MULTILINE)
    assert len(listed) == 11
    for number, title, page_number in listed:
        heading = re.compile(rf"^\s*{number}\s+{re.escape(title.strip())}\s*$", re.MULTILINE)
        assert heading.search(pages[int(page_number) - 1]), title


def files_of(folder: Path) -> dict[Path, bytes]:
    return {p.relative_to(folder): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


def test_the_same_seed_and_date_give_the_same_files_of_an_area(folder, comparison, tmp_path):
    """The smallest area, computed anew in this process."""
    values, _ = running._analysed(3, 1, tmp_path, comparison["created"])
    running._written(3, values, tmp_path, "en")
    assert files_of(tmp_path) == files_of(folder / "area3")


def test_the_same_numbers_and_date_give_the_same_pages(
    folder, results, causes, tmp_path, monkeypatch
):
    areas = {
        area: running.AreaOutput(
            results[area],
            causes[area],
            paper_figures.draw_area(words_in("en"), area, results[area]),
        )
        for area in AREAS
    }
    monkeypatch.setattr(paper_command, "run_areas", lambda *_: areas)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", EPOCH)
    list(paper_command.reproduce_paper(tmp_path, 1, pdf=True))
    made = files_of(tmp_path)
    assert {str(name) for name in made} == {"comparison.json", "paper.html", "paper.pdf"}
    assert made.items() <= files_of(folder).items()


def test_a_table_row_is_never_parted_from_its_ratio(pages):
    """Table 4: published, simulated and ratio stay on one page."""
    for text in pages:
        lines = [line for line in text.splitlines() if re.match(r"\s*[123]\s+(POS|omega)", line)]
        kinds = [re.search(r"(published|simulated|ratio)", line)[1] for line in lines]
        assert kinds == ["published", "simulated", "ratio"] * (len(kinds) // 3)


def killed(*_):
    os._exit(9)


def test_a_killed_area_is_an_error_that_says_so(monkeypatch, tmp_path):
    monkeypatch.setattr(running, "_analysed", killed)
    with pytest.raises(PosstatsError, match="killed"):
        running.run_areas(tmp_path, 1, "", "en")


HELD = """
import os, signal, sys
from posstats.reports.commands.cli import main
from posstats.reports.papers.drift import running

told = int(sys.argv.pop(1))
signal.signal(signal.SIGINT, signal.default_int_handler)  # a background job ignores it

def wait(*_):
    os.write(told, b".")
    signal.pause()

running._analysed = running._reported = wait
main()
"""


def test_an_interrupt_ends_the_workers_and_leaves_nothing(tmp_path):
    """Two workers and the process that waits for them say so through a pipe, and stay there."""
    ours, theirs = os.pipe()
    process = subprocess.Popen(
        [sys.executable, "-c", HELD, str(theirs), "paper", "--out", tmp_path / "out"],
        pass_fds=(theirs,),
        stderr=subprocess.PIPE,
        text=True,
    )
    os.close(theirs)
    with os.fdopen(ours, "rb") as said:
        assert said.read(3) == b"..."
        assert list(tmp_path.glob(".posstats-*"))
        process.send_signal(signal.SIGINT)
        _, told = process.communicate()
        assert said.read() == b""  # nobody holds the other end any more
    assert process.returncode == 1
    assert told.strip() == "Aborted!"
    assert list(tmp_path.iterdir()) == []
