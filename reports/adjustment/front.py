"""What stands before the topics of an adjustment: what the block consists of, and key figures."""

from posstats.contract.adjustment import AdjustmentResults

from ..document import format as fmt
from ..document.key_figure import KeyFigure
from .check_points import accuracy
from .words import Words


def subtitle(words: Words, results: AdjustmentResults) -> str:
    """What the block consists of."""
    block = results.block
    counted = {
        "n_images": block.n_images,
        "n_strips": block.n_strips,
        "n_rays": block.n_rays,
        "n_tie_points": block.n_tie_points,
        "n_control_points": block.n_control_points,
        "n_check_points": block.n_check_points,
    }
    return words.text("consists.between").join(
        words.counted(f"consists.{key}", n) for key, n in counted.items()
    )


def key_figures(words: Words, results: AdjustmentResults) -> tuple[KeyFigure, ...]:
    """Sigma0, image residuals, accuracy of the orientations, check points."""
    sigma0 = fmt.number(results.sigma0)
    fit = KeyFigure(words.text("key.sigma0"), sigma0, "", fmt.p_phrase(results.chi2_p))
    return (fit, _image_figure(words, results), _orientation_figure(words, results),
            *_check_point_figure(words, results))  # fmt: skip


def _image_figure(words: Words, results: AdjustmentResults) -> KeyFigure:
    image = next(row for row in results.groups if row.group == "image")
    remark = words.text("key.image_remark", n=fmt.count(image.n))
    return KeyFigure(words.text("key.image"), fmt.number(image.rms), "px", remark)


def _orientation_figure(words: Words, results: AdjustmentResults) -> KeyFigure:
    """Medians of the worst axis and of the worst angle."""
    rows = results.orientations
    position_m = max(row.median_sigma for row in rows if row.unit == "m")
    angle_rad = max(row.median_sigma for row in rows if row.unit == "rad")
    remark = words.text("key.orientations_remark", angle=fmt.angle(angle_rad, 2))
    return KeyFigure(words.text("key.orientations"), fmt.number(position_m), "m", remark)


def _check_point_figure(words: Words, results: AdjustmentResults) -> tuple[KeyFigure, ...]:
    row = accuracy(results, "bundle")
    if row is None:
        return ()
    value = f"{fmt.number(row.rmse_horizontal_m)} / {fmt.number(row.rmse_vertical_m)}"
    remark = words.text("key.check_points_remark", n=fmt.count(row.n))
    return (KeyFigure(words.text("key.check_points"), value, "m", remark),)
