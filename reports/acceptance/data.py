"""acceptance.json: the assessment with its words, and the files that the document embeds."""

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory

from posstats.acceptance.assessment import Assessment, assess
from posstats.acceptance.evidence import best_orientation, evidence
from posstats.acceptance.product import Product
from posstats.acceptance.profile import Contract, Profile, ProfileFile
from posstats.acceptance.profile_files import profile_of_files
from posstats.acceptance.values import Occasion, acceptance_values, document_id
from posstats.contract.acceptance import (
    Acceptance,
    AttachedFile,
    ChosenStatement,
)
from posstats.contract.choices import JudgedOrientation, Language
from posstats.contract.notice import Notice
from posstats.contract.results import Results
from posstats.errors import PosstatsError

from ..archive.writing import Attachment
from ..block.csv_files import write_tables
from ..document import format as fmt
from . import words as acceptance_words

RESULTS, ACCEPTANCE = "results.json", "acceptance.json"


@dataclass(frozen=True)
class Demand:
    """What a product is held against, and how it is to be told.

    Attributes
    ----------
    orientation
        To be assessed; None: the best that the results hold.
    language
        Of the document.
    """

    profile: Profile
    contract: Contract
    product: Product
    orientation: JudgedOrientation | None
    language: Language


def embedded(
    results: Results, results_text: bytes, demand: Demand, others: Mapping[str, bytes]
) -> list[Attachment]:
    """The files inside the document, all but acceptance.json.

    Parameters
    ----------
    results_text
        The bytes of results.json.
    others
        More files by name: block.toml, templates.
    """
    files = [Attachment(RESULTS, results_text, "Data")]
    files += [
        Attachment(f"profile/{each.name}", each.content, "Source") for each in demand.profile.files
    ]
    files += [Attachment(name, content, "Source") for name, content in others.items()]
    with TemporaryDirectory() as folder:
        write_tables(results, Path(folder))
        files += [
            Attachment(f"tables/{path.name}", path.read_bytes(), "Supplement")
            for path in sorted(Path(folder).iterdir())
        ]
    return sorted(files, key=lambda each: each.name)


def assembled(
    results: Results, demand: Demand, files: Sequence[Attachment], created: str
) -> Acceptance:
    """The acceptance with its words.

    Parameters
    ----------
    files
        All that is embedded but itself.
    created
        ISO 8601 time; no clock is read here.

    Raises
    ------
    PosstatsError
        If the results do not hold the orientation, or the profile does not suit the product.
    """
    by_name = {each.name: _sha256(each.content) for each in files}
    orientation = demand.orientation or best_orientation(results)
    occasion = Occasion(
        orientation_reason=Notice(code="asked" if demand.orientation else orientation),
        contract=demand.contract,
        language=demand.language,
        created=created,
        results_sha256=by_name[RESULTS],
    )
    listed = tuple(
        AttachedFile(file=each.name, sha256=by_name[each.name], relationship=each.relationship)
        for each in files
    )
    return _assembled(results, demand, orientation, occasion, listed)


def reassess(
    results: Results, profile_files: Mapping[str, bytes], stated: Acceptance
) -> Acceptance:
    """The acceptance again, from what a document embeds.

    Parameters
    ----------
    results
        The embedded results.
    profile_files
        The embedded profile and contract files by name, in the order of `stated`.
    stated
        The embedded acceptance: what was asked for is taken from it, nothing that was found.

    Raises
    ------
    PosstatsError
        As `assembled`, and if the files hold no requirement.
    """
    files = [ProfileFile(name, content) for name, content in profile_files.items()]
    profile, contract = profile_of_files(files)
    if profile is None:
        raise PosstatsError("the embedded profile holds no requirement")
    product = Product(**asdict(stated.product))
    demand = Demand(profile, contract, product, stated.orientation, stated.language)
    occasion = Occasion(
        orientation_reason=Notice(code=stated.orientation_reason.code),
        contract=contract,
        language=stated.language,
        created=stated.created,
        results_sha256=stated.results.sha256,
    )
    return _assembled(results, demand, stated.orientation, occasion, stated.attachments)


def _assembled(
    results: Results,
    demand: Demand,
    orientation: JudgedOrientation,
    occasion: Occasion,
    listed: tuple[AttachedFile, ...],
) -> Acceptance:
    found = evidence(results, orientation, demand.product)
    assessment = assess(found, demand.profile, demand.product, demand.language)
    values = acceptance_values(assessment, results, occasion)
    words = acceptance_words.words_of(values)
    worded = replace(
        values,
        versions=values.versions | {"weasyprint": version("weasyprint")},
        requirements=tuple(
            replace(row, reason=acceptance_words.reason(words, row)) for row in values.requirements
        ),
        statement=statement(assessment),
        attachments=listed,
    )
    return replace(worded, document_id=document_id(worded))


def statement(assessment: Assessment) -> str:
    """The standard's own wording with its numbers, or empty where it has none to say.

    It is in the language of the standard, whatever that of the document is.
    """
    return " ".join(_filled(each) for each in assessment.statements)


def _filled(chosen: ChosenStatement) -> str:
    class_m, found_m = chosen.class_m, chosen.found_m
    digits = _honest_digits(found_m, class_m)
    text = chosen.template.format(
        class_m="" if class_m is None else fmt.as_chosen(class_m),
        class_cm="" if class_m is None else fmt.as_chosen(100.0 * class_m),
        found_m="" if found_m is None else fmt.number(found_m, digits),
        found_cm="" if found_m is None else fmt.number(100.0 * found_m, digits),
        n_points=fmt.count(chosen.n_points),
    )
    return text if text.endswith((".", "。")) else f"{text}."


def _honest_digits(found_m: float | None, class_m: float | None) -> int:
    """Significant digits with which a value within its class does not round beyond it."""
    if found_m is None or class_m is None or found_m > class_m:
        return 3
    return next((n for n in range(3, 10) if float(f"{found_m:.{n}g}") <= class_m), 10)


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
