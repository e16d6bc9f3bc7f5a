"""What stands before the topics of a block's report: what it consists of, its key figures."""

from collections.abc import Iterator

from ..document import format as fmt
from ..document.front import Front, Verdict
from ..document.key_figure import KeyFigure
from ..document.rows import first
from .verdict import is_coarse, paragraph
from .words import BlockReport, Words


def front(report: BlockReport) -> Front:
    """The first page."""
    words, results = report.words, report.results
    return Front(
        language=words.catalogue.language,
        title=words.text("block_document.title"),
        subject=results.block.name,
        subtitle=subtitle(report),
        mark=words.text("mark.simulated") if results.block.simulated else "",
        created=(results.created or "").partition("T")[0],
        version=results.posstats_version,
        verdict=Verdict(paragraph(report), "coarse" if is_coarse(results) else ""),
        key_figures=tuple(key_figures(report)),
    )


def subtitle(report: BlockReport) -> str:
    """The block in numbers."""
    block = report.results.block
    counted = {
        "n_images": block.n_images,
        "n_strips": block.n_strips,
        "n_models": block.n_models,
        "n_tie_points": block.n_tie_points,
        "n_check_points": block.n_check_points,
    }
    words = report.words
    return words.text("consists.between").join(
        words.counted(f"consists.{key}", n) for key, n in counted.items()
    )


def key_figures(report: BlockReport) -> Iterator[KeyFigure]:
    """Parallax from POS, after correction and after relative orientation; check-point accuracy."""
    words, numbers = report.words, report.results.verdict
    yield _parallax(words, "key.pos", numbers.raw_px, numbers.raw_mm)
    if numbers.corrected_angles:
        yield _parallax(words, "key.corrected", numbers.corrected_px, numbers.corrected_mm)
    yield _parallax(words, "key.relative", numbers.relative_px, numbers.relative_mm)
    yield from _check_points(report)


def _parallax(words: Words, label: str, px: float | None, mm: float | None) -> KeyFigure:
    remark = words.text("key.parallax")
    if not fmt.is_missing(mm):
        remark = words.text("key.parallax_mm", mm=fmt.with_unit(mm, "mm", 2))
    return KeyFigure(words.text(label), fmt.number(px), "px", remark)


def _check_points(report: BlockReport) -> Iterator[KeyFigure]:
    words, results = report.words, report.results
    points = first(results.check_points, orientation="selected", translation_removed=False)
    if points is None or fmt.is_missing(points.rmse_horizontal_m):
        return
    value = f"{fmt.number(points.rmse_horizontal_m)} / {fmt.number(points.rmse_vertical_m)}"
    is_corrected = bool(results.verdict.corrected_angles)
    label = words.text("key.check_points_corrected" if is_corrected else "key.check_points")
    yield KeyFigure(label, value, "m", words.text("key.rmse", n=fmt.count(points.n)))
