"""The document of the report on an adjustment: what it says around its tables and figures."""

import msgspec

from posstats.contract.check_points import CheckPointStatistics
from posstats.contract.survey import InputFile

from ..block import statistics_tables
from ..document import format as fmt
from ..document.content import Bullets, Content, Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.front import Verdict
from ..document.numbering import ReportDocument, numbered
from ..document.table import pairs
from . import (
    figures as adjustment_figures,
)
from . import (
    tables as adjustment_tables,
)
from . import (
    verdict as adjustment_verdict,
)
from .view import CONTROL, DEFORMATION, DRIFTS, Results


def build(results: Results) -> ReportDocument:
    """Make the document.

    Parameters
    ----------
    results
        The dictionary of ``adjustment.json``, the only source of the report.
    """
    drawings = adjustment_figures.draw(results)
    opening, sections = numbered(known(drawings.get("plan")), _parts(results, drawings))
    block = results["block"]
    return ReportDocument(
        language="en",
        title="Bundle block adjustment with POS",
        subject=str(block["name"]),
        subtitle=_subtitle(results),
        mark="Simulated data" if block["simulated"] else "",
        created=str(results.get("created") or "").partition("T")[0],
        version=str(results["posstats_version"]),
        verdict=Verdict(adjustment_verdict.paragraph(results)),
        key_figures=adjustment_verdict.key_figures(results),
        opening=opening,
        sections=sections,
    )


def _subtitle(results: Results) -> str:
    block = results["block"]
    counted = {"n_images": "image", "n_strips": "strip", "n_rays": "image ray",
               "n_tie_points": "tie point", "n_control_points": "control point",
               "n_check_points": "check point"}  # fmt: skip
    return " · ".join(
        f"{fmt.count(block[key])} {word}{'' if block[key] == 1 else 's'}"
        for key, word in counted.items()
    )


def _parts(results: Results, drawings: dict[str, Drawing]) -> tuple[Part, ...]:
    return (
        _observations(results, drawings),
        _parameters(results),
        _orientations(results),
        _points(results, drawings),
        _blunders(results),
        _limits(results),
        _provenance(results),
    )


def _observations(results: Results, drawings: dict[str, Drawing]) -> Part:
    text = (
        "Image coordinates, GNSS positions, IMU angles, control points and prior values of the "
        "additional parameters are adjusted together, each with the weight of its stated accuracy."
    )
    if results["settings"]["estimate_weights"]:
        text += (
            " The variances of the groups were estimated: the residuals of every group, set "
            "against its redundancy, say how accurate its observations are."
        )
    pictures = [drawing for name, drawing in drawings.items() if name.startswith("residuals")]
    table = filled([adjustment_tables.groups(results)])
    content: tuple[Content, ...] = (Paragraph(text), *table, *pictures)
    return Part("observations", "Observations and their residuals", content)


def _parameters(results: Results) -> Part:
    table = adjustment_tables.parameters(results)
    if not table.rows:
        none = Paragraph("The adjustment had no additional parameters.")
        return Part("parameters", "Errors of the POS and of the image", (none,))
    text = (
        "Shifts and drifts of GNSS and IMU, the boresight, and the deformation of the image are "
        "unknowns of the adjustment. Those of the POS have prior values of zero with the standard "
        "deviations of the settings, as weighted observations: what the measurements do not "
        "determine stays near zero instead of spoiling the block."
    )
    tables = (
        table,
        adjustment_tables.cameras(results),
        adjustment_tables.dropped(results),
        adjustment_tables.correlations(results),
    )
    return Part(
        "parameters",
        "Errors of the POS and of the image",
        (Paragraph(text), *filled(tables)),
    )


def _orientations(results: Results) -> Part:
    points = results["points"]
    text = (
        "Standard deviations are those of the adjustment, scaled by sigma0. Differences of the POS "
        "contain its systematic errors. Every image is in adjusted_orientations.csv, every point "
        "with its covariance in points.csv."
    )
    if points["median_sigma_m"]:
        x, y, z = (fmt.with_unit(value, "m", 2) for value in points["median_sigma_m"])
        text += (
            f" The {fmt.count(points['n_tie'])} tie points have median standard deviations of {x} "
            f"east, {y} north and {z} up."
        )
    table = filled([adjustment_tables.orientations(results)])
    return Part("orientations", "Adjusted orientations and points", (Paragraph(text), *table))


def _points(results: Results, drawings: dict[str, Drawing]) -> Part:
    tables = filled(
        [
            adjustment_tables.control_points(results),
            statistics_tables.check_points(
                msgspec.convert(results["check_points"], list[CheckPointStatistics]),
                (),
                translation_removed=False,
            ),
            adjustment_tables.check_point_list(results),
        ]
    )
    if not tables:
        none = Paragraph("There were neither control points nor check points.")
        return Part("points", "Control points and check points", (none,))
    text = (
        "Rays to check points took no part. They were intersected afterwards from the adjusted "
        "orientations, with the estimated image deformation taken off."
    )
    content: tuple[Content, ...] = (Paragraph(text), *tables)
    return Part(
        "points",
        "Control points and check points",
        (*content, *known(drawings.get("check_points"))),
    )


def _blunders(results: Results) -> Part:
    text = (
        "A robust adjustment without control and with weak POS first takes out rays that "
        "contradict other rays. Data snooping then tests every observation by its "
        "standardised residual w, takes out the worst, and adjusts again until none is left."
    )
    if not results["snooping_complete"]:
        text += " It stopped before that: more blunders may be in the block."
    table = adjustment_tables.blunders(results)
    none = () if table.rows else (Paragraph("No observation was taken out."),)
    return Part("blunders", "Blunders", (Paragraph(text), *filled([table]), *none))


def _limits(results: Results) -> Part:
    table = adjustment_tables.observability(results)
    first = (
        "Some unknowns are known from prior values or from the POS alone:"
        if table.rows
        else "The measurements determine all parameters and images."
    )
    warnings = tuple(str(warning) for warning in results["warnings"])
    told = (
        (Paragraph("Warnings of the adjustment:"), Bullets(warnings))
        if warnings
        else (Paragraph("The adjustment gave no warnings."),)
    )
    return Part(
        "limits",
        "What the measurements do not determine, and warnings",
        (Paragraph(first), *filled([table]), *told),
    )


def _provenance(results: Results) -> Part:
    versions = [(str(name), str(version)) for name, version in results["versions"].items()]
    tables = [
        statistics_tables.inputs(msgspec.convert(results["block"]["inputs"], list[InputFile])),
        pairs("settings", "Settings of the adjustment.", ("Setting", "Value"), _settings(results)),
        pairs("versions", "Software.", ("Package", "Version"), versions),
    ]
    return Part("provenance", "Inputs, settings, versions", filled(tables))


def _settings(results: Results) -> list[tuple[str, str]]:
    settings = results["settings"]
    control = settings["control"]
    chosen = ", ".join(control) if isinstance(control, list) else CONTROL[control]
    priors = settings["priors"]
    shown = [
        ("Control points", chosen),
        ("Shifts and drifts of the POS", DRIFTS[settings["drift"]]),
        ("Image deformation", DEFORMATION[settings["self_calibration"]]),
        ("Principal distance and point estimated", _yes(settings["camera"])),
        ("Lever arm estimated", _yes(settings["lever_arm"])),
        ("Weights estimated", _yes(settings["estimate_weights"])),
        ("Insignificant parameters dropped", _yes(settings["drop_insignificant"])),
        ("Robust", _yes(settings["robust"])),
        ("Stated accuracy of positions", fmt.with_unit(settings["position_m"], "m")),
        ("Stated accuracy of angles", fmt.with_unit(fmt.DEGREE.scaled(settings["angle_rad"]), "°")),
        ("Stated accuracy of image coordinates", fmt.with_unit(settings["image_px"], "px")),
    ]
    if settings.get("calibration"):
        shown.append(("Calibration applied", settings["calibration"]))
    if settings["drift"] != "none":
        words = {"shift_m": ("GNSS shift", "m", 1.0),
                 "drift_m_per_s": ("GNSS drift", "m/100 s", 100.0),
                 "shift_rad": ("IMU shift", "°", fmt.DEGREE.per_si),
                 "drift_rad_per_s": ("IMU drift", "°/100 s", 100.0 * fmt.DEGREE.per_si),
                 "boresight_rad": ("boresight", "°", fmt.DEGREE.per_si)}  # fmt: skip
        for key, (name, unit, factor) in words.items():
            value = priors[key]
            text = "free" if value is None else fmt.with_unit(value * factor, unit)
            shown.append((f"Prior standard deviation, {name}", text))
    return shown


def _yes(value: bool) -> str:
    return "yes" if value else "no"
