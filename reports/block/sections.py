"""What a block's report says, section by section, around its tables and figures."""

from posstats.contract.results import Bundle, Results

from ..document import format as fmt
from ..document.content import Bullets, Content, Paragraph, Part, filled, known
from ..document.drawing import Drawing
from ..document.rows import rows
from ..document.table import pairs
from . import parallax_tables, regression_tables, statistics_tables
from .view import decided_by_strip


def subtitle(results: Results) -> str:
    """The block in figures."""
    block = results.block
    counted = (
        ("n_images", "images"),
        ("n_strips", "strips"),
        ("n_models", "stereo models"),
        ("n_tie_points", "tie points"),
        ("n_check_points", "check points"),
    )
    return " · ".join(f"{fmt.count(getattr(block, key))} {words}" for key, words in counted)


def block_report(
    results: Results, drawings: dict[str, Drawing]
) -> tuple[tuple[Content, ...], tuple[Part, ...]]:
    """The opening (the plan) and the sections of a block's report."""
    opening = known(drawings.get("plan"))
    parts = (
        _parallax(results, drawings),
        _error_sources(results, drawings),
        _angle_errors(results),
        *_bundle(results.bundle),
        _regression(results, drawings),
        _decisions(results),
        _corrected(results, drawings),
        _check_points(results, drawings),
        _limits(results),
        _provenance(results),
    )
    return opening, parts


def _parallax(results: Results, drawings: dict[str, Drawing]) -> Part:
    units = ("px", "mm") if results.units.mm else ("px",)
    text = (
        "Vertical parallax is what keeps two conjugate rays from meeting: their distance across "
        "the base, at the scale of the image. A stereo model is two consecutive exposures of a "
        "strip with at least six tie points in common; its parallax is the root mean square (RMS) "
        "over these points. Parallax computed from the POS shows the errors of the POS and the "
        "measuring noise; parallax left by relative orientation, which needs no POS angles, shows "
        "the measuring noise alone."
    )
    if not results.units.mm:
        text += " The pixel size is not known, so all parallax is given in pixels (px)."
    tables = [parallax_tables.by_strip(results, unit) for unit in units]
    models = parallax_tables.by_model(results)
    return Part(
        "parallax",
        "Vertical parallax",
        (Paragraph(text), *filled(tables), *known(drawings.get("models")), *filled([models])),
    )


def _error_sources(results: Results, drawings: dict[str, Drawing]) -> Part:
    text = (
        "Every model is oriented again while POS angles of its right image are held: all three, "
        "omega, phi, or kappa. If the parallax stays high when an angle is held, and falls to that "
        "of relative orientation when it is free, this angle carries the error."
    )
    table = parallax_tables.error_sources(results)
    return Part(
        "sources",
        "Error sources",
        (Paragraph(text), *known(drawings.get("error_sources")), *filled([table])),
    )


def _angle_errors(results: Results) -> Part:
    how = {
        "coplanarity": "They are estimated by a least-squares adjustment of the whole block in "
        "which the rays of each pair of images have to lie in one plane; positions are weighted by "
        "their stated accuracy, angles are almost free, and check points take no part.",
        "bundle": "They are estimated by a bundle adjustment of the whole block; positions are "
        "weighted by their stated accuracy, control points, where there are any, by theirs, angles "
        "are almost free, and check points take no part.",
        "adjusted": "They are the differences between the POS and the adjusted orientation given "
        "with the block.",
    }
    text = (
        "The error of an angle is POS minus estimated, one value per image. "
        f"{how[results.settings.errors]}"
    )
    errors = results.angle_errors
    unused = [row.image for row in errors if not row.used]
    if unused:
        few = "" if len(unused) > 12 else f" ({', '.join(unused)})"
        text += (
            f" For {len(unused)} of {len(errors)} images the tie points do not determine the "
            f"angles; they take no part in summary and regression{few}."
        )
    return Part(
        "angles",
        "Errors of the POS angles",
        (Paragraph(text), *filled([statistics_tables.angle_summary(results)])),
    )


def _bundle(bundle: Bundle | None) -> tuple[Part, ...]:
    """Nothing, unless the angle errors come from a bundle adjustment."""
    if bundle is None:
        return ()
    text = (
        "The rays of every point have to meet in it. Sigma0 compares the residuals of image "
        "coordinates, positions and control points with their stated accuracies: 1 if these are "
        "right, and p is the probability of a sigma0 at least as far from 1 by chance. The weak "
        "priors of the angles do not count. A small p says that a stated accuracy is wrong, or "
        "that errors are left which the adjustment has no unknowns for, such as a shift of the "
        "positions against control points. A wrong image accuracy alone does no harm: angle errors "
        "and their covariance come from a second adjustment with the noise that the residuals "
        "show."
    )
    return (
        Part(
            "bundle",
            "Bundle adjustment",
            (
                Paragraph(f"{text} {_gain_of_control(bundle.n_control_points)}"),
                *filled([statistics_tables.bundle(bundle)]),
            ),
        ),
    )


def _gain_of_control(n: int) -> str:
    if not n:
        return (
            "The block has no measured control point, so this adjustment leaves open the same "
            "rotations as the tie points alone."
        )
    return (
        f"{fmt.count(n)} control point{'s fix' if n > 1 else ' helps to fix'} what tie points and "
        "positions leave open, above all the roll of strips without side overlap."
    )


def _regression(results: Results, drawings: dict[str, Drawing]) -> Part:
    text = (
        "If the error of an angle follows time, a straight line describes it and can be taken off. "
        "Ordinary least squares (OLS) treats the errors of all images as independent, as the "
        "published method does. Generalised least squares (GLS) allows for their covariance: "
        "errors of neighbouring images come from the same tie points, and along one strip alone "
        "they form a chain, for which OLS intervals are far too narrow."
    )
    if results.settings.frame == "camera":
        text += " The figures show the frame of the corrections: angles about the camera's axes."
    pictures = [drawing for name, drawing in drawings.items() if name.startswith("regression")]
    tables = [
        regression_tables.ordinary_regression(results),
        regression_tables.generalised_regression(results),
    ]
    reasons = () if tables[0].rows else tuple(Paragraph(note) for note in tables[0].notes[2:])
    return Part(
        "regression", "Errors over time", (Paragraph(text), *filled(tables), *reasons, *pictures)
    )


def _decisions(results: Results) -> Part:
    frame = results.settings.frame
    text = (
        f"Rules: {results.settings.rules}. Scope: {results.settings.scope}. "
        f"Frame of the corrections: {frame} (ground: the angle as delivered; camera: a rotation "
        "about the axes of the image, in which a misalignment of the camera is constant)."
    )
    why = results.settings.frame_reason or ""
    content: list[Content] = [Paragraph(f"{text} {why}".strip())]
    compared = results.frames
    if compared:
        content.append(
            pairs(
                "frames",
                "Mean vertical parallax of strips whose own errors took no part in the fit, px.",
                ("Frame", "Parallax out of sample, px"),
                [(row.frame, fmt.number(row.out_of_sample_px)) for row in compared],
            )
        )
    if decided_by_strip(results):
        content += filled([regression_tables.decisions_by_strip(results)])
    content += filled([regression_tables.decisions(results)])
    return Part("decisions", "Decisions", tuple(content))


def _corrected(results: Results, drawings: dict[str, Drawing]) -> Part:
    text = (
        "Corrected angle = POS angle minus fitted error. The parallax is computed again from the "
        "corrected POS, for each of omega, phi and kappa alone and for the selected set. “Alone” "
        "is by definition the OLS line of that angle in the ground frame, whatever was decided."
    )
    forms = {row.form for row in results.selection if row.correct}
    if results.settings.frame == "camera" or "constant" in forms:
        text += (
            " The selected set is of another kind (a constant, or about the camera's axes), so it "
            "can do what no single line does."
        )
    table = parallax_tables.corrected(results)
    return Part(
        "corrected",
        "Parallax after correction",
        (Paragraph(text), *known(drawings.get("corrected")), *filled([table])),
    )


def _check_points(results: Results, drawings: dict[str, Drawing]) -> Part:
    tables = [
        statistics_tables.check_points(
            results.check_points, results.verdict.corrected_angles, translation_removed=removed
        )
        for removed in (True, False)
    ]
    if not any(table.rows for table in tables):
        none = Paragraph(
            "No check points could be used, so the accuracy on the ground was not tested."
        )
        return Part("check-points", "Check points", (none,))
    text = (
        "Every check point is intersected from all images that show it, with the orientation "
        "named, and compared with its given coordinates. Check points took no part in any "
        "estimate above."
    )
    return Part(
        "check-points",
        "Check points",
        (Paragraph(text), *filled(tables), *known(drawings.get("check_points"))),
    )


def _limits(results: Results) -> Part:
    text = (
        "Tie points tell orientation errors only where these make vertical parallax. Within one "
        "strip, a common rotation about the base axis (roll) makes none; only side overlap with "
        "another strip fixes it. Rotations about the other two axes are tied to the direction of "
        "the base between GNSS positions."
    )
    if blind := _less_known_than_stated(results):
        text += f" {blind}"
    table = statistics_tables.observability(results)
    told = (
        (Paragraph("Warnings of the analysis:"), Bullets(results.warnings))
        if results.warnings
        else (Paragraph("The analysis gave no warnings."),)
    )
    return Part(
        "limits",
        "What the data cannot tell, and warnings",
        (Paragraph(text), *filled([table]), *told),
    )


def _less_known_than_stated(results: Results) -> str:
    """Angles that the tie points give less well than the POS claims to know them."""
    stated = results.settings.angle_rad
    known = {
        row.angle: row.median_sigma_rad
        for row in rows(results.angle_error_summary, frame="ground")
        if stated and row.median_sigma_rad and row.median_sigma_rad > stated
    }
    if not known:
        return ""
    shown = fmt.joined(f"{name} only to {fmt.angle(sigma)}" for name, sigma in known.items())
    return (
        f"Here they give {shown} (median standard deviation of an image), less well than the POS "
        f"is stated to know its angles, {fmt.angle(stated)}: smaller errors cannot be seen."
    )


def _provenance(results: Results) -> Part:
    words = {
        "rules": "Rules",
        "scope": "Scope of the regressions",
        "errors": "Source of the angle errors",
        "frame": "Frame of the corrections",
        "robust": "Robust estimation",
    }
    shown = [(text, _plain(getattr(results.settings, key))) for key, text in words.items()]
    tables = [
        statistics_tables.inputs(results.block.inputs),
        pairs("settings", "Settings of the analysis.", ("Setting", "Value"), shown),
        pairs("versions", "Software.", ("Package", "Version"), results.versions.items()),
    ]
    return Part("provenance", "Inputs, settings, versions", filled(tables))


def _plain(value: object) -> str:
    if value is None:
        return fmt.MISSING
    return {True: "yes", False: "no"}[value] if isinstance(value, bool) else str(value)
