"""Analysis -> the contract's `Results`, of which ``results.json`` and every page are made."""

import numpy as np

from posstats.analysis.rows import (
    angle_error_rows,
    angle_error_summary_rows,
    bundle_row,
    corrected_parallax_rows,
    error_source_rows,
    frame_rows,
    model_rows,
    parallax_rows,
    regression_row,
    selection_rows,
)
from posstats.analysis.steps import Analysis
from posstats.arrays import Floats
from posstats.contract.files import as_values
from posstats.contract.record import record
from posstats.contract.results import (
    AnalysedBlock,
    AnalysisSettings,
    Observability,
    Results,
    Units,
    Verdict,
)
from posstats.contract.versions import versions
from posstats.geometry.ground.check_points import check_point_accuracy
from posstats.geometry.ground.rows import block_summary, image_places, residual_rows
from posstats.geometry.stereo.parallax import NOTICEABLE, block_statistics
from posstats.geometry.stereo.relative_orientation import RelativeOrientation
from posstats.version import __version__


def results(analysis: Analysis, *, created: str | None = None) -> Results:
    """The results of an analysis as they are written down.

    Parameters
    ----------
    created
        ISO 8601 time stamp to put in; no clock is read here.
    """
    frames, block = analysis.frames, analysis.block
    summary = vars(block_summary(block))
    residuals = analysis.check_points
    return Results(
        posstats_version=__version__,
        created=created,
        versions=versions(),
        block=AnalysedBlock(**summary, n_models=len(analysis.models)),
        settings=_settings(analysis),
        units=Units(mm=bool(np.isfinite(analysis.models.pixel_size_mm).all())),
        verdict=_verdict(analysis),
        expected_noise_px=_expected_noise_px(analysis),
        images=image_places(block),
        parallax=tuple(parallax_rows(analysis)),
        models=tuple(model_rows(analysis)),
        error_sources=tuple(error_source_rows(analysis)),
        angle_errors=tuple(angle_error_rows(frames)),
        angle_error_summary=tuple(
            row for frame in frames for row in angle_error_summary_rows(frame)
        ),
        bundle=None if analysis.bundle is None else bundle_row(analysis.bundle),
        regression=tuple(regression_row(each) for frame in frames for each in frame.regressions),
        frames=tuple(frame_rows(analysis)),
        selection=tuple(selection_rows(analysis.chosen)),
        corrected_parallax=tuple(corrected_parallax_rows(analysis)),
        check_points=tuple(
            check_point_accuracy(each, translation_removed=removed)
            for each in residuals
            for removed in (False, True)
        ),
        check_point_residuals=tuple(row for each in residuals for row in residual_rows(each)),
        observability=tuple(
            Observability(scope=each.scope, rotations=each.rotations, images=each.images)
            for each in frames[0].errors.observability
        ),
        notices=(*block.notices, *frames[0].errors.notices),
    )


def _settings(analysis: Analysis) -> AnalysisSettings:
    settings = analysis.settings
    values = {
        "rules": str(settings.rules),
        "scope": settings.scope,
        "errors": settings.errors,
        "frame": analysis.chosen.frame,
        "frame_setting": settings.frame,
        "frame_notice": analysis.frame_notice and as_values(analysis.frame_notice),
        "robust": settings.robust,
        "position_m": analysis.block.accuracy.position_m,
        "angle_rad": analysis.block.accuracy.angle_rad,
        "image_px": analysis.block.accuracy.image_px,
    }
    return record(AnalysisSettings, values)


def _verdict(analysis: Analysis) -> Verdict:
    levels = {
        "raw": analysis.raw_px,
        "relative": analysis.independent.y_parallax_rms_px,
        "corrected": analysis.corrected_px["selected"],
    }
    row: dict[str, object] = {}
    for name, rms_px in levels.items():
        mean = block_statistics(analysis.models, rms_px)
        row |= {f"{name}_px": mean.mean_px, f"{name}_mm": mean.mean_mm}
        row[f"{name}_median_px"] = _median(rms_px)
    row |= _cause(analysis)
    row["corrected_angles"] = list(
        dict.fromkeys(each.angle for each in analysis.chosen.decisions if each.correct)
    )
    return record(Verdict, row)


def _cause(analysis: Analysis) -> dict[str, object]:
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


def _median(rms_px: Floats) -> float | None:
    """Median over the models that have a value."""
    valued = rms_px[np.isfinite(rms_px)]
    return float(np.median(valued)) if len(valued) else None


def _expected_noise_px(analysis: Analysis) -> float:
    """RMS y-parallax that the stated image accuracy alone leaves: both images' y count."""
    return float(np.sqrt(2.0)) * analysis.block.accuracy.image_px
