"""The acceptance document as its readers meet it, in both languages."""

import copy
import re
import subprocess
import xml.etree.ElementTree as ET
from pathlib import Path

import acceptance_values as values
import pytest
from needed import chinese_typeface, program
from page_reading import assert_shown_without_fault, pdf_pages, plain, read

from posstats.errors import PosstatsError
from posstats.reports.acceptance import figures as acceptance_figures
from posstats.reports.acceptance import words as acceptance_words
from posstats.reports.acceptance.document import build
from posstats.reports.acceptance.page import render_document, unshown
from posstats.reports.acceptance.units import lengths
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


@pytest.mark.parametrize(
    ("case", "said"),
    [
        ("accepted", ("✓ Accepted", "All 9 requirements assessed are met.")),
        ("rejected", ("✗ Rejected", "2 of 9 requirements are not met: horizontal RMSE of the")),
        ("not assessable", ("? Not assessable", "4 mandatory requirements could not be assessed")),
        ("borderline", ("The 95 % interval includes the limit.", "With 2431 check points")),
        (
            "few",
            ("With 12 check points the RMSE is known only roughly", "12 falls short of the 30"),
        ),
        ("none", ("No check point could be used", "There are no check points.")),
    ],
)
def test_the_page_says_the_verdict_and_why(pages, case, said):
    text = re.sub(r"\s+", " ", words_on(pages[case]))
    for words in said:
        assert words in text


def test_the_first_page_names_standard_class_orientation_and_statement(pages):
    first = re.sub(r"\s+", " ", words_on(pages["accepted"])).split("Contents")[0]
    for words in (
        "PA-3F2A-91C0-77DE",
        "2026-01-05",
        "horizontal 10 cm, vertical 10 cm",
        "POS with the selected corrections. The results hold neither a bundle adjustment",
        "was found to be RMSE H = 7.2 (cm).",
        "Simulated data.",
        "7.23 cm",
        "≤ 10.00 cm",
    ):
        assert words in first


def test_a_real_block_carries_no_mark_and_a_simulated_one_does():
    real = values.acceptance(40, simulated=False)
    page = render_document(real, values.results(simulated=False), {})
    assert "Simulated" not in words_on(page).replace("area 1, simulated", "")
    assert "The data are simulated" in words_on(render_document(values.acceptance(40), RESULTS, {}))


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
    coarse = copy.deepcopy(CASES["accepted"])
    for row in coarse["requirements"]:
        if row["unit"] == "m":
            row["limit"] *= 50.0
    coarse["product"] |= {"class_h_m": 5.0, "class_v_m": 5.0}
    text = words_on(render_document(coarse, RESULTS, {})).split("How to verify")[0]
    assert lengths(coarse).unit.name == "m"
    assert not re.search(r"\d cm\b", text.replace("10.0 (cm)", ""))


def test_different_numbers_never_look_the_same():
    row = dict(CASES["accepted"]["requirements"][0], found=0.100004, limit=0.1)
    words = acceptance_words.words_of(CASES["accepted"])
    said = acceptance_words.reason(words, row | {"reason_code": "exceeds"})
    assert plain(said) == "10.0004 cm is beyond the limit of 10.0000 cm."


def test_every_check_point_is_listed_once_with_its_differences(pages):
    table = re.search(r'id="table-check_points".*?</table>', pages["accepted"], re.DOTALL)[0]
    assert len(re.findall(r"<tr>", table)) == 201
    assert "fewer than two rays" in table
    assert "blunder" in table


def test_figures_are_vectors_with_alternative_text():
    case = CASES["borderline"]
    drawn = acceptance_figures.draw(acceptance_words.words_of(case), case, RESULTS)
    assert set(drawn) == {"shares", "histograms", "point_plan", "parallax_by_strip",
                          "regression_by_angle"}  # fmt: skip
    for name, drawing in drawn.items():
        root = ET.fromstring(drawing.svg)  # noqa: S314 - made here
        assert root[0].text == drawing.title
        assert root.findall(".//{*}text"), name
        assert not root.findall(".//{*}image"), name


def test_the_same_arguments_give_the_same_bytes(pages):
    before = copy.deepcopy(CASES["few"])
    assert render_document(CASES["few"], RESULTS, {}) == pages["few"]
    assert CASES["few"] == before


def test_data_that_are_no_acceptance_are_refused():
    with pytest.raises(PosstatsError, match="not the data of an acceptance document"):
        render_document({"language": "en"}, RESULTS, {})
    with pytest.raises(PosstatsError, match="no language"):
        render_document(CASES["few"] | {"language": "xx"}, RESULTS, {})


def test_reasons_for_the_data_are_those_of_the_pages(pages):
    text = re.sub(r"\s+", " ", words_on(pages["not assessable"]))
    for reason in acceptance_words.reasons(CASES["not assessable"]):
        assert plain(reason) in text


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
        for given in (*RESULTS["warnings"], *CASES["rejected"]["profile"]["notes"]):
            ours = ours.replace(given, "")
        assert word not in ours
    assert '<html lang="zh-CN">' in pages["zh"]


def test_chinese_is_embedded_bold_too_and_in_english_documents(pages):
    for name in ("zh", "chinese names"):
        faces = re.findall(r'"posstats CJK"; font-weight: (\w+)', pages[name])
        assert faces == ["normal", "bold"], name
    assert 'posstats CJK"; font-weight' not in pages["accepted"]


def test_characters_that_cannot_be_shown_are_named_and_do_not_stop_figures():
    case, results = copy.deepcopy(CASES["few"]), copy.deepcopy(RESULTS)
    case["check_points"][0]["point"] = "क1"
    for key in ("images", "models", "angle_errors", "parallax"):
        for row in results[key]:
            row["strip"] = "ꀀ" if row["strip"] == "1" else row["strip"]
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
