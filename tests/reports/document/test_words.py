"""Notices in words: plurals, ids, numbers by their names, translated texts."""

import pytest

from posstats.contract.notice import Notice, listing
from posstats.reports.document.catalogue import MissingMessageError, catalogue
from posstats.reports.document.format import by_name
from posstats.reports.document.words import Words

ENGLISH, CHINESE = (Words(catalogue(each, "document", "notices")) for each in ("en", "zh"))
DRIFT = Notice(
    code="drift",
    values={
        "significance": "not_significant",
        "slope_rad_per_s": -6.774e-11,
        "slope_se_rad_per_s": 3.84e-9,
        "p": 0.9871,
        "alpha": 0.05,
    },
)


def test_a_count_decides_on_the_plural():
    (one,), (two,) = (listing("strips_of_one_image", ids) for ids in (["7"], ["7", "9"]))
    assert ENGLISH.notice(one) == "1 strip of one image: 7."
    assert ENGLISH.notice(two) == "2 strips of one image: 7, 9."
    assert CHINESE.notice(two) == "2 条航带仅有一张影像：7、9。"


def test_of_many_ids_the_first_are_named_and_the_others_counted():
    (many,) = listing("strips_of_one_image", range(12_000), most=2)
    assert many.values == {"n": 12_000, "ids": ("0", "1")}
    assert ENGLISH.notice(many).endswith(": 0, 1 and 11\u202f998 more.")
    assert ENGLISH.notice(many, plain=True).endswith(": 0, 1 and 11998 more.")
    assert CHINESE.notice(many).endswith("：0、1和另外 11\u202f998 项。")


def test_nothing_to_list_is_no_notice():
    assert listing("strips_of_one_image", []) == ()


def test_numbers_are_written_for_reading_or_as_python_prints_them():
    assert "−6.77\u00a0×\u00a010⁻¹¹ ± 3.8\u00a0×\u00a010⁻⁹" in ENGLISH.notice(DRIFT)
    assert "-6.77e-11 ± 3.8e-09" in ENGLISH.notice(DRIFT, plain=True)
    assert "(p = 0.99, " in ENGLISH.notice(DRIFT)


@pytest.mark.parametrize(
    ("name", "value", "text", "plain"),
    [
        ("p", 0.00099, "p < 0.001", "p < 0.001"),
        ("p", 0.0097, "p = 0.0097", "p = 0.0097"),
        ("p", 1.0, "p = 1", "p = 1"),
        ("r_squared", 0.99449, "0.994", "0.994"),
        ("min_r_squared", 0.8, "0.8", "0.8"),
        ("change_share", 0.98437, "98.4%", "98.4%"),
        ("min_gain_share", 0.05, "5%", "5%"),
        ("constant_rad", -5.8901e-6, "−5.89\u00a0×\u00a010⁻⁶", "-5.89e-06"),
        ("n_pairs", 12_345, "12\u202f345", "12345"),
        ("n_sigmas", 3.0, "3", "3"),
        ("slope_rad_per_s", None, "–", "–"),
    ],
)
def test_values_are_written_by_their_names(name, value, text, plain):
    assert by_name(name, value, ENGLISH.joined) == text
    assert by_name(name, value, ENGLISH.joined, plain=True) == plain


def test_texts_among_the_values_are_translated_where_the_catalogue_knows_them():
    assert "不显著" in CHINESE.notice(DRIFT)
    known = Notice(code="no_test_out_of_sample", values={"out_of_sample": "leave_strip_out"})
    assert CHINESE.text("value.out_of_sample.leave_strip_out") in CHINESE.notice(known)
    other = Notice(code="no_test_out_of_sample", values={"out_of_sample": "bootstrap"})
    assert "bootstrap" in ENGLISH.notice(other)


def test_why_is_another_notice_on_the_same_values():
    values = {"n": 2, "n_needed": 3}
    why = ENGLISH.notice(Notice(code="too_few_images", values=values))
    said = Notice(code="no_line", values={"why": "too_few_images", **values})
    assert ENGLISH.notice(said).endswith(f": {why}")


def test_a_reason_joins_its_notices():
    first, second = Notice(code="no_covariance"), Notice(code="equal_times")
    for words in (ENGLISH, CHINESE):
        between = words.text("clause.between")
        both = between.join(words.notice(each) for each in (first, second))
        assert words.reason((first, second)) == both


def test_a_notice_without_words_is_an_error():
    with pytest.raises(MissingMessageError):
        ENGLISH.notice(Notice(code="perhaps"))


def test_of_many_names_the_first_are_shown_and_the_others_counted():
    words = ENGLISH
    more = words.text("list.more", n="2")
    assert words.first("abcd", 2) == words.joined(["a", "b", more])
    assert words.first("abcd", 2, sentence=True) == words.first("abcd", 2)
    assert words.first("abc", 3) == words.text("list.between").join("abc")
    assert words.first("abc", 3, sentence=True) == words.joined("abc")
    assert not words.first([], 3)
