"""Every cell of the report on the first paper against the run that it comes from."""

import re

import numpy as np
import pytest
from paper_doubles import N_STRIPS, drift_run
from shown_values import assert_cell, assert_column, items_of, svgs_of, tables_of

from posstats.contract.comparison import Comparison
from posstats.contract.files import from_json, to_json
from posstats.papers.drift.areas import area_scenario
from posstats.papers.drift.findings import CRITERIA
from posstats.papers.drift.published import recomputed
from posstats.papers.drift.seeds import share
from posstats.reports.papers.conclusion import how_many
from posstats.reports.papers.drift.conclusions import conclusions
from posstats.reports.papers.drift.document import TOPICS, build
from posstats.reports.papers.drift.figures import draw_area
from posstats.reports.papers.drift.report import Report
from posstats.reports.papers.drift.results import results
from posstats.reports.papers.drift.words import words_in

CREATED = "2026-01-05T00:00:00+00:00"
LANGUAGES = ("en", "zh")
ANGLES = ("omega", "phi", "kappa")


@pytest.fixture(scope="module")
def run():
    return drift_run()


@pytest.fixture(scope="module")
def documents(run):
    made = {}
    for language in LANGUAGES:
        words = words_in(language)
        figures = {area: draw_area(words, area, run.results[area]) for area in N_STRIPS}
        made[language] = build(words, Report(run, conclusions(words, run), figures), CREATED)
    return made


@pytest.fixture(scope="module", params=LANGUAGES)
def tables(request, documents):
    return tables_of(documents[request.param])


def compared(run, table, **conditions):
    return [
        each
        for each in run.compared
        if each.table == table and all(getattr(each, k) == v for k, v in conditions.items())
    ]


def test_table_1_shows_every_quantity_as_printed_and_as_simulated(run, tables):
    columns = tables["areas"].columns
    for k, area in enumerate(N_STRIPS):
        found = compared(run, 1, area=area)
        assert_column(columns[2 * k + 1], [each.published for each in found], "")
        assert_column(columns[2 * k + 2], [each.reproduced for each in found], "")


def test_the_chosen_errors_are_those_of_the_scenarios(tables):
    columns = tables["simulated_errors"].columns
    for column, area in zip(columns[1:], N_STRIPS, strict=True):
        scenario = area_scenario(area)
        omega = scenario.errors.omega
        values = [1e3 * omega.constant_rad, 1e7 * omega.drift_rad_per_s, 1e6 * omega.noise_rad]
        for cell, value in zip(column.cells, values, strict=False):
            assert float(cell) == pytest.approx(value, rel=1e-9)
        assert float(column.cells[-1]) == scenario.terrain.relief_m


@pytest.mark.parametrize("method", ["pos", "independent", "dependent"])
def test_table_2_shows_every_strip_and_the_mean_of_the_area(run, tables, method):
    columns = tables[f"parallax_{method}"].columns
    places = [(area, strip) for area, n in N_STRIPS.items()
              for strip in (*map(str, range(1, n + 1)), None)]  # fmt: skip
    for first, statistic in ((2, "max"), (5, "min"), (8, "mean")):
        quantity = f"{method}_{statistic}_mm"
        found = {(e.area, e.strip): e for e in compared(run, 2, quantity=quantity)}
        shown = [found.get(place) for place in places]
        for column, name in zip(
            columns[first:], ("published", "reproduced", "ratio"), strict=False
        ):
            assert_column(column, [each and getattr(each, name) for each in shown], "")


def test_held_and_corrected_angles_show_the_findings(run, tables):
    found = run.findings.values()
    held, corrected = tables["held"].columns, tables["corrected"].columns
    for column, name in zip(held[1:5], ("angles", *ANGLES), strict=True):
        assert_column(column, [getattr(each, f"held_{name}_mm") for each in found], "")
    assert_column(held[5], [each.dependent_mm for each in found], "")
    for column, angle in zip(held[6:], ANGLES, strict=True):
        assert_column(column, [100.0 * each.kept_by[angle] for each in found], "")
    names = ("pos_mm", *(f"corrected_{angle}_mm" for angle in ANGLES), "independent_mm")
    for column, name in zip(corrected[1:6], names, strict=True):
        assert_column(column, [getattr(each, name) for each in found], "")
    ratios = [each.corrected_omega_mm / each.independent_mm for each in found]
    assert_column(corrected[6], ratios)


def test_table_3_shows_published_simulated_and_ratio_line_by_line(run, tables):
    columns = tables["one_strip"].columns
    for column, quantity in zip(columns[3:5], ("r_squared", "f_statistic"), strict=True):
        found = compared(run, 3, quantity=quantity)
        values = [v for each in found for v in (each.published, each.reproduced, each.ratio)]
        assert_column(column, values)


def test_lines_of_blocks_and_strips_show_their_regressions(run, tables):
    columns = tables["lines"].columns
    rows = [row for each in run.results.values() for row in each.regression
            if row.frame == "ground"]  # fmt: skip
    assert_column(columns[3], [row.n for row in rows])
    assert_column(columns[4], [row.intercept_rad for row in rows])
    assert_column(columns[5], [row.slope_rad_per_s for row in rows])
    for column, name in ((columns[8], "p_value"), (columns[9], "gls_p_value")):
        for cell, row in zip(column.cells, rows, strict=True):
            value = getattr(row, name)
            assert cell == "< 0.001" if value < 0.001 else float(cell) == round(value, 3)


def test_table_4_shows_published_simulated_and_ratio_line_by_line(run, tables):
    columns = tables["check_points"].columns
    quantities = [f"{statistic}_{side}_m" for statistic in ("max", "min", "rmse")
                  for side in ("horizontal", "vertical")]  # fmt: skip
    for column, quantity in zip(columns[4:], quantities, strict=True):
        found = compared(run, 4, quantity=quantity)
        values = [v for each in found for v in (each.published, each.reproduced, each.ratio)]
        assert_column(column, values)


def test_shares_and_recomputed_numbers_are_shown(tables):
    for column, area in zip(tables["shares"].columns[1:], N_STRIPS, strict=True):
        shown = [None if name == "only_omega_is_linear" and area != 1 else 100.0 * share(name, area)
                 for name in CRITERIA]  # fmt: skip
        assert_column(column, shown, "")
    columns, printed = tables["printed_regression"].columns, recomputed(58)
    assert_column(columns[1], [each.r_squared for each in printed])
    assert_column(columns[3], [each.zero_crossing_t for each in printed])


def test_key_figures_are_those_of_area_1(run, documents):
    (strip,) = compared(run, 3, angle="omega", quantity="r_squared")
    means = [
        compared(run, 2, area=1, strip=None, quantity=f"{method}_mean_mm")[0].reproduced
        for method in ("pos", "independent")
    ]
    values = (*means, strip.reproduced, run.findings[1].corrected_omega_mm)
    for figure, value in zip(documents["zh"].key_figures, values, strict=True):
        assert_cell(figure.value, value)


@pytest.mark.parametrize("language", LANGUAGES)
def test_conclusions_hold_if_they_hold_in_every_area(run, language):
    words = words_in(language)
    told = {each.title: each.holds for each in conclusions(words, run)}
    for name in set(CRITERIA) - {"only_omega_is_linear"}:
        expected = all(getattr(each, name) for each in run.findings.values())
        assert told[words.of("title", name)] == expected
    assert told[words.of("title", "only_omega_is_linear")] == run.findings[1].only_omega_is_linear
    corrected = [row.rmse_horizontal_m for each in run.results.values() for row in each.check_points
                 if (row.orientation, row.translation_removed) == ("omega", False)]  # fmt: skip
    assert told[words.of("title", "orthophoto")] == (max(corrected) <= 5.0)


@pytest.mark.parametrize("language", LANGUAGES)
def test_the_verdict_counts_what_holds_and_names_what_does_not(run, language):
    words = words_in(language)
    found = conclusions(words, run)
    failed = [k for k, each in enumerate(found, start=1) if not each.holds]
    assert failed
    told = [int(each) for each in re.findall(r"\d+", how_many(words, found))]
    assert sorted(told) == sorted([len(found) - len(failed), len(found), *failed])


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_topic_and_figure_is_there_and_numbers_are_readable(documents, language):
    document = documents[language]
    assert len(document.sections) == len(TOPICS)
    names = ("error_sources", "regression", "corrected")
    assert set(svgs_of(document)) == {f"area{area}_{name}" for area in N_STRIPS for name in names}
    said = " ".join(getattr(item, "text", "") for item in items_of(document))
    assert not re.search(r"\b(None|nan|inf)\b|[{}]", said + document.verdict.summary)


def test_the_chinese_document_has_the_numbers_of_the_english_one(documents):
    """Cells that hold numbers only are the same; nothing is in English but names of files."""
    english, chinese = (tables_of(documents[each]) for each in LANGUAGES)
    assert english.keys() == chinese.keys()
    for name, table in english.items():
        for ours, theirs in zip(table.columns, chinese[name].columns, strict=True):
            if ours.align == "right":
                assert ours.cells == theirs.cells, name
    said = [getattr(item, "text", "") for item in items_of(documents["zh"])]
    assert not [text for text in said if re.search(r"([a-z]+ ){4}", text)]


def test_the_file_is_read_back_and_holds_every_number(run):
    words = words_in("en")
    made = results(run, conclusions(words, run), CREATED)
    assert from_json(to_json(made), Comparison, "comparison.json") == made
    assert made.rows == run.compared
    linear = [each for each in made.seed_shares if each.finding == "only_omega_is_linear"]
    assert [each.area for each in linear] == [1]
    assert np.isclose(linear[0].share, share("only_omega_is_linear", 1))
