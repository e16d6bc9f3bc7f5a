"""What a standard or a contract demands, as data: frozen, read by `profile_files`."""

import hashlib
from dataclasses import dataclass, field, fields

from posstats.acceptance.formula import Formula, FormulaError, MissingProductValue
from posstats.acceptance.product import Product
from posstats.acceptance.quantity_names import QUANTITIES, Quantity
from posstats.contract.acceptance import Exceeding, Parties, StatedComponent
from posstats.contract.choices import TerrainKind

__all__ = [
    "Contract",
    "Product",
    "Profile",
    "ProfileFile",
    "Requirement",
    "Statement",
]


@dataclass(frozen=True)
class Requirement:
    """One demand: a quantity, its limit, and where the number comes from.

    Attributes
    ----------
    id
        Unique in the profile; a contract overrides a requirement by it.
    quantity
        A key of `QUANTITIES`, which says unit and sense of the limit.
    limit
        In the quantity's unit.
    source
        Where limit and threshold are cited from.
    clause
        Of the standard or contract, "" if none is known.
    mandatory
        Whether a product cannot be accepted while this is not assessed.
    exceeding
        What it means that the limit is not kept: the product fails, or the case is to be
        investigated, which leaves the requirement not assessed.
    threshold
        Of `n_blunders_h` and `n_blunders_v` only: residuals beyond this (m) are counted.
    terrain
        The only terrain that it applies to, None for any.
    when_given
        What a product must state for the requirement to apply (`GIVEN_NAMES`), None for any
        product: without it a requirement whose limit cannot be computed is not assessed.
    basis_of_score
        Whether the score of this quantity enters a quality grade (GB/T 24356).
    """

    id: str
    quantity: str
    limit: Formula
    source: str
    clause: str = ""
    mandatory: bool = True
    exceeding: Exceeding = "fail"
    threshold: Formula | None = None
    terrain: TerrainKind | None = None
    when_given: str | None = None
    basis_of_score: bool = False

    @property
    def measured(self) -> Quantity:
        """Unit and sense of its quantity."""
        return QUANTITIES[self.quantity]

    def applies_to(self, product: Product) -> bool:
        """Whether a product is of its terrain and states what it asks for."""
        if self.terrain is not None and self.terrain != product.terrain:
            return False
        return self.when_given is None or product.states(self.when_given)

    def demands_the_same_as(self, other: "Requirement") -> bool:
        """Whether two requirements differ in clause and source at most."""
        cited = ("clause", "source")
        names = [each.name for each in fields(self) if each.name not in cited]
        return all(getattr(self, name) == getattr(other, name) for name in names)


@dataclass(frozen=True)
class Statement:
    """A standard's own wording of what was found, for one component and in one language.

    The texts hold ``{class_m}``, ``{class_cm}``, ``{found_m}``, ``{found_cm}`` and
    ``{n_points}``, to be filled in by `str.format` with numbers that are already text.

    Attributes
    ----------
    tested
        For `least_points` check points or more, "" if the standard has none.
    tested_with_fewer
        For fewer, "" if the standard has none.
    produced
        For a product that was not tested, "" if the standard has none.
    rests_on
        Ids of the requirements that the wording claims to be met or to have been heeded.
    withheld_by
        Those of `rests_on` that a contract changed or omitted: the standard's words would then
        claim what was not tested, and are not to be used.
    """

    component: StatedComponent
    language: str = "en"
    least_points: int = 1
    tested: str = ""
    tested_with_fewer: str = ""
    produced: str = ""
    rests_on: tuple[str, ...] = ()
    withheld_by: tuple[str, ...] = ()


@dataclass(frozen=True)
class ProfileFile:
    """A file as it was read: what a document embeds, and what it can be judged from again."""

    name: str
    content: bytes

    @property
    def sha256(self) -> str:
        """SHA-256 of the content, hexadecimal."""
        return hashlib.sha256(self.content).hexdigest()


@dataclass(frozen=True, kw_only=True)
class Contract(Parties):
    """A contract file: the parties, and in `product` what it states of the product."""

    product: Product = field(default_factory=Product)


@dataclass(frozen=True)
class Profile:
    """The requirements of a standard, as changed by a contract.

    Attributes
    ----------
    name, edition, title, source
        Of the standard; a contract that extends it keeps them unless it gives its own.
    notes
        What a reader must know of the numbers: what was not seen, what is left to the contract.
    needs
        Alternatives of which a product must state at least one each (`GIVEN_NAMES`).
    scales
        Denominators of the map scales that the limits are for, () for any.
    files
        The files that it was read from: the contract first, what it extends after it.
    changed, added, omitted
        Ids of requirements that the files changed, added or left out of what they extend.
    """

    name: str
    edition: str
    title: str
    source: str
    requirements: tuple[Requirement, ...]
    notes: tuple[str, ...] = ()
    needs: tuple[tuple[str, ...], ...] = ()
    scales: tuple[int, ...] = ()
    statements: tuple[Statement, ...] = ()
    files: tuple[ProfileFile, ...] = ()
    changed: tuple[str, ...] = ()
    added: tuple[str, ...] = ()
    omitted: tuple[str, ...] = ()

    def requirements_for(self, product: Product) -> tuple[Requirement, ...]:
        """The requirements that apply to a product, in order; possibly none."""
        return tuple(each for each in self.requirements if each.applies_to(product))

    def statement(self, component: StatedComponent, language: str = "en") -> Statement | None:
        """The wording for a component in a language, else in English; None without one.

        One that is withheld because a contract changed what it rests on counts as none.
        """
        usable = {
            each.language: each
            for each in self.statements
            if each.component == component and not each.withheld_by
        }
        return usable.get(language, usable.get("en"))

    def product_findings(self, product: Product) -> tuple[str, ...]:
        """Why a product cannot be judged by this profile: one sentence per fault, () if it can.

        Named are values that the profile needs and the product does not state, a map scale that
        the limits are not for, and limits that have no usable value for this product. A limit of
        a single requirement that needs a value which is not stated is no fault: the requirement
        is not assessed.
        """
        findings = [
            f"profile {self.name} needs {' or '.join(names)} of the product"
            for names in self.needs
            if not any(product.states(name) for name in names)
        ]
        scale = product.map_scale
        if self.scales and scale is not None and scale not in self.scales:
            known = ", ".join(f"{each:d}" for each in self.scales)
            findings.append(
                f"profile {self.name}: found map_scale {scale:g}, expected one of {known}"
            )
        for requirement in self.requirements_for(product):
            findings += _faults(requirement, product)
        return tuple(findings)


def _faults(requirement: Requirement, product: Product) -> list[str]:
    """Sentences on the formulas of a requirement that have no usable value for a product."""
    found = []
    for key in ("limit", "threshold"):
        formula = getattr(requirement, key)
        try:
            if formula is not None:
                formula.evaluate(product)
        except FormulaError as error:
            found.append(f"requirement {requirement.id}, {key}: {error}")
        except MissingProductValue:
            continue
    return found
