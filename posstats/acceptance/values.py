"""Assessment -> `Acceptance`, but for its words and what the document embeds."""

import hashlib
import json
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass

import numpy as np

from posstats.acceptance.accuracy_statement import (
    ISO_19157,
    AccuracyStatement,
    accuracy_statement,
)
from posstats.acceptance.assessment import Assessment, Finding
from posstats.acceptance.evidence import Evidence
from posstats.acceptance.profile import Contract, Profile
from posstats.arrays import Floats
from posstats.contract.acceptance import (
    Acceptance,
    Accuracy,
    Axis,
    JudgedPoint,
    JudgedRequirement,
    LargestResidual,
    MeanError,
    MeanShift,
    Normality,
    Parties,
    PercentileError,
    QualityGrade,
    Rmse,
    StatedProduct,
    UsedProfile,
)
from posstats.contract.check_points import CheckPointResidual
from posstats.contract.choices import Language
from posstats.contract.files import as_values
from posstats.contract.notice import Notice
from posstats.contract.record import plain, record
from posstats.contract.results import Results
from posstats.contract.survey import InputFile
from posstats.contract.versions import versions
from posstats.version import __version__

_AXES: tuple[Axis, ...] = ("x", "y", "z")
_APART = ("document_id", "posstats_version", "versions")


@dataclass(frozen=True)
class Occasion:
    """What an acceptance is besides its assessment.

    Attributes
    ----------
    orientation_reason
        Why this orientation was assessed: its name, or `asked`.
    contract
        Parties and subject.
    language
        Of the document.
    created
        ISO 8601 time stamp; no clock is read here.
    results_sha256
        Of the bytes of results.json.
    """

    orientation_reason: Notice
    contract: Contract
    language: Language
    created: str
    results_sha256: str


def acceptance_values(assessment: Assessment, results: Results, occasion: Occasion) -> Acceptance:
    """The acceptance, without the words of reasons and statement.

    Parameters
    ----------
    assessment
        Of an orientation that the results hold.
    occasion
        All else that the document says.
    """
    evidence = assessment.evidence
    parties = asdict(occasion.contract)
    del parties["product"]
    return Acceptance(
        posstats_version=__version__,
        versions=versions(),
        created=occasion.created,
        language=occasion.language,
        verdict=assessment.verdict,
        orientation=evidence.orientation,
        orientation_reason=occasion.orientation_reason,
        profile=_profile(assessment.profile),
        product=record(StatedProduct, asdict(assessment.product)),
        contract=record(Parties, parties),
        block=results.block,
        results=InputFile(file="results.json", sha256=occasion.results_sha256),
        settings=results.settings,
        requirements=tuple(_requirement(each) for each in assessment.findings),
        statements=assessment.statements,
        quality_grade=None
        if assessment.grade is None
        else QualityGrade(score=assessment.score, grade=assessment.grade),
        accuracy=_accuracy(accuracy_statement(evidence), evidence),
        check_points=tuple(_check_points(assessment, results)),
        warnings=results.warnings,
        notices=results.notices,
    )


def document_id(acceptance: Acceptance) -> str:
    """Sixteen hexadecimal digits of the SHA-256 of what the document says, its versions apart."""
    said = {key: value for key, value in as_values(acceptance).items() if key not in _APART}
    text = json.dumps(said, sort_keys=True, ensure_ascii=False)
    digest = hashlib.sha256(text.encode("utf-8")).hexdigest()[:16].upper()
    return "PA-" + "-".join(digest[k : k + 4] for k in range(0, 16, 4))


def _profile(profile: Profile) -> UsedProfile:
    return UsedProfile(
        name=profile.name,
        edition=profile.edition,
        title=profile.title,
        source=profile.source,
        files=tuple(InputFile(file=each.name, sha256=each.sha256) for each in profile.files),
        notes=profile.notes,
        changed=profile.changed,
        added=profile.added,
        omitted=profile.omitted,
    )


def _requirement(finding: Finding) -> JudgedRequirement:
    requirement = finding.requirement
    values = {
        "id": requirement.id,
        "clause": requirement.clause,
        "quantity": requirement.quantity,
        "source": requirement.source,
        "mandatory": requirement.mandatory,
        "exceeding": requirement.exceeding,
        "threshold": finding.threshold,
        "found": finding.found,
        "limit": finding.limit,
        "limit_formula": requirement.limit.text,
        "unit": requirement.measured.unit,
        "margin": finding.margin,
        "verdict": finding.judgement,
        "reason_code": finding.reason.code,
        "reason_values": finding.reason.values,
        "low": finding.low,
        "high": finding.high,
        "n_to_decide": finding.n_to_decide,
        "score": finding.score,
    }
    return record(JudgedRequirement, values)


def _accuracy(found: AccuracyStatement, evidence: Evidence) -> Accuracy:
    survey_h, survey_v = (_rms(each) for each in (evidence.survey_h_m, evidence.survey_v_m))
    return Accuracy(
        n=len(evidence),
        n_given=evidence.n_given,
        survey_known=bool(np.isfinite([survey_h, survey_v]).all()),
        survey_h_m=plain(survey_h),
        survey_v_m=plain(survey_v),
        rmse=_rmse(found, survey_h, survey_v),
        mean_error=_mean_errors(found),
        percentiles=_percentiles(found),
        covariance_iso_19157=ISO_19157["covariance"],
        covariance_m2=tuple(map(tuple, plain(found.covariance_m2))),
        mean_shift=record(MeanShift, asdict(found.shift)),
        normality=_normality(found),
        largest_residual=_largest(found, evidence.point),
    )


def _rms(values: Floats) -> float:
    """Root mean square; NaN without values or where one is not known."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")


def _rmse(found: AccuracyStatement, survey_h: float, survey_v: float) -> tuple[Rmse, ...]:
    survey = {"h": survey_h, "v": survey_v, "3d": float(np.hypot(survey_h, survey_v))}
    measure = {"h": ISO_19157["rmse_planimetry"], "3d": None}
    return tuple(
        record(
            Rmse,
            {
                "component": name,
                "iso_19157": measure.get(name, ISO_19157["rmse"]),
                "value_m": interval.rmse,
                "low_m": interval.low,
                "high_m": interval.high,
                "df": interval.df,
                "product_m": _product_m(interval.rmse, survey.get(name)),
            },
        )
        for name, interval in found.rmse.items()
    )


def _product_m(rmse_m: float | None, survey_m: float | None) -> float | None:
    if rmse_m is None or survey_m is None:
        return None
    return float(np.hypot(rmse_m, survey_m))


def _mean_errors(found: AccuracyStatement) -> tuple[MeanError, ...]:
    return tuple(
        MeanError(
            component=axis,
            iso_19157=ISO_19157["bias"],
            value_m=each.mean,
            se_m=each.se,
            p=each.p,
            reason=each.reason,
        )
        for axis, each in zip(_AXES, found.component_shift, strict=True)
    )


def _percentiles(found: AccuracyStatement) -> tuple[PercentileError, ...]:
    return tuple(
        record(
            PercentileError,
            {
                "name": each.name,
                "iso_19157": ISO_19157[each.name],
                "value_m": each.sample.value,
                "low_m": each.sample.low,
                "high_m": each.sample.high,
                "normal_m": each.normal_m,
                "n_for_high": each.sample.n_for_high,
            },
        )
        for each in found.percentiles
    )


def _normality(found: AccuracyStatement) -> tuple[Normality, ...]:
    return tuple(
        Normality(component=axis, w=each.w, p=each.p, reason=each.reason)
        for axis, each in zip(_AXES, found.normality, strict=True)
    )


def _largest(found: AccuracyStatement, point: Sequence[str]) -> tuple[LargestResidual, ...]:
    return tuple(
        LargestResidual(
            component=axis,
            point=None if each.point is None else point[each.point],
            value_m=each.residual,
            p=each.p_holm,
            reason=each.reason,
        )
        for axis, each in zip(_AXES, found.largest, strict=True)
    )


def _check_points(assessment: Assessment, results: Results) -> Iterator[JudgedPoint]:
    """Every check point of the orientation, intersected or not."""
    beyond_m = {
        each.requirement.quantity: each.threshold
        for each in assessment.findings
        if each.threshold is not None
    }
    for row in results.check_point_residuals:
        if row.orientation == assessment.evidence.orientation:
            yield _check_point(row, beyond_m)


def _check_point(row: CheckPointResidual, beyond_m: dict[str, float]) -> JudgedPoint:
    dh_m = dv_m = None
    if row.status == "ok" and row.dx_m is not None and row.dy_m is not None:
        dh_m = float(np.hypot(row.dx_m, row.dy_m))
        dv_m = None if row.dz_m is None else abs(row.dz_m)
    sizes = {"n_blunders_h": dh_m, "n_blunders_v": dv_m}
    values = asdict(row)
    del values["orientation"]
    return JudgedPoint(
        **values,
        dh_m=dh_m,
        blunder=any(
            size is not None and name in beyond_m and size > beyond_m[name]
            for name, size in sizes.items()
        ),
    )
