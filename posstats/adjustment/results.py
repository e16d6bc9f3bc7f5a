"""Adjustment -> the contract's `AdjustmentResults`: ``adjustment.json`` and its report."""

from posstats.adjustment.notices import adjustment_notices
from posstats.adjustment.rows import (
    blunder_rows,
    camera_rows,
    cell_rows,
    control_rows,
    correlation_rows,
    group_rows,
    orientation_rows,
    parameter_rows,
    point_summary,
)
from posstats.adjustment.steps import Adjustment
from posstats.contract.adjustment import (
    AdjustedBlock,
    AdjustmentRequest,
    AdjustmentResults,
    DroppedParameter,
)
from posstats.contract.record import plain, record
from posstats.contract.versions import versions
from posstats.geometry.ground.check_points import check_point_accuracy
from posstats.geometry.ground.rows import block_summary, image_places, residual_rows
from posstats.version import __version__


def adjustment_results(
    adjustment: Adjustment, *, created: str | None = None, calibration: str | None = None
) -> AdjustmentResults:
    """The results of an adjustment as they are written down.

    Parameters
    ----------
    created
        ISO 8601 time stamp to put in; no clock is read here.
    calibration
        Name of the file of the calibration that was taken off.
    """
    overall = adjustment.overall
    residuals = (adjustment.check_points, adjustment.pos_check_points)
    return AdjustmentResults(
        n_iterations=adjustment.adjusted.n_iterations,
        sigma0=plain(overall.sigma0),
        dof=overall.dof,
        chi2_p=plain(overall.p),
        posstats_version=__version__,
        created=created,
        versions=versions(),
        block=_block(adjustment),
        settings=_settings(adjustment, calibration),
        groups=tuple(group_rows(adjustment)),
        parameters=tuple(parameter_rows(adjustment)),
        dropped=_dropped(adjustment),
        correlations=tuple(correlation_rows(adjustment)),
        observability=adjustment.undetermined,
        blunders=tuple(blunder_rows(adjustment)),
        n_rejected_rays=int(adjustment.rejected.sum()),
        snooping_complete=adjustment.snooping.complete,
        check_points=tuple(
            check_point_accuracy(each, translation_removed=removed)
            for each in residuals
            for removed in (False, True)
        ),
        check_point_residuals=tuple(row for each in residuals for row in residual_rows(each)),
        control_points=tuple(control_rows(adjustment)),
        cameras=tuple(camera_rows(adjustment)),
        orientations=tuple(orientation_rows(adjustment)),
        points=point_summary(adjustment),
        images=image_places(adjustment.block),
        image_residuals=tuple(cell_rows(adjustment)),
        notices=(*adjustment.block.notices, *adjustment_notices(adjustment)),
    )


def _block(adjustment: Adjustment) -> AdjustedBlock:
    return AdjustedBlock(
        **vars(block_summary(adjustment.block)),
        n_control_points=len(adjustment.problem.control.point),
        n_rays=int((~adjustment.adjusted.rejected).sum()),
        self_calibrated=adjustment.settings.self_calibration != "none",
    )


def _settings(adjustment: Adjustment, calibration: str | None) -> AdjustmentRequest:
    accuracy = adjustment.block.accuracy
    values = {
        **vars(adjustment.settings),
        "priors": vars(adjustment.settings.priors),
        "position_m": accuracy.position_m,
        "angle_rad": accuracy.angle_rad,
        "image_px": accuracy.image_px,
        "calibration": calibration,
    }
    return record(AdjustmentRequest, values)


def _dropped(adjustment: Adjustment) -> tuple[DroppedParameter, ...]:
    return tuple(
        DroppedParameter(name=each.parameter.name, scope=each.parameter.scope, reason=each.reason)
        for each in adjustment.dropped
    )
