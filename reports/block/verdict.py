"""The verdict on a block in one paragraph of plain words."""

import math
from collections.abc import Iterable

from posstats.contract.check_points import CheckPointStatistics
from posstats.contract.results import Observability, Results

from ..document import format as fmt
from ..document.rows import first, rows
from .verdict_cause import NEAR_RELATIVE, cause, over_time
from .view import angles, decided_by_strip

COARSE_PX = 50.0  # neither stereo viewing nor matching bridges this much parallax
MUCH_LEFT = 3.0  # multiple of relative orientation's from which the rest is explained
SKEWED = 1.25  # mean over median from which the median is told beside the mean
FORMS = {"linear": "linear in time", "constant": "constant"}
START_ONLY = (
    "these orientations can serve as start values of an aerial triangulation, not for direct "
    "georeferencing"
)


def paragraph(results: Results) -> str:
    """The verdict: parallax, cause, time, correction, what is left, check points, what is open."""
    if fmt.is_missing(results.verdict.raw_px):
        sentences = [
            "No vertical parallax could be computed: no stereo model of the block has six or more "
            "tie points in common. Nothing can be said about the POS angles.",
            _check_points(results),
        ]
    else:
        sentences = [
            _too_coarse(results),
            _raw(results),
            cause(results),
            over_time(results),
            _correction(results),
            _left(results),
            _check_points(results),
            _open(results),
        ]
    return " ".join(sentence for sentence in sentences if sentence)


def is_coarse(results: Results) -> bool:
    """Whether the POS is far too coarse for direct use, before and after correction."""
    numbers = results.verdict
    values = fmt.present([numbers.raw_px, numbers.corrected_px])
    return min(values, default=0.0) >= COARSE_PX


def _too_coarse(results: Results) -> str:
    if not is_coarse(results):
        return ""
    errs = [
        f"{row.angle} by {_degrees(row.rms_rad)}"
        for row in rows(results.angle_error_summary, frame="ground")
        if row.rms_rad is not None
    ]
    how = f" Its angles err (RMS): {fmt.joined(errs)}." if errs else ""
    return f"This POS is far too coarse for direct use.{how}"


def _raw(results: Results) -> str:
    numbers = results.verdict
    raw, relative = numbers.raw_px, numbers.relative_px
    found = _parallax(raw, numbers.raw_mm, numbers.raw_median_px)
    text = (
        f"The POS as delivered leaves a mean vertical parallax of {found} "
        f"in {results.block.n_models} stereo models"
    )
    if raw is None or not relative:
        return f"{text}."
    free = _parallax(numbers.relative_px, numbers.relative_mm, numbers.relative_median_px)
    if raw / relative >= NEAR_RELATIVE:
        text += f", {_times(raw / relative)} the {free} that relative orientation of them leaves"
    else:
        text += f"; relative orientation of the same models leaves {free}"
    noise = results.expected_noise_px
    if not fmt.is_missing(noise):
        text += f" (the stated image accuracy alone would leave {fmt.with_unit(noise, 'px', 2)})"
    return f"{text}."


def _correction(results: Results) -> str:
    chosen = results.verdict.corrected_angles
    strip_wise = ", strip by strip," if decided_by_strip(results) else ""
    rules = f"By the rules “{results.settings.rules}”{strip_wise}"
    if not chosen:
        only = f"; {START_ONLY}" if is_coarse(results) else ""
        return f"{rules} no angle was corrected, so this parallax remains{only}."
    what = fmt.joined(f"{angle} ({_form(results, angle)})" for angle in chosen)
    others = [a for a in angles(results.settings.frame) if a not in chosen]
    left = f"; {fmt.joined(others)} stayed as delivered" if others else ""
    return f"{rules} {what} {'was' if len(chosen) == 1 else 'were'} corrected{left}."


def _form(results: Results, angle: str) -> str:
    """``linear in time``, ``constant of 18 mrad``, or in how many strips which."""
    decided = rows(results.selection, angle=angle)
    made = [row for row in decided if row.correct]
    forms = fmt.joined(sorted({FORMS[row.form] for row in made}), "or")
    if decided_by_strip(results):
        return f"{forms} in {len(made)} of {len(decided)} strips"
    frame = results.settings.frame
    fit = first(results.regression, angle=angle, frame=frame, scope="block")
    if forms == "constant" and fit and not fmt.is_missing(fit.constant_rad):
        return f"constant of {fmt.angle(fit.constant_rad)}"
    return forms


def _left(results: Results) -> str:
    numbers = results.verdict
    corrected, relative = numbers.corrected_px, numbers.relative_px
    if not numbers.corrected_angles or corrected is None:
        return ""
    found = _parallax(corrected, numbers.corrected_mm, numbers.corrected_median_px)
    text = f"The correction leaves {found}"
    if relative:
        text += f", {_times(corrected / relative)} what relative orientation leaves"
    if is_coarse(results):
        return f"{text}; {START_ONLY}."
    much = relative and corrected / relative >= MUCH_LEFT
    return f"{text}.{_scatter(results) if much else ''}"


def _scatter(results: Results) -> str:
    """What the corrections leave in the angles, and how much of it no line can take off."""
    named: list[str] = []
    remaining: list[float] = []
    about_line: list[float] = []
    frame = results.settings.frame
    for angle in angles(frame):
        size = first(results.angle_error_summary, angle=angle, frame=frame)
        fit = first(results.regression, angle=angle, frame=frame, scope="block")
        decision = first(results.selection, angle=angle)
        form = decision.form if decision else None
        if not size or not fit or size.rms_rad is None or fit.sigma_rad is None:
            return ""
        mean = (size.mean_rad or 0.0) if form == "constant" else 0.0
        named.append(angle)
        about_line.append(fit.sigma_rad)
        rest = math.sqrt(size.rms_rad**2 - mean**2)
        remaining.append(fit.sigma_rad if form == "linear" else rest)
    if math.hypot(*about_line) < 0.5 * math.hypot(*remaining):
        return ""
    unit = fmt.angle_unit(remaining)
    sizes = fmt.joined(
        f"{fmt.with_unit(unit.scaled(value), unit.name, 2)} in {angle}"
        for angle, value in zip(named, remaining, strict=True)
    )
    lines = fmt.joined(fmt.number(unit.scaled(value), 2) for value in about_line)
    return (
        f" What is left in the angles is {sizes} (RMS); {lines} {unit.name} of it is scatter from "
        "image to image about the lines, which no line over time can take off."
    )


def _check_points(results: Results) -> str:
    before = first(results.check_points, orientation="pos", translation_removed=True)
    if before is None or before.rmse_horizontal_m is None:
        none = "" if results.block.n_check_points else "No check points were given, so "
        return f"{none or 'No check point could be intersected, so '}the ground was not tested."
    corrected = bool(results.verdict.corrected_angles)
    text = (
        f"At {before.n} check points the RMSE with the mean shift removed is "
        f"{_accuracy(before)} from the POS as delivered"
    )
    after = first(results.check_points, orientation="selected", translation_removed=True)
    if corrected and after:
        text += f" and {_accuracy(after)} after correction"
    shift = (after or before).shift_m
    if shift:
        horizontal = fmt.with_unit(math.hypot(shift[0], shift[1]), "m")
        vertical = fmt.with_unit(abs(shift[2]), "m")
        which = "after correction the mean shift" if corrected else "the mean shift"
        text += f"; {which} itself is {horizontal} horizontally and {vertical} vertically"
    return f"{text}."


def _open(results: Results) -> str:
    """What the data cannot tell."""
    found = [row for row in results.observability if row.unobservable]
    block = [row for row in found if row.scope == "block"]
    if block:
        return f"What the tie points of this block cannot tell: {_motions(block)}."
    if found:
        return (
            f"Within single strips the tie points cannot tell {_motions(found)}; only side overlap "
            "with other strips fixes it."
        )
    return ""


def _motions(found: Iterable[Observability]) -> str:
    return fmt.joined(dict.fromkeys(words for row in found for words in row.unobservable))


def _parallax(px: float | None, mm: float | None, median: float | None) -> str:
    remarks = [] if fmt.is_missing(mm) else [_mm(mm)]
    if px and median and not 1.0 / SKEWED < px / median < SKEWED:
        remarks.append(f"median {fmt.with_unit(median, 'px')}")
    text = fmt.with_unit(px, "px")
    return f"{text} ({', '.join(remarks)})" if remarks else text


def _mm(value: float | None) -> str:
    return fmt.with_unit(value, "mm", 2)


def _degrees(value_rad: float) -> str:
    return fmt.with_unit(math.degrees(value_rad), "°", 2)


def _times(ratio: float) -> str:
    return f"{fmt.number(ratio, 2)} times"


def _accuracy(row: CheckPointStatistics) -> str:
    horizontal = fmt.with_unit(row.rmse_horizontal_m, "m")
    return f"{horizontal} horizontally and {fmt.with_unit(row.rmse_vertical_m, 'm')} vertically"
