"""What stands before the topics of a document: subject, verdict, key figures, parties."""

from dataclasses import dataclass

from .key_figure import KeyFigure
from .letters import width
from .table import Table

LONG_VALUE = 60  # letters from which a value needs the whole width of the page


@dataclass(frozen=True)
class Fact:
    """A name and a value."""

    label: str
    value: str

    @property
    def is_long(self) -> bool:
        """Whether the value needs the whole width of the page."""
        return width(self.value) > LONG_VALUE


@dataclass(frozen=True)
class Verdict:
    """What was found, in short.

    `kind` is a word for the look (``accepted``, ``rejected``, ``not-assessable``; ``coarse`` for a
    POS that cannot be used; or empty); `sign` and `word` say the same; `summary` is the text.
    """

    summary: str
    kind: str = ""
    sign: str = ""
    word: str = ""


@dataclass(frozen=True)
class Signature:
    """A party that signs: its role and its name, if known."""

    role: str
    name: str


@dataclass(frozen=True, kw_only=True)
class Front:
    """The first page; what a kind of document does not have stays empty.

    `title` says what kind of document this is, `subject` what it is about, `subtitle` what that
    consists of; `mark` stands on every page (simulated data); `created` is a date as text;
    `identity` says which document this is, `basis` what was judged by what, `statement` a
    standard's own words, `facts` who and what is concerned, `short` the requirements in short.
    """

    language: str
    title: str
    subject: str
    subtitle: str
    version: str
    verdict: Verdict
    mark: str = ""
    created: str = ""
    key_figures: tuple[KeyFigure, ...] = ()
    document_id: str = ""
    identity: tuple[Fact, ...] = ()
    basis: tuple[Fact, ...] = ()
    statement: str = ""
    facts: tuple[Fact, ...] = ()
    short: Table | None = None
    signatures: tuple[Signature, ...] = ()
