"""Words of the adjustment's report: every code, name and kind has its own in both languages."""

import ast
import re
import string
from typing import get_args

import pytest
from helpers import ROOT

from posstats.adjustment import undetermined
from posstats.contract.adjustment import DroppedParameter, Group, Observed
from posstats.contract.notice import Notice
from posstats.numerics.bundle.parameters import UNITS
from posstats.reports.adjustment.words import words_in
from posstats.reports.document.catalogue import catalogue
from posstats.settings import DriftScope, NamedControl, SelfCalibration

LANGUAGES = ("en", "zh")
CODE = ROOT / "posstats" / "adjustment"
REPORT = ROOT / "reports" / "adjustment"
FAMILIES = {
    "group": get_args(Group),
    "weight": get_args(Observed)[:1] + get_args(Observed)[2:],
    "kind": get_args(Observed),
    "named": get_args(Observed),
    "several": get_args(Observed)[1:],
    "drift": get_args(DriftScope),
    "self_calibration": get_args(SelfCalibration),
    "control_choice": get_args(NamedControl),
    "dropped": ("singular", "not determined", "not significant"),
}


def texts_of(path):
    """Texts in a module that are no docstrings, and beginnings of those that are put together."""
    tree = ast.parse(path.read_text(encoding="utf-8"))
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def codes():
    """Codes of notices, as the modules of the adjustment spell them."""
    texts = [text for path in CODE.glob("*.py") for text in texts_of(path)]
    named = set(re.findall(r'Notice\(\s*code="(\w+)"', "".join(
        path.read_text(encoding="utf-8") for path in CODE.glob("*.py")
    )))  # fmt: skip
    rules = set(texts) & {name.removeprefix("notice.open_") for name in of_notices("open_")}
    return named | {f"systematic_{kind}" for kind in ("gnss", "imu")} | {
        f"{what}_{rule}" for rule in rules for what in ("open", "helps")
    }  # fmt: skip


def of_notices(beginning):
    own = catalogue("en", "adjustment").messages
    return {name for name in own if name.startswith(f"notice.{beginning}")}


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_message_of_a_notice_is_that_of_a_code_and_the_other_way_round(language):
    own = catalogue(language, "adjustment").messages
    said = {name.removeprefix("notice.") for name in own if name.startswith("notice.")}
    assert said == codes()


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("family", FAMILIES)
def test_every_kind_has_words(language, family):
    words = words_in(language)
    assert all(words.catalogue.holds(family, key) for key in FAMILIES[family])
    assert DroppedParameter(name="x", scope="block", reason=FAMILIES["dropped"][0]).reason


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_parameter_has_words_of_its_own(language):
    words = words_in(language)
    named = [words.parameter(name) for name in UNITS]
    assert len(set(named)) == len(UNITS)


@pytest.mark.parametrize("name", UNITS)
def test_every_parameter_with_a_prior_has_an_explanation(name):
    family = undetermined.family_of(name)
    for language in LANGUAGES:
        assert words_in(language).notice(Notice(code=f"open_{family}"))
        assert words_in(language).notice(Notice(code=f"helps_{family}"))


def test_both_languages_say_the_same_of_the_same_values():
    english, chinese = (catalogue(each, "adjustment").messages for each in LANGUAGES)
    assert english.keys() == chinese.keys()
    for name, forms in english.items():
        assert all(forms)
        assert all(chinese[name])
        assert places(forms) == places(chinese[name]), name


def places(forms):
    return {name for form in forms for _, name, _, _ in string.Formatter().parse(form) if name}


def test_every_message_is_used():
    texts = {text for path in REPORT.glob("*.py") for text in texts_of(path)}
    families = tuple(f"{each}." for each in (*FAMILIES, "notice", "component", "orientation",
                     "panel", "prior", "setting", "consists", "provenance"))  # fmt: skip
    beginnings = tuple(text for text in texts if re.fullmatch(r"[a-z]+\.", text))
    unused = {
        name for name in catalogue("en", "adjustment").messages
        if name not in texts and not name.startswith((*families, *beginnings))
    }  # fmt: skip
    assert unused <= {f"parameter.{source}_{kind}" for source in ("gnss", "imu")
                      for kind in ("shift", "drift")}  # fmt: skip


@pytest.mark.parametrize(("n", "key"), [(0, "control.no"), (1, "control.count")])
def test_control_points_are_counted_in_words(n, key):
    words = words_in("en")
    said = words.notice(Notice(code="open_gnss_of_block", values={"n_control": n}))
    counted = words.text(key) if n == 0 else words.counted(key, n)
    assert counted in said
