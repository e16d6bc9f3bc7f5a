"""``acceptance.json``: what a product was held against, and what was found.

Lengths are metres, everything else has the unit of its quantity; what is not known is None. Keys
may be added, not renamed.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Literal

from posstats.contract.about import about
from posstats.contract.check_points import CheckPointDifference
from posstats.contract.choices import JudgedOrientation, Language, TerrainKind
from posstats.contract.notice import Notice, Value
from posstats.contract.results import AnalysedBlock, AnalysisSettings
from posstats.contract.survey import InputFile

SCHEMA = "posstats-acceptance/1"

Verdict = Literal["accepted", "rejected", "not assessable"]
Judgement = Literal["pass", "fail", "not assessed"]
Exceeding = Literal["fail", "investigate"]
Unit = Literal["m", "px", "1"]
StatedComponent = Literal["horizontal", "vertical"]
StatementKind = Literal["tested", "tested_with_fewer", "produced"]
Grade = Literal["excellent", "good", "pass", "fail"]
Relationship = Literal["Data", "Source", "Supplement", "Alternative", "Unspecified"]
Axis = Literal["x", "y", "z"]
Component = Literal["x", "y", "h", "v", "3d"]
PercentileName = Literal["CE90", "CE95", "LE90", "LE95"]


@dataclass(frozen=True, kw_only=True)
class UsedProfile:
    """The profile that was judged by."""

    name: Annotated[str, about("its name")]
    edition: Annotated[str, about("of the standard")]
    title: Annotated[str, about("of the standard")]
    source: Annotated[str, about("where it is cited from")]
    files: Annotated[
        tuple[InputFile, ...], about("that it was read from: the contract first, then the standard")
    ]
    notes: Annotated[tuple[str, ...], about("what a reader must know of its numbers")] = ()
    changed: Annotated[tuple[str, ...], about("ids of requirements that the contract changed")] = ()
    added: Annotated[tuple[str, ...], about("that it added")] = ()
    omitted: Annotated[tuple[str, ...], about("that it left out")] = ()


@dataclass(frozen=True, kw_only=True)
class StatedProduct:
    """What the product is stated to be, by contract file and command line."""

    class_h_m: Annotated[float | None, about("accuracy class, horizontal")] = None
    class_v_m: Annotated[float | None, about("accuracy class, vertical")] = None
    gsd_m: Annotated[float | None, about("ground sampling distance")] = None
    map_scale: Annotated[float | None, about("denominator of the map scale")] = None
    terrain: Annotated[TerrainKind | None, about("kind of terrain")] = None
    lot_size: Annotated[int | None, about("units delivered together")] = None
    sample_size: Annotated[int | None, about("those of them inspected")] = None
    survey_sigma_h_m: Annotated[
        float | None, about("accuracy of the check points' survey, radial horizontal")
    ] = None
    survey_sigma_v_m: Annotated[float | None, about("vertical")] = None


@dataclass(frozen=True, kw_only=True)
class Parties:
    """Who delivers what to whom, as the contract file says it; empty where it does not."""

    number: Annotated[str, about("of the contract")] = ""
    title: Annotated[str, about("of the contract")] = ""
    client: Annotated[str, about("client")] = ""
    contractor: Annotated[str, about("contractor")] = ""
    inspector: Annotated[str, about("inspecting office")] = ""
    flight: Annotated[str, about("flight")] = ""
    flight_date: Annotated[str, about("date of the flight")] = ""
    sensor: Annotated[str, about("sensor")] = ""
    place: Annotated[str, about("place")] = ""
    remarks: Annotated[str, about("remarks")] = ""


@dataclass(frozen=True, kw_only=True)
class JudgedRequirement:
    """A requirement of the profile, and what was found of it."""

    id: Annotated[str, about("as in the profile")]
    clause: Annotated[str, about("of the standard or contract; empty if none is known")]
    quantity: Annotated[str, about("what is limited")]
    source: Annotated[str, about("where the limit is cited from")]
    mandatory: Annotated[
        bool, about("whether the product is not assessable while this is not assessed")
    ]
    exceeding: Annotated[Exceeding, about("what a value on the wrong side of the limit means")]
    threshold: Annotated[float | None, about("residuals beyond it were counted, m")] = None
    found: Annotated[float | None, about("what was found")] = None
    limit: Annotated[float | None, about("what it was held against")] = None
    limit_formula: Annotated[str, about("the limit as the profile has it")]
    unit: Annotated[Unit, about("of found value, limit and margin")]
    margin: Annotated[float | None, about("what is left to the limit, negative beyond it")] = None
    verdict: Annotated[Judgement, about("on this requirement")]
    reason_code: Annotated[str, about("why")]
    reason_values: Annotated[Mapping[str, Value], about("what the reason says, as data")]
    low: Annotated[float | None, about("95 % interval of what was found, where known")] = None
    high: Annotated[float | None, about("its upper bound")] = None
    n_to_decide: Annotated[
        int | None,
        about("check points with which the same value would be clear of the limit, if it is not"),
    ] = None
    score: Annotated[float | None, about("of GB/T 24356")] = None
    reason: Annotated[str, about("why, in words of `language`")] = ""


@dataclass(frozen=True, kw_only=True)
class ChosenStatement:
    """The standard's own wording for a component: a template, and its numbers."""

    component: Annotated[StatedComponent, about("what it speaks of")]
    kind: Annotated[StatementKind, about("which of the standard's wordings")]
    template: Annotated[str, about("the wording")]
    class_m: Annotated[float | None, about("accuracy class")]
    found_m: Annotated[float | None, about("what was found")]
    n_points: Annotated[int, about("check points")]


@dataclass(frozen=True, kw_only=True)
class QualityGrade:
    """The smallest score and its grade (GB/T 24356)."""

    score: Annotated[float | None, about("`null` if a basis of it is not met")]
    grade: Annotated[Grade, about("of the score")]


@dataclass(frozen=True, kw_only=True)
class Rmse:
    """Root mean square error of a component at the check points."""

    component: Annotated[Component, about("axis, horizontal, vertical, or in space")]
    iso_19157: Annotated[int | None, about("measure: 39, horizontal 47")]
    value_m: Annotated[float | None, about("RMSE")]
    low_m: Annotated[float | None, about("its 95 % interval")]
    high_m: Annotated[float | None, about("upper bound")]
    df: Annotated[float | None, about("degrees of freedom")]
    product_m: Annotated[float | None, about("with the survey of the check points")]


@dataclass(frozen=True, kw_only=True)
class MeanError:
    """Mean difference of a component; null hypothesis of the test: it is zero (Student)."""

    component: Annotated[Axis, about("axis of the crs")]
    iso_19157: Annotated[int, about("measure: 128")]
    value_m: Annotated[float | None, about("mean")]
    se_m: Annotated[float | None, about("its standard error")]
    p: Annotated[float | None, about("two-sided")]
    reason: Annotated[str | None, about("why there is no test")] = None


@dataclass(frozen=True, kw_only=True)
class PercentileError:
    """A circular or linear error."""

    name: Annotated[PercentileName, about("circular or linear, and its share in percent")]
    iso_19157: Annotated[int, about("measure: 44, 45, 35, 36")]
    value_m: Annotated[float | None, about("of the sample")]
    low_m: Annotated[float | None, about("its 95 % interval")]
    high_m: Annotated[float | None, about("upper bound; `null` below `n_for_high` points")]
    normal_m: Annotated[float | None, about("of normal errors with the same second moments")]
    n_for_high: Annotated[int, about("points from which there is an upper bound")]


@dataclass(frozen=True, kw_only=True)
class MeanShift:
    """Hotelling's test; null hypothesis: the mean difference is zero."""

    t2: Annotated[float | None, about("statistic")]
    f: Annotated[float | None, about("the same as F")]
    df1: Annotated[int, about("degrees of freedom")]
    df2: Annotated[int, about("degrees of freedom")]
    p: Annotated[float | None, about("P(F > f)")]
    reason: Annotated[str | None, about("why there is no test")] = None


@dataclass(frozen=True, kw_only=True)
class Normality:
    """Shapiro-Wilk's test of a component; null hypothesis: its differences are normal."""

    component: Annotated[Axis, about("axis of the crs")]
    w: Annotated[float | None, about("statistic")]
    p: Annotated[float | None, about("small for other distributions")]
    reason: Annotated[str | None, about("why there is no test")] = None


@dataclass(frozen=True, kw_only=True)
class LargestResidual:
    """Grubbs' test of a component; null hypothesis: its largest residual is of a normal sample."""

    component: Annotated[Axis, about("axis of the crs")]
    point: Annotated[str | None, about("id of the check point")]
    value_m: Annotated[float | None, about("difference minus mean")]
    p: Annotated[float | None, about("after Holm over the components")]
    reason: Annotated[str | None, about("why there is no test")] = None


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """What the check points say, whatever a profile asks; their mean difference is kept."""

    n: Annotated[int, about("check points that were intersected")]
    n_given: Annotated[int, about("all")]
    survey_known: Annotated[bool, about("whether the accuracy of their survey is stated")]
    survey_h_m: Annotated[float | None, about("accuracy of their survey, radial horizontal")]
    survey_v_m: Annotated[float | None, about("vertical")]
    rmse: Annotated[tuple[Rmse, ...], about("of `x`, `y`, `h`, `v`, `3d`")]
    mean_error: Annotated[tuple[MeanError, ...], about("of `x`, `y`, `z`")]
    percentiles: Annotated[tuple[PercentileError, ...], about("`CE90`, `CE95`, `LE90`, `LE95`")]
    covariance_iso_19157: Annotated[int, about("measure of the next: 32")]
    covariance_m2: Annotated[
        tuple[tuple[float | None, ...], ...], about("of X, Y, Z about the mean, m²")
    ]
    mean_shift: Annotated[MeanShift, about("Hotelling's test of a mean of zero")]
    normality: Annotated[tuple[Normality, ...], about("Shapiro-Wilk's test by component")]
    largest_residual: Annotated[tuple[LargestResidual, ...], about("Grubbs' test by component")]


@dataclass(frozen=True, kw_only=True)
class JudgedPoint(CheckPointDifference):
    """A check point of the assessed orientation, intersected or not."""

    dh_m: Annotated[float | None, about("horizontal length of the difference")]
    blunder: Annotated[bool, about("whether it lies beyond the profile's threshold")]


@dataclass(frozen=True, kw_only=True)
class AttachedFile(InputFile):
    """A file inside the document."""

    relationship: Annotated[Relationship, about("to the pages (PDF/A-3)")]


@dataclass(frozen=True, kw_only=True)
class Acceptance:
    """All that an acceptance document says."""

    schema: Annotated[str, about('`"posstats-acceptance/1"`')] = SCHEMA
    posstats_version: Annotated[str, about("version of the package")]
    versions: Annotated[dict[str, str], about("Python and the main libraries")]
    created: Annotated[str, about("ISO 8601 time")]
    language: Annotated[Language, about("of the texts `reason` and `statement`")]
    verdict: Annotated[Verdict, about("on the product")]
    orientation: Annotated[JudgedOrientation, about("what was assessed")]
    orientation_reason: Annotated[
        Notice, about("why: `code` is `asked`, or the orientation's name")
    ]
    profile: Annotated[UsedProfile, about("what was judged by")]
    product: Annotated[StatedProduct, about("as contract file and command line state it")]
    contract: Annotated[Parties, about("as the contract file states them")]
    block: Annotated[AnalysedBlock, about("of the results")]
    results: Annotated[InputFile, about("the results that were assessed")]
    settings: Annotated[AnalysisSettings, about("of the results")]
    requirements: Annotated[tuple[JudgedRequirement, ...], about("those that apply to the product")]
    statements: Annotated[
        tuple[ChosenStatement, ...], about("how the standard's wording was chosen")
    ]
    quality_grade: Annotated[QualityGrade | None, about("`null` without scores")]
    accuracy: Annotated[Accuracy, about("what the check points say")]
    check_points: Annotated[tuple[JudgedPoint, ...], about("one per check point of the block")]
    warnings: Annotated[tuple[str, ...], about("of the results")] = ()
    notices: Annotated[tuple[Notice, ...], about("the warnings as codes and values")] = ()
    statement: Annotated[str, about("the standard's wording, or empty")] = ""
    attachments: Annotated[
        tuple[AttachedFile, ...], about("files inside the PDF, but for this one")
    ] = ()
    document_id: Annotated[
        str, about("from the SHA-256 of all else, but for what the versions say")
    ] = ""
