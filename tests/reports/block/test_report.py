"""The report as its readers meet it: HTML, PDF, tables and figures made from results alone."""

import csv
import re
import sys
import xml.etree.ElementTree as ET
from dataclasses import fields, replace
from pathlib import Path

import numpy as np
import pytest
from page_reading import assert_shown_without_fault, pdf_pages, plain, read
from report_results import area_results, coarse_results, with_rows

from posstats.contract.survey import InputFile
from posstats.errors import PosstatsError
from posstats.reports.block import document as block_document
from posstats.reports.block import figures, verdict
from posstats.reports.block.csv_files import write_tables
from posstats.reports.block.report import write_report
from posstats.reports.block.summary import summary
from posstats.reports.figures.plan_view import PlanView
from posstats.reports.pages import html, pdf

HOSTILE = "<script>alert(1)</script> \"a\", 'b' & $x_1$"


@pytest.fixture(scope="module")
def area():
    return area_results(per_strip=12)


@pytest.fixture(scope="module")
def coarse():
    return coarse_results()


@pytest.fixture(scope="module")
def page(area) -> str:
    return html.render(block_document.build(area))


@pytest.fixture(scope="module")
def coarse_page(coarse) -> str:
    return html.render(block_document.build(coarse))


def test_verdict_names_parallax_cause_drift_correction_and_check_points(area):
    said = plain(verdict.paragraph(area))
    for words in (
        "22.6 px (0.27 mm)",
        "81 times the 0.280 px",
        "comes from omega",
        "follows time",
        "omega (linear in time) was corrected; phi and kappa stayed as delivered",
        "leaves 0.400 px (0.0048 mm), 1.4 times",
        "At 15 check points",
        "rotation about the base axis",
    ):
        assert words in said


def test_verdict_of_a_coarse_pos_says_so_and_how_much_each_angle_errs(coarse):
    said = plain(verdict.paragraph(coarse))
    assert said.startswith("This POS is far too coarse for direct use. Its angles err (RMS): omega")
    assert "No check points were given" in said
    assert "no angle was corrected" in said
    assert "mm" not in said


def test_verdict_of_a_block_without_models_says_that_nothing_is_known(area):
    nothing = replace(area.verdict, raw_px=None, relative_px=None, corrected_px=None)
    empty = replace(area, verdict=nothing)
    assert "No vertical parallax could be computed" in verdict.paragraph(empty)


def test_verdict_gives_the_cause_its_share(area):
    results = replace(area, verdict=replace(area.verdict, cause="kappa", cause_share=0.5))
    said = plain(verdict.paragraph(results))
    assert "Most of it comes from kappa" in said
    assert "with all three angles held 22." in said


def test_check_points_that_none_could_be_intersected_make_no_table(area):
    numbers = [each.name for each in fields(area.check_points[0]) if each.name.endswith("_m")]
    none = dict.fromkeys(numbers) | {"n": 0}
    results = with_rows(area, "check_points", lambda row: replace(row, **none))
    results = replace(results, check_point_residuals=())
    text = html.render(block_document.build(results))
    assert 'id="table-check_points_shift_kept"' not in text
    assert "No check point could be intersected" in text


def test_verdict_names_an_interval_that_includes_zero(area):
    results = with_rows(area, "regression", lambda r: replace(r, gls_slope_ci95=(-1e-7, 9e-7)))
    assert "includes zero, so a drift is not proven" in verdict.paragraph(results)


def test_tables_and_figures_are_numbered_from_one_without_gaps(page):
    for kind in ("Table", "Figure"):
        numbers = [int(n) for n in re.findall(rf"<strong>{kind} (\d+)\.</strong>", page)]
        assert numbers == list(range(1, len(numbers) + 1))
        assert len(numbers) >= 8


def test_the_page_loads_nothing_and_repeats_no_id(page, coarse_page):
    for text in (page, coarse_page):
        parsed = read(text)
        assert "script" not in parsed.tags
        assert all(link.startswith(("#", "data:")) for link in parsed.links)
        addresses = re.findall(r"url\([\"']?([^\"')]*)", text)
        assert addresses
        assert all(address.startswith(("#", "data:")) for address in addresses)
        assert len(parsed.ids) == len(set(parsed.ids))
        targets = {link[1:] for link in parsed.links if link.startswith("#")}
        assert targets <= set(parsed.ids)


def test_simulated_blocks_are_marked_and_real_ones_are_not(page, coarse_page):
    assert "Simulated data" in "".join(read(page).texts)
    assert "Simulated" not in "".join(read(coarse_page).texts)


def test_hostile_ids_appear_as_text(area):
    results = area
    for key in ("images", "models", "angle_errors", "parallax", "error_sources"):
        results = with_rows(
            results, key, lambda row: replace(row, strip=HOSTILE) if row.strip == "1" else row
        )
    results = with_rows(results, "models", lambda row: replace(row, left=HOSTILE))
    inputs = (InputFile(file=HOSTILE, sha256="0"),)
    block = replace(area.block, name=HOSTILE, inputs=inputs)
    results = replace(results, block=block, warnings=(HOSTILE,))
    parsed = read(html.render(block_document.build(results)))
    assert "script" not in parsed.tags
    texts = [text.strip() for text in parsed.texts]
    assert texts.count(HOSTILE) >= 5


def test_missing_values_are_dashes_never_words_of_the_program(coarse_page):
    text = " ".join(read(coarse_page.split("</style>", 1)[1]).texts)
    assert not re.search(r"\b(None|nan|NaN|inf|null)\b", text)
    assert "–" in text


def test_no_number_has_more_digits_than_anyone_reads(page):
    text = plain(" ".join(read(page.split("</style>", 1)[1]).texts))
    assert not re.search(r"\d\.\d{7,}", text)


def test_empty_lists_still_make_a_report(area):
    names = [each.name for each in fields(area) if isinstance(getattr(area, each.name), tuple)]
    empty = replace(area, expected_noise_px=None, **dict.fromkeys(names, ()))
    text = html.render(block_document.build(empty))
    assert "no check points" in text.lower() or "not tested" in text


def test_every_figure_is_well_formed_with_a_title_and_texts_as_texts(area):
    for name, drawing in figures.draw(area).items():
        root = ET.fromstring(drawing.svg)  # noqa: S314 - made here
        assert root[0].tag.endswith("title")
        assert root[0].text
        assert root.findall(".//{*}text"), name
        ids = [node.get("id") for node in root.iter() if node.get("id")]
        assert all(label.startswith(f"{name}-") for label in ids)


def test_figures_leave_the_settings_of_matplotlib_alone(area):
    import matplotlib

    def settings():  # reading "backend" would import pyplot
        return {key: matplotlib.rcParams[key] for key in matplotlib.rcParams if key != "backend"}

    before = settings()
    figures.draw(area)
    assert settings() == before
    assert "matplotlib.pyplot" not in sys.modules


def test_figures_and_page_are_the_same_bytes_every_time(area, page):
    assert html.render(block_document.build(area)) == page


def test_csv_tables_keep_every_row_and_every_digit(area, tmp_path):
    write_tables(area, tmp_path)
    with (tmp_path / "models.csv").open(encoding="utf-8", newline="") as stream:
        read_back = list(csv.DictReader(stream))
    assert len(read_back) == len(area.models)
    assert [float(row["pos_px"]) for row in read_back] == [m.pos_px for m in area.models]
    with (tmp_path / "regression.csv").open(encoding="utf-8", newline="") as stream:
        first = next(csv.DictReader(stream))
    assert float(first["slope_ci95_low"]) == area.regression[0].slope_ci95[0]


def test_csv_tables_leave_missing_values_empty(coarse, tmp_path):
    write_tables(coarse, tmp_path)
    with (tmp_path / "parallax.csv").open(encoding="utf-8", newline="") as stream:
        assert all(row["mean_mm"] == "" for row in csv.DictReader(stream))


def test_write_report_writes_all_parts(coarse, tmp_path):
    assert write_report(coarse, tmp_path / "out", pdf=False) == ""
    written = {
        str(path.relative_to(tmp_path / "out")): path for path in (tmp_path / "out").rglob("*.*")
    }
    assert {"report.html", "tables/models.csv", "figures/plan.svg"} <= set(written)
    assert "report.pdf" not in written
    assert all(path.stat().st_size for path in written.values())


@pytest.fixture(scope="module")
def pdf_file(page, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("pdf") / "report.pdf"
    path.write_bytes(pdf.render(page))
    return path


def test_every_pdf_page_is_numbered_headed_and_marked(pdf_file, area):
    pages = pdf_pages(pdf_file)
    assert len(pages) >= 6
    for number, text in enumerate(pages, start=1):
        assert f"page {number} of {len(pages)}" in text
        assert area.block.name in text
        assert "Simulated data" in text


def test_the_pdf_holds_verdict_contents_and_captions(pdf_file):
    text = re.sub(r"\s+", " ", " ".join(pdf_pages(pdf_file)))
    assert "The parallax comes from omega" in text
    assert "Contents" in text
    assert "Table 1." in text
    assert "Figure 1." in text
    assert "Null hypothesis" in text


def test_the_pdf_is_the_same_bytes_every_time(page, pdf_file):
    assert pdf.render(page) == pdf_file.read_bytes()


def test_a_missing_pango_names_the_packages_to_install(monkeypatch):
    def missing(*_, **__):
        raise OSError("cannot load library 'libpango-1.0-0'")

    monkeypatch.setattr("builtins.__import__", _failing_import(missing))
    with pytest.raises(PosstatsError, match=r"libpango-1\.0-0 libpangoft2-1\.0-0"):
        pdf.render("<p>text</p>")


def _failing_import(missing):
    genuine = __import__

    def guarded(name, *args, **kwargs):
        return missing() if name.startswith("weasyprint") else genuine(name, *args, **kwargs)

    return guarded


@pytest.mark.parametrize("width", [400, 1280])
def test_a_browser_sees_no_error_no_request_and_no_sideways_scrolling(
    page, coarse_page, tmp_path, width
):
    for text in (page, coarse_page):
        assert_shown_without_fault(text, width, tmp_path)


def at_strips(results):
    """The results as if decided strip by strip: omega linear in strip 2, nothing else."""
    decided = [
        replace(row, scope=scope, correct=linear, form="linear" if linear else "none")
        for scope in dict.fromkeys(image.strip for image in results.images)
        for row in results.selection
        for linear in (row.angle == "omega" and scope == "2",)
    ]
    by_strip = replace(results.settings, scope="strip")
    return replace(results, settings=by_strip, selection=tuple(decided))


def test_decisions_by_strip_are_one_matrix_and_reasons_only_of_corrections(area):
    results = at_strips(area)
    text = html.render(block_document.build(results))
    matrix = re.search(r'id="table-decisions_by_strip".*?</table>', text, re.DOTALL)[0]
    assert matrix.count("<tr>") == 1 + results.block.n_strips
    reasons = re.search(r'id="table-decisions".*?</table>', text, re.DOTALL)[0]
    assert reasons.count("<tr>") == 2
    assert "omega (linear in time in 1 of 5 strips) was corrected" in verdict.paragraph(results)
    told = list(summary(results))
    assert "omega: corrected in 1 of 5 strips: strip 2 linear" in told
    assert "phi: corrected in 0 of 5 strips" in told


def test_verdict_of_a_constant_in_the_camera_frame_gives_its_size(area):
    names = {"omega": "pitch", "phi": "roll", "kappa": "yaw"}
    camera = {
        key: tuple(replace(r, angle=names[r.angle], frame="camera") for r in getattr(area, key))
        for key in ("regression", "angle_error_summary", "selection")
    }
    first, *others = camera["selection"]
    results = replace(
        area,
        settings=replace(area.settings, frame="camera", rules="strict"),
        verdict=replace(area.verdict, corrected_angles=("pitch",)),
        regression=(*area.regression, *camera["regression"]),
        angle_error_summary=(*area.angle_error_summary, *camera["angle_error_summary"]),
        selection=(replace(first, form="constant"), *others),
    )
    said = plain(verdict.paragraph(results))
    size = results.regression[0].constant_rad * 1e3
    assert f"pitch (constant of {size:.1f} mrad" in said
    assert "roll and yaw stayed as delivered" in said


def test_verdict_of_strips_that_differ_points_to_the_camera_frame(area):
    differ = {"p_value": 0.6, "strip_effect_sigma_rad": 0.02, "white_noise_sigma_rad": 2e-5}
    results = with_rows(area, "regression", lambda row: replace(row, **differ))
    assert "--frame auto --rules strict" in verdict.paragraph(results)
    results = replace(results, settings=replace(area.settings, frame_setting="auto"))
    assert "differs from strip to strip" in verdict.paragraph(results)
    assert "--frame auto" not in verdict.paragraph(results)


def test_verdict_says_what_a_poor_correction_leaves_in_the_angles(area):
    results = replace(area, verdict=replace(area.verdict, corrected_px=4.0))
    said = plain(verdict.paragraph(results))
    sigma = [round(row.sigma_rad * 1e6) for row in area.regression if row.scope == "block"]
    assert re.search(rf"What is left in the angles is {sigma[0] // 10}\d µrad in omega", said)
    assert "scatter from image to image about the lines" in said


def test_angles_known_less_well_than_the_pos_claims_are_named(area):
    assert "less well than the POS" not in html.render(block_document.build(area))
    sigma = {"omega": 3e-4, "phi": 1e-5, "kappa": 1e-5}
    results = with_rows(
        area, "angle_error_summary", lambda row: replace(row, median_sigma_rad=sigma[row.angle])
    )
    page = html.render(block_document.build(results))
    assert "Here they give omega only to 300 µrad (0.0172°)" in plain(page)


def stretched(image):
    corners = tuple((x, 8.0 * y) for x, y in image.footprint)
    return replace(image, y_m=8.0 * image.y_m, footprint=corners)


def test_a_long_block_is_turned_and_its_arrow_says_so(area):
    drawn = figures.draw(area)["plan"]
    assert "N →" not in drawn.svg
    turned = figures.draw(with_rows(area, "images", stretched))["plan"]
    assert "N →" in turned.svg
    assert "north to the right" in turned.caption


def test_a_turned_plan_is_a_rotation_of_the_ground_not_a_mirror_image():
    view = PlanView(west=100.0, east=200.0, south=0.0, north=1000.0, turned=True)
    east_north = [(110.0, 20.0), (190.0, 20.0), (190.0, 900.0)]
    ground, paper = np.array(east_north), view.on_paper(east_north)
    sides = [np.diff(corners, axis=0) for corners in (ground, paper)]
    assert np.linalg.det(sides[0]) == pytest.approx(np.linalg.det(sides[1]))
    assert paper[0].tolist() == [20.0, 90.0]


def test_no_word_of_a_decision_is_broken_on_paper(pdf_file):
    text = " ".join(pdf_pages(pdf_file))
    row = re.search(r"omega +ground +block +yes +linear", text)
    assert row, text
