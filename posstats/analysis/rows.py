"""Rows of results.json, one function per list; ``docs/results.md`` names every key."""

from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from posstats.adjustment.imu_free import ImuFreeBundle
from posstats.analysis.regression import AngleRegression
from posstats.analysis.steps import Analysis, FrameAnalysis
from posstats.block.model import Block
from posstats.geometry.ground.check_points import CheckPointResiduals, check_point_accuracy
from posstats.geometry.ground.footprints import footprints
from posstats.geometry.stereo.parallax import strip_statistics
from posstats.numerics.kernels.rotation import ANGLE_NAMES, CAMERA_ANGLE_NAMES
from posstats.statistics.drift import DriftFit

_Floats = NDArray[np.float64]
Row = dict[str, Any]

_OLS_KEYS = (
    "n_time_clusters",
    "time_origin_s",
    "intercept_rad",
    "intercept_se_rad",
    "slope_rad_per_s",
    "slope_se",
    "slope_ci95",
    "cov_intercept_slope",
    "r_squared",
    "f_statistic",
    "df_model",
    "df_resid",
    "p_value",
    "sigma_rad",
)
_GLS_KEYS = (
    "gls_intercept_rad",
    "gls_intercept_se",
    "gls_slope_rad_per_s",
    "gls_slope_se",
    "gls_slope_ci95",
    "gls_cov_intercept_slope",
    "gls_df_resid",
    "gls_p_value",
    "white_noise_sigma_rad",
    "strip_effect_sigma_rad",
)


def block_row(block: Block) -> Row:
    """What a block is, and what it was read from."""
    n_checks = 0 if block.ground_points is None else int(block.ground_points.is_check.sum())
    return {
        "name": block.name,
        "n_images": len(block.orientations),
        "n_strips": len(block.orientations.strips),
        "n_tie_points": int((~block.check_points).sum()),
        "n_check_points": n_checks,
        "simulated": block.simulated,
        "crs": block.frame.crs,
        "angles": block.orientations.system,
        "inputs": [{"file": name, "sha256": digest} for name, digest in block.inputs],
    }


def image_rows(block: Block) -> list[Row]:
    """Every image with its place in the plan."""
    pos = block.orientations
    position = block.frame.to_crs(pos.position_m)
    return [
        {
            "image": pos.image[k],
            "strip": pos.strip[k],
            "time_s": pos.time_s[k],
            "x_m": position[k, 0],
            "y_m": position[k, 1],
            "z_m": position[k, 2],
            "footprint": corners,
        }
        for k, corners in enumerate(footprints(block))
    ]


def parallax_rows(analysis: Analysis) -> list[Row]:
    """Parallax by strip, from POS and after relative orientation (Table 2)."""
    methods = {
        "pos": analysis.raw_px,
        "independent": analysis.independent.y_parallax_rms_px,
        "dependent": analysis.dependent.y_parallax_rms_px,
    }
    return [
        {
            "strip": each.strip,
            "method": method,
            "n_models": each.n_models,
            "max_mm": each.max_mm,
            "min_mm": each.min_mm,
            "mean_mm": each.mean_mm,
            "max_px": each.max_px,
            "min_px": each.min_px,
            "mean_px": each.mean_px,
        }
        for method, rms_px in methods.items()
        for each in strip_statistics(analysis.models, rms_px)
    ]


def model_rows(analysis: Analysis) -> list[Row]:
    """RMS y-parallax of every stereo model."""
    models, pos = analysis.models, analysis.models.orientations
    independent, dependent = analysis.independent, analysis.dependent
    return [
        {
            "left": pos.image[models.pairs.left[k]],
            "right": pos.image[models.pairs.right[k]],
            "strip": models.strip[k],
            "n_points": models.pairs.n_points[k],
            "n_rejected": independent.n_rejected[k],
            "pos_px": analysis.raw_px[k],
            "independent_px": independent.y_parallax_rms_px[k],
            "dependent_px": dependent.y_parallax_rms_px[k],
            "corrected_px": analysis.corrected_px["selected"][k],
            "adjusted_px": _of_model(analysis.triangulated_px.get("adjusted"), k),
            "bundle_px": _of_model(analysis.triangulated_px.get("bundle"), k),
            "status": independent.status[k],
        }
        for k in range(len(models))
    ]


def _of_model(rms_px: _Floats | None, k: int) -> float | None:
    return None if rms_px is None else float(rms_px[k])


def error_source_rows(analysis: Analysis) -> list[Row]:
    """Parallax by strip with POS angles held (Figure 1)."""
    held = {name: each.y_parallax_rms_px for name, each in analysis.fixed.items()}
    held["none"] = analysis.dependent.y_parallax_rms_px
    return [row for name, rms_px in held.items() for row in _means(analysis, "fixed", name, rms_px)]


def corrected_parallax_rows(analysis: Analysis) -> list[Row]:
    """Parallax by strip after each correction (Figure 3)."""
    return [
        row
        for name, rms_px in analysis.corrected_px.items()
        for row in _means(analysis, "corrected", name, rms_px)
    ]


def _means(analysis: Analysis, key: str, name: str, rms_px: _Floats) -> Iterator[Row]:
    for each in strip_statistics(analysis.models, rms_px):
        yield {
            "strip": each.strip,
            key: name,
            "n_models": each.n_models,
            "mean_mm": each.mean_mm,
            "mean_px": each.mean_px,
        }


def angle_error_rows(frames: Sequence[FrameAnalysis]) -> list[Row]:
    """Angle errors of every image, in every frame that was analysed."""
    errors = frames[0].errors
    columns = {
        key: values
        for frame in frames
        for axis, angle in enumerate(_angle_names(frame))
        for key, values in (
            (f"{angle}_rad", frame.errors.error_rad[:, axis]),
            (f"sigma_{angle}_rad", frame.errors.sigma_rad[:, axis]),
        )
    }
    return [
        {"image": errors.image[k], "strip": errors.strip[k], "time_s": errors.time_s[k]}
        | {key: values[k] for key, values in columns.items()}
        | {"used": errors.used[k]}
        for k in range(len(errors))
    ]


def _angle_names(frame: FrameAnalysis) -> tuple[str, ...]:
    return ANGLE_NAMES if frame.frame == "ground" else CAMERA_ANGLE_NAMES


def angle_error_summary_rows(frame: FrameAnalysis) -> Iterator[Row]:
    """Size of the angle errors in one frame."""
    errors = frame.errors
    for axis, angle in enumerate(_angle_names(frame)):
        used = errors.error_rad[errors.used, axis]
        sigma = errors.sigma_rad[errors.used, axis]
        any_used = len(used) > 0
        yield {
            "angle": angle,
            "frame": frame.frame,
            "n": len(used),
            "mean_rad": used.mean() if any_used else None,
            "rms_rad": np.sqrt(np.mean(used**2)) if any_used else None,
            "max_abs_rad": np.abs(used).max() if any_used else None,
            "median_sigma_rad": np.median(sigma) if any_used else None,
        }


def bundle_row(bundle: ImuFreeBundle) -> Row:
    """The bundle adjustment that the angle errors come from."""
    return {
        "sigma0": bundle.overall.sigma0,
        "dof": bundle.overall.dof,
        "p_value": bundle.overall.p,
        "image_rms_px": bundle.image_rms_px,
        "sigma_image_px": bundle.sigma_px,
        "n_rays": int((~bundle.adjusted.rejected).sum()),
        "n_rejected_rays": bundle.n_rejected,
        "n_control_points": len(bundle.problem.control.point),
    }


def regression_row(each: AngleRegression) -> Row:
    """Fits of one angle over one scope (Table 3)."""
    row: Row = {
        "angle": each.angle,
        "frame": each.frame,
        "scope": each.scope,
        "n": each.n,
        "n_strips": each.n_strips,
    }
    origin_s = None if each.ols is None else each.ols.time_reference_s
    constant = each.gls_constant
    return (
        row
        | _ols(each.ols)
        | _gls(each.gls, origin_s)
        | {
            "constant_rad": None if constant is None else constant.value,
            "constant_se_rad": None if constant is None else constant.se,
            "constant_p_value": None if constant is None else constant.p_value,
            "covariance_known": each.covariance_known,
            "reason": each.reason,
        }
    )


def _ols(fit: DriftFit | None) -> Row:
    """The paper's regression; intercepts are given at `time_origin_s`."""
    if fit is None:
        return dict.fromkeys(_OLS_KEYS)
    origin_s = fit.time_reference_s
    intercept, intercept_se = fit.intercept_at(origin_s)
    values = (
        fit.n_time_clusters,
        origin_s,
        intercept,
        intercept_se,
        fit.slope,
        fit.slope_se,
        fit.conf_int(),
        fit.coefficient_covariance(origin_s)[0, 1],
        fit.rsquared,
        fit.f_statistic,
        fit.df_model,
        fit.df_resid,
        fit.f_pvalue,
        fit.sigma,
    )
    return dict(zip(_OLS_KEYS, values, strict=True))


def _gls(fit: DriftFit | None, origin_s: float | None) -> Row:
    if fit is None or origin_s is None:
        return dict.fromkeys(_GLS_KEYS)
    intercept, intercept_se = fit.intercept_at(origin_s)
    values = (
        intercept,
        intercept_se,
        fit.slope,
        fit.slope_se,
        fit.conf_int(),
        fit.coefficient_covariance(origin_s)[0, 1],
        fit.df_resid,
        fit.f_pvalue,
        fit.white_noise_sigma,
        fit.strip_effect_sigma,
    )
    return dict(zip(_GLS_KEYS, values, strict=True))


def frame_rows(analysis: Analysis) -> list[Row]:
    """How the frames compare out of sample; empty unless the frame was chosen automatically."""
    return [
        {
            "frame": each.frame,
            "out_of_sample_px": each.out_of_sample.corrected_px,
            "raw_px": each.out_of_sample.raw_px,
            "n_models": each.out_of_sample.n_models,
        }
        for each in analysis.frames
        if each.out_of_sample is not None
    ]


def selection_rows(chosen: FrameAnalysis) -> list[Row]:
    """The decisions of the chosen frame."""
    return [
        {
            "angle": each.angle,
            "frame": each.frame,
            "scope": each.scope,
            "correct": each.correct,
            "form": each.form,
            "rule": each.rule,
            "fit": each.fit,
            "reason": each.reason,
        }
        for each in chosen.decisions
    ]


def accuracy_row(residuals: CheckPointResiduals, *, translation_removed: bool) -> Row:
    """Statistics of the check points from one set of orientations."""
    return vars(check_point_accuracy(residuals, translation_removed)).copy()


def residual_rows(residuals: CheckPointResiduals) -> Iterator[Row]:
    """Every check point from one set of orientations."""
    for k in range(len(residuals)):
        yield {
            "orientation": residuals.orientation,
            "point": residuals.point[k],
            "n_rays": residuals.n_rays[k],
            "status": residuals.status[k],
            "survey_sigma_xy_m": residuals.survey_sigma_m[k, 0],
            "survey_sigma_z_m": residuals.survey_sigma_m[k, 1],
        } | {
            key: value
            for axis, name in enumerate("xyz")
            for key, value in (
                (f"{name}_m", residuals.given_m[k, axis]),
                (f"d{name}_m", residuals.difference_m[k, axis]),
                (f"sigma_{name}_m", residuals.sigma_m[k, axis]),
            )
        }
