"""Words of the adjustment's report: every code, name and kind has its own in both languages."""

from typing import get_args, get_type_hints

import pytest

from posstats.adjustment.defects import RULES
from posstats.adjustment.undetermined import FAMILIES, OF_CAMERA, family_of
from posstats.contract.adjustment import DroppedParameter, Element, Group, Observed
from posstats.contract.choices import DriftScope, NamedControl, SelfCalibration
from posstats.contract.notice import Notice
from posstats.numerics.bundle.parameters import UNITS
from posstats.reports.adjustment.words import words_in

LANGUAGES = ("en", "zh")
OBSERVED = get_args(Observed)
KINDS = {
    "group": get_args(Group),
    "weight": [kind for kind in OBSERVED if kind != "axes"],
    "kind": OBSERVED,
    "named": OBSERVED,
    "several": [kind for kind in OBSERVED if kind != "image"],
    "drift": get_args(DriftScope),
    "self_calibration": get_args(SelfCalibration),
    "control_choice": get_args(NamedControl),
    "dropped": get_args(get_type_hints(DroppedParameter)["reason"]),
    "bundle_component": get_args(Element),
    "bundle_orientation": ("pos", "bundle"),
    "panel": ("pos", "bundle"),
}
"""Families of messages, and the keys that the results can ask of them."""
OPEN = (*RULES, *FAMILIES, OF_CAMERA, "images", "datum", "datum_line", "datum_angles_alone",
        "images_by_imu", "part_of_images", "part_of_strips")  # fmt: skip
"""Why something can be open."""


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("family", KINDS)
def test_every_kind_has_words(language, family):
    words = words_in(language).catalogue
    assert [key for key in KINDS[family] if not words.holds(family, key)] == []


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("code", OPEN)
def test_every_cause_has_a_reason_and_a_remedy(language, code):
    words = words_in(language)
    values = {"n_control": 2} if code != "images" else {"n_rays": 5}
    reason = words.notice(Notice(code=f"open_{code}", values=values))
    assert reason != words.notice(Notice(code=f"helps_{code}"))


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_parameter_has_words_of_its_own(language):
    words = words_in(language)
    named = [words.parameter(name) for name in UNITS]
    assert len(set(named)) == len(UNITS)


def test_every_parameter_with_a_prior_has_a_cause():
    assert {family_of(name) for name in UNITS} == {*FAMILIES, OF_CAMERA}


@pytest.mark.parametrize("n", [0, 1, 3])
def test_control_points_are_counted_in_words(n):
    words = words_in("en")
    said = words.notice(Notice(code="open_gnss_of_block", values={"n_control": n}))
    counted = words.counted("control.count", n) if n else words.text("control.no")
    assert counted in said
