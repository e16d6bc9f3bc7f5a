"""What `posstats accept` says on the terminal, in the language of the document."""

import textwrap
import unicodedata
from collections.abc import Iterator

from posstats.contract.acceptance import Acceptance

from ..output.terminal import WIDTH
from .words import Words, words_of

_INDENT = 14


def summary(acceptance: Acceptance) -> Iterator[str]:
    """Verdict, requirements and statement, as lines of text."""
    words = words_of(acceptance)
    yield from _heading(words, acceptance)
    yield ""
    for row in acceptance.requirements:
        verdict = _padded(words.of("terminal_finding", row.verdict))
        line = words.text("terminal.requirement", verdict=verdict, id=row.id, reason=row.reason)
        yield from textwrap.wrap(line, WIDTH, subsequent_indent=" " * _INDENT)
    if acceptance.statement:
        yield ""
        yield from textwrap.wrap(acceptance.statement, WIDTH)


def _heading(words: Words, acceptance: Acceptance) -> Iterator[str]:
    block, profile = acceptance.block, acceptance.profile
    verdict = words.of("verdict", acceptance.verdict).upper()
    heading = "terminal.simulated" if block.simulated else "terminal.verdict"
    yield words.text(heading, verdict=verdict, name=block.name)
    yield words.text(
        "terminal.against",
        profile=profile.name,
        edition=profile.edition,
        orientation=words.of("terminal_orientation", acceptance.orientation),
        document_id=acceptance.document_id,
    )


def _padded(text: str) -> str:
    """Text of a column; a Chinese character is two wide."""
    wide = sum(unicodedata.east_asian_width(each) in "WF" for each in text)
    return text.ljust(_INDENT - wide)
