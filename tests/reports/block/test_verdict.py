"""The verdict on a block: what is said of which numbers, by the words of the catalogue."""

import math
import re
from dataclasses import replace

import pytest
from report_results import by_strips, with_rows

from posstats.reports.block.summary import summary
from posstats.reports.block.verdict import is_coarse, paragraph
from posstats.reports.block.words import BlockReport, words_in
from posstats.reports.document import format as fmt

WORDS = words_in("en")


def told(results):
    return paragraph(BlockReport(results, WORDS))


def line_of(results, angle, scope="block"):
    return next(r for r in results.regression if r.angle == angle and r.scope == scope)


def px(value):
    return fmt.with_unit(value, "px")


def test_parallax_is_told_with_its_multiple_of_relative_orientation(area):
    free = WORDS.text("raw.remarks", value=px(0.28), remarks="0.0034\u00a0mm")
    found = WORDS.text("raw.remarks", value=px(22.6), remarks="0.27\u00a0mm")
    noise = WORDS.text("raw.noise", noise="0.27\u00a0px")
    n = fmt.count(len(area.models))
    said = WORDS.text("raw.times", found=found, n=n, times="81", free=free, noise=noise)
    assert said in told(area)


def test_a_skewed_mean_is_told_with_its_median(area):
    skewed = replace(area, verdict=replace(area.verdict, raw_median_px=11.3))
    assert WORDS.text("raw.median", median=px(11.3)) in told(skewed)


def mean_px(results, held):
    rows = [row for row in results.error_sources if row.fixed == held]
    return sum(row.n_models * row.mean_px for row in rows) / sum(row.n_models for row in rows)


@pytest.mark.parametrize(("share", "kind"), [(None, "all"), (0.95, "all"), (0.5, "most")])
def test_the_cause_is_told_with_what_holding_it_leaves(area, share, kind):
    found = replace(area, verdict=replace(area.verdict, cause="kappa", cause_share=share))
    held, every = px(mean_px(area, "kappa")), px(mean_px(area, "angles"))
    said = WORDS.text(f"cause.{kind}_by_holding", angle="kappa", held=held, every=every)
    assert said in told(found)


def test_parallax_near_that_of_relative_orientation_needs_no_cause(area):
    good = replace(area, verdict=replace(area.verdict, cause=None, raw_px=0.3))
    assert WORDS.text("cause.none") in told(good)


def test_an_error_that_follows_time_is_told_with_its_rate_and_whether_it_is_sure(area):
    row = line_of(area, "omega")
    said = told(area)
    assert fmt.rate(row.slope_rad_per_s) in said
    assert fmt.angle(row.intercept_rad) in said
    unit = fmt.rate_unit(row.gls_slope_ci95)
    ends = WORDS.interval(*(fmt.number(unit.scaled(end)) for end in row.gls_slope_ci95))
    assert WORDS.text("surely.yes", ends=ends, unit=unit.name) in said


def test_an_interval_that_includes_zero_proves_no_drift(area):
    doubtful = with_rows(area, "regression", lambda r: replace(r, gls_slope_ci95=(-1e-7, 9e-7)))
    unit = fmt.rate_unit([-1e-7, 9e-7])
    ends = WORDS.interval(fmt.number(-1.0), fmt.number(9.0))
    assert WORDS.text("surely.not", ends=ends, unit=unit.name) in told(doubtful)


def test_strips_that_differ_point_to_the_camera_frame_unless_it_was_tried(area):
    sizes = {"p_value": 0.6, "strip_effect_sigma_rad": 0.02, "white_noise_sigma_rad": 2e-5}
    differ = with_rows(area, "regression", lambda row: replace(row, **sizes))
    sigma = fmt.angle(0.02)
    assert WORDS.text("time.like_misalignment", sigma=sigma) in told(differ)
    tried = replace(differ, settings=replace(area.settings, frame_setting="auto"))
    assert WORDS.text("time.strips_differ", sigma=sigma) in told(tried)
    assert "--frame auto" not in told(tried)


def correction(results):
    return WORDS.text("correction.by", rules=results.settings.rules)


def test_the_correction_is_told_with_its_form_and_what_stayed(area):
    what = WORDS.text("correction.angle", angle="omega", form=WORDS.text("form_in_words.linear"))
    others = WORDS.joined(["phi", "kappa"])
    said = WORDS.counted("correction.made_alone", 1, rules=correction(area), what=what,
                         others=others)  # fmt: skip
    assert said in told(area)
    found = WORDS.text("raw.remarks", value=px(0.4), remarks="0.0048\u00a0mm")
    left = WORDS.text("left.times", found=found, times="1.4")
    assert WORDS.text("left.sentence", left=left) in told(area)


def test_a_constant_in_the_camera_frame_is_told_with_its_size(area):
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
    size = fmt.angle(line_of(area, "omega").constant_rad)
    form = WORDS.text("correction.constant_of", size=size)
    what = WORDS.text("correction.angle", angle="pitch", form=form)
    said = WORDS.counted("correction.made_alone", 1, rules=correction(results), what=what,
                         others=WORDS.joined(["roll", "yaw"]))  # fmt: skip
    assert said in told(results)


def test_corrections_of_strips_are_counted(area):
    results = by_strips(area)
    form = WORDS.text("correction.in_strips", forms=WORDS.text("form_in_words.linear"), n="1",
                      total=fmt.count(area.block.n_strips))  # fmt: skip
    assert WORDS.text("correction.angle", angle="omega", form=form) in told(results)
    lines = {line.partition(":")[0]: line for line in summary(results)}
    assert re.findall(r"\d+", lines["omega"]) == ["1", "5", "2"]
    assert lines["omega"].endswith("strip 2 linear")
    assert re.findall(r"\d+", lines["phi"]) == ["0", "5"]


def test_what_a_poor_correction_leaves_in_the_angles_is_told(area):
    poor = replace(area, verdict=replace(area.verdict, corrected_px=4.0))
    rms = {row.angle: row.rms_rad for row in area.angle_error_summary}
    left = [line_of(area, "omega").sigma_rad, rms["phi"], rms["kappa"]]
    unit = fmt.angle_unit(left)
    sizes = [
        WORDS.text("left.size_in", size=fmt.with_unit(unit.scaled(v), unit.name, 2), angle=a)
        for a, v in zip(("omega", "phi", "kappa"), left, strict=True)
    ]
    lines = [line_of(area, a).sigma_rad for a in ("omega", "phi", "kappa")]
    about = WORDS.joined(fmt.number(unit.scaled(value), 2) for value in lines)
    said = WORDS.text("left.scatter", sizes=WORDS.joined(sizes), lines=about, unit=unit.name)
    assert said in told(poor)
    assert WORDS.joined(sizes) not in told(area)


def test_check_points_are_told_before_and_after_with_their_mean(area):
    rows = {r.orientation: r for r in area.check_points if r.translation_removed}
    before, after = (
        WORDS.text("ground.accuracy", h=fmt.with_unit(row.rmse_horizontal_m, "m"),
                   v=fmt.with_unit(row.rmse_vertical_m, "m"))
        for row in (rows["pos"], rows["selected"])
    )  # fmt: skip
    x, y, z = rows["selected"].shift_m
    said = WORDS.text(
        "ground.after_and_shift",
        n="15",
        before=before,
        after=after,
        h=fmt.with_unit(math.hypot(x, y), "m"),
        v=fmt.with_unit(abs(z), "m"),
    )
    assert said in told(area)


def test_what_single_strips_leave_open_is_told(area):
    rotations = WORDS.rotations(["about_base_axis"])
    assert told(area).endswith(WORDS.text("blind.strips", rotations=rotations))


def test_a_coarse_pos_is_called_so_with_the_size_of_each_error(coarse):
    assert is_coarse(coarse)
    said = told(coarse)
    assert said.startswith(WORDS.text("coarse.found"))
    sizes = [fmt.with_unit(math.degrees(row.rms_rad), "°", 2) for row in coarse.angle_error_summary]
    errors = WORDS.joined(
        WORDS.text("coarse.error", angle=row.angle, size=size)
        for row, size in zip(coarse.angle_error_summary, sizes, strict=True)
    )
    assert WORDS.text("coarse.errors", errors=errors) in said
    assert WORDS.text("ground.none_given") in said
    only = WORDS.text("coarse.only")
    assert WORDS.text("correction.none_coarse", rules=correction(coarse), only=only) in said
    assert "mm" not in said


def test_a_block_without_models_tells_nothing_of_the_angles(area):
    nothing = replace(area.verdict, raw_px=None, relative_px=None, corrected_px=None)
    assert told(replace(area, verdict=nothing)).startswith(WORDS.text("verdict.none"))


@pytest.mark.parametrize("language", ["en", "zh"])
def test_the_verdict_holds_the_same_numbers_in_both_languages(area, coarse, language):
    for results in (area, coarse):
        said = paragraph(BlockReport(results, words_in(language)))
        assert px(results.verdict.raw_px) in said
        assert px(results.verdict.relative_px) in said
        assert results.settings.rules in said
