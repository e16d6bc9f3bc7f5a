"""The report as its readers meet it: HTML and PDF made from results alone."""

import re
import sys
import xml.etree.ElementTree as ET
from dataclasses import fields, replace
from pathlib import Path

import pytest
from page_reading import assert_shown_without_fault, pdf_pages, plain, read
from report_results import with_rows
from shown_values import svgs_of, tables_of

from posstats.contract.notice import Notice
from posstats.contract.survey import InputFile
from posstats.errors import PosstatsError
from posstats.reports.block.document import build
from posstats.reports.block.report import write_report
from posstats.reports.block.words import words_in
from posstats.reports.pages import html, pdf

HOSTILE = "<script>alert(1)</script> \"a\", 'b' & $x_1$"
WORDS = words_in("en")


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
    told = Notice(code="images_untied", values={"n": 1, "ids": (HOSTILE,)})
    results = replace(results, block=block, notices=(told,))
    parsed = read(html.render(build(results)))
    assert "script" not in parsed.tags
    texts = [text.strip() for text in parsed.texts]
    assert texts.count(HOSTILE) >= 5
    assert sum(HOSTILE in text for text in texts) > texts.count(HOSTILE)  # in the warning


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
    assert WORDS.text("check_points.none") in html.render(build(empty))


def test_every_figure_is_well_formed_with_a_title_and_texts_as_texts(area_document):
    for name, svg in svgs_of(area_document).items():
        root = ET.fromstring(svg)  # noqa: S314 - made here
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
    build(area)
    assert settings() == before
    assert "matplotlib.pyplot" not in sys.modules


def test_figures_and_page_are_the_same_bytes_every_time(area, page):
    assert html.render(build(area)) == page


def test_the_chinese_report_is_chinese_throughout_and_holds_the_same_numbers(
    area, area_document, chinese_document
):
    """All that it says is what the English one says, but for the words."""
    english, chinese = area_document, chinese_document
    assert [part.id for part in chinese.sections] == [part.id for part in english.sections]
    tables = tables_of(chinese)
    for name, table in tables_of(english).items():
        for one, other in zip(table.columns, tables[name].columns, strict=True):
            if one.align == "right" and one.title != WORDS.text("column.interval"):
                assert one.cells == other.cells
    text = " ".join(read(html.render(chinese).split("</style>", 1)[1]).texts)
    for word in ("Table", "Figure", "strip ", "parallax", "error of", "median"):
        assert word not in text.replace(area.block.name, "")


def test_the_figures_of_a_chinese_report_are_in_its_typeface(area_document, chinese_document):
    drawn = svgs_of(chinese_document)
    assert set(drawn) == set(svgs_of(area_document))
    for svg in drawn.values():
        assert "posstats CJK" in svg


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
    for known in ("22.6 px (0.27 mm)", "Contents", "Table 1.", "Figure 1.", "Null hypothesis"):
        assert known in text


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


def test_no_word_of_a_decision_is_broken_on_paper(pdf_file):
    text = " ".join(pdf_pages(pdf_file))
    row = re.search(r"omega +ground +block +yes +linear", text)
    assert row, text
