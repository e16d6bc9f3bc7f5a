"""``adjustment.json``: what a bundle block adjustment found.

Lengths in metres unless the name says px, angles in radians, rates in rad/s. What is not
available or cannot be tested is None. Standard deviations are scaled by sigma0. Keys may be added,
not renamed.
"""

from dataclasses import dataclass
from typing import Annotated, Literal

from posstats.contract.about import about
from posstats.contract.check_points import CheckPointResidual, CheckPointStatistics
from posstats.contract.choices import ControlChoice, DriftScope, SelfCalibration
from posstats.contract.notice import Notice
from posstats.contract.survey import BlockSummary, ImagePlace

SCHEMA = "posstats-adjustment/1"

Group = Literal["image", "gnss", "imu", "control", "parameters"]
Observed = Literal["image", "axes", "gnss", "imu", "control"]
DropReason = Literal["singular", "not determined", "not significant"]
OpenKind = Literal["parameter", "image", "connection"]
Element = Literal["omega", "phi", "kappa", "x", "y", "z"]
Point = tuple[float, float]


@dataclass(frozen=True, kw_only=True)
class AdjustedBlock(BlockSummary):
    """What the block is, and how much of it was used."""

    n_control_points: Annotated[int, about("control points of the last adjustment")]
    n_rays: Annotated[int, about("image rays used")]
    self_calibrated: Annotated[bool, about("whether image deformation was unknown")]


@dataclass(frozen=True, kw_only=True)
class Priors:
    """Standard deviations of POS parameters as observations of the value 0."""

    shift_m: Annotated[float | None, about("of a GNSS shift; `null`: free, as below")]
    drift_m_per_s: Annotated[float | None, about("of a GNSS drift")]
    shift_rad: Annotated[float | None, about("of an IMU shift")]
    drift_rad_per_s: Annotated[float | None, about("of an IMU drift")]
    boresight_rad: Annotated[float | None, about("of a boresight angle")]
    lever_arm_m: Annotated[float | None, about("of what the lever arm differs from the stated one")]


@dataclass(frozen=True, kw_only=True)
class AdjustmentRequest:
    """What was asked for, and the stated accuracies."""

    control: Annotated[ControlChoice, about("a choice of control points, or their ids")]
    drift: Annotated[DriftScope, about("scope of the POS parameters")]
    self_calibration: Annotated[SelfCalibration, about("parameters of image deformation")]
    camera: Annotated[bool, about("whether principal distance and point were unknown")]
    lever_arm: Annotated[bool, about("whether the lever arm was unknown")]
    estimate_weights: Annotated[bool, about("whether the variances of the groups were estimated")]
    drop_insignificant: Annotated[bool, about("whether insignificant parameters were dropped")]
    robust: Annotated[bool, about("whether rays were rejected before data snooping")]
    priors: Annotated[Priors, about("standard deviations of the POS parameters")]
    bauer_radius_mm: Annotated[float, about("r0 of eq. 6")]
    position_m: Annotated[float, about("stated standard deviation of a position")]
    angle_rad: Annotated[float, about("stated standard deviation of an angle")]
    image_px: Annotated[float, about("stated standard deviation of an image coordinate")]
    calibration: Annotated[str | None, about("file of the calibration taken off, or `null`")] = None


@dataclass(frozen=True, kw_only=True)
class GroupSummary:
    """A group of observations."""

    group: Annotated[
        Group,
        about("`parameters`: the prior values of additional parameters"),
    ]
    n: Annotated[int, about("observations")]
    rms: Annotated[
        float | None,
        about("of the residuals, per coordinate, in `unit`; priors: over standard deviations"),
    ]
    redundancy: Annotated[float, about("sum of the redundancy numbers")]
    variance_factor: Annotated[
        float | None, about("weighted sum of squared residuals over the redundancy")
    ]
    weight_factor: Annotated[
        float | None, about("estimated over stated variance, with `--estimate-weights`")
    ]
    n_unchecked: Annotated[int | None, about("observations of a redundancy number below 1 %")]
    median_detectable: Annotated[
        float | None, about("median of the smallest detectable blunders, in `unit`")
    ]
    unit: Annotated[
        Literal["px", "m", "rad", "standard deviations"], about("of `rms` and `median_detectable`")
    ]


@dataclass(frozen=True, kw_only=True)
class AdditionalParameter:
    """An additional parameter: measured minus true, with its test."""

    name: Annotated[str, about("such as `imu_omega_drift`")]
    scope: Annotated[str, about("`\"block\"`, a strip's id, or a camera's")]
    value: Annotated[float, about("estimate, in `unit`")]
    sigma: Annotated[float, about("its standard deviation")]
    t: Annotated[float | None, about("value over standard deviation")]
    p: Annotated[float | None, about("two-sided, of Student's test against 0")]
    significant: Annotated[bool, about("p < 0.05")]
    determined: Annotated[
        bool,
        about(
            "with a prior: the measurements alone know it better than the prior does; free: one"
            " standard deviation moves no observation by more than ten of its own"
        ),
    ]
    prior_sigma: Annotated[
        float | None, about("standard deviation of the prior value 0; `null`: free")
    ]
    prior_released: Annotated[
        bool, about("whether the measurements contradict the prior, which was given up")
    ]
    unit: Annotated[str, about("`m`, `m/s`, `rad`, `rad/s`, `px`, `1/mm2`, or empty")]


@dataclass(frozen=True, kw_only=True)
class DroppedParameter:
    """A parameter that was dropped."""

    name: Annotated[str, about("of the parameter")]
    scope: Annotated[str, about("of the parameter")]
    reason: Annotated[
        DropReason, about("`singular`: without it the normal equations may be regular")
    ]


@dataclass(frozen=True, kw_only=True)
class Correlation:
    """A correlation above 0.95, of two parameters or of a parameter and an orientation."""

    first: Annotated[str, about("name of a parameter")]
    first_scope: Annotated[str, about("its scope")]
    second: Annotated[str, about("name of a parameter, or an element `omega` ... `z` of an image")]
    second_scope: Annotated[str, about("its scope, or the image's id")]
    value: Annotated[float, about("correlation")]


@dataclass(frozen=True, kw_only=True)
class Undetermined:
    """Something that the measurements leave open."""

    kind: Annotated[
        OpenKind,
        about(
            "`parameter`: known from its prior, or its relation to others, alone; `image`: an"
            " angle known from the IMU alone; `connection`: a part without a point in common with"
            " the rest"
        ),
    ]
    names: Annotated[
        tuple[str, ...], about("names of the parameters, or ids of the images or strips")
    ]
    scope: Annotated[str, about("of the parameters")]
    reason: Annotated[str, about("why")] = ""
    remedy: Annotated[str, about("what would determine it")] = ""
    reason_notice: Annotated[Notice, about("the reason as code and values")]
    remedy_notice: Annotated[Notice, about("the remedy as code and values")]


@dataclass(frozen=True, kw_only=True)
class ContradictedObservation:
    """An observation, or all rays of an image, that the others contradict."""

    kind: Annotated[
        Observed,
        about(
            "`image`: a ray; `axes`: an image with exchanged or reversed axes; `gnss`, `imu`,"
            " `control`"
        ),
    ]
    image: Annotated[str | None, about("id of the image")]
    point: Annotated[str | None, about("id of the point")]
    w: Annotated[float | None, about("standardised residual when it was taken out")]
    size: Annotated[tuple[float | None, ...], about("measured minus adjusted, in `unit`")]
    unit: Annotated[Literal["px", "m", "rad"], about("of `size`")]
    found_by: Annotated[
        Literal["snooping", "robust"], about("data snooping, or the robust adjustment")
    ]
    taken_out: Annotated[bool, about("false: kept, as the block is not determined without it")]


@dataclass(frozen=True, kw_only=True)
class ControlPoint:
    """A control point of the last adjustment: adjusted minus given, crs axes."""

    point: Annotated[str, about("id of the point")]
    x_m: Annotated[float, about("given")]
    y_m: Annotated[float, about("given")]
    z_m: Annotated[float, about("given")]
    dx_m: Annotated[float | None, about("adjusted minus given")]
    dy_m: Annotated[float | None, about("adjusted minus given")]
    dz_m: Annotated[float | None, about("adjusted minus given")]
    largest_w: Annotated[float | None, about("largest standardised residual of its coordinates")]


@dataclass(frozen=True, kw_only=True)
class AdjustedCamera:
    """Interior orientation in the terms of ``block.toml`` (``--camera``)."""

    camera: Annotated[str, about("id of the camera")]
    stated_principal_distance_px: Annotated[float, about("as in `block.toml`")]
    principal_distance_px: Annotated[float, about("adjusted")]
    stated_principal_point_px: Annotated[Point, about("column, row, as in `block.toml`")]
    principal_point_px: Annotated[Point, about("column, row, adjusted")]


@dataclass(frozen=True, kw_only=True)
class OrientationElement:
    """An element of the orientations, over all images."""

    element: Annotated[Element, about("angle, or coordinate of the projection centre")]
    median_sigma: Annotated[float, about("median standard deviation")]
    max_sigma: Annotated[float, about("largest standard deviation")]
    pos_mean: Annotated[float, about("mean of POS minus adjusted")]
    pos_rms: Annotated[float, about("root mean square of POS minus adjusted")]
    unit: Annotated[Literal["rad", "m"], about("of all four")]


@dataclass(frozen=True, kw_only=True)
class PointSummary:
    """How many points there are, and how well they are known."""

    n_tie: Annotated[int, about("tie points")]
    n_control: Annotated[int, about("control points")]
    median_sigma_m: Annotated[
        tuple[float, float, float] | None,
        about("median standard deviations x, y, z of the tie points; `null` without"),
    ]


@dataclass(frozen=True, kw_only=True)
class FormatCell:
    """Image residuals, measured minus adjusted, in a cell of the image format."""

    camera: Annotated[str, about("id of the camera")]
    x_px: Annotated[float, about("middle of the cell")]
    y_px: Annotated[float, about("middle of the cell")]
    n: Annotated[int, about("rays")]
    dx_px: Annotated[float, about("mean, measured minus adjusted")]
    dy_px: Annotated[float, about("mean, measured minus adjusted")]
    rms_px: Annotated[float, about("root mean square of a coordinate's residual")]


@dataclass(frozen=True, kw_only=True)
class AdjustmentResults:
    """All that an adjustment found."""

    schema: Annotated[str, about('`"posstats-adjustment/1"`')] = SCHEMA
    converged: Annotated[bool, about("`true`: without convergence there is no file")] = True
    n_iterations: Annotated[int, about("steps of the last adjustment")]
    sigma0: Annotated[float | None, about("standard deviation of unit weight")]
    dof: Annotated[int, about("degrees of freedom")]
    chi2_p: Annotated[
        float | None, about("two-sided p of the chi-square test of the stated weights")
    ]
    posstats_version: Annotated[str, about("version of the package")]
    created: Annotated[str | None, about("ISO 8601 time, or `null`")]
    versions: Annotated[dict[str, str], about("Python and the main libraries")]
    block: Annotated[AdjustedBlock, about("what the block is")]
    settings: Annotated[AdjustmentRequest, about("what was asked for")]
    groups: Annotated[tuple[GroupSummary, ...], about("groups of observations")]
    parameters: Annotated[tuple[AdditionalParameter, ...], about("additional parameters")]
    dropped: Annotated[tuple[DroppedParameter, ...], about("dropped parameters, in order")]
    correlations: Annotated[tuple[Correlation, ...], about("correlations above 0.95")]
    observability: Annotated[tuple[Undetermined, ...], about("what is left open")]
    blunders: Annotated[tuple[ContradictedObservation, ...], about("what the others contradict")]
    n_rejected_rays: Annotated[int, about("rays that the robust adjustment took out (step 2)")]
    snooping_complete: Annotated[bool, about("whether data snooping ended before its limit")]
    check_points: Annotated[
        tuple[CheckPointStatistics, ...], about("orientations `bundle` and `pos`")
    ]
    check_point_residuals: Annotated[
        tuple[CheckPointResidual, ...], about("orientations `bundle` and `pos`")
    ]
    control_points: Annotated[
        tuple[ControlPoint, ...], about("control points of the last adjustment")
    ]
    cameras: Annotated[tuple[AdjustedCamera, ...], about("cameras, with `--camera`")]
    orientations: Annotated[tuple[OrientationElement, ...], about("one per element")]
    points: Annotated[PointSummary, about("how well the points are known")]
    images: Annotated[tuple[ImagePlace, ...], about("one per image")]
    image_residuals: Annotated[tuple[FormatCell, ...], about("cells of the image format")]
    warnings: Annotated[tuple[str, ...], about("sentences")] = ()
    notices: Annotated[tuple[Notice, ...], about("the warnings as codes and values")] = ()
