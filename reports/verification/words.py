"""What `posstats verify` says: its questions and the words of its answers. Plain English."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import StrEnum

SHOWN = 5


class Standing(StrEnum):
    """How a question is answered; only FAIL makes the command fail."""

    PASS = "PASS"  # noqa: S105 - no password
    FAIL = "FAIL"
    NOT_ASKED = "NOT ASKED"
    NOT_SIGNED = "NOT SIGNED"


@dataclass(frozen=True)
class Answer:
    """One question with its answer."""

    standing: Standing
    question: str
    text: str

    @property
    def line(self) -> str:
        """For the terminal: whatever a document says cannot steer it."""
        text = f"{self.question}: {self.text}"
        return f"{self.standing:<10}  " + "".join(c if c.isprintable() else "\ufffd" for c in text)


def answer(question: str, problems: Iterable[str], holds: str) -> Answer:
    """PASS with the words `holds` if there are no problems, FAIL with the first few otherwise."""
    found = list(problems)
    if not found:
        return Answer(Standing.PASS, question, holds)
    return Answer(Standing.FAIL, question, listed(found))


def failed(question: str, reason: object) -> Answer:
    """FAIL with a reason."""
    return Answer(Standing.FAIL, question, str(reason))


def listed(items: Sequence[str]) -> str:
    """The first few items in a row."""
    hidden = len(items) - SHOWN
    return "; ".join(items[:SHOWN]) + (f"; and {hidden} more" if hidden > 0 else "")


READABLE = "is it an acceptance document of posstats"
SIGNED = "is it signed"
TRUSTED = "is the signer trusted"
APPENDED = "is nothing appended to it but signatures"
FILES = "are the embedded files complete and as listed"
ASSESSMENT = "does the assessment follow from the embedded results and profile"
PAGES = "do the pages say what the embedded data say"
INPUTS = "are the input files those that the document names"
RECOMPUTED = "does recomputing from the input files give the same results"

UNSIGNED = "no; who made it, and that it was never rewritten as a whole, cannot be known"
UNSIGNED_TRUST = "nobody signed"
NO_ANCHOR = "no certificate to trust was given (--trust)"
NO_INPUTS = "no input files were given (--inputs)"
NOTHING_APPENDED = "yes, nothing is appended"
ONLY_SIGNATURES = "yes, only signatures"
SAME_BYTES = "yes, made again from the data they have the same bytes"
SAME_DECODED = "yes, made again from the data they hold the same, packed differently"
NOT_HERE = "not with the versions at hand"


def readable(document_id: object, verdict: object) -> str:
    """What the document calls itself."""
    return f"yes, {document_id}, verdict {verdict}"


def intact_question(name: str) -> str:
    """Whether what was signed is unchanged."""
    return f"is {name} intact"


def certificate_question(name: str) -> str:
    """Whether the signer's certificate was in force."""
    return f"is the certificate of {name} in force"


def trust_question(name: str) -> str:
    """Whether somebody the user trusts vouches for the signer."""
    return f"is the signer of {name} trusted"


def own_templates(names: Sequence[str]) -> str:
    """Why pages of unknown templates are not believed."""
    return (
        f"they are laid out by templates of the document's own ({listed(names)}), which can say or"
        " hide anything: give the folder where you know them from (--templates), or trust the data"
        " alone"
    )


def same_text(other: str) -> str:
    """Pages of other versions: what was compared, and what was not."""
    return (
        f"yes, but the text of the pages alone was compared, not their drawings: {other}; with the"
        " same versions all is compared"
    )


def other_versions(made: str, here: str) -> str:
    """Why pages cannot be compared byte by byte."""
    return f"made with {made}, compared with {here}"
