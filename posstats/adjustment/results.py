"""Adjustment -> adjustment.json: plain values, described in ``docs/adjustment.md``.

Lengths in metres unless the name says px, angles in radians, rates in rad/s. What is not
available or cannot be tested is null. Standard deviations are scaled by sigma0.
"""

from collections.abc import Iterator
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from posstats.adjustment.additional_parameters import INTERIOR
from posstats.adjustment.check_points import camera_values
from posstats.adjustment.significance import HIGH_CORRELATION
from posstats.adjustment.snooping import Blunder
from posstats.adjustment.steps import Adjustment
from posstats.adjustment.weights import variance_factors
from posstats.arrays import Floats, Ids
from posstats.contract.record import plain
from posstats.contract.versions import versions
from posstats.formats.adjusted_writing import write_adjusted, write_points
from posstats.geometry.ground.check_points import check_point_accuracy
from posstats.geometry.ground.rows import block_summary, image_places, residual_rows
from posstats.numerics.bundle.parameters import UNITS
from posstats.numerics.bundle.rays import CAMERA_PARAMETERS
from posstats.numerics.kernels.rotation import ANGLE_NAMES, wrapped
from posstats.version import __version__

Row = dict[str, Any]

SCHEMA = "posstats-adjustment/1"
ELEMENTS = (*ANGLE_NAMES, "x", "y", "z")
_GROUP_UNITS = {"image": "px", "gnss": "m", "imu": "rad", "control": "m"}
_MANY = 0.2  # share of the images from which blunders are none
_CELLS = 12  # of the image format along its longer side


def adjustment_results(adjustment: Adjustment, *, created: str | None = None) -> dict[str, Any]:
    """The results of an adjustment as a dictionary of plain values.

    Parameters
    ----------
    created
        ISO 8601 time stamp to put in; no clock is read here.
    """
    adjusted, overall = adjustment.adjusted, adjustment.overall
    values: dict[str, Any] = plain(
        {
            "schema": SCHEMA,
            "converged": True,
            "n_iterations": adjusted.n_iterations,
            "sigma0": overall.sigma0,
            "dof": overall.dof,
            "chi2_p": overall.p,
            "posstats_version": __version__,
            "created": created,
            "versions": versions(),
            "block": _block(adjustment),
            "settings": _settings(adjustment),
            "groups": list(_group_rows(adjustment)),
            "parameters": list(_parameter_rows(adjustment)),
            "dropped": [
                {"name": each.parameter.name, "scope": each.parameter.scope, "reason": each.reason}
                for each in adjustment.dropped
            ],
            "correlations": list(_correlation_rows(adjustment)),
            "observability": [vars(each) for each in adjustment.undetermined],
            "blunders": list(_blunder_rows(adjustment)),
            "n_rejected_rays": int(adjustment.rejected.sum()),
            "snooping_complete": adjustment.snooping.complete,
            "check_points": [
                vars(check_point_accuracy(residuals, translation_removed=removed))
                for residuals in (adjustment.check_points, adjustment.pos_check_points)
                for removed in (False, True)
            ],
            "check_point_residuals": [
                vars(row)
                for residuals in (adjustment.check_points, adjustment.pos_check_points)
                for row in residual_rows(residuals)
            ],
            "control_points": list(_control_rows(adjustment)),
            "cameras": list(_camera_rows(adjustment)),
            "orientations": list(_orientation_rows(adjustment)),
            "points": _points(adjustment),
            "images": [vars(each) for each in image_places(adjustment.block)],
            "image_residuals": list(_cells(adjustment)),
            "warnings": list(_warnings(adjustment)),
        }
    )
    return values


def write_adjustment(adjustment: Adjustment, folder: str | PathLike[str]) -> None:
    """Write ``adjusted_orientations.csv`` and ``points.csv`` into a folder."""
    target = Path(folder)
    write_adjusted(
        adjustment.block,
        adjustment.orientations,
        adjustment.pose_covariance,
        target / "adjusted_orientations.csv",
    )
    position, covariance, role = all_points(adjustment)
    used = adjustment.stated.point[~adjustment.adjusted.rejected]
    n_rays = np.bincount(used, minlength=len(position))
    check = role == "check"
    n_rays[check] = np.bincount(adjustment.block.tie_points.point, minlength=len(position))[check]
    columns = {"n_rays": n_rays, "role": role}
    write_points(adjustment.block, position, covariance, columns, target / "points.csv")


def all_points(adjustment: Adjustment) -> tuple[Floats, Floats, Ids]:
    """Positions (p, 3), covariances (p, 3, 3), computing frame, and roles (p,) of all points."""
    adjusted, block = adjustment.adjusted, adjustment.block
    position = adjusted.ground_m.copy()
    covariance = adjustment.scale**2 * adjusted.ground_covariance_m2
    role = np.full(len(position), "tie", dtype=object)
    role[adjustment.problem.control.point] = "control"
    role[block.check_points] = "check"
    number = {point: k for k, point in enumerate(block.tie_points.point_id)}
    for row, point in enumerate(adjustment.check_points.point):
        if point in number:
            position[number[point]] = adjustment.check_point_position_m[row]
            covariance[number[point]] = adjustment.check_point_covariance_m2[row]
    return position, covariance, role


def _block(adjustment: Adjustment) -> Row:
    summary = block_summary(adjustment.block)
    return vars(summary) | {
        "inputs": [vars(each) for each in summary.inputs],
        "n_control_points": len(adjustment.problem.control.point),
        "n_rays": int((~adjustment.adjusted.rejected).sum()),
        "self_calibrated": adjustment.settings.self_calibration != "none",
    }


def _settings(adjustment: Adjustment) -> Row:
    settings, accuracy = adjustment.settings, adjustment.block.accuracy
    control = settings.control
    return {
        "control": list(control) if isinstance(control, tuple) else control,
        "drift": settings.drift,
        "self_calibration": settings.self_calibration,
        "camera": settings.camera,
        "lever_arm": settings.lever_arm,
        "estimate_weights": settings.estimate_weights,
        "drop_insignificant": settings.drop_insignificant,
        "robust": settings.robust,
        "priors": vars(settings.priors),
        "bauer_radius_mm": settings.bauer_radius_mm,
        "position_m": accuracy.position_m,
        "angle_rad": accuracy.angle_rad,
        "image_px": accuracy.image_px,
    }


def _group_rows(adjustment: Adjustment) -> Iterator[Row]:
    """Groups of observations; last the priors of the additional parameters."""
    adjusted = adjustment.adjusted
    residuals = {
        "image": np.where(adjusted.rejected[:, None], np.nan, adjusted.residual_px),
        "gnss": _observed(adjusted.residual_pos, adjusted.redundancy_pos)[:, :3],
        "imu": _observed(adjusted.residual_pos, adjusted.redundancy_pos)[:, 3:],
        "control": adjusted.residual_control_m,
    }
    factors = variance_factors(adjusted)
    for name, residual in residuals.items():
        group = adjusted.groups[name]
        yield {
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
    priors = adjusted.groups["parameters"]
    yield {
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


def _observed(residual: Floats, redundancy: Floats) -> Floats:
    return np.where(np.isnan(redundancy), np.nan, residual)


def _rms(values: Floats) -> float | None:
    known = values[np.isfinite(values)]
    return float(np.sqrt(np.mean(known**2))) if len(known) else None


def _median(values: Floats) -> float | None:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if len(known) else None


def _parameter_rows(adjustment: Adjustment) -> Iterator[Row]:
    prior = {(each.name, each.scope): each.sigma for each in adjustment.stated.parameters}
    for test, last in zip(adjustment.parameters, adjustment.problem.parameters, strict=True):
        stated = prior.get((test.name, test.scope))
        yield {
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


def _correlation_rows(adjustment: Adjustment) -> Iterator[Row]:
    """Above 0.95: of two parameters, and of a parameter with an element of an orientation."""
    parameters, found = adjustment.problem.parameters, adjustment.common_correlations
    for i, j, value in zip(found.first, found.second, found.value, strict=True):
        first, second = parameters[i], parameters[j]
        yield {
            "first": first.name,
            "first_scope": first.scope,
            "second": second.name,
            "second_scope": second.scope,
            "value": value,
        }
    image = adjustment.block.orientations.image
    for k, value in enumerate(found.with_image):
        if abs(value) > HIGH_CORRELATION:
            yield {
                "first": parameters[k].name,
                "first_scope": parameters[k].scope,
                "second": ELEMENTS[found.element[k]],
                "second_scope": image[found.image[k]],
                "value": value,
            }


def _blunder_rows(adjustment: Adjustment) -> Iterator[Row]:
    """What was taken out, then what would have been but holds the block, then rejected rays."""
    for blunder in adjustment.snooping.blunders:
        yield _blunder_row(adjustment, blunder) | {"found_by": "snooping", "taken_out": True}
    held = adjustment.snooping.held
    if held is not None:
        yield _blunder_row(adjustment, held) | {"found_by": "snooping", "taken_out": False}
    rays = np.flatnonzero(adjustment.rejected)
    size = np.abs(adjustment.adjusted.residual_px[rays]).max(axis=1, initial=0.0)
    for ray in rays[np.argsort(-np.nan_to_num(size), kind="stable")]:
        far = Blunder("image", int(ray), np.nan, -adjustment.adjusted.residual_px[ray], "px")
        yield _blunder_row(adjustment, far) | {"found_by": "robust", "taken_out": True}


def _blunder_row(adjustment: Adjustment, blunder: Blunder) -> Row:
    """Kind, image and point, largest |w|, and measured minus adjusted."""
    stated, block = adjustment.stated, adjustment.block
    image, point = None, None
    if blunder.kind == "image":
        image, point = stated.image[blunder.index], stated.point[blunder.index]
    elif blunder.kind == "control":
        point = stated.control.point[blunder.index]
    else:
        image = blunder.index
    return {
        "kind": blunder.kind,
        "image": None if image is None else block.orientations.image[image],
        "point": None if point is None else block.tie_points.point_id[point],
        "w": blunder.w,
        "size": blunder.size,
        "unit": blunder.unit,
    }


def _control_rows(adjustment: Adjustment) -> Iterator[Row]:
    """Control points of the last adjustment: adjusted minus given, crs axes."""
    block, control = adjustment.block, adjustment.problem.control
    given = block.frame.to_crs(control.position_m)
    adjusted = adjustment.adjusted.ground_m[control.point]
    difference = block.frame.to_crs(adjusted) - given
    w = adjustment.single["control"].w
    for k, point in enumerate(control.point):
        yield {
            "point": block.tie_points.point_id[point],
            **{f"{axis}_m": given[k, a] for a, axis in enumerate("xyz")},
            **{f"d{axis}_m": difference[k, a] for a, axis in enumerate("xyz")},
            "largest_w": _largest(w[k]),
        }


def _largest(w: Floats) -> float | None:
    known = w[np.isfinite(w)]
    return float(known[np.abs(known).argmax()]) if len(known) else None


def _camera_rows(adjustment: Adjustment) -> Iterator[Row]:
    """Stated and adjusted interior orientation of every camera, in the terms of block.toml."""
    if not adjustment.settings.camera:
        return
    found = camera_values(adjustment.problem, adjustment.adjusted).value
    for camera, values in zip(adjustment.block.cameras, found, strict=True):
        c, x0, y0 = (values[CAMERA_PARAMETERS.index(name)] for name in INTERIOR)
        column, row = camera.principal_point_px
        yield {
            "camera": camera.id,
            "stated_principal_distance_px": camera.principal_distance_px,
            "principal_distance_px": camera.principal_distance_px + c,
            "stated_principal_point_px": (column, row),
            "principal_point_px": (column + x0, row - y0),
        }


def _orientation_rows(adjustment: Adjustment) -> Iterator[Row]:
    """Per element: how well it is known, and by how much the POS differs."""
    pos, orientations = adjustment.block.orientations, adjustment.orientations
    turned = wrapped(pos.angles_rad - orientations.angles_rad)
    difference = np.column_stack([turned, pos.position_m - orientations.position_m])
    sigma = np.column_stack([orientations.sigma_angles_rad, orientations.sigma_position_m])
    for k, element in enumerate(ELEMENTS):
        yield {
            "element": element,
            "median_sigma": np.median(sigma[:, k]),
            "max_sigma": np.max(sigma[:, k]),
            "pos_mean": np.mean(difference[:, k]),
            "pos_rms": np.sqrt(np.mean(difference[:, k] ** 2)),
            "unit": "rad" if k < 3 else "m",
        }


def _points(adjustment: Adjustment) -> Row:
    """How many points, and how well they are known."""
    _, covariance, role = all_points(adjustment)
    variance = np.diagonal(covariance, axis1=1, axis2=2)
    tie = (role == "tie") & np.isfinite(variance).all(axis=1)
    sigma = np.sqrt(variance[tie])
    return {
        "n_tie": int(tie.sum()),
        "n_control": int((role == "control").sum()),
        "median_sigma_m": np.median(sigma, axis=0) if len(sigma) else None,
    }


def _cells(adjustment: Adjustment) -> Iterator[Row]:
    """Mean image residuals, measured minus computed, over cells of the image format."""
    stated, adjusted = adjustment.stated, adjustment.adjusted
    used = ~adjusted.rejected
    camera = stated.exposures.camera[stated.image]
    for number, each in enumerate(adjustment.block.cameras):
        rays = np.flatnonzero(used & (camera == number))
        size = max(each.width_px, each.height_px) / _CELLS
        cell = np.floor(stated.xy_px[rays] / size).astype(int)
        residual = -adjusted.residual_px[rays]
        places, index = np.unique(cell, axis=0, return_inverse=True)
        count = np.bincount(index, minlength=len(places))
        mean = [np.bincount(index, residual[:, a], len(places)) / count for a in range(2)]
        square = np.bincount(index, (residual**2).sum(axis=1), len(places))
        for k, place in enumerate((places + 0.5) * size):
            yield {
                "camera": each.id,
                "x_px": place[0],
                "y_px": place[1],
                "n": count[k],
                "dx_px": mean[0][k],
                "dy_px": mean[1][k],
                "rms_px": np.sqrt(square[k] / (2 * count[k])),
            }


def _doubtful_control(adjustment: Adjustment) -> Iterator[str]:
    """A control point that no other checks, where priors of the GNSS gave way to it."""
    control = adjustment.problem.control
    with_prior = {each.name for each in adjustment.stated.parameters if each.sigma is not None}
    freed = [
        each.name
        for each in adjustment.problem.parameters
        if each.sigma is None and each.name in with_prior and each.name.startswith("gnss")
    ]
    if freed and len(control.point) == 1:
        point = adjustment.block.tie_points.point_id[control.point[0]]
        yield (
            f"control point {point} contradicts the prior of {', '.join(dict.fromkeys(freed))}, and"
            " no other control point tells which of the two is wrong: the block follows the point"
        )


def _warnings(adjustment: Adjustment) -> Iterator[str]:
    n_images = len(adjustment.block.orientations)
    for kind, words in (("gnss", "GNSS positions"), ("imu", "IMU angles")):
        n = sum(blunder.kind == kind for blunder in adjustment.snooping.blunders)
        if n > _MANY * n_images:
            yield (
                f"the {words} of {n} of {n_images} images contradict the other observations: this"
                " is no blunder but a systematic error that no parameter describes (--drift block"
                " or strip), or their stated accuracy is too optimistic"
            )
    yield from _doubtful_control(adjustment)
    if adjustment.snooping.held is not None:
        yield (
            "data snooping ended at an observation that contradicts others but without which the"
            " block is not determined: it, or one that it is tied to, is a blunder"
        )
    elif not adjustment.snooping.complete:
        yield (
            "data snooping stopped at its largest number of blunders: the stated weights may be too"
            " optimistic (see the variance factors), or the block holds many blunders"
        )
    if adjustment.weights is not None and adjustment.weights.kept:
        groups = ", ".join(adjustment.weights.kept)
        yield (
            f"too little redundancy, or residuals of zero, to estimate the weight of: {groups}; it"
            " keeps the stated one"
        )
    if adjustment.weights is not None and not adjustment.weights.converged:
        yield "the estimated weights did not settle"
