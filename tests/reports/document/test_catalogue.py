"""Messages of a catalogue: families of the data, plurals, enumerations, values."""

import re
from dataclasses import fields

import pytest
from helpers import ROOT

from posstats.acceptance.evidence import ORIENTATIONS
from posstats.acceptance.quantity_names import QUANTITIES
from posstats.contract.acceptance import StatedProduct
from posstats.errors import PosstatsError
from posstats.reports.document.catalogue import MissingMessageError, catalogue
from posstats.statistics import samples

DOMAINS = ("document", "acceptance")
ENGLISH, CHINESE = catalogue("en", *DOMAINS), catalogue("zh", *DOMAINS)
ACCEPTANCE = "".join(
    path.read_text(encoding="utf-8") for path in (ROOT / "posstats" / "acceptance").glob("*.py")
)
CODES = {"within", "exceeds", "investigate", *re.findall(r'Reason\("([^"]+)"', ACCEPTANCE)}
UNTESTABLE = {samples.NO_POINTS, samples.TOO_FEW_POINTS, samples.TOO_MANY_POINTS,
              samples.NO_SCATTER, samples.COLLINEAR}  # fmt: skip


def test_every_reason_quantity_and_orientation_has_words():
    for words in (ENGLISH, CHINESE):
        for code in CODES:
            assert words.holds("reason", code)
        for code in UNTESTABLE:
            assert words.holds("untestable", code)
        for quantity in QUANTITIES:
            assert words.holds("quantity", quantity)
        for name in ORIENTATIONS:
            assert words.holds("orientation", name)
            assert words.holds("orientation_reason", name)
        assert words.holds("orientation_reason", "asked")
        for stated in fields(StatedProduct):
            assert words.holds("product", stated.name)


def test_a_missing_message_is_an_error_and_never_its_id():
    with pytest.raises(MissingMessageError):
        ENGLISH.text("verdict.perhaps")
    with pytest.raises(KeyError):
        ENGLISH.text("key.limit")
    with pytest.raises(PosstatsError, match="no language"):
        catalogue("fr", *DOMAINS)


def test_plurals_follow_the_language():
    assert ENGLISH.plural("delivered.n_images", 1, n="1") == "1 image"
    assert ENGLISH.plural("delivered.n_images", 2, n="2") == "2 images"
    assert CHINESE.plural("delivered.n_images", 1, n="1") == "影像 1 张"


def test_enumerations_follow_the_language():
    assert ENGLISH.joined(["a", "b", "c"]) == "a, b and c"
    assert CHINESE.joined(["甲", "乙", "丙"]) == "甲、乙和丙"
    assert ENGLISH.joined([]) == ""


def test_values_with_braces_stay_as_they_are():
    assert ENGLISH.text("key.limit", limit="{x} {{7*7}} %s") == "limit {x} {{7*7}} %s"
