"""Rule sets as data, and decisions with their reasons."""

from dataclasses import dataclass, replace

import numpy as np
import pytest
from finding_parts import assert_finding
from statsmodels.stats.multitest import multipletests

from posstats.analysis.angle_errors import AngleErrors
from posstats.analysis.out_of_sample import LEAVE_STRIP_OUT
from posstats.analysis.regression import regress
from posstats.analysis.rules import RuleFormatError, decide, load_rules
from posstats.contract.notice import Notice
from posstats.errors import BlockFormatError, PosstatsError

N_STRIPS, PER_STRIP = 5, 20


def angle_errors(constant=(0, 0, 0), drift=(0, 0, 0), noise=1e-5, seed=1, known=True):
    rng = np.random.default_rng(seed)
    n = N_STRIPS * PER_STRIP
    strip = np.repeat([f"s{k}" for k in range(N_STRIPS)], PER_STRIP).astype(object)
    time = np.arange(n) * 15.0 + np.repeat(np.arange(N_STRIPS), PER_STRIP) * 300.0
    covariance = np.zeros((n, 3, n, 3))
    for axis in range(3):
        covariance[:, axis, :, axis] = noise**2 * np.eye(n)
    return AngleErrors(
        frame="ground",
        source="coplanarity" if known else "adjusted",
        image=np.arange(n).astype(str).astype(object),
        strip=strip,
        time_s=time,
        error_rad=np.array(constant) + np.outer(time, drift) + noise * rng.standard_normal((n, 3)),
        covariance_rad2=covariance if known else None,
        used=np.full(n, True),
    )


@dataclass
class FakeParallax:
    raw_px: float
    corrected_px: float
    method: str = LEAVE_STRIP_OUT


def saving(shares):
    """Parallax of 10 px, of which every corrected angle saves its share of the rest."""

    def out_of_sample(decisions):
        left = 10.0
        for decision in decisions:
            left *= 1.0 - shares.get(decision.angle, 0.0) * decision.correct
        return FakeParallax(10.0, left)

    return out_of_sample


def codes(decision):
    return [each.code for each in decision.notices]


def forms(decisions):
    return [decision.form for decision in decisions]


def test_paper_corrects_a_clear_line_only():
    regressions = regress(angle_errors(constant=(0, 1e-3, 0), drift=(5e-7, 0, 1e-9)))
    decisions = decide(regressions, load_rules("paper"))
    assert forms(decisions) == ["linear", "none", "none"]
    assert [d.angle for d in decisions] == ["omega", "phi", "kappa"]
    assert decisions[0].correct
    assert [codes(each) for each in decisions] == [
        ["drift_explains"], ["drift_explains_little"], ["drift_explains_little"]
    ]  # fmt: skip
    (drift,) = decisions[0].notices
    line = regressions[0].ols
    assert drift.values == {
        "significance": "significant", "slope_rad_per_s": line.slope,
        "slope_se_rad_per_s": line.slope_se, "p": line.f_pvalue, "alpha": 0.05,
        "r_squared": line.rsquared, "min_r_squared": 0.8,
    }  # fmt: skip
    assert decisions[1].notices[0].values["significance"] == "not_significant"


def test_paper_wants_both_significance_and_fit():
    regressions = regress(angle_errors(drift=(1e-8, 0, 0)))
    assert regressions[0].ols.f_pvalue < 0.05
    assert regressions[0].ols.rsquared < 0.8
    assert not decide(regressions, load_rules("paper"))[0].correct


def test_strict_takes_line_or_constant_by_nested_tests():
    regressions = regress(angle_errors(constant=(0, 1e-3, 0), drift=(5e-7, 0, 0)))
    decisions = decide(
        regressions, load_rules("strict"), out_of_sample=saving({"omega": 0.5, "phi": 0.5})
    )
    assert forms(decisions) == ["linear", "constant", "none"]
    assert codes(decisions[0]) == ["drift", "less_parallax_out_of_sample"]
    assert codes(decisions[1]) == ["drift", "constant", "less_parallax_out_of_sample"]
    tested = decisions[0].notices[1].values
    assert tested["change_share"] == pytest.approx(0.5)
    assert (tested["out_of_sample"], tested["min_gain_share"]) == (LEAVE_STRIP_OUT, 0.05)
    assert {d.fit for d in decisions} == {"gls"}


def test_strict_refuses_what_saves_less_than_five_per_cent():
    regressions = regress(angle_errors(constant=(0, 1e-3, 0), drift=(5e-7, 0, 0)))
    decisions = decide(
        regressions, load_rules("strict"), out_of_sample=saving({"omega": 0.04, "phi": -0.2})
    )
    assert forms(decisions) == ["none", "none", "none"]
    less, more = (each.notices[-1] for each in decisions[:2])
    assert (less.code, more.code) == ("less_parallax_out_of_sample", "more_parallax_out_of_sample")
    assert less.values["change_share"] == pytest.approx(0.04)
    assert more.values["change_share"] == pytest.approx(0.2)


def test_strict_judges_a_small_angle_after_the_large_one():
    """Phi saves nothing visible while omega's error hides it, and half of what omega leaves."""

    def quadrature(decisions):
        parts = {"omega": 10.0, "phi": 1.0}
        left = [parts.get(d.angle, 0.0) * (not d.correct) for d in decisions]
        return FakeParallax(np.hypot(10.0, 1.0), float(np.hypot(np.linalg.norm(left), 0.5)))

    regressions = regress(angle_errors(constant=(0, 1e-3, 0), drift=(5e-7, 0, 0)))
    decisions = decide(regressions, load_rules("strict"), out_of_sample=quadrature)
    assert forms(decisions) == ["linear", "constant", "none"]


def test_strict_says_when_nothing_can_be_tested():
    def untestable(decisions):
        return FakeParallax(np.nan, np.nan)

    regressions = regress(angle_errors(drift=(5e-7, 0, 0)))
    first = decide(regressions, load_rules("strict"), out_of_sample=untestable)[0]
    assert not first.correct
    assert codes(first)[-1] == "no_test_out_of_sample"


def test_strict_needs_the_models():
    with pytest.raises(PosstatsError, match="stereo models"):
        decide(regress(angle_errors()), load_rules("strict"))


def test_errors_without_covariance_are_judged_by_their_scatter():
    regressions = regress(angle_errors(drift=(5e-7, 0, 0), known=False))
    assert not regressions[0].covariance_known
    first = decide(regressions, load_rules("strict"), out_of_sample=saving({"omega": 0.5}))[0]
    assert first.form == "linear"
    assert "no_covariance" in codes(first)


def test_holm_makes_a_weak_finding_insignificant():
    errors = angle_errors()
    rules = replace(load_rules("strict"), min_parallax_gain=0.0, forms=("linear",))
    regressions = regress(errors)
    lowest = min(r.gls.f_pvalue for r in regressions if r.scope == "block")
    level = replace(rules, alpha=1.5 * lowest)
    assert not any(d.correct for d in decide(regressions, level))
    assert any(d.correct for d in decide(regressions, replace(level, holm=False)))


def chance(block, p_values):
    return [
        replace(r, gls=replace(r.gls, f_pvalue=p)) for r, p in zip(block, p_values, strict=True)
    ]


def test_holm_decides_as_statsmodels_does():
    rules = replace(load_rules("strict"), min_parallax_gain=0.0, forms=("linear",))
    block = [r for r in regress(angle_errors()) if r.scope == "block"]
    for p_values in np.random.default_rng(1).uniform(size=(10, 3)) ** 3:
        rejected, *_ = multipletests(p_values, alpha=0.05, method="holm")
        decisions = decide(chance(block, p_values), rules)
        assert [d.correct for d in decisions] == list(rejected)


def test_holm_keeps_the_level_over_three_angles():
    """Oracle: without any drift p is uniform, and 5 % of three-angle blocks may show one."""
    rules = replace(load_rules("strict"), min_parallax_gain=0.0, forms=("linear",))
    block = [r for r in regress(angle_errors()) if r.scope == "block"]
    false, false_plain = 0, 0
    for p_values in np.random.default_rng(1).uniform(size=(400, 3)):
        by_chance = chance(block, p_values)
        false += any(d.correct for d in decide(by_chance, rules))
        false_plain += any(d.correct for d in decide(by_chance, replace(rules, holm=False)))
    assert 7 <= false <= 34  # binomial(400, 0.05) in all but 0.2 % of the cases
    assert 38 <= false_plain <= 78  # binomial(400, 1 - 0.95^3)


def test_strip_scope_decides_every_strip_by_itself():
    errors = angle_errors()
    second = errors.strip == "s1"
    shifted = errors.error_rad + np.outer(second * errors.time_s, [1e-5, 0, 0])
    regressions = regress(replace(errors, error_rad=shifted))
    decisions = decide(regressions, load_rules("paper"), scope="strip")
    assert len(decisions) == 3 * N_STRIPS
    assert [(d.scope, d.angle) for d in decisions if d.correct] == [("s1", "omega")]


def test_unused_images_take_no_part():
    errors = angle_errors(drift=(5e-7, 0, 0))
    used = np.arange(len(errors)) % 2 == 0
    spoilt = np.where(used[:, None], errors.error_rad, np.nan)
    block = regress(replace(errors, error_rad=spoilt, used=used))[0]
    assert block.n == used.sum()
    assert block.gls.slope == pytest.approx(5e-7, rel=0.05)


def test_short_strips_have_a_reason_instead_of_a_line():
    errors = angle_errors(constant=(1e-3, 0, 0))
    used = (errors.strip != "s0") | (np.arange(len(errors)) < 2)
    short = next(r for r in regress(replace(errors, used=used)) if r.scope == "s0")
    assert short.n == 2
    assert short.ols is None
    assert short.gls is None
    assert short.gls_constant.value == pytest.approx(1e-3, rel=0.1)
    assert short.notice == Notice(code="too_few_images", values={"n": 2, "n_needed": 3})
    decision = decide([short], load_rules("paper"), scope="strip")[0]
    assert not decision.correct
    assert codes(decision) == ["no_line"]
    assert decision.notices[0].values == {"why": "too_few_images", "n": 2, "n_needed": 3}


def test_covariance_that_cannot_be_used_leaves_ols_and_a_reason():
    errors = angle_errors(drift=(5e-7, 0, 0))
    block = regress(replace(errors, covariance_rad2=-errors.covariance_rad2))[0]
    assert block.ols.slope == pytest.approx(5e-7, rel=0.05)
    assert block.gls is None
    assert block.gls_constant is None
    assert block.notice == Notice(code="indefinite_covariance")


def test_no_image_used_at_all():
    errors = angle_errors()
    regressions = regress(replace(errors, used=np.full(len(errors), False)))
    assert {r.n for r in regressions} == {0}
    assert not any(d.correct for d in decide(regressions, load_rules("paper")))


GOOD = 'fit = "ols"\nforms = ["linear"]\nalpha = 0.05\n'


def test_rules_from_a_file(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(GOOD + "min_r_squared = 0.5\n")
    rules = load_rules(path)
    assert (rules.name, rules.fit, rules.forms) == ("mine", "ols", ("linear",))
    assert (rules.alpha, rules.min_r_squared, rules.holm) == (0.05, 0.5, False)


@pytest.mark.parametrize(
    ("text", "where", "found", "expected"),
    [
        (
            GOOD + "min_rsquared = 0.8",
            "mine.toml:4, min_rsquared",
            "an unknown key",
            "min_r_squared?",
        ),
        (
            GOOD.replace("0.05", "5"),
            "mine.toml:3, alpha",
            "5",
            "a number between 0",
        ),
        (GOOD.replace("0.05", "true"), "mine.toml:3, alpha", "True", "a number between 0"),
        (GOOD.replace("0.05", "nan"), "mine.toml:3, alpha", "nan", "a number between 0"),
        (GOOD.replace('"ols"', '"wls"'), "mine.toml:1, fit", "'wls'", "ols or gls;"),
        (GOOD.replace('"ols"', "[1]"), "mine.toml:1, fit", "[1]", "ols or gls"),
        (
            GOOD.replace('["linear"]', '["quadratic"]'),
            "mine.toml:2, forms",
            "['quadratic']",
            "a list of",
        ),
        (GOOD.replace('["linear"]', "[]"), "mine.toml:2, forms", "[]", "a list of"),
        (GOOD.replace('["linear"]', '"linear"'), "mine.toml:2, forms", "'linear'", "a list of"),
        (
            GOOD.replace('["linear"]', '["linear", "linear"]'),
            "mine.toml:2, forms",
            "'linear' twice",
            "each once",
        ),
        (GOOD + 'holm = "yes"', "mine.toml:4, holm", "'yes'", "true or false"),
        (GOOD + "min_parallax_gain = 5", "mine.toml:4, min_parallax_gain", "5", "a share from 0"),
        (GOOD + "name = 3", "mine.toml:4, name", "3", "text in quotes"),
        ("", "mine.toml, fit", "nothing", "ols or gls"),
        ("fit = ", "mine.toml", "no valid TOML:", ""),
    ],
)
def test_bad_rule_files_are_named_with_their_fault(tmp_path, text, where, found, expected):
    path = tmp_path / "mine.toml"
    path.write_text(text)
    with pytest.raises(RuleFormatError) as caught:
        load_rules(path)
    assert_finding(caught.value.findings[0], where, found, expected)
    assert isinstance(caught.value, BlockFormatError)


def test_rule_file_that_is_not_text(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(RuleFormatError, match=r"mine\.toml:1: .* not UTF-8"):
        load_rules(path)


def test_all_faults_are_listed(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text('fit = "x"\nforms = 1\nalfa = 2\n')
    with pytest.raises(RuleFormatError) as caught:
        load_rules(path)
    assert len(caught.value.findings) == 4


def test_unknown_rule_set_names_the_nearest(tmp_path):
    with pytest.raises(PosstatsError, match="expected strict"):
        load_rules("strickt")
    with pytest.raises(PosstatsError, match="no rule file"):
        load_rules(tmp_path)
