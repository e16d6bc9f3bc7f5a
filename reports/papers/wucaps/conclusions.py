"""The second paper's conclusions as sentences, each with what the simulation says of it."""

from collections.abc import Callable

from posstats.geometry.stereo.parallax import NOTICEABLE
from posstats.papers.wucaps.findings import (
    LESS,
    MOST_HORIZONTAL,
    MOST_VERTICAL,
    RECOMMENDED,
    SituationFindings,
)
from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.seeds import repeated, share
from posstats.papers.wucaps.situations import Situation

from ...document import format as fmt
from ..drift.conclusions import Conclusion
from .words import BLOCKS, SITUATIONS, TERRAIN

_LIMITS = f"{fmt.fixed(MOST_HORIZONTAL, 1)} (H) and {fmt.fixed(MOST_VERTICAL, 1)} (V)"
_NEAR = f"{fmt.fixed(100.0 * NOTICEABLE, 0)}\u00a0%"


def conclusions(run: Reproduction) -> tuple[Conclusion, ...]:
    """Every conclusion of the paper that the simulation can test."""
    return (
        _calibration_is_not_enough(run),
        _unknowns_are_needed(run),
        _errors_are_removed(run, "flat"),
        _errors_are_removed(run, "mountain"),
        _calibration_is_dispensable(run),
        _parallax_is_removed(run),
    )


def beyond(run: Reproduction) -> tuple[Conclusion, ...]:
    """Questions that the paper leaves open."""
    return (_less_control(run, "flat"), _less_control(run, "mountain"), _free_is_open(run))


def _calibration_is_not_enough(run: Reproduction) -> Conclusion:
    def shown(found: SituationFindings) -> str:
        vertical = fmt.fixed(found.ratios("calibrated")[1], 1)
        parallax = fmt.fixed(found.calibrated_mm / found.relative_mm, 1)
        return (
            f"vertical RMSE {vertical} times that of the bundle without systematic errors, "
            f"parallax {parallax} times that of relative orientation"
        )

    return _tested(
        run, tuple(run.findings), "calibration_is_not_enough",
        "A calibrated POS alone leaves parallax and height errors",
        "Even a POS that was calibrated keeps systematic errors: direct georeferencing with it "
        "leaves parallax in the models, and heights too poor for large scales.",
        "POS calibrated on another flight:",
        shown,
        f"Holds if the first is above {fmt.fixed(MOST_VERTICAL, 1)} and the second above 2.",
    )  # fmt: skip


def _unknowns_are_needed(run: Reproduction) -> Conclusion:
    return _tested(
        run, tuple(run.findings), "unknowns_are_needed",
        "The adjustment needs unknowns for the errors of the POS",
        "A bundle adjustment supported by the POS has to hold unknowns for shift and drift of "
        "GNSS and IMU.",
        "Bundle without them, recommended control, RMSE over that without systematic errors:",
        lambda found: _ratios(found, "bundle"),
        f"Holds if it is above {_LIMITS.replace('and', 'or')}.",
    )  # fmt: skip


def _errors_are_removed(run: Reproduction, situation: Situation) -> Conclusion:
    words = {"centre": "one central point", "corners": "four corner points"}
    control = words[RECOMMENDED[situation]]
    return _tested(
        run, (situation,), "errors_are_removed",
        f"{control.capitalize()} will do in {BLOCKS[situation]}",
        f"In {BLOCKS[situation]}, the adjustment removes the systematic errors of the POS "
        f"thoroughly with {control}.",
        "Drifts weighted, RMSE over that without systematic errors and with all control:",
        lambda found: _ratios(found, found.recommended),
        f"Holds up to {_LIMITS}.",
    )  # fmt: skip


def _calibration_is_dispensable(run: Reproduction) -> Conclusion:
    def shown(found: SituationFindings) -> str:
        raw = _metres(found, found.recommended)
        return f"{raw} from the POS as recorded, {_metres(found, 'both')} calibrated"

    return _tested(
        run, tuple(run.findings), "calibration_is_dispensable",
        "No calibration field is needed",
        "The adjustment calibrates itself: a POS calibrated before gives no better result.",
        "Drifts weighted, recommended control, RMSE H / V:",
        shown,
        "The boresight is an unknown of the adjustment, so taking one off before only shifts its "
        f"value. Holds if the calibrated POS is better by less than {_NEAR}.",
    )  # fmt: skip


def _parallax_is_removed(run: Reproduction) -> Conclusion:
    def shown(found: SituationFindings) -> str:
        left = fmt.joined(fmt.fixed(1e3 * mm, 1) for mm in (found.weighted_mm, found.relative_mm))
        return f"{left}\u00a0µm (POS {fmt.fixed(1e3 * found.pos_mm, 0)}\u00a0µm)"

    return _tested(
        run, tuple(run.findings), "parallax_is_removed",
        "The adjusted orientations do for mapping: models free of parallax",
        "The orientations that the adjustment gives do for topographic mapping from models that "
        "are set up by them, without relative orientation.",
        "Mean parallax, drifts weighted with recommended control, and after relative orientation:",
        shown,
        f"Holds if the first is at most {_NEAR} larger.",
    )  # fmt: skip


def _less_control(run: Reproduction, situation: Situation) -> Conclusion:
    less = LESS[situation]
    words = {"centre": "one central point is", "none": "no control point is"}[less]
    return _tested(
        run, (situation,), "less_control_is_not_enough",
        f"{words.capitalize()} not enough in {BLOCKS[situation]}",
        f"In {BLOCKS[situation]}, {words} not enough: what the paper recommends is needed.",
        "Drifts weighted, RMSE over that without systematic errors:",
        lambda found: _ratios(found, f"weighted_{less}"),
        f"Holds if it is above {_LIMITS.replace('and', 'or')}.",
    )  # fmt: skip


def _free_is_open(run: Reproduction) -> Conclusion:
    def shown(found: SituationFindings) -> str:
        n = found.free_undetermined.count("+") + 1 if found.free_undetermined else 0
        return f"{n} kinds of parameters not determined; RMSE H / V {_metres(found, 'free')}"

    return _tested(
        run, tuple(run.findings), "one_point_leaves_free_unknowns_open",
        "Free shifts and drifts of every strip are not determined by one point",
        "Without weights, shifts and drifts of every strip are not determined by one control "
        "point: the weights are essential.",
        "Drifts free, one central point:",
        shown,
        "Holds if a parameter is not determined: one standard deviation of it moves an observation "
        "by more than ten of its own.",
    )  # fmt: skip


def _ratios(found: SituationFindings, name: str) -> str:
    horizontal, vertical = found.ratios(name)
    return f"{fmt.number(horizontal)} (H), {fmt.number(vertical)} (V)"


def _metres(found: SituationFindings, name: str) -> str:
    sides = (getattr(found, f"{name}_{side}_m") for side in ("horizontal", "vertical"))
    return " / ".join(fmt.fixed(value, 3) for value in sides) + "\u00a0m"


def _tested(
    run: Reproduction,
    situations: tuple[Situation, ...],
    criterion: str,
    title: str,
    text: str,
    heading: str,
    shown: Callable[[SituationFindings], str],
    rule: str,
) -> Conclusion:
    """A conclusion that holds if its criterion holds in every situation that it is about."""
    found = {situation: run.findings[situation] for situation in situations}
    return Conclusion(
        title,
        text,
        all(getattr(each, criterion) for each in found.values()),
        (
            heading,
            *(f"{SITUATIONS[situation]}: {shown(each)}" for situation, each in found.items()),
            rule,
            _seeds(criterion, situations),
        ),
    )


def _seeds(criterion: str, situations: tuple[Situation, ...]) -> str:
    n = len(repeated()[situations[0]])
    held = fmt.joined(fmt.fixed(n * share(criterion, situation), 0) for situation in situations)
    where = f" ({fmt.joined(TERRAIN[each] for each in situations)})" if len(situations) > 1 else ""
    return f"Holds for {held} of {n} seeds{where}."
