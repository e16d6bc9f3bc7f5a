"""``results.json``: what an analysis found.

Lengths in metres unless the name says mm or px, angles in radians, rates in rad/s. What is not
available or cannot be tested is None. Keys may be added, not renamed.
"""

from dataclasses import dataclass
from typing import Annotated, Literal

from posstats.contract.about import about
from posstats.contract.check_points import CheckPointResidual, CheckPointStatistics
from posstats.contract.choices import AngleErrorSource, FitKind, Form, Frame, FrameChoice, Scope
from posstats.contract.notice import Notice
from posstats.contract.status import ModelStatus
from posstats.contract.survey import BlockSummary, ImagePlace

SCHEMA = "posstats-results/1"

Method = Literal["pos", "independent", "dependent"]
Fixed = Literal["none", "angles", "omega", "phi", "kappa"]


@dataclass(frozen=True, kw_only=True)
class AnalysisSettings:
    """What was asked for, and the stated accuracies."""

    rules: Annotated[str, about("`paper`, `strict`, or the rule set's file")]
    scope: Annotated[Scope, about("one correction for the block, or for each strip")]
    errors: Annotated[AngleErrorSource, about("where angle errors come from")]
    frame: Annotated[Frame, about("frame of the corrections")]
    frame_setting: Annotated[FrameChoice, about("frame as asked for")]
    frame_reason: Annotated[
        str | None, about("why that frame, if chosen automatically, in English")
    ] = None
    frame_notice: Annotated[Notice | None, about("the same as code and values")] = None
    robust: Annotated[bool, about("whether blunders of tie points were resisted")]
    position_m: Annotated[float, about("stated standard deviation of a position")]
    angle_rad: Annotated[float, about("stated standard deviation of an angle")]
    image_px: Annotated[float, about("stated standard deviation of an image coordinate")]


@dataclass(frozen=True, kw_only=True)
class AnalysedBlock(BlockSummary):
    """What the block is."""

    n_models: Annotated[int, about("stereo models")]


@dataclass(frozen=True, kw_only=True)
class Units:
    """Which units the results have."""

    mm: Annotated[bool, about("whether results in millimetres exist (pixel size known)")]


@dataclass(frozen=True, kw_only=True)
class Verdict:
    """Means over the models of the block (medians where the name says so)."""

    raw_px: Annotated[float | None, about("vertical parallax of the POS as it is")]
    raw_mm: Annotated[float | None, about("the same, mm")]
    raw_median_px: Annotated[float | None, about("median over the models")]
    relative_px: Annotated[float | None, about("after relative orientation: what the images allow")]
    relative_mm: Annotated[float | None, about("the same, mm")]
    relative_median_px: Annotated[float | None, about("median over the models")]
    corrected_px: Annotated[float | None, about("after the selected corrections")]
    corrected_mm: Annotated[float | None, about("the same, mm")]
    corrected_median_px: Annotated[float | None, about("median over the models")]
    cause: Annotated[
        Literal["omega", "phi", "kappa"] | None,
        about("the angle whose holding keeps the parallax, or `null`"),
    ]
    cause_share: Annotated[
        float | None,
        about(
            "share of the parallax added by holding each of the three angles alone that this one"
            " keeps (above 0.5), or `null` with `cause`"
        ),
    ]
    corrected_angles: Annotated[tuple[str, ...], about("the angles corrected")]


@dataclass(frozen=True, kw_only=True)
class StripParallax:
    """Vertical parallax of a strip by one method: over its models (Table 2)."""

    strip: Annotated[str, about("id of the strip")]
    method: Annotated[Method, about("the POS as it is, or relative orientation")]
    n_models: Annotated[int, about("models with a value")]
    max_mm: Annotated[float | None, about("largest RMS of a model, mm")]
    min_mm: Annotated[float | None, about("smallest, mm")]
    mean_mm: Annotated[float | None, about("mean, mm")]
    max_px: Annotated[float | None, about("largest, px")]
    min_px: Annotated[float | None, about("smallest, px")]
    mean_px: Annotated[float | None, about("mean, px")]


@dataclass(frozen=True, kw_only=True)
class ModelParallax:
    """A stereo model, with root mean squares of its vertical parallax."""

    left: Annotated[str, about("left image")]
    right: Annotated[str, about("right image")]
    strip: Annotated[str, about("id of the strip")]
    n_points: Annotated[int, about("tie points in common")]
    n_rejected: Annotated[int, about("points that the robust orientation took out")]
    pos_px: Annotated[float | None, about("the POS, all points")]
    independent_px: Annotated[float | None, about("relative orientation, the points kept")]
    dependent_px: Annotated[float | None, about("relative orientation, the points kept")]
    corrected_px: Annotated[
        float | None, about("the POS after the selected corrections, all points")
    ]
    adjusted_px: Annotated[float | None, about("the block's adjusted orientation, all points")] = (
        None
    )
    bundle_px: Annotated[
        float | None, about("the orientation of `--errors bundle`, all points")
    ] = None
    status: Annotated[ModelStatus, about('`"ok"`, or why there is no relative orientation')]


@dataclass(frozen=True, kw_only=True)
class ErrorSource:
    """Parallax of a strip with POS angles of the right image held (Figure 1)."""

    strip: Annotated[str, about("id of the strip")]
    fixed: Annotated[Fixed, about("what is held")]
    n_models: Annotated[int, about("models with a value")]
    mean_mm: Annotated[float | None, about("mean over the models, mm")]
    mean_px: Annotated[float | None, about("mean over the models, px")]


@dataclass(frozen=True, kw_only=True)
class ImageAngleErrors:
    """Angle errors of an image: POS minus estimate.

    Those about the axes of the image are there with ``--frame camera`` or ``auto`` only.
    """

    image: Annotated[str, about("id of the image")]
    strip: Annotated[str, about("id of the strip")]
    time_s: Annotated[float, about("time of exposure")]
    omega_rad: Annotated[float | None, about("error in the ground frame")]
    sigma_omega_rad: Annotated[float | None, about("its standard deviation")]
    phi_rad: Annotated[float | None, about("error in the ground frame")]
    sigma_phi_rad: Annotated[float | None, about("its standard deviation")]
    kappa_rad: Annotated[float | None, about("error in the ground frame")]
    sigma_kappa_rad: Annotated[float | None, about("its standard deviation")]
    pitch_rad: Annotated[float | None, about("error about image x")] = None
    sigma_pitch_rad: Annotated[float | None, about("its standard deviation")] = None
    roll_rad: Annotated[float | None, about("error about image y")] = None
    sigma_roll_rad: Annotated[float | None, about("its standard deviation")] = None
    yaw_rad: Annotated[float | None, about("error about image z")] = None
    sigma_yaw_rad: Annotated[float | None, about("its standard deviation")] = None
    used: Annotated[bool, about("false: missing or not determined")]


@dataclass(frozen=True, kw_only=True)
class AngleErrorSummary:
    """Size of the errors of one angle in one frame, over the images used."""

    angle: Annotated[str, about("omega, phi, kappa in `ground`; pitch, roll, yaw in `camera`")]
    frame: Annotated[Frame, about("`ground` or `camera`")]
    n: Annotated[int, about("images used")]
    mean_rad: Annotated[float | None, about("mean error")]
    rms_rad: Annotated[float | None, about("root mean square error")]
    max_abs_rad: Annotated[float | None, about("largest error")]
    median_sigma_rad: Annotated[float | None, about("median standard deviation of an error")]


@dataclass(frozen=True, kw_only=True)
class Bundle:
    """The bundle adjustment that the angle errors come from (``--errors bundle``)."""

    sigma0: Annotated[
        float | None,
        about(
            "standard deviation of unit weight with the stated accuracies of image coordinates,"
            " positions and control points"
        ),
    ]
    dof: Annotated[int, about("their degrees of freedom; the priors of the angles do not count")]
    p_value: Annotated[float | None, about("two-sided, of the chi-square test of `sigma0` = 1")]
    image_rms_px: Annotated[float | None, about("root mean square residual of an image coordinate")]
    sigma_image_px: Annotated[
        float | None,
        about(
            "noise of an image coordinate, estimated from the residuals; the weights of the last"
            " adjustment"
        ),
    ]
    n_rays: Annotated[int, about("rays that took part")]
    n_rejected_rays: Annotated[int, about("rays taken out because they contradict others")]
    n_control_points: Annotated[int, about("ground points of role `control` that took part")]


@dataclass(frozen=True, kw_only=True)
class Regression:
    """Fits of one angle over one scope (Table 3).

    Angles of frame ``camera`` are right-handed about image x, y, z: R_pos = R_estimated exp([e]x).
    ``gls_*``: covariance of the angle errors, plus white noise and (block) a random constant per
    strip, estimated by REML.
    """

    angle: Annotated[str, about("omega, phi, kappa in `ground`; pitch, roll, yaw in `camera`")]
    frame: Annotated[Frame, about("`ground` or `camera`")]
    scope: Annotated[str, about('`"block"`, or a strip\'s id')]
    n: Annotated[int, about("images used")]
    n_strips: Annotated[int, about("their strips")]
    n_time_clusters: Annotated[int | None, about("groups of exposures between gaps in time")]
    time_origin_s: Annotated[float | None, about("the time to which intercepts refer")]
    intercept_rad: Annotated[float | None, about("OLS (eq. 2 of the first source)")]
    intercept_se_rad: Annotated[float | None, about("its standard error")]
    slope_rad_per_s: Annotated[float | None, about("OLS")]
    slope_se: Annotated[float | None, about("its standard error")]
    slope_ci95: Annotated[tuple[float | None, float | None] | None, about("`[low, high]`")]
    cov_intercept_slope: Annotated[float | None, about("covariance of both, rad²/s")]
    r_squared: Annotated[float | None, about("eq. 3")]
    f_statistic: Annotated[float | None, about("eq. 4")]
    df_model: Annotated[int | None, about("degrees of freedom of the model")]
    df_resid: Annotated[float | None, about("degrees of freedom of the residuals")]
    p_value: Annotated[float | None, about("P(F > f_statistic)")]
    sigma_rad: Annotated[float | None, about("residual standard deviation")]
    gls_intercept_rad: Annotated[float | None, about("GLS")]
    gls_intercept_se: Annotated[float | None, about("its standard error")]
    gls_slope_rad_per_s: Annotated[float | None, about("GLS")]
    gls_slope_se: Annotated[float | None, about("its standard error")]
    gls_slope_ci95: Annotated[tuple[float | None, float | None] | None, about("`[low, high]`")]
    gls_cov_intercept_slope: Annotated[float | None, about("covariance of both, rad²/s")]
    gls_df_resid: Annotated[float | None, about("Satterthwaite's degrees of freedom")]
    gls_p_value: Annotated[float | None, about("of slope zero")]
    white_noise_sigma_rad: Annotated[float | None, about("estimated white noise")]
    strip_effect_sigma_rad: Annotated[
        float | None, about("estimated constant per strip; `null` without strip effect")
    ]
    constant_rad: Annotated[float | None, about("the constant fitted alone, by GLS")]
    constant_se_rad: Annotated[float | None, about("its standard error")]
    constant_p_value: Annotated[float | None, about("of constant zero")]
    covariance_known: Annotated[
        bool, about("false if the errors came without covariance (`--errors adjusted`)")
    ]
    reason: Annotated[str | None, about("why a fit is impossible, in English, or `null`")] = None
    notice: Annotated[Notice | None, about("the same as code and values")] = None


@dataclass(frozen=True, kw_only=True)
class FrameComparison:
    """A frame tried out of sample (``--frame auto``)."""

    frame: Annotated[Frame, about("`ground` or `camera`")]
    out_of_sample_px: Annotated[
        float | None, about("mean parallax of the models tested, corrected")
    ]
    raw_px: Annotated[float | None, about("the same models as they are")]
    n_models: Annotated[int, about("models tested")]


@dataclass(frozen=True, kw_only=True)
class Selection:
    """What is corrected of one angle over one scope, and why."""

    angle: Annotated[str, about("omega, phi, kappa; or pitch, roll, yaw")]
    frame: Annotated[Frame, about("`ground` or `camera`")]
    scope: Annotated[str, about('`"block"`, or a strip\'s id')]
    correct: Annotated[bool, about("whether it is corrected")]
    form: Annotated[Form, about("of the function taken off")]
    rule: Annotated[str, about("name of the rule set")]
    fit: Annotated[FitKind, about("the fit that is taken off")]
    reason: Annotated[str, about("why, in English")] = ""
    notices: Annotated[tuple[Notice, ...], about("the same as codes and values")] = ()


@dataclass(frozen=True, kw_only=True)
class CorrectedParallax:
    """Parallax of a strip after a correction (Figure 3)."""

    strip: Annotated[str, about("id of the strip")]
    corrected: Annotated[
        Literal["omega", "phi", "kappa", "selected"], about("the angle corrected alone, or the set")
    ]
    n_models: Annotated[int, about("models with a value")]
    mean_mm: Annotated[float | None, about("mean over the models, mm")]
    mean_px: Annotated[float | None, about("mean over the models, px")]


@dataclass(frozen=True, kw_only=True)
class Observability:
    """What the measurements of one scope leave open."""

    scope: Annotated[str, about('`"block"` or a strip\'s id')]
    unobservable: Annotated[tuple[str, ...], about("rotations left open, in words")] = ()
    rotations: Annotated[
        tuple[str, ...],
        about("the same as codes: `about_base_axis`, `about_axis_across`, `about_vertical`"),
    ] = ()
    images: Annotated[tuple[str, ...], about("ids of images whose angles are not determined")]


@dataclass(frozen=True, kw_only=True)
class Results:
    """All that an analysis found."""

    schema: Annotated[str, about('`"posstats-results/1"`')] = SCHEMA
    posstats_version: Annotated[str, about("version of the package")]
    created: Annotated[str | None, about("ISO 8601 time, or `null`")]
    versions: Annotated[dict[str, str], about("Python and the main libraries")]
    block: Annotated[AnalysedBlock, about("what the block is")]
    settings: Annotated[AnalysisSettings, about("what was asked for")]
    units: Annotated[Units, about("which units the results have")]
    verdict: Annotated[Verdict, about("the block in numbers")]
    expected_noise_px: Annotated[
        float | None, about("the parallax that the stated image accuracy alone would leave")
    ]
    images: Annotated[tuple[ImagePlace, ...], about("one per image")]
    parallax: Annotated[tuple[StripParallax, ...], about("one per strip and method")]
    models: Annotated[tuple[ModelParallax, ...], about("one per stereo model")]
    error_sources: Annotated[tuple[ErrorSource, ...], about("one per strip and held angle")]
    angle_errors: Annotated[tuple[ImageAngleErrors, ...], about("one per image")]
    angle_error_summary: Annotated[tuple[AngleErrorSummary, ...], about("one per angle and frame")]
    bundle: Annotated[Bundle | None, about("the adjustment that the angle errors come from")]
    regression: Annotated[tuple[Regression, ...], about("one per angle, frame and scope")]
    frames: Annotated[tuple[FrameComparison, ...], about("one per frame, with `--frame auto`")]
    selection: Annotated[tuple[Selection, ...], about("one per angle and scope")]
    corrected_parallax: Annotated[
        tuple[CorrectedParallax, ...], about("one per strip and correction")
    ]
    check_points: Annotated[
        tuple[CheckPointStatistics, ...],
        about("one per orientation, with the translation kept and removed"),
    ]
    check_point_residuals: Annotated[
        tuple[CheckPointResidual, ...], about("one per orientation and check point")
    ]
    observability: Annotated[tuple[Observability, ...], about("one per scope")]
    warnings: Annotated[tuple[str, ...], about("what to beware of, in English")] = ()
    notices: Annotated[tuple[Notice, ...], about("the same as codes and values")] = ()
