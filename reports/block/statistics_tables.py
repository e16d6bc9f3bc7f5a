"""Tables of angle errors, check points, observability and provenance."""

from collections.abc import Iterable, Sequence

from posstats.contract.check_points import CheckPointStatistics
from posstats.contract.results import Bundle, Results
from posstats.contract.survey import InputFile

from ..document import format as fmt
from ..document.rows import rows
from ..document.table import Table, count_column, number_column, pairs, text_column
from .view import orientation_label, scope_label


def angle_summary(results: Results) -> Table:
    """How much each angle errs, and how well that is known."""
    summary = results.angle_error_summary
    unit = fmt.angle_unit(row.rms_rad for row in summary)
    columns = [
        text_column("Angle", [row.angle for row in summary]),
        text_column("Frame", [row.frame for row in summary]),
        count_column("Images", [row.n for row in summary]),
    ]
    words = {"mean_rad": "mean", "rms_rad": "RMS", "max_abs_rad": "largest",
             "median_sigma_rad": "median std. dev."}  # fmt: skip
    for key, title in words.items():
        values = [getattr(row, key) for row in summary]
        columns.append(number_column(title, unit.name, [unit.scaled(v) for v in values]))
    if unit is not fmt.DEGREE:
        degrees = [fmt.DEGREE.scaled(row.rms_rad) for row in summary]
        columns.append(number_column("RMS", fmt.DEGREE.name, degrees))
    caption = (
        "Errors of the POS angles (POS minus estimated) over the images whose angles are "
        "determined. The standard deviation says how well one image's error is known."
    )
    return Table("angle_error_summary", caption, tuple(columns))


def bundle(row: Bundle) -> Table:
    """Figures of the bundle adjustment that the angle errors come from."""
    figures = (
        ("sigma0", fmt.number(row.sigma0)),
        ("degrees of freedom", fmt.count(row.dof)),
        ("p of the chi-square test of sigma0", fmt.p_value(row.p_value)),
        ("RMS image residual", fmt.with_unit(row.image_rms_px, "px")),
        ("noise of an image coordinate, estimated", fmt.with_unit(row.sigma_image_px, "px")),
        ("rays", fmt.count(row.n_rays)),
        ("rejected rays", fmt.count(row.n_rejected_rays)),
        ("control points", fmt.count(row.n_control_points)),
    )
    caption = "Bundle adjustment with the POS positions and nearly free angles."
    return pairs("bundle", caption, ("Figure", "Value"), figures)


def check_points(
    statistics: Iterable[CheckPointStatistics],
    corrected: Sequence[str],
    *,
    translation_removed: bool,
) -> Table:
    """Check-point differences of every orientation, mean shift removed or kept.

    `corrected` are the angles that were corrected.
    """
    stated = rows(statistics, translation_removed=translation_removed)
    kept = [row for row in stated if row.n]
    columns = [
        text_column("Orientation", [orientation_label(row.orientation, corrected) for row in kept]),
        count_column("Points", [row.n for row in kept]),
    ]
    for key, title in (("max", "maximum"), ("min", "minimum"), ("rmse", "RMSE")):
        for side, letter in (("horizontal", "H"), ("vertical", "V")):
            values = [getattr(row, f"{key}_{side}_m") for row in kept]
            columns.append(number_column(letter, "m", values, group=title))
    if not translation_removed:
        for k, axis in enumerate(("east", "north", "up")):
            shift = [row.shift_m[k] if row.shift_m else None for row in kept]
            columns.append(number_column(axis, "m", shift, group="mean difference"))
    how = "removed" if translation_removed else "kept"
    caption = (
        "Differences at check points (forward intersection of all rays minus given coordinates), "
        f"mean difference {how}. H: horizontal; V: vertical (absolute values)."
    )
    name = f"check_points_shift_{how}"
    return Table(name, caption, tuple(columns), _check_notes(translation_removed))


def _check_notes(translation_removed: bool) -> tuple[str, ...]:
    if not translation_removed:
        return ("RMSE divides the sum of squares by n: nothing was estimated from the points.",)
    return (
        "The mean difference was estimated from these same points, so RMSE divides the sum of "
        "squares by n − 1. This shows the precision within the block; acceptance has to use the "
        "differences with the mean kept.",
    )


def observability(results: Results) -> Table:
    """What the tie points cannot tell, by scope; images whose angles stay undetermined."""
    kept = [row for row in results.observability if row.unobservable or row.images]
    columns = (
        text_column("Scope", [scope_label(row.scope) for row in kept]),
        text_column("Not observable", [fmt.joined(row.unobservable) for row in kept]),
        text_column("Undetermined images", [_image_list(row.images) for row in kept]),
    )
    caption = (
        "What the tie points cannot observe: for each scope on its own, the motions that make no "
        "vertical parallax, and the images whose angles stay undetermined."
    )
    return Table("observability", caption, columns)


def inputs(files: Sequence[InputFile]) -> Table:
    """Input files with their SHA-256."""
    columns = (
        text_column("File", [row.file for row in files]),
        text_column("SHA-256", [row.sha256 for row in files]),
    )
    return Table("inputs", "Input files and their SHA-256 checksums.", columns)


def _image_list(images: Sequence[str], shown: int = 12) -> str:
    if not images:
        return fmt.MISSING
    more = f" and {len(images) - shown} more" if len(images) > shown else ""
    return ", ".join(images[:shown]) + more
