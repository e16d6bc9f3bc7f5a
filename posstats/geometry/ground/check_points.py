"""Check points: intersected from given orientations, compared with their surveyed positions."""

from dataclasses import dataclass

import numpy as np

from posstats.arrays import Bools, Floats, Ids, Ints
from posstats.block.model import Block, GroundPoints, Orientations
from posstats.contract.check_points import CheckPointStatistics
from posstats.geometry.ground.intersection import IntersectedPoints, intersect


@dataclass(frozen=True, eq=False)
class CheckPointResiduals:
    """The g check points of a block, intersected from one set of orientations.

    Positions and differences are in the axes of the block's crs; NaN where a point cannot be
    intersected, for the reason in `status`.

    Attributes
    ----------
    orientation
        Name of the orientations, as in the results ("pos", "selected", ...).
    point
        (g,) ids, in the order of the block's ground points.
    given_m
        (g, 3) surveyed positions.
    difference_m
        (g, 3) computed minus given.
    sigma_m
        (g, 3) standard deviations of the differences: image noise, stated accuracy of the
        orientations (independent between images) and of the survey, where that is stated.
    survey_sigma_m
        (g, 2) horizontal (of X and of Y) and vertical of the survey; NaN where not stated.
    n_rays
        (g,) rays used.
    rms_px
        (g,) root mean square of the image residuals.
    status
        (g,) "ok" or why there is no position, as in `IntersectedPoints`.
    """

    orientation: str
    point: Ids
    given_m: Floats
    difference_m: Floats
    sigma_m: Floats
    survey_sigma_m: Floats
    n_rays: Ints
    rms_px: Floats
    status: Ids

    def __len__(self) -> int:
        return len(self.point)

    @property
    def is_ok(self) -> Bools:
        """(g,) true where there is a difference."""
        return np.asarray(self.status == "ok", dtype=bool)


def check_point_residuals(
    block: Block, orientations: Orientations, name: str
) -> CheckPointResiduals:
    """Intersect the check points of a block and subtract the surveyed positions.

    Parameters
    ----------
    block
        Its frame turns computed and given positions into crs axes.
    orientations
        Orientations of the block's images, computing frame.
    name
        Name of these orientations in the results.
    """
    given, points = surveyed_check_points(block)
    computed = intersect(
        block.tie_points,
        orientations,
        block.cameras,
        points,
        sigma_image_px=block.accuracy.image_px,
    )
    return differences(block, name, given, computed, computed.covariance_with_orientation_m2)


def surveyed_check_points(block: Block) -> tuple[GroundPoints, Ints]:
    """The g check points, and (g,) their indices among the tie points; -1: in no image."""
    surveyed = block.ground_points
    given = GroundPoints.none() if surveyed is None else surveyed.subset(surveyed.is_check)
    wanted = set(given.point)
    number = {point: k for k, point in enumerate(block.tie_points.point_id) if point in wanted}
    return given, np.array([number.get(point, -1) for point in given.point], dtype=np.intp)


def differences(
    block: Block,
    name: str,
    given: GroundPoints,
    computed: IntersectedPoints,
    covariance_m2: Floats,
) -> CheckPointResiduals:
    """Computed minus surveyed positions, in crs axes.

    Parameters
    ----------
    block
        Its frame turns positions into crs axes.
    name
        Name of the orientations.
    given, computed
        g check points, computing frame.
    covariance_m2
        (g, 3, 3) of the computed positions.
    """
    given_m = block.frame.to_crs(given.position_m)
    variance = _variance_along_crs(block, covariance_m2, given_m)
    return CheckPointResiduals(
        orientation=name,
        point=given.point,
        given_m=given_m,
        difference_m=_to_crs(block, computed) - given_m,
        sigma_m=np.sqrt(variance + _survey_variance(given)),
        survey_sigma_m=np.column_stack([given.sigma_xy_m, given.sigma_z_m]),
        n_rays=computed.n_rays,
        rms_px=computed.rms_px,
        status=computed.status,
    )


def check_point_accuracy(
    residuals: CheckPointResiduals, translation_removed: bool
) -> CheckPointStatistics:
    """Maximum, minimum and RMSE of the differences at check points, horizontal and vertical.

    Horizontal is hypot(dX, dY) of a point, vertical |dZ|. The root mean squares have the
    divisor n, or n - 1 where the mean difference was removed: that estimate spends one point
    on the translation and uses the check points themselves, so it is no proof of accuracy.
    """
    difference = residuals.difference_m[residuals.is_ok]
    n = len(difference)
    shift = difference.mean(axis=0) if n else None
    divisor = n
    if translation_removed and shift is not None:
        difference = difference - shift
        divisor = n - 1
    horizontal = np.hypot(difference[:, 0], difference[:, 1])
    max_h, min_h, rmse_h = _extremes_and_rmse(horizontal, divisor)
    max_v, min_v, rmse_v = _extremes_and_rmse(np.abs(difference[:, 2]), divisor)
    return CheckPointStatistics(
        orientation=residuals.orientation,
        translation_removed=translation_removed,
        n=n,
        max_horizontal_m=max_h,
        max_vertical_m=max_v,
        min_horizontal_m=min_h,
        min_vertical_m=min_v,
        rmse_horizontal_m=rmse_h,
        rmse_vertical_m=rmse_v,
        shift_m=None if shift is None else (float(shift[0]), float(shift[1]), float(shift[2])),
    )


def _extremes_and_rmse(
    values: Floats, divisor: int
) -> tuple[float | None, float | None, float | None]:
    if divisor < 1:
        return None, None, None
    rmse = float(np.sqrt(np.sum(values**2) / divisor))
    return float(values.max()), float(values.min()), rmse


def _to_crs(block: Block, computed: IntersectedPoints) -> Floats:
    """(g, 3) computed positions in the crs; NaN where there is none."""
    position = np.full((len(computed), 3), np.nan)
    position[computed.is_ok] = block.frame.to_crs(computed.position_m[computed.is_ok])
    return position


def _variance_along_crs(block: Block, covariance_m2: Floats, given_m: Floats) -> Floats:
    """(g, 3) variances along the crs axes, m2, of covariances (g, 3, 3) in the computing frame."""
    axes = block.frame.computing_from_crs_axes(given_m)
    variance: Floats = np.einsum("gji,gjk,gki->gi", axes, covariance_m2, axes)
    return variance


def _survey_variance(given: GroundPoints) -> Floats:
    """(g, 3) variances of the surveyed positions, m2; 0 where not stated."""
    sigma = np.column_stack([given.sigma_xy_m, given.sigma_xy_m, given.sigma_z_m])
    return np.nan_to_num(sigma) ** 2
