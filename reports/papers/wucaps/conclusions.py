"""The second paper's conclusions as sentences, each with what the simulation says of it."""

from collections.abc import Callable

from posstats.geometry.stereo.parallax import NOTICEABLE
from posstats.papers.wucaps.findings import (
    LESS,
    MOST_HORIZONTAL,
    MOST_VERTICAL,
    SituationFindings,
)
from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.seeds import repeated, share
from posstats.papers.wucaps.situations import Situation

from ...document import format as fmt
from ...document.content import Paragraph, Part
from .. import seeds
from ..conclusion import Conclusion, evidence
from .report import Report
from .words import Words

_LIMITS = {
    "h": fmt.fixed(MOST_HORIZONTAL, 1),
    "v": fmt.fixed(MOST_VERTICAL, 1),
    "near": f"{fmt.fixed(100.0 * NOTICEABLE, 0)}\u00a0%",
}


def topic(words: Words, report: Report) -> Part:
    """Every conclusion with its evidence, and what the paper leaves open."""
    return Part(
        "conclusions",
        words.text("conclusions.title"),
        (
            Paragraph(words.text("conclusions.text")),
            evidence(words, "evidence", words.text("conclusions.evidence_caption"),
                     words.text("conclusions.column"), report.conclusions),
            evidence(words, "beyond", words.text("conclusions.asked"),
                     words.text("conclusions.statement"), report.beyond),
        ),
    )  # fmt: skip


def conclusions(words: Words, run: Reproduction) -> tuple[Conclusion, ...]:
    """Every conclusion of the paper that the simulation can test."""
    return (
        _calibration_is_not_enough(words, run),
        _unknowns_are_needed(words, run),
        _errors_are_removed(words, run, "flat"),
        _errors_are_removed(words, run, "mountain"),
        _calibration_is_dispensable(words, run),
        _parallax_is_removed(words, run),
    )


def beyond(words: Words, run: Reproduction) -> tuple[Conclusion, ...]:
    """Questions that the paper leaves open."""
    return (
        _less_control(words, run, "flat"),
        _less_control(words, run, "mountain"),
        _free_is_open(words, run),
    )


def _calibration_is_not_enough(words: Words, run: Reproduction) -> Conclusion:
    def shown(found: SituationFindings) -> str:
        return words.text(
            "shown.calibration_is_not_enough",
            vertical=fmt.fixed(found.ratios("calibrated")[1], 1),
            parallax=fmt.fixed(found.calibrated_mm / found.relative_mm, 1),
        )

    return _tested(words, run, "calibration_is_not_enough", shown)


def _unknowns_are_needed(words: Words, run: Reproduction) -> Conclusion:
    return _tested(words, run, "unknowns_are_needed", lambda found: _ratios(words, found, "bundle"))


def _errors_are_removed(words: Words, run: Reproduction, situation: Situation) -> Conclusion:
    def shown(found: SituationFindings) -> str:
        return _ratios(words, found, found.recommended)

    return _tested(words, run, "errors_are_removed", shown, situation)


def _calibration_is_dispensable(words: Words, run: Reproduction) -> Conclusion:
    def shown(found: SituationFindings) -> str:
        return words.text(
            "shown.calibration_is_dispensable",
            raw=_metres(found, found.recommended),
            calibrated=_metres(found, "both"),
        )

    return _tested(words, run, "calibration_is_dispensable", shown)


def _parallax_is_removed(words: Words, run: Reproduction) -> Conclusion:
    def shown(found: SituationFindings) -> str:
        left = words.joined(fmt.fixed(1e3 * mm, 1) for mm in (found.weighted_mm, found.relative_mm))
        return words.text(
            "shown.parallax_is_removed", left=left, pos=fmt.fixed(1e3 * found.pos_mm, 0)
        )

    return _tested(words, run, "parallax_is_removed", shown)


def _less_control(words: Words, run: Reproduction, situation: Situation) -> Conclusion:
    def shown(found: SituationFindings) -> str:
        return _ratios(words, found, f"weighted_{LESS[situation]}")

    return _tested(words, run, "less_control_is_not_enough", shown, situation)


def _free_is_open(words: Words, run: Reproduction) -> Conclusion:
    def shown(found: SituationFindings) -> str:
        n = found.free_undetermined.count("+") + 1 if found.free_undetermined else 0
        return words.text(
            "shown.one_point_leaves_free_unknowns_open",
            kinds=fmt.count(n),
            rmse=_metres(found, "free"),
        )

    return _tested(words, run, "one_point_leaves_free_unknowns_open", shown)


def _ratios(words: Words, found: SituationFindings, name: str) -> str:
    horizontal, vertical = map(fmt.number, found.ratios(name))
    return words.text("shown.ratios", horizontal=horizontal, vertical=vertical)


def _metres(found: SituationFindings, name: str) -> str:
    sides = (getattr(found, f"{name}_{side}_m") for side in ("horizontal", "vertical"))
    return " / ".join(fmt.fixed(value, 3) for value in sides) + "\u00a0m"


def _tested(
    words: Words,
    run: Reproduction,
    criterion: str,
    shown: Callable[[SituationFindings], str],
    only: Situation | None = None,
) -> Conclusion:
    """A conclusion that holds if its criterion holds in every situation that it is about."""
    situations = tuple(run.findings) if only is None else (only,)
    said = criterion if only is None else f"{criterion}_{only}"
    found = {situation: run.findings[situation] for situation in situations}
    return Conclusion(
        words.of("title", said),
        words.of("claim", said),
        all(getattr(each, criterion) for each in found.values()),
        (
            words.of("heading", criterion),
            *(words.line(words.situation(each), shown(found[each])) for each in situations),
            words.of("rule", criterion, **_LIMITS),
            seeds.held(
                words,
                [share(criterion, each) for each in situations],
                len(repeated()[situations[0]]),
                words.joined(words.terrain(each) for each in situations),
            ),
        ),
    )
