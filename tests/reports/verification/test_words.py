"""Answers of `posstats verify` in words: every code has some in both languages, and is used."""

import re
import string

import pytest
from helpers import ROOT

from posstats.contract.acceptance import Verdict
from posstats.reports.document.letters import width
from posstats.reports.verification.answers import (
    FILES,
    PAGES,
    TRUSTED,
    Answer,
    Question,
    Standing,
    answer,
    failed,
    said,
)
from posstats.reports.verification.words import SHOWN, STANDING_WIDTH, asked, line, told, words_of

ENGLISH, CHINESE = words_of("en"), words_of("zh")
SOURCES = "".join(
    path.read_text(encoding="utf-8")
    for path in sorted((ROOT / "reports" / "verification").glob("*.py"))
)


def family(words, name: str) -> dict[str, tuple[str, ...]]:
    messages = words.catalogue.messages
    return {
        each.removeprefix(f"{name}."): forms
        for each, forms in messages.items()
        if each.startswith(f"{name}.")
    }


def places(forms: tuple[str, ...]) -> set[str]:
    return {name for form in forms for _, name, _, _ in string.Formatter().parse(form) if name}


def test_every_part_of_an_answer_has_words_and_every_message_is_said():
    codes = set(re.findall(r'\b(?:said|caught)\(\s*"(\w+)"', SOURCES))
    within = set(re.findall(r'\b_within\(\s*"(\w+)"', SOURCES))
    codes |= within | {f"{code}_within" for code in within}
    assert codes == set(family(ENGLISH, "said")) == set(family(CHINESE, "said"))


def test_every_question_standing_and_verdict_has_words():
    codes = set(re.findall(r'\bQuestion\("(\w+)"', SOURCES))
    for words in (ENGLISH, CHINESE):
        assert set(family(words, "question")) == codes
        assert set(family(words, "standing")) == {each.value for each in Standing}
        verdicts = {each.replace(" ", "_") for each in Verdict.__args__}
        assert set(family(words, "verdict_said")) == verdicts


@pytest.mark.parametrize("name", ["said", "question", "answer", "signature", "signing"])
def test_both_languages_have_the_same_messages_with_the_same_places(name):
    chinese = family(CHINESE, name)
    for code, forms in family(ENGLISH, name).items():
        assert all(forms)
        assert all(chinese[code])
        assert places(forms) == places(chinese[code]), code


def test_a_line_begins_with_the_standing_and_aligns_in_both_languages():
    for words in (ENGLISH, CHINESE):
        for standing in Standing:
            text = line(words, Answer(standing, FILES, (said("only_signatures"),)))
            assert text.startswith(words.of("standing", standing))
            assert width(text[: text.index(asked(words, FILES))]) == STANDING_WIDTH + 2


def test_signatures_are_numbered_where_there_are_several():
    for words in (ENGLISH, CHINESE):
        assert "2" in asked(words, Question("intact", 2))
        assert words.text("signature.only") in asked(words, Question("intact"))


def test_the_first_parts_are_told_and_the_others_counted():
    problems = [said("page_differs", number=n) for n in range(1, SHOWN + 4)]
    text = told(ENGLISH, answer(PAGES, problems, said("same_bytes")))
    assert re.findall(r"\d+", text) == ["1", "2", "3", "4", "5", "3"]
    hedged = told(ENGLISH, failed(PAGES, *problems, hedged=True))
    assert hedged == ENGLISH.text("answer.hedged", text=text)


def test_who_issued_its_own_certificate_is_told_in_words():
    part = said("trusted", signer="A", issuer=None)
    for words in (ENGLISH, CHINESE):
        assert words.text("signature.own_issuer") in told(words, answer(TRUSTED, [], part))


def test_counts_choose_the_form_of_their_message():
    one, two = (told(ENGLISH, answer(FILES, [], said("files_as_listed", n=n))) for n in (1, 2))
    assert one.rstrip("s") == two.rstrip("s").replace("2", "1")
    assert one != two.replace("2", "1")
