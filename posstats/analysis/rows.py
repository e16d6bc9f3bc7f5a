"""Rows of ``results.json``, one function per list."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from posstats.adjustment.imu_free import ImuFreeBundle
from posstats.analysis.regression import AngleRegression
from posstats.analysis.steps import Analysis, FrameAnalysis
from posstats.arrays import Floats
from posstats.contract.files import as_values
from posstats.contract.record import record
from posstats.contract.results import (
    AngleErrorSummary,
    Bundle,
    CorrectedParallax,
    ErrorSource,
    FrameComparison,
    ImageAngleErrors,
    ModelParallax,
    Regression,
    Selection,
    StripParallax,
)
from posstats.geometry.stereo.parallax import strip_statistics
from posstats.numerics.kernels.rotation import ANGLE_NAMES, CAMERA_ANGLE_NAMES
from posstats.statistics.drift import DriftFit

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


def parallax_rows(analysis: Analysis) -> Iterator[StripParallax]:
    """Parallax by strip, from POS and after relative orientation (Table 2)."""
    methods = {
        "pos": analysis.raw_px,
        "independent": analysis.independent.y_parallax_rms_px,
        "dependent": analysis.dependent.y_parallax_rms_px,
    }
    for method, rms_px in methods.items():
        for each in strip_statistics(analysis.models, rms_px):
            yield record(StripParallax, vars(each) | {"method": method})


def model_rows(analysis: Analysis) -> Iterator[ModelParallax]:
    """RMS y-parallax of every stereo model."""
    models, pos = analysis.models, analysis.models.orientations
    independent, dependent = analysis.independent, analysis.dependent
    for k in range(len(models)):
        values = {
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
        yield record(ModelParallax, values)


def _of_model(rms_px: Floats | None, k: int) -> float | None:
    return None if rms_px is None else float(rms_px[k])


def error_source_rows(analysis: Analysis) -> Iterator[ErrorSource]:
    """Parallax by strip with POS angles held (Figure 1)."""
    held = {name: each.y_parallax_rms_px for name, each in analysis.fixed.items()}
    held["none"] = analysis.dependent.y_parallax_rms_px
    for name, values in _means(analysis, held):
        yield record(ErrorSource, {"fixed": name} | values)


def corrected_parallax_rows(analysis: Analysis) -> Iterator[CorrectedParallax]:
    """Parallax by strip after each correction (Figure 3)."""
    for name, values in _means(analysis, analysis.corrected_px):
        yield record(CorrectedParallax, {"corrected": name} | values)


def _means(
    analysis: Analysis, rms_px: Mapping[str, Floats]
) -> Iterator[tuple[str, dict[str, object]]]:
    """Means over the models of every strip, for every name."""
    keys = ("strip", "n_models", "mean_mm", "mean_px")
    for name, values in rms_px.items():
        for each in strip_statistics(analysis.models, values):
            yield name, {key: getattr(each, key) for key in keys}


def angle_error_rows(frames: Sequence[FrameAnalysis]) -> Iterator[ImageAngleErrors]:
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
    of_image = {"image": errors.image, "strip": errors.strip, "time_s": errors.time_s}
    for k in range(len(errors)):
        values: dict[str, object] = {key: column[k] for key, column in of_image.items()}
        values |= {key: column[k] for key, column in columns.items()}
        yield record(ImageAngleErrors, values | {"used": errors.used[k]})


def _angle_names(frame: FrameAnalysis) -> tuple[str, ...]:
    return ANGLE_NAMES if frame.frame == "ground" else CAMERA_ANGLE_NAMES


def angle_error_summary_rows(frame: FrameAnalysis) -> Iterator[AngleErrorSummary]:
    """Size of the angle errors in one frame."""
    errors = frame.errors
    for axis, angle in enumerate(_angle_names(frame)):
        used = errors.error_rad[errors.used, axis]
        sigma = errors.sigma_rad[errors.used, axis]
        any_used = len(used) > 0
        values = {
            "angle": angle,
            "frame": frame.frame,
            "n": len(used),
            "mean_rad": used.mean() if any_used else None,
            "rms_rad": np.sqrt(np.mean(used**2)) if any_used else None,
            "max_abs_rad": np.abs(used).max() if any_used else None,
            "median_sigma_rad": np.median(sigma) if any_used else None,
        }
        yield record(AngleErrorSummary, values)


def bundle_row(bundle: ImuFreeBundle) -> Bundle:
    """The bundle adjustment that the angle errors come from."""
    values = {
        "sigma0": bundle.overall.sigma0,
        "dof": bundle.overall.dof,
        "p_value": bundle.overall.p,
        "image_rms_px": bundle.image_rms_px,
        "sigma_image_px": bundle.sigma_px,
        "n_rays": int((~bundle.adjusted.rejected).sum()),
        "n_rejected_rays": bundle.n_rejected,
        "n_control_points": len(bundle.problem.control.point),
    }
    return record(Bundle, values)


def regression_row(each: AngleRegression) -> Regression:
    """Fits of one angle over one scope (Table 3)."""
    origin_s = None if each.ols is None else each.ols.time_reference_s
    constant = each.gls_constant
    values = {
        "angle": each.angle,
        "frame": each.frame,
        "scope": each.scope,
        "n": each.n,
        "n_strips": each.n_strips,
        "constant_rad": None if constant is None else constant.value,
        "constant_se_rad": None if constant is None else constant.se,
        "constant_p_value": None if constant is None else constant.p_value,
        "covariance_known": each.covariance_known,
        "notice": each.notice and as_values(each.notice),
    }
    return record(Regression, values | _ols(each.ols) | _gls(each.gls, origin_s))


def _ols(fit: DriftFit | None) -> dict[str, object]:
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


def _gls(fit: DriftFit | None, origin_s: float | None) -> dict[str, object]:
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


def frame_rows(analysis: Analysis) -> Iterator[FrameComparison]:
    """How the frames compare out of sample; empty unless the frame was chosen automatically."""
    for each in analysis.frames:
        tried = each.out_of_sample
        if tried is not None:
            values = {
                "frame": each.frame,
                "out_of_sample_px": tried.corrected_px,
                "raw_px": tried.raw_px,
                "n_models": tried.n_models,
            }
            yield record(FrameComparison, values)


def selection_rows(chosen: FrameAnalysis) -> Iterator[Selection]:
    """The decisions of the chosen frame."""
    keys = ("angle", "frame", "scope", "correct", "form", "rule", "fit")
    for each in chosen.decisions:
        values = {key: getattr(each, key) for key in keys}
        yield record(Selection, values | {"notices": as_values(each.notices)})
