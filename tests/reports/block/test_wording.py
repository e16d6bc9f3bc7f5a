"""The English words of results.json are those of its codes, and as they always were."""

from dataclasses import fields, is_dataclass, replace

import numpy as np
import pytest
from strip_scene import block, scene

from posstats.analysis.results import results
from posstats.analysis.steps import Settings, analyse
from posstats.contract.files import from_json, to_json
from posstats.contract.notice import Notice
from posstats.contract.results import Results
from posstats.reports.block.wording import warnings, with_words
from posstats.reports.document import format as fmt
from posstats.reports.document.catalogue import catalogue
from posstats.reports.document.words import Words

LISTED = Notice(code="images_untied", values={"n": 3, "ids": ("a", "b")})
DRIFT = {
    "significance": "significant",
    "slope_rad_per_s": 4.7312e-7,
    "slope_se_rad_per_s": 5.46e-9,
    "p": 1e-9,
    "alpha": 0.05,
    "r_squared": 0.99412,
    "min_r_squared": 0.8,
}


@pytest.fixture(scope="module")
def coded():
    """Results of a single strip, which leaves rotations and images open."""
    oriented, ground = scene(1, n_points=20)
    turned = oriented.with_angles(oriented.angles_rad + 1e-5)
    found = results(
        analyse(block(turned, ground, is_check=np.arange(20) < 4), Settings(frame="auto"))
    )
    decisions = (
        replace(found.selection[0], notices=(Notice(code="drift_explains", values=DRIFT),)),
    )
    return replace(found, notices=(LISTED,), selection=decisions + found.selection[1:])


def test_numbers_alone_hold_no_words(coded):
    assert coded.warnings == ()
    assert {row.reason for row in coded.regression} == {None}
    assert {row.reason for row in coded.selection} == {""}


def test_every_code_gets_its_words(coded):
    worded = with_words(coded)
    assert len(worded.warnings) == len(worded.notices)
    assert all(row.reason for row in worded.selection)
    assert (worded.settings.frame_reason is None) == (worded.settings.frame_notice is None)
    for row in worded.regression:
        assert (row.reason is None) == (row.notice is None)
    for row in worded.observability:
        assert len(row.unobservable) == len(row.rotations)


def test_words_change_nothing_else(coded):
    worded = with_words(coded)
    for field in fields(Results):
        if field.name not in {"settings", "regression", "selection", "observability", "warnings"}:
            assert getattr(worded, field.name) == getattr(coded, field.name)


def test_results_read_back_hold_codes_and_words(coded):
    worded = with_words(coded)
    back = from_json(to_json(worded), Results, "results.json")
    assert back.notices == (LISTED,)
    assert back.warnings == worded.warnings
    assert is_dataclass(back.selection[0].notices[0])


def test_the_file_keeps_its_spelling_and_pages_write_the_same_for_reading(coded):
    """Oracle: the sentences of version 0.1.0."""
    said = with_words(coded).selection[0].reason
    assert said == (
        "drift 4.73e-07 ± 5.5e-09 rad/s significant (p < 0.001, level 0.05), R2 = 0.994 reaches 0.8"
    )
    words = Words(catalogue("en", "document", "notices"))
    assert words.reason(coded.selection[0].notices) == fmt.prose(said)
    assert warnings((LISTED,)) == (
        "no tie points in common with another image (3 of the images): a, b and 1 more",
    )
