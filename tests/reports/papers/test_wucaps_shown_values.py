"""Every cell of the report on the second paper against the run that it comes from."""

import json
import re

import numpy as np
import pytest
from paper_doubles import wucaps_run
from shown_values import assert_cell, assert_column, items_of, svgs_of, tables_of

from posstats.contract.files import as_values, from_json, to_json
from posstats.contract.wucaps import Wucaps
from posstats.papers.wucaps.findings import CRITERIA
from posstats.papers.wucaps.seeds import pooled, share
from posstats.papers.wucaps.situations import SITUATIONS, situation_scenario
from posstats.reports.papers.wucaps.conclusions import beyond, conclusions
from posstats.reports.papers.wucaps.document import TOPICS, build
from posstats.reports.papers.wucaps.report import Report
from posstats.reports.papers.wucaps.results import results
from posstats.reports.papers.wucaps.words import words_in

CREATED = "2026-01-05T00:00:00+00:00"
LANGUAGES = ("en", "zh")


@pytest.fixture(scope="module")
def run():
    return wucaps_run()


def report_in(language, run):
    words = words_in(language)
    return words, Report(run, conclusions(words, run), beyond(words, run))


@pytest.fixture(scope="module")
def documents(run):
    return {each: build(*report_in(each, run), CREATED) for each in LANGUAGES}


@pytest.fixture(scope="module", params=LANGUAGES)
def tables(request, documents):
    return tables_of(documents[request.param])


def of(rows, name):
    return [row.measures and getattr(row.measures, name) for row in rows]


@pytest.mark.parametrize("situation", SITUATIONS)
def test_check_points_show_their_rmse_its_prediction_and_the_ratio(run, tables, situation):
    rows = run.runs[situation].rows
    columns = tables[f"check_points_{situation}"].columns
    best = rows[-1].measures
    for column, name in zip(
        columns[2:6],
        ("horizontal_m", "vertical_m", "predicted_horizontal_m", "predicted_vertical_m"),
        strict=True,
    ):
        assert_column(column, of(rows, name))
    for column, name in zip(columns[6:], ("horizontal_m", "vertical_m"), strict=True):
        values = [value and value / getattr(best, name) for value in of(rows, name)]
        assert_column(column, values)


@pytest.mark.parametrize("situation", SITUATIONS)
def test_orientations_show_their_errors_and_the_parallax(run, tables, situation):
    rows = run.runs[situation].rows
    columns = tables[f"orientations_{situation}"].columns
    assert_column(columns[2], of(rows, "position_horizontal_m"))
    assert_column(columns[3], of(rows, "position_vertical_m"))
    for column, angle in zip(columns[4:7], ("omega", "phi", "kappa"), strict=True):
        values = [v and 1e3 * np.degrees(v) for v in of(rows, f"{angle}_rad")]
        assert_column(column, values, "")
    assert_column(columns[7], [v and 1e3 * v for v in of(rows, "parallax_mm")], "")


def test_undetermined_parameters_are_marked(run, tables):
    rows = run.runs["flat"].rows
    controls = tables["check_points_flat"].columns[1].cells
    assert [cell.endswith("*") for cell in controls] == [bool(row.undetermined) for row in rows]


def test_the_boresight_stands_beside_the_injected_one_in_degrees(run, tables):
    columns = tables["boresight"].columns
    names = ("roll", "pitch", "yaw")
    true = [
        getattr(situation_scenario(s).errors, n).constant_rad for s in SITUATIONS for n in names
    ]
    calibrations = [run.runs[s].calibration for s in SITUATIONS]
    found = np.concatenate([each.boresight_rad for each in calibrations])
    sigma = np.concatenate([np.sqrt(np.diag(each.covariance)) for each in calibrations])
    for column, values in zip(columns[2:5], (true, found, sigma), strict=True):
        assert_column(column, list(values))
    assert_column(columns[5], list((found - true) / sigma))


def test_shares_are_those_of_the_seeds(tables):
    for column, situation in zip(tables["shares"].columns[1:], SITUATIONS, strict=True):
        assert_column(column, [100.0 * share(name, situation) for name in CRITERIA], "")


def test_predictions_are_pooled_over_the_seeds(tables):
    columns = tables["predictions"].columns
    names = [f"weighted_{c}" for c in ("none", "centre", "corners", "all")] + ["reference"]
    lines = [(situation, name) for situation in SITUATIONS for name in names]
    for first, side in ((2, "horizontal"), (6, "vertical")):
        rmse, predicted, best = (
            np.array([pooled(text.format(name=n, side=side), s) for s, n in lines])
            for text in ("{name}_{side}_m", "{name}_predicted_{side}_m", "reference_{side}_m")
        )
        shown = (rmse, predicted, rmse / predicted, rmse / best)
        for column, values in zip(columns[first : first + 4], shown, strict=True):
            assert_column(column, list(values))


def test_key_figures_are_the_rmse_of_calibrated_pos_and_adjustment(run, documents):
    shown = documents["zh"].key_figures
    for k, found in enumerate(run.findings.values()):
        for figure, name in zip(shown[2 * k :], ("calibrated", found.recommended), strict=False):
            sides = [getattr(found, f"{name}_{side}_m") for side in ("horizontal", "vertical")]
            for cell, value in zip(figure.value.split(" / "), sides, strict=True):
                assert_cell(cell, value)


@pytest.mark.parametrize("language", LANGUAGES)
def test_conclusions_say_whether_their_criterion_holds(run, language):
    words, report = report_in(language, run)
    flat, mountain = run.findings["flat"], run.findings["mountain"]
    both = {"calibration_is_not_enough", "unknowns_are_needed", "calibration_is_dispensable",
            "parallax_is_removed", "one_point_leaves_free_unknowns_open"}  # fmt: skip
    expected = {
        words.of("title", name): getattr(flat, name) and getattr(mountain, name) for name in both
    }
    for name in ("errors_are_removed", "less_control_is_not_enough"):
        for situation, found in run.findings.items():
            expected[words.of("title", f"{name}_{situation}")] = getattr(found, name)
    told = {each.title: each.holds for each in (*report.conclusions, *report.beyond)}
    assert told == expected
    assert len(set(told.values())) == 2


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_topic_and_figure_is_there_and_numbers_are_readable(documents, language):
    document = documents[language]
    assert len(document.sections) == len(TOPICS)
    assert set(svgs_of(document)) == {
        "wucaps_plan", "wucaps_parallax", *(f"wucaps_accuracy_{s}" for s in SITUATIONS)
    }  # fmt: skip
    assert not re.search(r"\b(None|nan|inf)\b|[{}]", repr(document.verdict))
    assert document.language == language


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


def test_the_file_is_read_back_and_holds_every_row(run):
    _, report = report_in("en", run)
    made = results(report, CREATED)
    assert from_json(to_json(made), Wucaps, "wucaps.json") == made
    rows = json.loads(to_json(made))["rows"]
    expected = [row for each in run.runs.values() for row in each.rows]
    for written, row in zip(rows, expected, strict=True):
        measures = {} if row.measures is None else as_values(row.measures)
        assert {name: written[name] for name in measures} == measures
        assert ("vertical_m" in written) == (row.measures is not None)
        assert written["determined"] == (bool(measures) and not row.undetermined)
