"""What the report on the second paper says, section by section."""

from collections.abc import Sequence

from posstats.papers.wucaps.findings import RECOMMENDED
from posstats.papers.wucaps.reproduction import Reproduction
from posstats.papers.wucaps.seeds import pooled, repeated, share
from posstats.papers.wucaps.situations import flight_seed

from ...document import format as fmt
from ...document.content import Bullets, Content, Paragraph, Part
from ...document.table import Table, pairs, prose_column, text_column
from ..drift.conclusions import Conclusion
from . import figures as wucaps_figures
from . import tables
from .words import CONTROL, SITUATIONS, TERRAIN

_SIDES = ("horizontal", "vertical")


def sections(
    run: Reproduction,
    found: Sequence[Conclusion],
    beyond: Sequence[Conclusion],
    versions: Sequence[tuple[str, str]],
) -> tuple[Part, ...]:
    """The sections of the report."""
    return (
        _conclusions(found, beyond),
        _situations(run),
        _check_points(run),
        _orientations(run),
        _calibration(run),
        _repeated(run),
        _remarks(run),
        _provenance(run, versions),
    )


def opening(found: Sequence[Conclusion]) -> tuple[Content, ...]:
    """The conclusions in a few words, for the first page."""
    columns = (
        text_column("", [str(k) for k in range(1, len(found) + 1)]),
        text_column("Conclusion of the paper", [each.title for each in found]),
        text_column("Simulated", [_holds(each) for each in found]),
    )
    caption = "The paper's conclusions, and whether the simulated blocks bear them out."
    failed = frozenset(k for k, each in enumerate(found) if not each.holds)
    return (Table("conclusions", caption, columns, strong=failed),)


def _holds(conclusion: Conclusion) -> str:
    return "holds" if conclusion.holds else "does not hold"


def _conclusions(found: Sequence[Conclusion], beyond: Sequence[Conclusion]) -> Part:
    text = (
        "Every conclusion of the paper that a simulation can test is judged by a criterion stated "
        "with it. “Holds” says that errors of the kind that the paper supposes lead to what the "
        "paper found; it does not prove what its aircraft did."
    )
    caption = "The paper's conclusions, each with the evidence of the simulated blocks."
    asked = (
        "What the paper leaves open, judged alike by this run. How many seeds agree says more than "
        "one run."
    )
    return Part(
        "conclusions",
        "Conclusions",
        (
            Paragraph(text),
            _evidence("evidence", caption, "Conclusion of the paper", found),
            _evidence("beyond", asked, "Statement", beyond),
        ),
    )


def _evidence(name: str, caption: str, title: str, found: Sequence[Conclusion]) -> Table:
    columns = (
        text_column("", [str(k) for k in range(1, len(found) + 1)]),
        text_column(title, [each.text for each in found]),
        text_column("Simulated", [_holds(each) for each in found]),
        prose_column("Evidence", ["\n".join(each.evidence) for each in found]),
    )
    return Table(name, caption, columns)


def _situations(run: Reproduction) -> Part:
    text = (
        "The paper (source 2 of docs/method.md; only a part of it is at hand, without its tables) "
        "tests a POS-supported self-calibrating bundle block adjustment on film of two regions: "
        "flat, 1:2500, and mountainous, 1:32\u202f000. The photographs are not public. Two blocks "
        "of such cameras, scales and terrain are simulated with known truth, and with errors of "
        "the POS of the kind that the paper models: a boresight, and for every strip a shift and a "
        "drift of GNSS and IMU (its equations 7 and 8). Of each, a second flight with other shifts "
        "and drifts but the same boresight is simulated, from which the POS is calibrated, and the "
        "same flight without systematic errors."
    )
    return Part(
        "situations",
        "Simulated blocks",
        (Paragraph(text), tables.situations(run), tables.errors(run), wucaps_figures.plan(run)),
    )


def _check_points(run: Reproduction) -> Part:
    text = (
        "Check points are intersected from the oriented images and compared with their survey; no "
        "mean is removed. The predicted RMSE follows from the covariance of the adjustment, scaled "
        "by its sigma0, of the image coordinates and the survey; of direct georeferencing from the "
        "stated accuracy of the POS. Where it is far below the RMSE, the standard deviations say "
        "nothing of the systematic errors. The adjustments are plain least squares without a "
        "search for blunders: there are none, and a search would take systematic errors of the "
        "POS for blunders."
    )
    content: list[Content] = [Paragraph(text)]
    for each in run.runs.values():
        content += [wucaps_figures.accuracies(each), tables.check_points(each)]
    return Part("check-points", "Accuracy at check points", tuple(content))


def _orientations(run: Reproduction) -> Part:
    text = (
        "Projection centres and angles are compared with the true ones. The parallax of a model "
        "shows only what its two images have against each other: a bundle adjustment makes models "
        "free of parallax even where the block as a whole is out of place, as with free drifts and "
        "one control point."
    )
    found = [tables.orientations(each) for each in run.runs.values()]
    return Part(
        "orientations",
        "Orientations and parallax",
        (Paragraph(text), *found, wucaps_figures.parallax(run)),
    )


def _calibration(run: Reproduction) -> Part:
    text = (
        "The usual alternative estimates the boresight once and takes it off every flight "
        "(posstats calibrate, and --calibration). What remains are the shifts and drifts of the "
        "flight itself, and the error of the estimated boresight, which all its images share."
    )
    return Part("calibration", "Calibration on another flight",
                (Paragraph(text), tables.boresight(run)))  # fmt: skip


def _repeated(run: Reproduction) -> Part:
    n_seeds = len(repeated()["flat"])
    deviations = [
        pooled(f"weighted_{c}_{side}_m", s) / pooled(f"weighted_{c}_predicted_{side}_m", s) - 1.0
        for s in run.runs
        for c in CONTROL
        for side in _SIDES
    ]
    worst = 100.0 * max(map(abs, deviations))
    n_strips = len(run.runs["flat"].flights.flight.orientations.strips)
    text = (
        f"One run is one throw of the dice: with {n_strips} strips "
        "there are as many shifts and drifts, and what they leave of a datum is common to "
        f"all check points. The experiment was repeated with {n_seeds} seeds. Over these the RMSE "
        "of the weighted adjustments agree with what their covariances predict to "
        f"{fmt.fixed(worst, 0)}\u00a0% or better, whatever the control points. With the "
        f"recommended control they are {_over_reference(run)} times those without systematic "
        "errors. That single runs exceed the limits of 2.0 and 2.2 is the scatter of so few shifts "
        "and drifts, which in the flat block are large against the image noise."
    )
    return Part(
        "repeated",
        "How often the findings come out",
        (Paragraph(text), tables.shares(run), tables.predictions(run)),
    )


def _over_reference(run: Reproduction) -> str:
    """Ratios of the pooled RMSE, horizontal / vertical, of all situations."""
    ratios = {
        s: [
            fmt.number(
                pooled(f"weighted_{RECOMMENDED[s]}_{side}_m", s) / pooled(f"reference_{side}_m", s)
            )
            for side in _SIDES
        ]
        for s in run.runs
    }
    return fmt.joined(f"{' / '.join(each)} ({TERRAIN[s]}, H / V)" for s, each in ratios.items())


def _remarks(run: Reproduction) -> Part:
    return Part(
        "remarks",
        "What to make of it",
        (
            Bullets(
                (
                    _regression(run),
                    _raw_angles(run),
                    _free(run),
                    _necessity(),
                    "Not simulated: deformation of the film, for which the paper has three "
                    "parameters after Bauer (posstats adjust --self-calibration bauer), errors "
                    "that are neither constant nor linear within a strip, blunders, and terrain "
                    "that hides points.",
                )
            ),
        ),
    )


def _regression(run: Reproduction) -> str:
    chosen = {s: [d for d in each.analysis.chosen.decisions if d.correct]
              for s, each in run.runs.items()}  # fmt: skip
    n_chosen = sum(map(len, chosen.values()))
    lines = {s: each.measures("strip_lines") for s, each in run.runs.items()}
    vertical = fmt.joined(fmt.with_unit(each.vertical_m, "m") for each in lines.values())
    picked = (
        "correct nothing here: errors that jump from strip to strip are no line over the flight"
        if n_chosen == 0
        else f"correct {n_chosen} angles here"
    )
    where = fmt.joined(TERRAIN[situation] for situation in run.runs)
    return (
        f"The first paper's regression on time, by its own rules (R² of at least 0.8), would "
        f"{picked}. Taking off the line of every angle and strip in spite of the rules helps, but "
        f"leaves vertical errors of {vertical} ({where}): the angles estimated from parallax are "
        "no better than the GNSS that holds the block, whose own shifts and drifts it "
        "does not touch."
    )


def _raw_angles(run: Reproduction) -> str:
    flat = run.runs["flat"]
    pos, bundle = flat.measures("pos"), flat.measures("bundle", "centre")
    return (
        "A bundle adjustment without unknowns of the POS is no harmless simplification: where the "
        "recorded angles, with a boresight of half a degree, are weighted by 0.006°, they outweigh "
        "the GNSS. In the flat block its horizontal RMSE with one point is "
        f"{fmt.with_unit(bundle.horizontal_m, 'm')}, that of direct georeferencing "
        f"{fmt.with_unit(pos.horizontal_m, 'm')}. Its sigma0 of "
        f"{fmt.number(flat.row('bundle', 'centre').sigma0, 2)} gives the alarm."
    )


def _free(run: Reproduction) -> str:
    sizes = fmt.joined(
        f"{fmt.with_unit(each.measures('free', 'centre').horizontal_m, 'm')} / "
        f"{fmt.with_unit(each.measures('free', 'centre').vertical_m, 'm')} ({TERRAIN[situation]})"
        for situation, each in run.runs.items()
    )
    return (
        "The paper calls the POS data weighted observations and is silent on weights of the shifts "
        "and drifts. They are essential: free for every strip, they are singular without control; "
        "with one point nothing but the unsteadiness of the flight holds the block against "
        "tilting, turning and stretching, and check points are off by "
        f"{sizes}, H / V. With four corner points free ones do nearly as well as weighted ones."
    )


def _necessity() -> str:
    horizontal, vertical = (
        [
            fmt.number(pooled(f"weighted_{c}_{side}_m", "mountain")
                       / pooled(f"reference_{side}_m", "mountain"), 2)
            for c in ("none", "centre", "corners")
        ]
        for side in _SIDES
    )  # fmt: skip
    without = fmt.fixed(100.0 * (1.0 - share("less_control_is_not_enough", "mountain")), 0)
    return (
        "How much control a block needs follows from its scale. Shifts of the GNSS of some "
        "decimetres are small against what 5 µm of image noise make at 1:32\u202f000, and several "
        "times what they make at 1:2500. Over all seeds the mountainous block without control, "
        "with one and with four points has "
        f"{' / '.join(horizontal)} times (H) and {' / '.join(vertical)} times (V) the RMSE without "
        f"systematic errors. One point helps, but {without}\u00a0% of the seeds stay within the "
        "limits without any; as a check of the datum, which no other observation gives, it is "
        "worth more than by what it adds to the accuracy."
    )


def _provenance(run: Reproduction, versions: Sequence[tuple[str, str]]) -> Part:
    seeds = [
        (
            f"{SITUATIONS[s]}: scenario and seed",
            f"wucaps-{s}.toml, seed {flight_seed(run.seed, s)}; calibration flight "
            f"{flight_seed(run.seed, s) + 1}",
        )
        for s in run.runs
    ]
    recommended = [(f"{SITUATIONS[s]}: recommended control", CONTROL[RECOMMENDED[s]])
                   for s in run.runs]  # fmt: skip
    text = (
        "All numbers of this report are in wucaps.json. The command posstats wucaps "
        f"--seed {run.seed} makes the same files again."
    )
    return Part(
        "provenance",
        "Inputs, settings, versions",
        (
            Paragraph(text),
            pairs("settings", "Blocks, seeds and settings.", ("Item", "Value"),
                                    [*seeds, *recommended]),
            pairs("versions", "Software.", ("Package", "Version"),
                                    list(versions)),
        ),
    )  # fmt: skip
