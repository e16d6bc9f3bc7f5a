"""What stands before the topics of the report on the second paper."""

from posstats.papers.wucaps.findings import RECOMMENDED, SituationFindings
from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.situations import Situation

from ...document import format as fmt
from ...document.key_figure import KeyFigure
from ..conclusion import how_many
from ..document import PaperFront
from .repeated import n_seeds
from .report import Report
from .words import Words


def front(words: Words, report: Report) -> PaperFront:
    """What was simulated, what was found, in numbers."""
    run = report.run
    return PaperFront(_subtitle(words, run), _verdict(words, report), _key_figures(words, run))


def _subtitle(words: Words, run: Reproduction) -> str:
    """What was simulated."""
    flights = [each.flights.flight for each in run.runs.values()]
    return words.text(
        "front.subtitle",
        images=fmt.count(sum(len(flight.orientations) for flight in flights)),
        strips=fmt.count(sum(len(flight.orientations.strips) for flight in flights)),
        ways=str(sum(len(each.rows) for each in run.runs.values())),
    )


def _verdict(words: Words, report: Report) -> str:
    """What was found, in short."""
    run = report.run
    ratios = words.joined(_ratios(words, *each) for each in run.findings.items())
    return words.text(
        "front.verdict",
        held=how_many(words, report.conclusions),
        ratios=ratios,
        seed=str(run.seed),
        total=n_seeds(),
    )


def _ratios(words: Words, situation: Situation, found: SituationFindings) -> str:
    horizontal, vertical = map(fmt.number, found.ratios(found.recommended))
    return words.text(
        "front.ratios",
        horizontal=horizontal,
        vertical=vertical,
        terrain=words.terrain(situation),
        control=words.control(RECOMMENDED[situation]),
    )


def _key_figures(words: Words, run: Reproduction) -> tuple[KeyFigure, ...]:
    """Accuracies of the calibrated POS and of the adjustment, by situation."""
    return tuple(figure for each in run.findings.items() for figure in _of_situation(words, *each))


def _of_situation(
    words: Words, situation: Situation, found: SituationFindings
) -> tuple[KeyFigure, KeyFigure]:
    terrain = words.of("terrain_title", situation)
    control = words.control(RECOMMENDED[situation])
    remark = words.text("key.adjusted_remark", control=control, best=_pair(found, "reference"))
    return (
        KeyFigure(words.text("key.calibrated", terrain=terrain), _pair(found, "calibrated"), "m",
                  words.text("key.calibrated_remark")),
        KeyFigure(words.text("key.adjusted", terrain=terrain), _pair(found, found.recommended),
                  "m", remark),
    )  # fmt: skip


def _pair(found: SituationFindings, name: str) -> str:
    """RMSE of check points, horizontal / vertical."""
    sides = (getattr(found, f"{name}_{side}_m") for side in ("horizontal", "vertical"))
    return " / ".join(fmt.number(value, 2) for value in sides)
