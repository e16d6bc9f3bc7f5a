"""Rows of ``adjustment.json`` on observations, parameters, points and images."""

from collections.abc import Iterator

import numpy as np

from posstats.adjustment.additional_parameters import INTERIOR
from posstats.adjustment.check_points import camera_values
from posstats.adjustment.significance import HIGH_CORRELATION
from posstats.adjustment.snooping import Blunder
from posstats.adjustment.steps import Adjustment
from posstats.adjustment.weights import variance_factors
from posstats.adjustment.writing import all_points
from posstats.arrays import Floats
from posstats.contract.adjustment import (
    AdditionalParameter,
    AdjustedCamera,
    ContradictedObservation,
    ControlPoint,
    Correlation,
    FormatCell,
    GroupSummary,
    OrientationElement,
    PointSummary,
)
from posstats.contract.record import record
from posstats.numerics.bundle.parameters import UNITS
from posstats.numerics.bundle.problem import ObservationGroup
from posstats.numerics.bundle.rays import CAMERA_PARAMETERS
from posstats.numerics.kernels.rotation import ANGLE_NAMES, wrapped

ELEMENTS = (*ANGLE_NAMES, "x", "y", "z")
_GROUP_UNITS = {"image": "px", "gnss": "m", "imu": "rad", "control": "m"}
_CELLS = 12  # of the image format along its longer side


def group_rows(adjustment: Adjustment) -> Iterator[GroupSummary]:
    """Groups of observations; last the priors of the additional parameters."""
    adjusted = adjustment.adjusted
    factors = variance_factors(adjusted)
    for name, residual in _residuals(adjustment).items():
        group = adjusted.groups[name]
        values = {
            "group": name,
            "n": group.n,
            "rms": _rms(residual),
            "redundancy": group.redundancy,
            "variance_factor": factors[name],
            "weight_factor": adjustment.weights.factor[name] if adjustment.weights else None,
            "n_unchecked": adjustment.single[name].n_unchecked,
            "median_detectable": _median(adjustment.single[name].detectable),
            "unit": _GROUP_UNITS[name],
        }
        yield record(GroupSummary, values)
    yield _prior_row(adjusted.groups["parameters"])


def _residuals(adjustment: Adjustment) -> dict[str, Floats]:
    """Residuals by group; NaN of what took no part."""
    adjusted = adjustment.adjusted
    pos = np.where(np.isnan(adjusted.redundancy_pos), np.nan, adjusted.residual_pos)
    return {
        "image": np.where(adjusted.rejected[:, None], np.nan, adjusted.residual_px),
        "gnss": pos[:, :3],
        "imu": pos[:, 3:],
        "control": adjusted.residual_control_m,
    }


def _prior_row(priors: ObservationGroup) -> GroupSummary:
    values = {
        "group": "parameters",
        "n": priors.n,
        "rms": np.sqrt(priors.square_sum / priors.n) if priors.n else None,
        "redundancy": priors.redundancy,
        "variance_factor": priors.square_sum / priors.redundancy if priors.redundancy else None,
        "weight_factor": None,
        "n_unchecked": None,
        "median_detectable": None,
        "unit": "standard deviations",
    }
    return record(GroupSummary, values)


def _rms(values: Floats) -> float | None:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else None


def _median(values: Floats) -> float | None:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else None


def parameter_rows(adjustment: Adjustment) -> Iterator[AdditionalParameter]:
    """Additional parameters with their tests, and what became of their priors."""
    prior = {(each.name, each.scope): each.sigma for each in adjustment.stated.parameters}
    for test, last in zip(adjustment.parameters, adjustment.problem.parameters, strict=True):
        stated = prior.get((test.name, test.scope))
        values = {
            "name": test.name,
            "scope": test.scope,
            "value": test.value,
            "sigma": test.sigma,
            "t": test.t,
            "p": test.p,
            "significant": test.significant,
            "determined": test.determined,
            "prior_sigma": stated,
            "prior_released": stated is not None and last.sigma is None,
            "unit": UNITS[test.name],
        }
        yield record(AdditionalParameter, values)


def correlation_rows(adjustment: Adjustment) -> Iterator[Correlation]:
    """Above 0.95: of two parameters, and of a parameter with an element of an orientation."""
    parameters, found = adjustment.problem.parameters, adjustment.common_correlations
    for i, j, value in zip(found.first, found.second, found.value, strict=True):
        first, second = parameters[i], parameters[j]
        yield Correlation(
            first=first.name,
            first_scope=first.scope,
            second=second.name,
            second_scope=second.scope,
            value=float(value),
        )
    image = adjustment.block.orientations.image
    for k in np.flatnonzero(np.abs(found.with_image) > HIGH_CORRELATION):
        yield Correlation(
            first=parameters[k].name,
            first_scope=parameters[k].scope,
            second=ELEMENTS[found.element[k]],
            second_scope=str(image[found.image[k]]),
            value=float(found.with_image[k]),
        )


def blunder_rows(adjustment: Adjustment) -> Iterator[ContradictedObservation]:
    """What was taken out, then what would have been but holds the block, then rejected rays."""
    for blunder in adjustment.snooping.blunders:
        yield _blunder_row(adjustment, blunder, found_by="snooping")
    held = adjustment.snooping.held
    if held is not None:
        yield _blunder_row(adjustment, held, found_by="snooping", taken_out=False)
    rays = np.flatnonzero(adjustment.rejected)
    size = np.abs(adjustment.adjusted.residual_px[rays]).max(axis=1, initial=0.0)
    for ray in rays[np.argsort(-np.nan_to_num(size), kind="stable")]:
        far = Blunder("image", int(ray), np.nan, -adjustment.adjusted.residual_px[ray], "px")
        yield _blunder_row(adjustment, far, found_by="robust")


def _blunder_row(
    adjustment: Adjustment, blunder: Blunder, *, found_by: str, taken_out: bool = True
) -> ContradictedObservation:
    """Kind, image and point, largest |w|, and measured minus adjusted."""
    image, point = _place(adjustment, blunder)
    block = adjustment.block
    values = {
        "kind": blunder.kind,
        "image": None if image is None else block.orientations.image[image],
        "point": None if point is None else block.tie_points.point_id[point],
        "w": blunder.w,
        "size": blunder.size,
        "unit": blunder.unit,
        "found_by": found_by,
        "taken_out": taken_out,
    }
    return record(ContradictedObservation, values)


def _place(adjustment: Adjustment, blunder: Blunder) -> tuple[int | None, int | None]:
    """Indices of the image and of the point that an observation belongs to."""
    stated, at = adjustment.stated, blunder.index
    if blunder.kind == "image":
        return int(stated.image[at]), int(stated.point[at])
    if blunder.kind == "control":
        return None, int(stated.control.point[at])
    return at, None


def control_rows(adjustment: Adjustment) -> Iterator[ControlPoint]:
    """Control points of the last adjustment: adjusted minus given, crs axes."""
    block, control = adjustment.block, adjustment.problem.control
    given = block.frame.to_crs(control.position_m)
    adjusted = adjustment.adjusted.ground_m[control.point]
    difference = block.frame.to_crs(adjusted) - given
    w = adjustment.single["control"].w
    for k, point in enumerate(control.point):
        values = {
            "point": block.tie_points.point_id[point],
            **{f"{axis}_m": given[k, a] for a, axis in enumerate("xyz")},
            **{f"d{axis}_m": difference[k, a] for a, axis in enumerate("xyz")},
            "largest_w": _largest(w[k]),
        }
        yield record(ControlPoint, values)


def _largest(w: Floats) -> float | None:
    known = w[np.isfinite(w)]
    return float(known[np.abs(known).argmax()]) if len(known) else None


def camera_rows(adjustment: Adjustment) -> Iterator[AdjustedCamera]:
    """Stated and adjusted interior orientation of every camera, in the terms of block.toml."""
    if not adjustment.settings.camera:
        return
    found = camera_values(adjustment.problem, adjustment.adjusted).value
    for camera, values in zip(adjustment.block.cameras, found, strict=True):
        c, x0, y0 = (float(values[CAMERA_PARAMETERS.index(name)]) for name in INTERIOR)
        column, row = camera.principal_point_px
        yield AdjustedCamera(
            camera=camera.id,
            stated_principal_distance_px=camera.principal_distance_px,
            principal_distance_px=camera.principal_distance_px + c,
            stated_principal_point_px=(column, row),
            principal_point_px=(column + x0, row - y0),
        )


def orientation_rows(adjustment: Adjustment) -> Iterator[OrientationElement]:
    """Per element: how well it is known, and by how much the POS differs."""
    pos, orientations = adjustment.block.orientations, adjustment.orientations
    turned = wrapped(pos.angles_rad - orientations.angles_rad)
    difference = np.column_stack([turned, pos.position_m - orientations.position_m])
    sigma = np.column_stack([orientations.sigma_angles_rad, orientations.sigma_position_m])
    for k, element in enumerate(ELEMENTS):
        values = {
            "element": element,
            "median_sigma": np.median(sigma[:, k]),
            "max_sigma": np.max(sigma[:, k]),
            "pos_mean": np.mean(difference[:, k]),
            "pos_rms": np.sqrt(np.mean(difference[:, k] ** 2)),
            "unit": "rad" if k < 3 else "m",
        }
        yield record(OrientationElement, values)


def point_summary(adjustment: Adjustment) -> PointSummary:
    """How many points, and how well they are known."""
    _, covariance, role = all_points(adjustment)
    variance = np.diagonal(covariance, axis1=1, axis2=2)
    tie = (role == "tie") & np.isfinite(variance).all(axis=1)
    sigma = np.sqrt(variance[tie])
    values = {
        "n_tie": tie.sum(),
        "n_control": (role == "control").sum(),
        "median_sigma_m": np.median(sigma, axis=0) if len(sigma) else None,
    }
    return record(PointSummary, values)


def cell_rows(adjustment: Adjustment) -> Iterator[FormatCell]:
    """Mean image residuals, measured minus computed, over cells of the image format."""
    stated, adjusted = adjustment.stated, adjustment.adjusted
    camera = stated.exposures.camera[stated.image]
    for number, each in enumerate(adjustment.block.cameras):
        rays = np.flatnonzero(~adjusted.rejected & (camera == number))
        size_px = max(each.width_px, each.height_px) / _CELLS
        yield from _cells(each.id, stated.xy_px[rays], -adjusted.residual_px[rays], size_px)


def _cells(camera: str, xy_px: Floats, residual_px: Floats, size_px: float) -> Iterator[FormatCell]:
    """Cells of one camera that hold rays."""
    cell = np.floor(xy_px / size_px).astype(int)
    places, index = np.unique(cell, axis=0, return_inverse=True)
    count = np.bincount(index, minlength=len(places))
    mean = [np.bincount(index, residual_px[:, a], len(places)) / count for a in range(2)]
    square = np.bincount(index, (residual_px**2).sum(axis=1), len(places))
    for k, (x, y) in enumerate((places + 0.5) * size_px):
        values = {
            "camera": camera,
            "x_px": x,
            "y_px": y,
            "n": count[k],
            "dx_px": mean[0][k],
            "dy_px": mean[1][k],
            "rms_px": np.sqrt(square[k] / (2 * count[k])),
        }
        yield record(FormatCell, values)
