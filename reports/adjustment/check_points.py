"""What an adjustment says of its check points, for several topics."""

import math

from posstats.contract.adjustment import AdjustmentResults
from posstats.contract.check_points import CheckPointResidual, CheckPointStatistics

from ..document import format as fmt


def residuals(results: AdjustmentResults, orientation: str) -> list[CheckPointResidual]:
    """Check points by one orientation."""
    return [row for row in results.check_point_residuals if row.orientation == orientation]


def accuracy(results: AdjustmentResults, orientation: str) -> CheckPointStatistics | None:
    """Statistics by one orientation with the mean difference kept; None without check points."""
    for row in results.check_points:
        if row.orientation == orientation and not row.translation_removed:
            return None if fmt.is_missing(row.rmse_horizontal_m) else row
    return None


def predicted_rmse(results: AdjustmentResults) -> tuple[float, float] | None:
    """RMSE H and V of check points that their covariances predict; None without check points."""
    points = [row for row in residuals(results, "bundle") if row.status == "ok"]
    plane = fmt.present(sigma for row in points for sigma in (row.sigma_x_m, row.sigma_y_m))
    height = fmt.present(row.sigma_z_m for row in points)
    if not points or len(plane) + len(height) < 3 * len(points):
        return None
    n = len(points)
    horizontal = math.sqrt(sum(sigma * sigma for sigma in plane) / n)
    return horizontal, math.sqrt(sum(sigma * sigma for sigma in height) / n)
