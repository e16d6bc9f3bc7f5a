"""The verdict on a block in one paragraph of plain words."""

import math
from collections.abc import Iterator

from posstats.contract.check_points import CheckPointStatistics
from posstats.contract.results import Results

from ..document import format as fmt
from ..document.rows import first, rows
from .verdict_cause import NEAR_RELATIVE, cause, over_time
from .view import angles, decided_by_strip
from .words import BlockReport, Words

COARSE_PX = 50.0  # neither stereo viewing nor matching bridges this much parallax
MUCH_LEFT = 3.0  # multiple of relative orientation's from which the rest is explained
SKEWED = 1.25  # mean over median from which the median is told beside the mean


def paragraph(report: BlockReport) -> str:
    """The verdict: parallax, cause, time, correction, what is left, check points, what is open."""
    if report.results.verdict.raw_px is None:
        said = (report.words.text("verdict.none"), _check_points(report))
        return report.words.sentences(said)
    return report.words.sentences(
        (
            *_too_coarse(report),
            _raw(report),
            cause(report),
            over_time(report),
            _correction(report),
            *_left(report),
            _check_points(report),
            _open(report),
        )
    )


def is_coarse(results: Results) -> bool:
    """Whether the POS is far too coarse for direct use, before and after correction."""
    values = fmt.present([results.verdict.raw_px, results.verdict.corrected_px])
    return min(values, default=0.0) >= COARSE_PX


def _too_coarse(report: BlockReport) -> Iterator[str]:
    words, results = report.words, report.results
    if not is_coarse(results):
        return
    yield words.text("coarse.found")
    errors = [
        words.text("coarse.error", angle=words.angle(row.angle), size=_degrees(row.rms_rad))
        for row in rows(results.angle_error_summary, frame="ground")
        if row.rms_rad is not None
    ]
    if errors:
        yield words.text("coarse.errors", errors=words.joined(errors))


def _raw(report: BlockReport) -> str:
    words, results = report.words, report.results
    numbers = results.verdict
    raw, relative = numbers.raw_px, numbers.relative_px
    found = _parallax(words, raw, numbers.raw_mm, numbers.raw_median_px)
    values = {"found": found, "n": fmt.count(results.block.n_models)}
    if raw is None or not relative:
        return words.text("raw.alone", **values)
    values["free"] = _parallax(words, relative, numbers.relative_mm, numbers.relative_median_px)
    noise = results.expected_noise_px
    values["noise"] = (
        ""
        if fmt.is_missing(noise)
        else words.text("raw.noise", noise=fmt.with_unit(noise, "px", 2))
    )
    if raw / relative >= NEAR_RELATIVE:
        return words.text("raw.times", times=_ratio(raw, relative), **values)
    return words.text("raw.near", **values)


def _correction(report: BlockReport) -> str:
    words, results = report.words, report.results
    chosen = results.verdict.corrected_angles
    by = "correction.by_strip" if decided_by_strip(results) else "correction.by"
    rules = words.text(by, rules=results.settings.rules)
    if not chosen:
        if not is_coarse(results):
            return words.text("correction.none", rules=rules)
        return words.text("correction.none_coarse", rules=rules, only=words.text("coarse.only"))
    what = words.joined(
        words.text("correction.angle", angle=words.angle(angle), form=_form(report, angle))
        for angle in chosen
    )
    others = [words.angle(angle) for angle in angles(results.settings.frame) if angle not in chosen]
    if not others:
        return words.counted("correction.made", len(chosen), rules=rules, what=what)
    return words.counted("correction.made_alone", len(chosen), rules=rules, what=what,
                         others=words.joined(others))  # fmt: skip


def _form(report: BlockReport, angle: str) -> str:
    """``linear in time``, ``constant of 18 mrad``, or in how many strips which."""
    words, results = report.words, report.results
    decided = rows(results.selection, angle=angle)
    made = [row.form for row in decided if row.correct]
    forms = words.text("correction.or").join(
        words.of("form_in_words", form) for form in sorted(set(made))
    )
    if decided_by_strip(results):
        n, total = fmt.count(len(made)), fmt.count(len(decided))
        return words.text("correction.in_strips", forms=forms, n=n, total=total)
    frame = results.settings.frame
    fit = first(results.regression, angle=angle, frame=frame, scope="block")
    if set(made) == {"constant"} and fit and not fmt.is_missing(fit.constant_rad):
        return words.text("correction.constant_of", size=fmt.angle(fit.constant_rad))
    return forms


def _left(report: BlockReport) -> Iterator[str]:
    words, results = report.words, report.results
    numbers = results.verdict
    corrected, relative = numbers.corrected_px, numbers.relative_px
    if not numbers.corrected_angles or corrected is None:
        return
    found = _parallax(words, corrected, numbers.corrected_mm, numbers.corrected_median_px)
    text = words.text("left.found", found=found)
    if relative:
        text = words.text("left.times", found=found, times=_ratio(corrected, relative))
    if is_coarse(results):
        yield words.text("left.coarse", left=text, only=words.text("coarse.only"))
        return
    yield words.text("left.sentence", left=text)
    if relative and corrected / relative >= MUCH_LEFT:
        yield _scatter(report)


def _scatter(report: BlockReport) -> str:
    """What the corrections leave in the angles, and how much of it no line can take off."""
    words, remaining, about_line = report.words, [], []
    named = angles(report.results.settings.frame)
    for angle in named:
        sizes = _scatter_of(report.results, angle)
        if sizes is None:
            return ""
        remaining.append(sizes[0])
        about_line.append(sizes[1])
    if math.hypot(*about_line) < 0.5 * math.hypot(*remaining):
        return ""
    unit = fmt.angle_unit(remaining)
    shown = [fmt.with_unit(unit.scaled(value), unit.name, 2) for value in remaining]
    return words.text(
        "left.scatter",
        sizes=words.joined(
            words.text("left.size_in", size=size, angle=words.angle(angle))
            for angle, size in zip(named, shown, strict=True)
        ),
        lines=words.joined(fmt.number(unit.scaled(value), 2) for value in about_line),
        unit=unit.name,
    )


def _scatter_of(results: Results, angle: str) -> tuple[float, float] | None:
    """What is left of an angle's error, and the scatter about its line, rad; None if unknown."""
    frame = results.settings.frame
    size = first(results.angle_error_summary, angle=angle, frame=frame)
    fit = first(results.regression, angle=angle, frame=frame, scope="block")
    decision = first(results.selection, angle=angle)
    if not size or not fit or size.rms_rad is None or fit.sigma_rad is None:
        return None
    form = decision.form if decision else None
    if form == "linear":
        return fit.sigma_rad, fit.sigma_rad
    mean = (size.mean_rad or 0.0) if form == "constant" else 0.0
    return math.sqrt(size.rms_rad**2 - mean**2), fit.sigma_rad


def _check_points(report: BlockReport) -> str:
    words, results = report.words, report.results
    before = first(results.check_points, orientation="pos", translation_removed=True)
    if before is None or before.rmse_horizontal_m is None:
        n = results.block.n_check_points
        return words.text("ground.none_intersected" if n else "ground.none_given")
    is_corrected = bool(results.verdict.corrected_angles)
    after = first(results.check_points, orientation="selected", translation_removed=True)
    values = {"n": fmt.count(before.n), "before": _accuracy(words, before)}
    if is_corrected and after:
        values["after"] = _accuracy(words, after)
    shift = (after or before).shift_m
    if shift:
        values["h"] = fmt.with_unit(math.hypot(shift[0], shift[1]), "m")
        values["v"] = fmt.with_unit(abs(shift[2]), "m")
    said = "after" if "after" in values else "before"
    return words.of("ground", f"{said}_and_shift" if shift else said, **values)


def _open(report: BlockReport) -> str:
    """What the data cannot tell."""
    words = report.words
    found = [row for row in report.results.observability if row.rotations]
    block = [row for row in found if row.scope == "block"]
    if not found:
        return ""
    rotations = words.rotations(code for row in block or found for code in row.rotations)
    return words.text("blind.block" if block else "blind.strips", rotations=rotations)


def _parallax(words: Words, px: float | None, mm: float | None, median: float | None) -> str:
    remarks = [] if fmt.is_missing(mm) else [fmt.with_unit(mm, "mm", 2)]
    if px and median and not 1.0 / SKEWED < px / median < SKEWED:
        remarks.append(words.text("raw.median", median=fmt.with_unit(median, "px")))
    value = fmt.with_unit(px, "px")
    if not remarks:
        return value
    listed = words.text("list.between").join(remarks)
    return words.text("raw.remarks", value=value, remarks=listed)


def _degrees(value_rad: float) -> str:
    return fmt.with_unit(math.degrees(value_rad), "°", 2)


def _ratio(one: float, other: float) -> str:
    return fmt.number(one / other, 2)


def _accuracy(words: Words, row: CheckPointStatistics) -> str:
    h, v = (fmt.with_unit(m, "m") for m in (row.rmse_horizontal_m, row.rmse_vertical_m))
    return words.text("ground.accuracy", h=h, v=v)
