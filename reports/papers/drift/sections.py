"""What the report on the paper's reproduction says, section by section."""

from collections.abc import Mapping, Sequence

from posstats.papers.drift.areas import area_scenario, area_seed
from posstats.papers.drift.findings import only_row
from posstats.papers.drift.reproduction import Reproduction
from posstats.papers.drift.seeds import repeated

from ...document import format as fmt
from ...document.content import Content, Labelled, Paragraph, Part
from ...document.drawing import Drawing
from ...document.table import Table, pairs, prose_column, text_column
from . import tables
from .conclusions import Conclusion
from .remarks import differences, printed_numbers

Figures = Mapping[int, Sequence[Drawing]]
"""By area: Figures 1, 2 and 3."""


def sections(run: Reproduction, found: Sequence[Conclusion], figures: Figures) -> tuple[Part, ...]:
    """The sections of the report; tables and figures with the paper's numbers where it has them."""
    return (
        _conclusions(found),
        _areas(run),
        _parallax(run),
        _sources(run, figures),
        _regression(run, figures),
        _corrected(run, figures),
        _check_points(run),
        _repeated(run),
        printed_numbers(run),
        differences(run),
        _provenance(run),
    )


def opening(found: Sequence[Conclusion]) -> tuple[Content, ...]:
    """The conclusions in a few words, for the first page."""
    columns = (
        text_column("", [str(k) for k in range(1, len(found) + 1)]),
        text_column("Conclusion of the paper", [each.title for each in found]),
        text_column("Simulated", [_holds(each) for each in found]),
    )
    caption = "The paper's conclusions, and whether the simulated areas bear them out."
    failed = frozenset(k for k, each in enumerate(found) if not each.holds)
    return (Labelled("A", Table("conclusions", caption, columns, strong=failed)),)


def _conclusions(found: Sequence[Conclusion]) -> Part:
    columns = (
        text_column("", [str(k) for k in range(1, len(found) + 1)]),
        text_column("Conclusion of the paper", [each.text for each in found]),
        text_column("Simulated", [_holds(each) for each in found]),
        prose_column("Evidence", ["\n".join(each.evidence) for each in found]),
    )
    table = Table(
        "evidence",
        "The paper's conclusions, each with the evidence of the simulated areas.",
        columns,
    )
    text = (
        "What the paper concludes from its data is tested on the three simulated areas by the "
        "criterion stated with it. “Holds” says that the chain of analysis, given errors of the "
        "kind that the paper supposes, finds what the paper found; it does not prove what the "
        "paper's aircraft did. Two conclusions are not tested: that the corrected POS does not "
        "fully meet the accuracy of stereo mapping at 1:10 000 (the paper names no tolerance), and "
        "that a POS-supported block adjustment without control does (it is not part of this "
        "experiment)."
    )
    return Part("conclusions", "Conclusions", (Paragraph(text), Labelled("B", table)))


def _holds(conclusion: Conclusion) -> str:
    return "holds" if conclusion.holds else "does not hold"


def _areas(run: Reproduction) -> Part:
    text = (
        "The paper, in Chinese, detects systematic errors of POS angles by relative orientation, "
        "regresses them on flying time and corrects them, in three areas photographed at 1:78 000, "
        "1:72 000 and 1:83 000; the copy at hand gives neither title nor authors (source 1 of "
        "docs/method.md). Its photographs are not public. Three areas with the camera, scale, "
        "overlaps, strips, images, tie points and check points of its Table 1 are simulated "
        "instead: exact central projection of random points on smooth random terrain, measured "
        "with noise, from orientations that are then given errors. Tables and figures 1 to 4 carry "
        "the numbers of the paper; further tables carry letters. Published figures cannot stand "
        "beside ours: the copy at hand holds only their captions and what the text says of them."
    )
    device = (
        "The paper does not say how its strips ran. Here they run north and south by turns, and "
        "the errors are added to the angles in the ground frame, so omega, a rotation about the "
        "easting axis, is a pitch along the flight: a constant part makes some 15 mm of parallax "
        "per radian and shifts the ground. As a roll (strips east and west) it would act "
        "differently: what both images share would make no parallax at all, and what they do not "
        "share about 200 mm per radian. Everything below stands under this assumption."
    )
    scenarios = {area: area_scenario(area) for area in run.results}
    return Part(
        "areas",
        "Test areas",
        (
            Paragraph(text),
            Paragraph(device),
            Labelled("1", tables.areas(run)),
            Labelled("C", tables.simulated_errors(scenarios)),
        ),
    )


def _parallax(run: Reproduction) -> Part:
    text = (
        "The vertical parallax of a stereo model is the root mean square over its tie points of "
        "the distance across the base at which conjugate rays pass, at the scale of the image. The "
        "paper gives maximum, minimum and mean over the models of a strip."
    )
    trend = (
        "An error of omega that grows linearly over the whole flight makes the parallax grow from "
        "strip to strip, as simulated. In the published means only area 3 shows this; those of "
        "areas 1 and 2 do not grow, which speaks against one linear drift through these blocks."
    )
    content: list[Content] = [Paragraph(text)]
    for letter, method in zip("abc", tables.METHODS, strict=True):
        content.append(Labelled(f"2{letter}", tables.parallax(run, method)))
    return Part("parallax", "Vertical parallax", (*content, Paragraph(trend)))


def _sources(run: Reproduction, figures: Figures) -> Part:
    text = (
        "Each model is oriented again while POS angles of its right image are held at their POS "
        "values. An angle that keeps the parallax high when it is held carries the error. In the "
        "figures one bar stands for one strip, the number over a group is the mean over all "
        "models, and what is above the grey is, on the logarithmic scale, the factor that the POS "
        "angles cost."
    )
    drawings = _lettered(1, figures)
    return Part(
        "sources",
        "Error sources",
        (Paragraph(text), *drawings, Labelled("D", tables.held(run))),
    )


def _regression(run: Reproduction, figures: Figures) -> Part:
    text = (
        "The angle errors (POS minus estimated from the tie points) are regressed on time. The "
        "published F₀ and p belong to one strip of 60 images (section 9), so the first strip of "
        "area 1 stands beside them; lines of all strips and blocks follow. In the figures a dot is "
        "an image, colours tell the strips; where the OLS line (solid, dark band) and the GLS line "
        "(dashed, pale band), which allows for correlated errors, agree, one line is seen. R² is "
        "the share of the variation that time explains, p the probability of so large a slope if "
        "there were no drift."
    )
    return Part(
        "regression",
        "Angle errors over time",
        (
            Paragraph(text),
            Labelled("3a", tables.one_strip(run)),
            *_lettered(2, figures),
            Labelled("3b", tables.lines(run)),
        ),
    )


def _corrected(run: Reproduction, figures: Figures) -> Part:
    text = (
        "Each angle alone is corrected by its line over the whole block, and the parallax is "
        "computed again."
    )
    return Part(
        "corrected",
        "Parallax after correction",
        (Paragraph(text), *_lettered(3, figures), Labelled("E", tables.corrected(run))),
    )


def _lettered(number: int, figures: Figures) -> list[Labelled]:
    return [
        Labelled(f"{number}{letter}", drawings[number - 1])
        for letter, drawings in zip("abc", figures.values(), strict=True)
    ]


def _check_points(run: Reproduction) -> Part:
    shifts = {
        area: only_row(results.check_points, orientation="pos", translation_removed=False)
        for area, results in run.results.items()
    }
    kept = fmt.joined(fmt.with_unit(row.rmse_horizontal_m, "m") for row in shifts.values())
    text = (
        "Check points are intersected from all images that show them and compared with their given "
        "coordinates. As the paper says it did, the mean difference is removed first; as it is "
        "estimated from the same points, the simulated RMSE divides by n − 1. With the mean kept "
        f"the horizontal RMSE of the POS as delivered is {kept} (areas 1, 2 and 3)."
    )
    return Part("check-points", "Check points",
                (Paragraph(text), Labelled("4", tables.check_points(run))))  # fmt: skip


def _repeated(run: Reproduction) -> Part:
    n_seeds = len(repeated()[1])
    text = (
        f"One run is one random draw. The experiment was therefore repeated with {n_seeds} seeds, "
        "and each finding tested by the same criterion."
    )
    return Part("repeated", "How often the findings come out",
                (Paragraph(text), Labelled("F", tables.shares(run))))  # fmt: skip


def _provenance(run: Reproduction) -> Part:
    seeds = [
        (f"area {area}: scenario and seed", f"area{area}.toml, seed {area_seed(run.seed, area)}")
        for area in run.results
    ]
    versions = [(str(name), str(version)) for name, version in run.results[1].versions.items()]
    settings = [
        (name, str(getattr(run.results[1].settings, name)))
        for name in ("rules", "scope", "errors", "frame", "robust")
    ]
    text = (
        "Each area was analysed like any block; its results, tables and figures are in area1/, "
        "area2/ and area3/. Every published number and its reproduction is in "
        f"comparison.json. The command posstats paper --seed {run.seed} gives the same numbers "
        "again."
    )
    return Part(
        "provenance",
        "Inputs, settings, versions",
        (
            Paragraph(text),
            Labelled("H", pairs(
                "settings", "Areas, seeds and settings.", ("Item", "Value"), [*seeds, *settings])),
            Labelled("I", pairs(
                "versions", "Software.", ("Package", "Version"), versions)),
        ),
    )  # fmt: skip
