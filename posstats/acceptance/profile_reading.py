"""One profile or contract file: its keys read and checked, before files are put together."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal

from msgspec import Meta

from posstats.acceptance.product import GIVEN_NAMES, Product
from posstats.acceptance.profile import ProfileFile
from posstats.acceptance.profile_values import (
    Date,
    FilledText,
    Id,
    Ids,
    Language,
    Needs,
    Scales,
    Text,
    Texts,
    Wording,
    named,
)
from posstats.acceptance.quantity_names import QUANTITIES
from posstats.contract.acceptance import Exceeding, StatedComponent
from posstats.contract.choices import TerrainKind
from posstats.formats.toml_document import TomlDocument, open_toml
from posstats.formats.toml_lines import Place
from posstats.formats.toml_types import NEEDED, Count

ANY_TERRAIN = "any"
ALWAYS = "always"
_MAX_TABLES = 200
_MAX_LINE = 10_000


@dataclass(frozen=True)
class RequirementTable:
    """``[[requirement]]``; limit and threshold as they stand, for want of their unit."""

    id: Annotated[Id, NEEDED] | None = None
    clause: Text | None = None
    quantity: Annotated[str, named(QUANTITIES)] | None = None
    limit: object = None
    source: FilledText | None = None
    mandatory: bool | None = None
    exceeding: Exceeding | None = None
    threshold: object = None
    terrain: Literal[TerrainKind, "any"] | None = None
    when_given: Annotated[str, named((*GIVEN_NAMES, ALWAYS))] | None = None
    basis_of_score: bool | None = None


@dataclass(frozen=True)
class StatementTable:
    """``[[statement]]``."""

    component: Annotated[StatedComponent, NEEDED] | None = None
    language: Language | None = None
    least_points: Count | None = None
    tested: Wording | None = None
    tested_with_fewer: Wording | None = None
    produced: Wording | None = None
    rests_on: Ids | None = None


@dataclass(frozen=True)
class ContractTable:
    """``[contract]``: the values of `Parties`, as types that refuse what no page could show."""

    number: Text = ""
    title: Text = ""
    client: Text = ""
    contractor: Text = ""
    inspector: Text = ""
    flight: Text = ""
    flight_date: Date = ""
    sensor: Text = ""
    place: Text = ""
    remarks: Text = ""


@dataclass(frozen=True)
class ProfileTable:
    """A whole file; None: the file does not give it, or not rightly."""

    extends: FilledText | None = None
    name: Id | None = None
    edition: FilledText | None = None
    title: FilledText | None = None
    source: FilledText | None = None
    notes: Texts | None = None
    needs: Needs | None = None
    scales: Scales | None = None
    omit: Ids | None = None
    contract: ContractTable = field(default_factory=ContractTable)
    product: Product = field(default_factory=Product)
    requirement: Annotated[
        tuple[RequirementTable, ...],
        Meta(max_length=_MAX_TABLES, description="tables that begin with [[requirement]]"),
    ] = ()
    statement: Annotated[
        tuple[StatementTable, ...],
        Meta(max_length=_MAX_TABLES, description="tables that begin with [[statement]]"),
    ] = ()


@dataclass(frozen=True)
class TableOfFile:
    """A table as far as it could be read, and where it stands.

    Attributes
    ----------
    values
        The keys that the file gives and that are right.
    """

    document: TomlDocument
    place: Place
    values: Mapping[str, Any]

    @property
    def given(self) -> tuple[str, ...]:
        """The keys that the file gives, right or not."""
        return self.document.given(self.place)

    @property
    def is_right(self) -> bool:
        """Whether nothing of it was refused."""
        return self.document.is_right(self.place)

    def refuse(self, key: str, what: str) -> None:
        """A finding about a key."""
        self.document.refuse((*self.place, key), what)


@dataclass(frozen=True)
class FileContent:
    """What one file says, as far as it could be read."""

    file: ProfileFile
    top: TableOfFile
    contract: TableOfFile
    product: TableOfFile
    requirements: tuple[TableOfFile, ...]
    statements: tuple[TableOfFile, ...]

    @property
    def findings(self) -> list[str]:
        """What is wrong with it."""
        return self.top.document.findings


def open_profile(file: ProfileFile) -> TomlDocument:
    """The file parsed; a key of thousands of parts, which takes minutes, is refused before."""
    return open_toml(file.content, file.name, _MAX_LINE)


def read_content(file: ProfileFile) -> FileContent:
    """Read one file."""
    document = open_profile(file)
    read = document.read(ProfileTable) or ProfileTable()

    def table(values: object, *place: str | int) -> TableOfFile:
        return TableOfFile(document, place, document.said(values, place))

    return FileContent(
        file,
        table(read),
        table(read.contract, "contract"),
        table(read.product, "product"),
        tuple(table(each, "requirement", k) for k, each in enumerate(read.requirement)),
        tuple(table(each, "statement", k) for k, each in enumerate(read.statement)),
    )
