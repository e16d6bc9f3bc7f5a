"""Assessment -> acceptance.json but for its words: plain values, described in docs/acceptance.md.

Lengths in metres, everything else in the unit of its quantity; what is not known is null.
"""

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from posstats.acceptance.accuracy_statement import (
    ISO_19157,
    AccuracyStatement,
    accuracy_statement,
)
from posstats.acceptance.assessment import Assessment, Finding
from posstats.acceptance.evidence import Evidence
from posstats.acceptance.profile import Contract, Profile
from posstats.acceptance.reasons import Reason
from posstats.contract.files import as_values
from posstats.contract.record import plain
from posstats.contract.results import Results
from posstats.contract.versions import versions
from posstats.version import __version__

Row = dict[str, Any]

SCHEMA = "posstats-acceptance/1"
_AXES = ("x", "y", "z")
_VERSIONS = ("posstats_version", "versions")


@dataclass(frozen=True)
class Occasion:
    """What an acceptance is besides its assessment.

    Attributes
    ----------
    orientation_reason
        Why this orientation was assessed.
    contract
        Parties and subject.
    language
        Of the document.
    created
        ISO 8601 time stamp; no clock is read here.
    results_sha256
        Of the bytes of results.json.
    """

    orientation_reason: Reason
    contract: Contract
    language: str
    created: str
    results_sha256: str


def acceptance_values(assessment: Assessment, results: Results, occasion: Occasion) -> Row:
    """The dictionary of acceptance.json, without the words of reasons and statement.

    Parameters
    ----------
    assessment
        Of an orientation that the results hold.
    results
        Of an analysis.
    occasion
        All else that the document says.
    """
    evidence = assessment.evidence
    parties = asdict(occasion.contract)
    del parties["product"]
    values: Row = plain(
        {
            "schema": SCHEMA,
            "posstats_version": __version__,
            "versions": versions(),
            "created": occasion.created,
            "language": occasion.language,
            "verdict": assessment.verdict,
            "orientation": evidence.orientation,
            "orientation_reason": asdict(occasion.orientation_reason),
            "profile": _profile(assessment.profile),
            "product": asdict(assessment.product),
            "contract": parties,
            "block": as_values(results.block),
            "results": {"file": "results.json", "sha256": occasion.results_sha256},
            "settings": as_values(results.settings),
            "requirements": [_requirement(each) for each in assessment.findings],
            "statements": [asdict(each) for each in assessment.statements],
            "quality_grade": None
            if assessment.grade is None
            else {"score": assessment.score, "grade": assessment.grade},
            "accuracy": _accuracy(accuracy_statement(evidence), evidence),
            "check_points": list(_check_points(assessment, results)),
            "warnings": results.warnings,
        }
    )
    return values


def document_id(values: Mapping[str, Any]) -> str:
    """Sixteen hexadecimal digits of the SHA-256 of what the document says, its versions apart."""
    said = {key: value for key, value in values.items() if key not in _VERSIONS}
    text = json.dumps(said, sort_keys=True, ensure_ascii=False)
    digest = hashlib.sha256(text.encode("utf-8")).hexdigest()[:16].upper()
    return "PA-" + "-".join(digest[k : k + 4] for k in range(0, 16, 4))


def _profile(profile: Profile) -> Row:
    return {
        "name": profile.name,
        "edition": profile.edition,
        "title": profile.title,
        "source": profile.source,
        "files": [{"file": each.name, "sha256": each.sha256} for each in profile.files],
        "notes": profile.notes,
        "changed": profile.changed,
        "added": profile.added,
        "omitted": profile.omitted,
    }


def _requirement(finding: Finding) -> Row:
    requirement = finding.requirement
    return {
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
        "reason_values": dict(finding.reason.values),
        "low": finding.low,
        "high": finding.high,
        "n_to_decide": finding.n_to_decide,
        "score": finding.score,
    }


def _accuracy(found: AccuracyStatement, evidence: Evidence) -> Row:
    survey_h, survey_v = (_rms(each) for each in (evidence.survey_h_m, evidence.survey_v_m))
    return {
        "n": len(evidence),
        "n_given": evidence.n_given,
        "survey_known": bool(np.isfinite([survey_h, survey_v]).all()),
        "survey_h_m": survey_h,
        "survey_v_m": survey_v,
        "rmse": list(_rmse(found, survey_h, survey_v)),
        "mean_error": [
            {"component": axis, "iso_19157": ISO_19157["bias"],
             "value_m": each.mean, "se_m": each.se, "p": each.p, "reason": each.reason}
            for axis, each in zip(_AXES, found.component_shift, strict=True)
        ],
        "percentiles": [
            {"name": each.name, "iso_19157": ISO_19157[each.name],
             "value_m": each.sample.value, "low_m": each.sample.low, "high_m": each.sample.high,
             "normal_m": each.normal_m, "n_for_high": each.sample.n_for_high}
            for each in found.percentiles
        ],
        "covariance_iso_19157": ISO_19157["covariance"],
        "covariance_m2": found.covariance_m2,
        "mean_shift": asdict(found.shift),
        "normality": [
            {"component": axis, "w": each.w, "p": each.p, "reason": each.reason}
            for axis, each in zip(_AXES, found.normality, strict=True)
        ],
        "largest_residual": list(_largest(found, evidence.point)),
    }  # fmt: skip


def _rms(values: np.ndarray[Any, np.dtype[np.float64]]) -> float:
    """Root mean square; NaN without values or where one is not known."""
    return float(np.sqrt(np.mean(values**2))) if len(values) else float("nan")


def _rmse(found: AccuracyStatement, survey_h: float, survey_v: float) -> Iterator[Row]:
    survey = {"h": survey_h, "v": survey_v, "3d": float(np.hypot(survey_h, survey_v))}
    measure = {"h": ISO_19157["rmse_planimetry"]}
    for name, interval in found.rmse.items():
        product = None
        if name in survey and interval.rmse is not None:
            product = float(np.hypot(interval.rmse, survey[name]))
        yield {
            "component": name,
            "iso_19157": None if name == "3d" else measure.get(name, ISO_19157["rmse"]),
            "value_m": interval.rmse,
            "low_m": interval.low,
            "high_m": interval.high,
            "df": interval.df,
            "product_m": product,
        }


def _largest(found: AccuracyStatement, point: Sequence[str]) -> Iterator[Row]:
    for axis, each in zip(_AXES, found.largest, strict=True):
        yield {
            "component": axis,
            "point": None if each.point is None else point[each.point],
            "value_m": each.residual,
            "p": each.p_holm,
            "reason": each.reason,
        }


def _check_points(assessment: Assessment, results: Results) -> Iterator[Row]:
    """Every check point of the orientation, intersected or not."""
    beyond = {
        each.requirement.quantity: each.threshold
        for each in assessment.findings
        if each.threshold is not None
    }
    for row in as_values(results.check_point_residuals):
        if row["orientation"] != assessment.evidence.orientation:
            continue
        known = row["status"] == "ok"
        dh = float(np.hypot(row["dx_m"], row["dy_m"])) if known else None
        sizes = {"n_blunders_h": dh, "n_blunders_v": abs(row["dz_m"]) if known else None}
        copied = {key: value for key, value in row.items() if key != "orientation"}
        yield copied | {
            "dh_m": dh,
            "blunder": any(
                size is not None and name in beyond and size > beyond[name]
                for name, size in sizes.items()
            ),
        }
