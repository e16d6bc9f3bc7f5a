"""Topics that say something of some blocks only."""

from dataclasses import fields, replace

import pytest
from report_results import by_strips, with_rows
from shown_values import assert_column, paragraphs_of, tables_of

from posstats.contract.notice import Notice
from posstats.contract.results import Bundle, FrameComparison
from posstats.reports.block.document import build
from posstats.reports.block.words import words_in
from posstats.reports.document import format as fmt
from posstats.reports.document.content import Bullets

WORDS = words_in("en")


def test_check_points_that_none_could_be_intersected_make_no_table(area):
    numbers = [each.name for each in fields(area.check_points[0]) if each.name.endswith("_m")]
    none = dict.fromkeys(numbers) | {"n": 0}
    results = with_rows(area, "check_points", lambda row: replace(row, **none))
    document = build(replace(results, check_point_residuals=()))
    assert "check_points_shift_kept" not in tables_of(document)
    assert WORDS.text("check_points.none") in paragraphs_of(document)
    assert WORDS.text("ground.none_intersected") in document.verdict.summary


def test_decisions_by_strip_are_one_matrix_and_reasons_only_of_corrections(area):
    results = by_strips(area)
    tables = tables_of(build(results))
    matrix, reasons = tables["decisions_by_strip"], tables["decisions"]
    assert len(matrix.rows) == area.block.n_strips
    forms = [column.cells for column in matrix.columns[3::3]]
    linear, none = WORDS.text("form.linear"), WORDS.text("form.none")
    assert forms == [tuple(linear if k == 1 else none for k in range(5)), (none,) * 5, (none,) * 5]
    for column, angle in zip(matrix.columns[1::3], ("omega", "phi", "kappa"), strict=True):
        lines = [r for r in area.regression if r.angle == angle and r.scope != "block"]
        assert_column(column, [row.r_squared for row in lines])
    assert len(reasons.rows) == 1
    (corrected,) = [row for row in results.selection if row.correct]
    assert reasons.columns[-1].cells == (WORDS.reason(corrected.notices),)


def test_decisions_show_angle_form_and_reason_of_their_own_row(area, area_document):
    table = tables_of(area_document)["decisions"]
    assert table.columns[0].cells == tuple(row.angle for row in area.selection)
    assert table.columns[3].cells == tuple(WORDS.yes(row.correct) for row in area.selection)
    forms = tuple(WORDS.of("form", row.form) for row in area.selection)
    assert table.columns[4].cells == forms
    said = tuple(WORDS.reason(row.notices) for row in area.selection)
    assert table.columns[5].cells == said
    assert len(set(said)) == len(said)
    assert table.strong == {0}


def test_frames_are_compared_by_their_own_parallax(area):
    frames = tuple(
        FrameComparison(frame=frame, out_of_sample_px=px, raw_px=22.0, n_models=4)
        for frame, px in (("ground", 0.42), ("camera", 0.37))
    )
    table = tables_of(build(replace(area, frames=frames)))["frames"]
    assert table.rows == (("ground", "0.420"), ("camera", "0.370"))


def test_a_bundle_adjustment_is_a_topic_of_its_own(area, area_document):
    bundle = Bundle(
        sigma0=1.31, dof=201.0, p_value=0.0123, image_rms_px=0.21, sigma_image_px=0.34,
        n_rays=1500, n_rejected_rays=7, n_control_points=4,
    )  # fmt: skip
    document = build(replace(area, bundle=bundle))
    shown = tables_of(document)["bundle"].columns[1].cells
    assert shown == ("1.31", "201", "0.012", "0.210\u00a0px", "0.340\u00a0px", "1500", "7", "4")
    control = WORDS.counted("bundle.control", 4)
    assert any(text.endswith(control) for text in paragraphs_of(document))
    assert "bundle" not in tables_of(area_document)


def test_angles_known_less_well_than_the_pos_claims_are_named(area, area_document):
    stated = fmt.angle(area.settings.angle_rad)
    found = WORDS.text("limits.only_to", angle="omega", sigma=fmt.angle(3e-4))
    said = WORDS.text("limits.blind", found=found, stated=stated)
    sigma = {"omega": 3e-4, "phi": 1e-5, "kappa": 1e-5}
    loose = with_rows(
        area, "angle_error_summary", lambda row: replace(row, median_sigma_rad=sigma[row.angle])
    )
    assert any(text.endswith(said) for text in paragraphs_of(build(loose)))
    assert not any(found in text for text in paragraphs_of(area_document))


def test_warnings_are_the_notices_in_the_words_of_the_language(area, area_document):
    section = next(part for part in area_document.sections if part.id == "limits")
    (bullets,) = [item for item in section.items if isinstance(item, Bullets)]
    assert bullets.texts == tuple(WORDS.notice(each) for each in area.notices)


def test_without_notices_no_warning_is_made_up(area):
    document = build(replace(area, notices=()))
    assert WORDS.text("limits.no_warnings") in paragraphs_of(document)


def test_scopes_that_leave_nothing_open_have_no_row(area_document):
    table = tables_of(area_document)["observability"]
    assert table.columns[0].cells == tuple(WORDS.scope(str(k)) for k in range(1, 6))
    assert set(table.columns[1].cells) == {WORDS.rotations(["about_base_axis"])}


@pytest.mark.parametrize(("n", "more"), [(3, False), (14, True)])
def test_undetermined_images_are_listed_up_to_a_dozen(area, n, more):
    images = tuple(f"img{k}" for k in range(n))
    of_block = replace(area.observability[0], images=images)
    table = tables_of(build(replace(area, observability=(of_block,))))["observability"]
    (cell,) = table.columns[2].cells
    assert ("img11" in cell, "img12" in cell) == (more, False)
    assert (WORDS.text("list.more", n="2") in cell) == more


def test_regressions_that_could_not_be_made_are_told_with_their_reason(coarse):
    why = WORDS.notice(Notice(code="too_few_images", values={"n": 0, "n_needed": 3}))
    notes = tables_of(build(coarse))["regression_ols"].notes
    angles = WORDS.joined(["omega", "phi", "kappa"])
    single = [WORDS.scope(str(k)) for k in (3, 5, 8, 9, 12, 15)]
    said = WORDS.text("lines.not_fitted", angles=angles, scopes=WORDS.joined(single), why=why)
    assert said in notes


def test_settings_and_files_are_those_of_the_results(area, area_document):
    tables = tables_of(area_document)
    assert tables["inputs"].rows == tuple((f.file, f.sha256) for f in area.block.inputs)
    assert tables["versions"].rows == tuple(area.versions.items())
    assert [row[1] for row in tables["settings"].rows] == [
        "paper", "block", "coplanarity", "ground", "yes"
    ]  # fmt: skip
