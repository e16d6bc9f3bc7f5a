"""What `posstats verify` prints: a line an answer, in the words of the catalogue."""

from posstats.contract.notice import Notice, Value

from ..document.catalogue import catalogue
from ..document.letters import width
from ..document.words import Words
from .answers import Answer, Question

DOMAINS = ("document", "verification")
SHOWN = 5  # parts of an answer
STANDING_WIDTH = 10


def words_of(language: str) -> Words:
    """The words of a language."""
    return Words(catalogue(language, *DOMAINS))


def line(words: Words, answer: Answer) -> str:
    """An answer for the terminal: whatever a document says cannot steer it."""
    standing = words.of("standing", answer.standing)
    text = words.text(
        "answer.line", question=asked(words, answer.question), text=told(words, answer)
    )
    padding = " " * max(0, STANDING_WIDTH - width(standing))
    seen = "".join(letter if letter.isprintable() else "\ufffd" for letter in text)
    return f"{standing}{padding}  {seen}"


def asked(words: Words, question: Question) -> str:
    """A question in words."""
    number = question.signature
    signature = (
        words.text("signature.only") if number is None
        else words.text("signature.numbered", number=str(number))
    )  # fmt: skip
    return words.of("question", question.code, signature=signature)


def told(words: Words, answer: Answer) -> str:
    """An answer in words: its first few parts."""
    parts = [_part(words, each) for each in answer.said[:SHOWN]]
    hidden = len(answer.said) - SHOWN
    if hidden > 0:
        parts.append(words.text("answer.more", n=str(hidden)))
    text = words.text("answer.between").join(parts)
    return words.text("answer.hedged", text=text) if answer.hedged else text


def _part(words: Words, part: Notice) -> str:
    values = {name: _put(words, name, value) for name, value in part.values.items()}
    if isinstance(part.values.get("n"), int):
        return words.catalogue.plural(f"said.{part.code}", int(values["n"]), **values)
    return words.of("said", part.code, **values)


def _put(words: Words, name: str, value: Value) -> str:
    """A value as it is; verdicts are words of the catalogue, and so is an issuer that is none."""
    if name == "verdict":
        return words.known("verdict_said", str(value))
    if name == "issuer" and value is None:
        return words.text("signature.own_issuer")
    if isinstance(value, tuple):
        return words.text("answer.between").join(map(str, value))
    return str(value)
