"""The acceptance document as its readers meet it, in both languages."""

import re
import subprocess
import xml.etree.ElementTree as ET
from dataclasses import replace
from pathlib import Path

import acceptance_values as values
import pytest
from needed import chinese_typeface, program
from page_reading import assert_shown_without_fault, pdf_pages, plain, read

from posstats.contract.acceptance import Acceptance
from posstats.contract.files import from_values
from posstats.errors import PosstatsError
from posstats.reports.acceptance import words as acceptance_words
from posstats.reports.acceptance.document import build
from posstats.reports.acceptance.page import render_document, unshown
from posstats.reports.acceptance.units import lengths
from posstats.reports.document.catalogue import catalogue
from posstats.reports.document.words import Words
from posstats.reports.pages import pdf
from posstats.reports.typefaces import cjk

CASES = values.cases()
RESULTS = values.results()


@pytest.fixture(scope="module")
def pages() -> dict[str, str]:
    chinese_typeface()
    made = {name: render_document(case, RESULTS, {}) for name, case in CASES.items()}
    chinese = values.chinese_contract(CASES["rejected"])
    return made | {"zh": render_document(chinese, RESULTS, {})}


def words_on(page: str) -> str:
    return plain(" ".join(read(page.split("</style>", 1)[1]).texts))


def said(message: str, case: str = "accepted", n: int | None = None, **values: str) -> str:
    """A message of the catalogue as it stands on a page."""
    words = acceptance_words.words_of(CASES[case])
    text = words.text(message, **values) if n is None else words.counted(message, n, **values)
    return single_spaced(text)


def single_spaced(text: str) -> str:
    return re.sub(r"\s+", " ", plain(text))


def names_of(case: str, **conditions: str | bool) -> str:
    words, rows = acceptance_words.words_of(CASES[case]), CASES[case].requirements
    named = zip(words.requirements(rows), rows, strict=True)
    return words.listed(
        [n for n, r in named if all(getattr(r, k) == v for k, v in conditions.items())],
        acceptance_words.NAMED,
    )


def test_the_page_says_the_verdict_and_why(pages):
    failed = names_of("rejected", verdict="fail")
    unsettled = names_of("not assessable", verdict="not assessed", mandatory=True)
    expected = {
        "accepted": ("✓ Accepted", said("summary.pass", n=9)),
        "rejected": ("✗ Rejected", said("summary.fail", n=2, total="9", names=failed)),
        "not assessable": ("? Not assessable", said("summary.open", n=4, names=unsettled)),
        "borderline": (said("evidence.borderline"), "2431"),
        "few": (said("limits.few", n=12, enough="30"),
                said("reason.exceeds_at_least", found="12", limit="30")),
        "none": (said("accuracy.none"), said("check_points.none")),
    }  # fmt: skip
    for case, texts in expected.items():
        text = single_spaced(words_on(pages[case]))
        for words in texts:
            assert words in text, case


def test_the_first_page_names_standard_class_orientation_and_statement(pages):
    first = single_spaced(words_on(pages["accepted"])).split("Contents")[0]
    for words in (
        "PA-3F2A-91C0-77DE",
        "2026-01-05",
        "horizontal 10 cm, ",
        "vertical 10 cm",
        said("orientation.selected"),
        said("orientation_reason.selected"),
        "RMSE H = 7.2 (cm)",
        said("mark.sentence"),
        "7.23 cm",
        "≤ 10.00 cm",
    ):
        assert words in first


def test_a_real_block_carries_no_mark_and_a_simulated_one_does(pages):
    real = values.acceptance(40, simulated=False)
    page = render_document(real, values.results(simulated=False), {})
    assert "Simulated" not in words_on(page).replace("area 1, simulated", "")
    assert said("limits.simulated") in single_spaced(words_on(pages["accepted"]))


def test_ids_and_names_are_text_wherever_they_appear(pages):
    page = pages["hostile"]
    parsed = read(page)
    assert "script" not in parsed.tags
    assert page.count("</style>") == 1
    assert "\u202e" not in page
    texts = "\n".join(parsed.texts)
    assert texts.count(values.HOSTILE) >= 6
    assert texts.count(values.FORMULA) >= 3
    assert not re.search(r"\b49\b", words_on(page).split("Contents")[0])


def test_nothing_is_loaded_and_no_id_is_repeated(pages):
    for name, page in pages.items():
        parsed = read(page)
        assert all(link.startswith(("#", "data:")) for link in parsed.links), name
        assert len(parsed.ids) == len(set(parsed.ids)), name
        targets = {link[1:] for link in parsed.links if link.startswith("#")}
        assert targets <= set(parsed.ids), name
        assert "default-src 'none'" in page


def test_no_word_of_the_program_and_no_endless_number_is_shown(pages):
    for page in pages.values():
        text = re.sub("[Nn]ull hypothesis", "", words_on(page))
        assert not re.search(r"\b(None|nan|NaN|inf|null|undefined)\b", text)
        assert not re.search(r"\d\.\d{7,}", text)
        assert "{" not in text.replace(values.FORMULA, "").replace("{report.version}", "")


def test_lengths_have_one_unit_throughout(pages):
    assert lengths(CASES["accepted"]).unit.name == "cm"
    case = CASES["accepted"]
    rows = [replace(r, limit=50.0 * r.limit) if r.unit == "m" else r for r in case.requirements]
    product = replace(case.product, class_h_m=5.0, class_v_m=5.0)
    coarse = replace(case, requirements=tuple(rows), product=product)
    text = words_on(render_document(coarse, RESULTS, {})).split("How to verify")[0]
    assert lengths(coarse).unit.name == "m"
    assert not re.search(r"\d cm\b", text.replace("10.0 (cm)", ""))


def test_different_numbers_never_look_the_same():
    row = replace(
        CASES["accepted"].requirements[0], found=0.100004, limit=0.1, reason_code="exceeds"
    )
    words = acceptance_words.words_of(CASES["accepted"])
    shown = acceptance_words.reason(words, row)
    assert re.findall(r"[\d.]+ cm", plain(shown)) == ["10.0004 cm", "10.0000 cm"]


def test_every_check_point_is_listed_once_with_its_differences(pages):
    table = re.search(r'id="table-check_points".*?</table>', pages["accepted"], re.DOTALL)[0]
    assert len(re.findall(r"<tr>", table)) == 201
    assert said("status.fewer_than_two_rays") in table
    assert said("status.blunder") in table


def test_figures_are_vectors_with_alternative_text():
    document = build(CASES["borderline"], RESULTS)
    items = [item for section in document.sections for item in section.items]
    drawn = {item.drawing.name: item.drawing for item in items if item.kind == "figure"}
    assert set(drawn) == {"shares", "histograms", "point_plan", "parallax_by_strip",
                          "regression_by_angle"}  # fmt: skip
    for name, drawing in drawn.items():
        root = ET.fromstring(drawing.svg)  # noqa: S314 - made here
        assert root[0].text == drawing.title
        assert root.findall(".//{*}text"), name
        assert not root.findall(".//{*}image"), name


def test_the_same_arguments_give_the_same_bytes(pages):
    assert render_document(values.cases()["few"], RESULTS, {}) == pages["few"]


def test_data_that_are_no_acceptance_are_refused():
    with pytest.raises(PosstatsError, match="posstats-acceptance/1"):
        from_values({"language": "en"}, Acceptance, "acceptance.json")
    with pytest.raises(PosstatsError, match="language"):
        values.edited(CASES["few"], lambda made: made.update(language="xx"))


def test_reasons_for_the_data_are_those_of_the_pages(pages):
    text = single_spaced(words_on(pages["not assessable"]))
    words = acceptance_words.words_of(CASES["not assessable"])
    for row in CASES["not assessable"].requirements:
        assert single_spaced(acceptance_words.reason(words, row)) in text


# Chinese


def test_without_a_chinese_typeface_the_error_names_the_package(monkeypatch, tmp_path):
    fake = tmp_path / "fc-match"
    fake.write_text("#!/bin/sh\nprintf '/usr/share/fonts/none.ttf\\n0\\n'\n")
    fake.chmod(0o755)
    monkeypatch.setenv("PATH", str(tmp_path))
    cjk.font_file.cache_clear()
    try:
        with pytest.raises(PosstatsError, match="fonts-noto-cjk or fonts-wqy-microhei"):
            render_document(values.chinese_contract(CASES["few"]), RESULTS, {})
        with pytest.raises(PosstatsError, match="fonts-wqy-microhei"):
            render_document(CASES["chinese names"], RESULTS, {})
        render_document(CASES["few"], RESULTS, {})
        monkeypatch.setenv("PATH", "")
        cjk.font_file.cache_clear()
        with pytest.raises(PosstatsError, match="fontconfig"):
            render_document(values.chinese_contract(CASES["few"]), RESULTS, {})
    finally:
        cjk.font_file.cache_clear()


def test_the_chinese_page_is_chinese_throughout(pages):
    text = words_on(pages["zh"])
    for words in ("验收结论", "不合格", "产品平面中误差", "检查点", "上下视差", "限值", "委托单位"):
        assert words in text
    ours = re.sub(r"Edition.*?\n|ASPRS[^\n]*", "", text)
    for word in ("Requirement", "limit", "Table", "Figure", "strip", "Accepted", "check point"):
        for given in CASES["rejected"].profile.notes:
            ours = ours.replace(given, "")
        assert word not in ours
    assert '<html lang="zh-CN">' in pages["zh"]


def test_warnings_and_open_rotations_are_told_in_the_language_of_the_document(pages):
    (notice,) = RESULTS.notices
    for page, language in (("rejected", "en"), ("zh", "zh")):
        words = Words(catalogue(language, "document", "notices"))
        text = words_on(pages[page])
        assert words.notice(notice) in text
        assert words.text("rotation.about_base_axis") in text
    assert RESULTS.warnings[0] not in words_on(pages["zh"])


def test_chinese_is_embedded_bold_too_and_in_english_documents(pages):
    for name in ("zh", "chinese names"):
        faces = re.findall(r'"posstats CJK"; font-weight: (\w+)', pages[name])
        assert faces == ["normal", "bold"], name
    assert 'posstats CJK"; font-weight' not in pages["accepted"]


def test_characters_that_cannot_be_shown_are_named_and_do_not_stop_figures():
    def rename_point(made):
        made["check_points"][0]["point"] = "क1"

    def rename_strip(made):
        for key in ("images", "models", "angle_errors", "parallax"):
            for row in made[key]:
                row["strip"] = "ꀀ" if row["strip"] == "1" else row["strip"]

    case, results = values.edited(CASES["few"], rename_point), values.edited(RESULTS, rename_strip)
    assert {"क", "ꀀ"} >= set(unshown(case, results))
    page = render_document(case, results, {})
    for letter in unshown(case, results):
        assert f"U+{ord(letter):04X}" in page


# The PDF


@pytest.fixture(scope="module")
def pdf_files(pages, tmp_path_factory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("pdf")
    made = {}
    for name in {"long", "zh"} & set(pages):
        made[name] = folder / f"{name}.pdf"
        made[name].write_bytes(pdf.render(pages[name]))
    return made


def test_every_page_is_numbered_marked_and_carries_the_document_id(pdf_files):
    for name, path in pdf_files.items():
        told = pdf_pages(path)
        assert len(told) >= 12
        for number, text in enumerate(told, start=1):
            assert "PA-3F2A-91C0-77DE" in text
            expected = {"long": f"page {number} of {len(told)}",
                        "zh": f"第 {number} 页，共 {len(told)} 页"}[name]  # fmt: skip
            assert re.sub(r"\s+", " ", expected) in re.sub(r"\s+", " ", text)
            assert {"long": "Simulated data", "zh": "模拟数据"}[name] in text


def test_contents_have_page_numbers_and_signatures_stay_together(pdf_files):
    told = pdf_pages(pdf_files["long"])
    text = "\n".join(told[:3])
    for number, title in ((3, "Check points"), (10, "Signatures")):
        page = int(re.search(rf"{number} +{title} [ .]+(\d+)", text)[1])
        assert re.search(rf"{number} +{title}", told[page - 1])
    signatures = [page for page in told if "Signature, stamp" in page]
    assert len(signatures) == 1
    assert "For the client" in signatures[0]


def test_no_other_typeface_gets_into_the_pdf(pdf_files):
    for path in pdf_files.values():
        run = subprocess.run(
            [program("pdffonts", package="poppler-utils"), path],
            capture_output=True,
            text=True,
            check=True,
        )
        names = {line.split()[0].split("+")[1] for line in run.stdout.splitlines()[2:]}
        assert names <= {"DejaVu-Sans", "DejaVu-Sans-Bold", "posstats-CJK", "posstats-CJK-Bold"}


@pytest.mark.parametrize("width", [400, 1280])
def test_a_browser_sees_no_error_no_request_and_no_sideways_scrolling(pages, tmp_path, width):
    for name in ("long", "hostile", *({"zh"} & set(pages))):
        assert_shown_without_fault(pages[name], width, tmp_path)


def test_a_document_needs_no_more_than_frozen_data():
    document = build(CASES["few"], RESULTS)
    with pytest.raises(AttributeError):
        document.verdict.word = "Accepted"
