"""The first page: what was judged by what, the verdict, key figures, parties."""

from posstats.contract.acceptance import Acceptance, JudgedRequirement

from ..document import format as fmt
from ..document.front import Fact, Front, Signature, Verdict
from ..document.key_figure import KeyFigure
from . import units
from . import words as wording
from .requirements import short_table
from .words import Words

KEYS = (("rmse_h", "product_rmse_h"), ("rmse_v", "product_rmse_v"), ("n_check_points",))


def front(words: Words, acceptance: Acceptance) -> Front:
    """All that stands before the topics."""
    return Front(
        language=acceptance.language,
        title=words.text("document.title"),
        subject=acceptance.contract.title or acceptance.block.name,
        subtitle=_delivered(words, acceptance),
        mark=words.text("mark.simulated") if acceptance.block.simulated else "",
        created=_date(acceptance),
        version=acceptance.posstats_version,
        document_id=acceptance.document_id,
        identity=_identity(words, acceptance),
        verdict=_verdict(words, acceptance),
        basis=_basis(words, acceptance),
        statement=acceptance.statement,
        facts=_facts(words, acceptance),
        key_figures=_key_figures(words, acceptance),
        short=short_table(words, acceptance.requirements),
        signatures=_signatures(words, acceptance),
    )


def _date(acceptance: Acceptance) -> str:
    return acceptance.created.partition("T")[0]


def _delivered(words: Words, acceptance: Acceptance) -> str:
    """The block with what it consists of."""
    block = acceptance.block
    counts = {"n_images": block.n_images, "n_strips": block.n_strips, "n_models": block.n_models,
              "n_check_points": block.n_check_points}  # fmt: skip
    counted = [words.counted(f"delivered.{name}", n) for name, n in counts.items()]
    return words.text("delivered.between").join([block.name, *counted])


def _verdict(words: Words, acceptance: Acceptance) -> Verdict:
    return Verdict(
        kind=acceptance.verdict.replace(" ", "-"),
        sign=wording.SIGNS[acceptance.verdict],
        word=words.of("verdict", acceptance.verdict),
        summary=wording.summary(words, acceptance.requirements),
    )


def _basis(words: Words, acceptance: Acceptance) -> tuple[Fact, ...]:
    """Standard, class, and the orientation with the reason for it."""
    profile = acceptance.profile
    standard = (
        words.text("basis.edition", title=profile.title, edition=profile.edition)
        if profile.edition else profile.title
    )  # fmt: skip
    orientation = words.text(
        "basis.orientation_and_reason",
        orientation=words.orientation(acceptance.orientation),
        reason=words.of("orientation_reason", acceptance.orientation_reason.code),
    )
    said = {
        "standard": standard,
        "class": wording.classes(words, acceptance.product),
        "orientation": orientation,
    }
    return tuple(Fact(words.of("basis", key), value) for key, value in said.items() if value)


def _identity(words: Words, acceptance: Acceptance) -> tuple[Fact, ...]:
    stated = {"document_id": acceptance.document_id, "created": _date(acceptance)}
    return tuple(Fact(words.of("fact", key), value) for key, value in stated.items() if value)


def _facts(words: Words, acceptance: Acceptance) -> tuple[Fact, ...]:
    contract = acceptance.contract
    stated = {
        "number": contract.number,
        "client": contract.client,
        "contractor": contract.contractor,
        "inspector": contract.inspector,
        "flight": contract.flight,
        "flight_date": contract.flight_date,
        "sensor": contract.sensor,
        "place": contract.place,
        "remarks": contract.remarks,
    }
    return tuple(Fact(words.of("fact", key), value) for key, value in stated.items() if value)


def _signatures(words: Words, acceptance: Acceptance) -> tuple[Signature, ...]:
    contract = acceptance.contract
    parties = {
        "inspector": contract.inspector,
        "contractor": contract.contractor,
        "client": contract.client,
    }
    return tuple(Signature(words.of("party", role), name) for role, name in parties.items())


def _key_figures(words: Words, acceptance: Acceptance) -> tuple[KeyFigure, ...]:
    """The first requirement of each kind that has a value."""
    rows = {row.quantity: row for row in reversed(acceptance.requirements)}
    figures = []
    for quantities in KEYS:
        row = next((rows[quantity] for quantity in quantities if quantity in rows), None)
        if row is not None and row.found is not None:
            figures.append(_key_figure(words, row))
    return tuple(figures)


def _key_figure(words: Words, row: JudgedRequirement) -> KeyFigure:
    number, _, unit = units.pair(row, words.unit)[0].partition("\u00a0")
    known = units.limit(row, words.unit)
    remark = "" if known == fmt.MISSING else words.text("key.limit", limit=known)
    return KeyFigure(words.of("quantity", row.quantity), number, unit, remark)
