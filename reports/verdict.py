"""The verdict on a block in one paragraph of plain words, and its key figures."""

import math
from collections.abc import Iterable
from dataclasses import dataclass

from . import format as fmt
from .results_view import Results, Row, angles, first, mean_over_models, rows, setting, verdict

COARSE_PX = 50.0  # neither stereo viewing nor matching bridges this much parallax
NEAR_RELATIVE = 1.5  # up to this multiple of relative orientation's, parallax needs no correction
SKEWED = 1.25  # mean over median from which the median is told beside the mean
SIGNIFICANT = 0.05
ALONE = 0.9  # share of the cause from which other angles need no word


@dataclass(frozen=True)
class KeyFigure:
    """One number of the verdict, with what it is and a remark."""

    label: str
    value: str
    unit: str
    remark: str


def paragraph(results: Results) -> str:
    """The verdict: parallax, cause, time, correction, what is left, check points, what is open."""
    if fmt.is_missing(verdict(results).get("raw_px")):
        sentences = [
            "No vertical parallax could be computed: no stereo model of the block has six or more "
            "tie points in common. Nothing can be said about the POS angles.",
            _check_points(results),
        ]
    else:
        sentences = [
            _too_coarse(results),
            _raw(results),
            _cause(results),
            _time(results),
            _correction(results),
            _left(results),
            _check_points(results),
            _open(results),
        ]
    return " ".join(sentence for sentence in sentences if sentence)


def is_coarse(results: Results) -> bool:
    """Whether the POS is far too coarse for direct use, before and after correction."""
    numbers = verdict(results)
    values = fmt.present(numbers.get(key) for key in ("raw_px", "corrected_px"))
    return min(values, default=0.0) >= COARSE_PX


def key_figures(results: Results) -> tuple[KeyFigure, ...]:
    """Parallax from POS, after correction and after relative orientation; check-point accuracy."""
    numbers = verdict(results)
    figures = [
        _parallax_figure(numbers, name, label)
        for name, label in (
            ("raw", "POS as delivered"),
            ("corrected", "POS, corrected"),
            ("relative", "Relative orientation"),
        )
        if name != "corrected" or numbers.get("corrected_angles")
    ]
    point = first(results, "check_points", orientation="selected", translation_removed=False)
    if not fmt.is_missing(point.get("rmse_horizontal_m")):
        value = f"{fmt.number(point['rmse_horizontal_m'])} / {fmt.number(point['rmse_vertical_m'])}"
        label = "Check points, corrected" if numbers.get("corrected_angles") else "Check points"
        remark = f"RMSE H / V, {point['n']} points, mean kept"
        figures.append(KeyFigure(label, value, "m", remark))
    return tuple(figures)


def _parallax_figure(numbers: Row, name: str, label: str) -> KeyFigure:
    mm = numbers.get(f"{name}_mm")
    remark = "mean vertical parallax" + ("" if fmt.is_missing(mm) else f", {_mm(mm)}")
    return KeyFigure(label, fmt.number(numbers.get(f"{name}_px")), "px", remark)


def _too_coarse(results: Results) -> str:
    if not is_coarse(results):
        return ""
    errs = [
        f"{row['angle']} by {_degrees(row['rms_rad'])}"
        for row in rows(results, "angle_error_summary", frame="ground")
        if not fmt.is_missing(row["rms_rad"])
    ]
    how = f" Its angles err (RMS): {fmt.joined(errs)}." if errs else ""
    return f"This POS is far too coarse for direct use.{how}"


def _raw(results: Results) -> str:
    numbers = verdict(results)
    raw, relative = numbers["raw_px"], numbers.get("relative_px")
    text = (
        f"The POS as delivered leaves a mean vertical parallax of {_parallax(numbers, 'raw')} "
        f"in {results['block']['n_models']} stereo models"
    )
    if fmt.is_missing(relative) or not relative:
        return f"{text}."
    free = _parallax(numbers, "relative")
    if raw / relative >= NEAR_RELATIVE:
        text += f", {_times(raw / relative)} the {free} that relative orientation of them leaves"
    else:
        text += f"; relative orientation of the same models leaves {free}"
    noise = results.get("expected_noise_px")
    if not fmt.is_missing(noise):
        text += f" (the stated image accuracy alone would leave {fmt.with_unit(noise, 'px', 2)})"
    return f"{text}."


def _cause(results: Results) -> str:
    numbers = verdict(results)
    cause, raw, relative = (numbers.get(key) for key in ("cause", "raw_px", "relative_px"))
    if cause:
        held = mean_over_models(results, rows(results, "error_sources", fixed=cause))
        every = mean_over_models(results, rows(results, "error_sources", fixed="angles"))
        share = numbers.get("cause_share")
        most = share is not None and share < ALONE
        text = f"{'Most of it comes' if most else 'The parallax comes'} from {cause}"
        if held is not None and every is not None:
            text += (
                f": relative orientation with {cause} held at its POS value leaves "
                f"{fmt.with_unit(held, 'px')}, with all three angles held "
                f"{fmt.with_unit(every, 'px')}"
            )
        return f"{text}."
    if relative and raw / relative < NEAR_RELATIVE:
        return "This is about as good as the images allow, and no angle stands out."
    return "It cannot be laid to one angle alone: held one by one, several keep the parallax high."


def _time(results: Results) -> str:
    """Whether the error of the cause (or of every angle) follows time, by OLS and GLS."""
    cause = verdict(results).get("cause")
    if not cause:
        return _shares(results)
    row = first(results, "regression", angle=cause, frame="ground", scope="block")
    if fmt.is_missing(row.get("r_squared")):
        why = row.get("reason")
        return f"Whether its error follows time could not be tested{f' ({why})' if why else ''}."
    evidence = (
        f"R² = {fmt.fixed(row['r_squared'], 3)}, {fmt.p_phrase(row['p_value'])}, "
        f"{row['n']} images at {row['n_time_clusters']} separate times"
    )
    middle = f"Its error is {fmt.angle(row['intercept_rad'])} at mid-time"
    if row["p_value"] is None or row["p_value"] >= SIGNIFICANT:
        return f"{middle} and does not follow time ({evidence})."
    change = fmt.rate(row["slope_rad_per_s"])
    return f"{middle} and follows time: it changes by {change} ({evidence}); {_surely(row)}."


def _surely(row: Row) -> str:
    low, high = row.get("gls_slope_ci95") or (None, None)
    if low is None or high is None:
        return "with correlated errors allowed for, no interval can be given"
    unit = fmt.rate_unit([low, high])
    ends = f"{fmt.number(unit.scaled(low))} to {fmt.number(unit.scaled(high))}"
    zero = "includes zero, so a drift is not proven" if low <= 0.0 <= high else "excludes zero"
    return (
        f"with correlated errors allowed for, the 95 % interval of this rate, "
        f"({ends})\u00a0×\u00a0{unit.name}, {zero}"
    )


def _shares(results: Results) -> str:
    tested = [
        f"{row['angle']} {fmt.fixed(row['r_squared'], 2)}"
        for row in rows(results, "regression", frame="ground", scope="block")
        if not fmt.is_missing(row["r_squared"])
    ]
    if not tested:
        return "Whether the angle errors follow time could not be tested."
    return f"A line over time explains this share (R²) of the angle errors: {fmt.joined(tested)}."


def _correction(results: Results) -> str:
    chosen = verdict(results).get("corrected_angles") or []
    rules = f"By the rules “{setting(results, 'rules', 'paper')}”"
    if not chosen:
        return f"{rules} no angle was corrected, so this parallax remains."
    what = fmt.joined(f"{angle} ({_form(results, angle)})" for angle in chosen)
    others = [a for a in angles(setting(results, "frame", "ground")) if a not in chosen]
    left = f"; {fmt.joined(others)} stayed as delivered" if others else ""
    return f"{rules} {what} {'was' if len(chosen) == 1 else 'were'} corrected{left}."


def _form(results: Results, angle: str) -> str:
    """``linear in time``, ``constant``, or both where strips differ."""
    words = {"linear": "linear in time"}
    forms = {row["form"] for row in rows(results, "selection", angle=angle, correct=True)}
    return fmt.joined(sorted(words.get(form, form) for form in forms), "or")


def _left(results: Results) -> str:
    numbers = verdict(results)
    corrected, relative = numbers.get("corrected_px"), numbers.get("relative_px")
    if not numbers.get("corrected_angles") or fmt.is_missing(corrected):
        return ""
    text = f"The correction leaves {_parallax(numbers, 'corrected')}"
    if relative:
        text += f", {_times(corrected / relative)} what relative orientation leaves"
    return f"{text}."


def _check_points(results: Results) -> str:
    before = first(results, "check_points", orientation="pos", translation_removed=True)
    if fmt.is_missing(before.get("rmse_horizontal_m")):
        none = "" if results["block"]["n_check_points"] else "No check points were given, so "
        return f"{none or 'No check point could be intersected, so '}the ground was not tested."
    corrected = bool(verdict(results).get("corrected_angles"))
    text = (
        f"At {before['n']} check points the RMSE with the mean shift removed is "
        f"{_accuracy(before)} from the POS as delivered"
    )
    after = first(results, "check_points", orientation="selected", translation_removed=True)
    if corrected and after:
        text += f" and {_accuracy(after)} after correction"
    shift = fmt.present((after or before).get("shift_m") or ())
    if len(shift) == 3:
        horizontal = fmt.with_unit(math.hypot(shift[0], shift[1]), "m")
        vertical = fmt.with_unit(abs(shift[2]), "m")
        which = "after correction the mean shift" if corrected else "the mean shift"
        text += f"; {which} itself is {horizontal} horizontally and {vertical} vertically"
    return f"{text}."


def _open(results: Results) -> str:
    """What the data cannot tell."""
    found = [row for row in rows(results, "observability") if row["unobservable"]]
    block = [row for row in found if row["scope"] == "block"]
    if block:
        return f"What the tie points of this block cannot tell: {_motions(block)}."
    if found:
        return (
            f"Within single strips the tie points cannot tell {_motions(found)}; only side overlap "
            "with other strips fixes it."
        )
    return ""


def _motions(found: Iterable[Row]) -> str:
    return fmt.joined(dict.fromkeys(words for row in found for words in row["unobservable"]))


def _parallax(numbers: Row, name: str) -> str:
    px, mm, median = (numbers.get(f"{name}_{key}") for key in ("px", "mm", "median_px"))
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


def _accuracy(row: Row) -> str:
    horizontal = fmt.with_unit(row["rmse_horizontal_m"], "m")
    return f"{horizontal} horizontally and {fmt.with_unit(row['rmse_vertical_m'], 'm')} vertically"
