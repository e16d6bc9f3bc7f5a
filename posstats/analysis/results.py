"""Analysis -> results.json: plain values, described in ``docs/results.md``.

Lengths in metres unless the name says mm or px, angles in radians, rates in rad/s. What is not
available or cannot be tested is null.
"""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from posstats import __version__
from posstats.analysis.rows import (
    accuracy_row,
    angle_error_rows,
    angle_error_summary_rows,
    block_row,
    bundle_row,
    corrected_parallax_rows,
    error_source_rows,
    frame_rows,
    image_rows,
    model_rows,
    parallax_rows,
    regression_row,
    residual_rows,
    selection_rows,
)
from posstats.analysis.steps import Analysis
from posstats.geometry.stereo.parallax import NOTICEABLE, block_statistics
from posstats.geometry.stereo.relative_orientation import RelativeOrientation
from posstats.plain_values import RESULTS_SCHEMA, plain, versions

Row = dict[str, Any]


def results(analysis: Analysis, *, created: str | None = None) -> dict[str, Any]:
    """The results of an analysis as a dictionary of plain values.

    Parameters
    ----------
    created
        ISO 8601 time stamp to put in; no clock is read here.
    """
    values: dict[str, Any] = plain(
        {
            "schema": RESULTS_SCHEMA,
            "posstats_version": __version__,
            "created": created,
            "versions": versions(),
            "block": _block(analysis),
            "settings": _settings(analysis),
            "units": {"mm": bool(np.isfinite(analysis.models.pixel_size_mm).all())},
            "verdict": _verdict(analysis),
            "expected_noise_px": _expected_noise_px(analysis),
            "images": image_rows(analysis.block),
            "parallax": parallax_rows(analysis),
            "models": model_rows(analysis),
            "error_sources": error_source_rows(analysis),
            "angle_errors": angle_error_rows(analysis.frames),
            "angle_error_summary": [
                row for frame in analysis.frames for row in angle_error_summary_rows(frame)
            ],
            "bundle": None if analysis.bundle is None else bundle_row(analysis.bundle),
            "regression": [
                regression_row(each) for frame in analysis.frames for each in frame.regressions
            ],
            "frames": frame_rows(analysis),
            "selection": selection_rows(analysis.chosen),
            "corrected_parallax": corrected_parallax_rows(analysis),
            "check_points": [
                accuracy_row(residuals, translation_removed=removed)
                for residuals in analysis.check_points
                for removed in (False, True)
            ],
            "check_point_residuals": [
                row for residuals in analysis.check_points for row in residual_rows(residuals)
            ],
            "observability": [
                {
                    "scope": each.scope,
                    "unobservable": each.unobservable,
                    "images": each.images,
                }
                for each in analysis.frames[0].errors.observability
            ],
            "warnings": [*analysis.block.warnings, *analysis.frames[0].errors.warnings],
        }
    )
    return values


def _block(analysis: Analysis) -> Row:
    return block_row(analysis.block) | {"n_models": len(analysis.models)}


def _settings(analysis: Analysis) -> Row:
    settings = analysis.settings
    return {
        "rules": str(settings.rules),
        "scope": settings.scope,
        "errors": settings.errors,
        "frame": analysis.chosen.frame,
        "frame_setting": settings.frame,
        "frame_reason": analysis.frame_reason,
        "robust": settings.robust,
        "position_m": analysis.block.accuracy.position_m,
        "angle_rad": analysis.block.accuracy.angle_rad,
        "image_px": analysis.block.accuracy.image_px,
    }


def _verdict(analysis: Analysis) -> Row:
    levels = {
        "raw": analysis.raw_px,
        "relative": analysis.independent.y_parallax_rms_px,
        "corrected": analysis.corrected_px["selected"],
    }
    row: Row = {}
    for name, rms_px in levels.items():
        mean = block_statistics(analysis.models, rms_px)
        row |= {f"{name}_px": mean.mean_px, f"{name}_mm": mean.mean_mm}
        row[f"{name}_median_px"] = _median(rms_px)
    row |= _cause(analysis)
    row["corrected_angles"] = list(
        dict.fromkeys(each.angle for each in analysis.chosen.decisions if each.correct)
    )
    return row


def _cause(analysis: Analysis) -> Row:
    """The angle that keeps the parallax when it is held, and its share among the three.

    An angle is named when holding it keeps more parallax than holding either other angle and
    both together, and holding all three keeps noticeably more than relative orientation leaves.
    """
    least = _mean_px(analysis, analysis.dependent)
    kept = {name: _mean_px(analysis, each) - least for name, each in analysis.fixed.items()}
    all_held = kept.pop("angles")
    worst = max(kept, key=lambda angle: kept[angle])
    named = all_held > NOTICEABLE * least and kept[worst] > 0.5 * sum(kept.values())
    return {
        "cause": worst if named else None,
        "cause_share": kept[worst] / sum(kept.values()) if named else None,
    }


def _mean_px(analysis: Analysis, orientation: RelativeOrientation) -> float:
    return block_statistics(analysis.models, orientation.y_parallax_rms_px).mean_px


def _median(rms_px: NDArray[np.float64]) -> float | None:
    """Median over the models that have a value."""
    valued = rms_px[np.isfinite(rms_px)]
    return float(np.median(valued)) if len(valued) else None


def _expected_noise_px(analysis: Analysis) -> float:
    """RMS y-parallax that the stated image accuracy alone leaves: both images' y count."""
    return float(np.sqrt(2.0)) * analysis.block.accuracy.image_px
