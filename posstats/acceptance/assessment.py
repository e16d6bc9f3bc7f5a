"""Requirements held against the evidence: what passes, what fails, what nobody can tell.

A verdict follows the point estimates, as the standards want it. The 95 % intervals stand beside
them, and where an interval holds the limit, the number of check points that would decide.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from posstats.acceptance.evidence import Evidence
from posstats.acceptance.formula import MissingProductValue
from posstats.acceptance.product import Product
from posstats.acceptance.profile import Profile, Requirement
from posstats.acceptance.published import gbt_grade, gbt_score
from posstats.acceptance.quantities import Found, Question, find
from posstats.acceptance.reasons import Reason, Unavailable
from posstats.contract.acceptance import (
    ChosenStatement,
    Grade,
    Judgement,
    StatedComponent,
    StatementKind,
    Verdict,
)
from posstats.errors import PosstatsError
from posstats.statistics.rmse import n_to_decide

_CLASS = {"horizontal": "class_h", "vertical": "class_v"}


@dataclass(frozen=True)
class Finding:
    """A requirement and what was found of it.

    Attributes
    ----------
    found, limit, threshold
        In the unit of the quantity; None where there is none.
    low, high
        95 % interval of what was found; None where none is known.
    margin
        What is left to the limit, negative beyond it; None without found or limit.
    n_to_decide
        Check points with which an unchanged value would have the limit outside its interval; None
        where the interval leaves it out already, or no number that can be surveyed would do.
    score
        Of GB/T 24356, where the requirement is a basis of one and is met.
    """

    requirement: Requirement
    judgement: Judgement
    reason: Reason
    found: float | None = None
    limit: float | None = None
    threshold: float | None = None
    low: float | None = None
    high: float | None = None
    margin: float | None = None
    n_to_decide: int | None = None
    score: float | None = None


@dataclass(frozen=True)
class Assessment:
    """The verdict on one orientation.

    Attributes
    ----------
    findings
        One per requirement that applies to the product, in the profile's order.
    statements
        What the standard has said of the product; none where what it claims was not found.
    score, grade
        Of GB/T 24356: the smallest of the scores, None if a basis is not met, and its grade; None
        without a basis, or where one could not be assessed.
    """

    profile: Profile
    product: Product
    evidence: Evidence
    findings: tuple[Finding, ...]
    verdict: Verdict
    score: float | None
    grade: Grade | None
    statements: tuple[ChosenStatement, ...] = ()


def assess(
    evidence: Evidence, profile: Profile, product: Product, language: str = "en"
) -> Assessment:
    """Hold the evidence against a profile.

    Parameters
    ----------
    language
        Of the standard's statement, where it has one in that language.

    Raises
    ------
    PosstatsError
        If the product does not state what the profile needs, or is outside its range.
    """
    faults = profile.product_findings(product)
    if faults:
        raise PosstatsError("; ".join(faults))
    requirements = profile.requirements_for(product)
    findings = tuple(_finding(each, Question(evidence, product)) for each in requirements)
    score, grade = _quality(findings)
    assessed = Assessment(
        profile=profile,
        product=product,
        evidence=evidence,
        findings=findings,
        verdict=verdict(findings),
        score=score,
        grade=grade,
    )
    return replace(assessed, statements=_statements(assessed, language))


def _quality(findings: Sequence[Finding]) -> tuple[float | None, Grade | None]:
    """The smallest score and its grade: a quality is as good as its worst part."""
    bases = [each for each in findings if each.requirement.basis_of_score]
    if not bases or any(each.found is None for each in bases):
        return None, None
    reached = [each.score for each in bases if each.score is not None]
    score = min(reached) if len(reached) == len(bases) else None
    return score, gbt_grade(score)


def verdict(findings: Sequence[Finding]) -> Verdict:
    """Rejected if one fails, else not assessable if a mandatory one was not assessed."""
    if any(each.judgement == "fail" for each in findings):
        return "rejected"
    open_ones = [each for each in findings if each.judgement == "not assessed"]
    if not findings or any(each.requirement.mandatory for each in open_ones):
        return "not assessable"
    return "accepted"


def _finding(requirement: Requirement, question: Question) -> Finding:
    product = question.product
    try:
        limit = requirement.limit.evaluate(product)
        threshold = None
        if requirement.threshold is not None:
            threshold = requirement.threshold.evaluate(product)
    except MissingProductValue as missing:
        reason = Reason(code="product value missing", values={"name": missing.name})
        return Finding(requirement, "not assessed", reason)
    try:
        found = find(requirement.quantity, Question(question.evidence, product, threshold))
    except Unavailable as unavailable:
        return Finding(
            requirement, "not assessed", unavailable.reason, limit=limit, threshold=threshold
        )
    return _judged(requirement, found, limit, threshold)


def _judged(
    requirement: Requirement, found: Found, limit: float, threshold: float | None
) -> Finding:
    at_most = requirement.measured.sense == "at most"
    kept = found.value <= limit if at_most else found.value >= limit
    code, judgement = _words(kept, requirement)
    return Finding(
        requirement=requirement,
        judgement=judgement,
        reason=Reason(code=code, values={"found": found.value, "limit": limit}),
        found=found.value,
        limit=limit,
        threshold=threshold,
        low=_known(found.low),
        high=_known(found.high),
        margin=limit - found.value if at_most else found.value - limit,
        n_to_decide=_deciding_number(found, limit),
        score=gbt_score(found.value, limit) if requirement.basis_of_score else None,
    )


def _words(kept: bool, requirement: Requirement) -> tuple[str, Judgement]:
    if kept:
        return "within", "pass"
    if requirement.exceeding == "investigate":
        return "investigate", "not assessed"
    return "exceeds", "fail"


def _known(value: float) -> float | None:
    return None if value != value else value


def _deciding_number(found: Found, limit: float) -> int | None:
    """Of the fit alone, against what the survey leaves of the limit."""
    if found.df_per_point is None or not found.low < limit < found.high:
        return None
    if limit <= found.survey_m:
        return None
    fit, left = (math.sqrt(each**2 - found.survey_m**2) for each in (found.value, limit))
    return n_to_decide(fit, left, found.df_per_point)


def _statements(assessed: Assessment, language: str) -> tuple[ChosenStatement, ...]:
    components: tuple[StatedComponent, ...] = ("horizontal", "vertical")
    chosen = (_statement(assessed, each, language) for each in components)
    return tuple(each for each in chosen if each is not None)


def _statement(
    assessed: Assessment, component: StatedComponent, language: str
) -> ChosenStatement | None:
    """What the standard has said of a component; nothing where a claim of it was not found.

    Nor of a product that is rejected: the words would be read without the verdict.
    """
    if assessed.verdict == "rejected":
        return None
    wording = assessed.profile.statement(component, language)
    by_id = {each.requirement.id: each for each in assessed.findings}
    if wording is None or not all(name in by_id for name in wording.rests_on):
        return None
    n, claims = len(assessed.evidence), [by_id[name] for name in wording.rests_on]
    kind: StatementKind = "produced"
    if n > 0:
        if any(each.judgement != "pass" for each in claims):
            return None
        kind = "tested" if n >= wording.least_points else "tested_with_fewer"
    template: str = getattr(wording, kind)
    if not template:
        return None
    return ChosenStatement(
        component=component,
        kind=kind,
        template=template,
        class_m=assessed.product.value(_CLASS[component]),
        found_m=claims[0].found,
        n_points=n,
    )
