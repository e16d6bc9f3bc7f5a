"""Which angles to correct, in which form: rule sets are data, decisions say why."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from msgspec import Meta

from posstats.analysis.regression import (
    BLOCK_SCOPE,
    AngleRegression,
    ConstantFit,
    DriftFit,
)
from posstats.contract.choices import FitKind, Form, Scope
from posstats.contract.notice import Notice, Value
from posstats.errors import BlockFormatError, PosstatsError
from posstats.formats.hints import nearest
from posstats.formats.toml_document import open_toml
from posstats.formats.toml_types import Check, repeated
from posstats.statistics.holm import holm


class RuleFormatError(BlockFormatError):
    """A rule file that cannot be accepted; `findings` has one sentence per fault."""


@dataclass(frozen=True)
class RuleSet:
    """When an angle is corrected.

    Attributes
    ----------
    name, description
        For people.
    fit
        The fit that is tested, and whose values are subtracted.
    forms
        What may be subtracted: a constant, a line, or whichever nested tests prefer.
    alpha
        Level of the tests.
    holm
        Adjust the p-values of the angles of one scope (Holm 1979).
    min_r_squared
        Demanded of the line.
    min_parallax_gain
        Share of the mean y-parallax that the correction must save on images that took no part
        in the fit; 0 asks for no such proof.
    """

    fit: FitKind
    forms: Annotated[
        tuple[Literal["constant", "linear"], ...],
        Meta(min_length=1, description='a list of "constant", "linear"'),
        Check(repeated),
    ]
    alpha: Annotated[float, Meta(gt=0, lt=1, description="a number between 0 and 1")]
    name: Annotated[str, Meta(min_length=1)] = ""
    description: str = ""
    holm: bool = False
    min_r_squared: Annotated[float, Meta(ge=0, le=1, description="a number from 0 to 1")] = 0.0
    min_parallax_gain: Annotated[float, Meta(ge=0, lt=1, description="a share from 0 to 1")] = 0.0


@dataclass(frozen=True)
class Decision:
    """Whether and how one angle of one scope ("block" or a strip) is corrected, and why."""

    angle: str
    frame: str
    scope: str
    correct: bool
    form: Form
    fit: FitKind
    rule: str
    notices: tuple[Notice, ...] = ()


@dataclass(frozen=True)
class OutOfSampleParallax:
    """Mean RMS y-parallax over the same models, px, before and after correction; NaN if untestable.

    Attributes
    ----------
    n_models
        Models that could be tested.
    method
        How the images of the test were kept out of the fit, as a code.
    """

    raw_px: float
    corrected_px: float
    n_models: int
    method: str

    @property
    def gain(self) -> float:
        """Share of the mean parallax that the correction saves; NaN if untestable."""
        return 1.0 - self.corrected_px / self.raw_px


OutOfSampleTest = Callable[[Sequence[Decision]], OutOfSampleParallax]


def load_rules(name_or_path: str | Path) -> RuleSet:
    """A rule set that comes with posstats (``paper``, ``strict``), or a TOML file.

    Raises
    ------
    RuleFormatError
        For a file that is not TOML, an unknown or missing key, a value out of range.
    PosstatsError
        If there is no such rule set or file.
    """
    folder = files("posstats.analysis") / "rule_sets"
    known = sorted(Path(entry.name).stem for entry in folder.iterdir() if entry.name[0] != "_")
    name = str(name_or_path)
    if name in known:
        return _read_rules((folder / f"{name}.toml").read_bytes(), f"{name}.toml", name)
    path = Path(name_or_path)
    if not path.is_file():
        raise PosstatsError(
            f"no rule file {name}, and no rule set of that name{nearest(name, known)}"
        )
    return _read_rules(path.read_bytes(), path.name, path.stem)


def decide(
    regressions: Sequence[AngleRegression],
    rules: RuleSet,
    *,
    scope: Scope = "block",
    out_of_sample: OutOfSampleTest | None = None,
) -> tuple[Decision, ...]:
    """Decide for every angle of the block, or of every strip.

    Parameters
    ----------
    regressions
        Of one frame, from `regress`.
    scope
        Correct by one function of time for the block, or by one for every strip.
    out_of_sample
        Parallax on images that took no part in the fits, if the given decisions were applied
        (`posstats.analysis.out_of_sample` of the models). Needed by rules with
        `min_parallax_gain`.

    Raises
    ------
    PosstatsError
        If the rules need `out_of_sample` and it is not given.

    Notes
    -----
    Gains are judged step by step: the angle that saves most comes first, and every further
    angle must save its share of what the angles before it left.
    """
    if rules.min_parallax_gain > 0.0 and out_of_sample is None:
        raise PosstatsError(f"rules {rules.name!r} judge by parallax: they need the stereo models")
    wanted = [r for r in regressions if (r.scope == BLOCK_SCOPE) == (scope == "block")]
    decisions: list[Decision] = []
    for each in dict.fromkeys(regression.scope for regression in wanted):
        proposals = _proposals([r for r in wanted if r.scope == each], rules)
        if rules.min_parallax_gain > 0.0 and out_of_sample is not None:
            proposals = _proven(proposals, rules.min_parallax_gain, out_of_sample)
        decisions += proposals
    return tuple(decisions)


def chosen_fits(
    regression: AngleRegression, fit: FitKind
) -> tuple[DriftFit | None, ConstantFit | None]:
    """Line and constant of the kind of fit that a rule set uses."""
    if fit == "ols":
        return regression.ols, regression.ols_constant
    return regression.gls, regression.gls_constant


def _proposals(regressions: Sequence[AngleRegression], rules: RuleSet) -> list[Decision]:
    """Decisions by the tests alone, for the angles of one scope."""
    fits = [chosen_fits(regression, rules.fit) for regression in regressions]
    line_p = [None if line is None else line.f_pvalue for line, _ in fits]
    mean_p = [None if mean is None else mean.p_value for _, mean in fits]
    if rules.holm:
        line_p, mean_p = holm(line_p), holm(mean_p)
    return [
        _proposal(regression, rules, line, mean)
        for regression, line, mean in zip(regressions, line_p, mean_p, strict=True)
    ]


def _proposal(
    regression: AngleRegression, rules: RuleSet, line_p: float | None, mean_p: float | None
) -> Decision:
    line, mean = chosen_fits(regression, rules.fit)
    form: Form = "none"
    notices = [] if regression.notice is None else [_no_line(regression.notice)]
    if "linear" in rules.forms and line is not None and line_p is not None:
        significant = line_p < rules.alpha
        explains = line.rsquared >= rules.min_r_squared
        form = "linear" if significant and explains else form
        notices.append(_on_line(line, line_p, rules))
    if form == "none" and "constant" in rules.forms and mean is not None and mean_p is not None:
        form = "constant" if mean_p < rules.alpha else form
        notices.append(_on_constant(mean, mean_p, rules))
    if rules.fit == "gls" and not regression.covariance_known:
        notices.append(Notice(code="no_covariance"))
    return Decision(
        angle=regression.angle,
        frame=regression.frame,
        scope=regression.scope,
        correct=form != "none",
        form=form,
        fit=rules.fit,
        rule=rules.name,
        notices=tuple(notices),
    )


def _no_line(why: Notice) -> Notice:
    return Notice(code="no_line", values={"why": why.code, **why.values})


def _on_line(line: DriftFit, p_value: float, rules: RuleSet) -> Notice:
    values: dict[str, Value] = {
        "significance": _significance(p_value, rules),
        "slope_rad_per_s": line.slope,
        "slope_se_rad_per_s": line.slope_se,
        "p": p_value,
        "alpha": rules.alpha,
    }
    if rules.min_r_squared == 0.0:
        return Notice(code="drift", values=values)
    explains = line.rsquared >= rules.min_r_squared
    values |= {"r_squared": line.rsquared, "min_r_squared": rules.min_r_squared}
    return Notice(code="drift_explains" if explains else "drift_explains_little", values=values)


def _on_constant(mean: ConstantFit, p_value: float, rules: RuleSet) -> Notice:
    values: dict[str, Value] = {
        "significance": _significance(p_value, rules),
        "constant_rad": mean.value,
        "constant_se_rad": mean.se,
        "p": p_value,
    }
    return Notice(code="constant", values=values)


def _significance(p_value: float, rules: RuleSet) -> str:
    return "significant" if p_value < rules.alpha else "not_significant"


def _proven(
    proposals: list[Decision], min_gain: float, out_of_sample: OutOfSampleTest
) -> list[Decision]:
    """Keep the corrections that save parallax out of sample, the largest saving first."""
    waiting = [k for k, decision in enumerate(proposals) if decision.correct]
    kept: list[int] = []
    judged = dict(enumerate(proposals))
    while waiting:
        before, tries = _tried(proposals, kept, waiting, out_of_sample)
        gains = {k: 1.0 - after.corrected_px / before for k, after in tries.items()}
        best = max(waiting, key=lambda k: np.nan_to_num(gains[k], nan=-np.inf))
        if gains[best] >= min_gain:
            judged[best] = _with_gain(proposals[best], gains[best], min_gain, tries[best].method)
            kept.append(best)
            waiting.remove(best)
            continue
        for k in waiting:
            judged[k] = _with_gain(proposals[k], gains[k], min_gain, tries[k].method)
        break
    return [judged[k] for k in range(len(proposals))]


def _tried(
    proposals: list[Decision], kept: list[int], waiting: list[int], out_of_sample: OutOfSampleTest
) -> tuple[float, dict[int, OutOfSampleParallax]]:
    """Parallax with what is kept so far, and with each waiting correction added to it."""

    def only(wanted: list[int]) -> list[Decision]:
        return [
            decision if k in wanted else replace(decision, correct=False)
            for k, decision in enumerate(proposals)
        ]

    tries = {k: out_of_sample(only([*kept, k])) for k in waiting}
    before = out_of_sample(only(kept)).corrected_px
    return before, tries


def _with_gain(decision: Decision, gain: float, min_gain: float, method: str) -> Decision:
    if np.isnan(gain):
        untested = Notice(code="no_test_out_of_sample", values={"out_of_sample": method})
        notices = (*decision.notices, untested)
        return replace(decision, correct=False, form="none", notices=notices)
    tested = Notice(
        code="less_parallax_out_of_sample" if gain >= 0.0 else "more_parallax_out_of_sample",
        values={
            "change_share": abs(gain),
            "out_of_sample": method,
            "min_gain_share": min_gain,
        },
    )
    kept = gain >= min_gain
    form: Form = decision.form if kept else "none"
    return replace(decision, correct=kept, form=form, notices=(*decision.notices, tested))


def _read_rules(content: bytes, source: str, name: str) -> RuleSet:
    rules = open_toml(content, source).read_or_raise(RuleSet, RuleFormatError)
    return replace(rules, name=rules.name or name)
