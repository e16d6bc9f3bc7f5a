"""The questions of `posstats verify` and their answers, as codes and values; `words` says them."""

from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum

from posstats.contract.notice import Notice, Value


class Standing(StrEnum):
    """How a question is answered; only FAIL makes the command fail."""

    PASS = "pass"  # noqa: S105 - no password
    FAIL = "fail"
    NOT_ASKED = "not_asked"
    NOT_SIGNED = "not_signed"


@dataclass(frozen=True)
class Question:
    """What is asked; `signature` is the number of the one asked about, where there are several."""

    code: str
    signature: int | None = None


READABLE = Question("readable")
SIGNED = Question("signed")
TRUSTED = Question("trusted")
APPENDED = Question("appended")
FILES = Question("files")
ASSESSMENT = Question("assessment")
PAGES = Question("pages")
INPUTS = Question("inputs")
RECOMPUTED = Question("recomputed")


@dataclass(frozen=True)
class Answer:
    """A question with its answer.

    Attributes
    ----------
    said
        What holds, or all that does not.
    hedged
        Whether other versions made the document: what differs may be theirs.
    """

    standing: Standing
    question: Question
    said: tuple[Notice, ...]
    hedged: bool = False


def said(code: str, **values: Value) -> Notice:
    """A part of an answer."""
    return Notice(code=code, values=values)


def answer(
    question: Question, problems: Iterable[Notice], holds: Notice, *, hedged: bool = False
) -> Answer:
    """PASS with `holds` if there are no problems, else FAIL with them."""
    found = tuple(problems)
    if found:
        return Answer(Standing.FAIL, question, found, hedged)
    return Answer(Standing.PASS, question, (holds,))


def failed(question: Question, *problems: Notice, hedged: bool = False) -> Answer:
    """FAIL for reasons."""
    return Answer(Standing.FAIL, question, problems, hedged)


def not_asked(question: Question, reason: Notice) -> Answer:
    """A question that nobody wanted to be answered, and what it would take."""
    return Answer(Standing.NOT_ASKED, question, (reason,))


def caught(code: str, error: BaseException) -> Notice:
    """A part of an answer whose reason is an error, in the error's own words."""
    return said(code, reason=str(error))
