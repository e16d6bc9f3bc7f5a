"""The acceptance document: its front and its topics."""

from collections.abc import Mapping
from typing import Any

from posstats.contract.results import Results

from ..document import format as fmt
from ..document.front import Fact, Signature, Verdict
from ..document.key_figure import KeyFigure
from ..document.numbering import ReportDocument, numbered
from . import tables, units
from . import words as wording
from .figures import draw
from .sections import parts
from .words import Words

PARTIES = ("inspector", "contractor", "client")
STATED = ("title", "number", "client", "contractor", "inspector", "flight", "flight_date", "sensor",
          "place", "remarks")  # fmt: skip
COUNTED = ("n_images", "n_strips", "n_models", "n_check_points")
KEYS = (("rmse_h", "product_rmse_h"), ("rmse_v", "product_rmse_v"), ("n_check_points",))


def build(acceptance: Mapping[str, Any], results: Results, unshown: str = "") -> ReportDocument:
    """Make the document.

    Parameters
    ----------
    acceptance
        The dictionary of ``acceptance.json``.
    results
        What the analysis found.
    unshown
        Characters that no typeface at hand can show.
    """
    words = wording.words_of(acceptance)
    drawings = draw(words, acceptance, results)
    _, sections = numbered((), parts(words, acceptance, results, drawings, unshown))
    contract, block = acceptance["contract"], acceptance["block"]
    return ReportDocument(
        language=acceptance["language"],
        title=words.text("document.title"),
        subject=str(contract.get("title") or block["name"]),
        subtitle=_delivered(words, block),
        mark=words.text("mark.simulated") if block["simulated"] else "",
        created=_date(acceptance),
        version=str(acceptance["posstats_version"]),
        document_id=str(acceptance["document_id"]),
        identity=_identity(words, acceptance),
        verdict=_verdict(words, acceptance),
        basis=_basis(words, acceptance),
        statement=str(acceptance["statement"] or ""),
        facts=_facts(words, acceptance),
        key_figures=_key_figures(words, acceptance),
        short=tables.requirements_in_short(words, acceptance),
        sections=sections,
        signatures=tuple(
            Signature(words.text(f"party.{party}"), str(contract.get(party) or ""))
            for party in PARTIES
        ),
    )


def _date(acceptance: Mapping[str, Any]) -> str:
    return str(acceptance.get("created") or "").partition("T")[0]


def _delivered(words: Words, block: Mapping[str, Any]) -> str:
    counted = [
        words.counted(f"delivered.{key}", block[key])
        for key in COUNTED
        if block.get(key) is not None
    ]
    return words.text("delivered.between").join([str(block["name"]), *counted])


def _verdict(words: Words, acceptance: Mapping[str, Any]) -> Verdict:
    verdict = acceptance["verdict"]
    return Verdict(
        kind=verdict.replace(" ", "-"),
        sign=wording.SIGNS[verdict],
        word=words.of("verdict", verdict),
        summary=wording.summary(words, acceptance),
    )


def _basis(words: Words, acceptance: Mapping[str, Any]) -> tuple[Fact, ...]:
    """Standard, class, and the orientation with the reason for it."""
    profile = acceptance["profile"]
    standard = words.text("basis.edition", title=str(profile["title"]),
                          edition=str(profile["edition"]))  # fmt: skip
    orientation = words.text("basis.orientation_and_reason",
                             orientation=words.orientation(acceptance["orientation"]),
                             reason=wording.orientation_reason(words, acceptance))  # fmt: skip
    said = (("standard", standard if profile["edition"] else str(profile["title"])),
            ("class", wording.classes(words, acceptance)),
            ("orientation", orientation))  # fmt: skip
    return tuple(Fact(words.text(f"basis.{key}"), value) for key, value in said if value)


def _identity(words: Words, acceptance: Mapping[str, Any]) -> tuple[Fact, ...]:
    stated = (("document_id", acceptance["document_id"]), ("created", _date(acceptance)))
    return tuple(Fact(words.text(f"fact.{key}"), str(value)) for key, value in stated if value)


def _facts(words: Words, acceptance: Mapping[str, Any]) -> tuple[Fact, ...]:
    contract = acceptance["contract"]
    stated = [(key, contract.get(key)) for key in STATED if key != "title"]
    return tuple(Fact(words.text(f"fact.{key}"), str(value)) for key, value in stated if value)


def _key_figures(words: Words, acceptance: Mapping[str, Any]) -> tuple[KeyFigure, ...]:
    """The first requirement of each kind that has a value."""
    rows = {row["quantity"]: row for row in reversed(acceptance["requirements"])}
    figures = []
    for quantities in KEYS:
        row = next((rows[q] for q in quantities if q in rows), None)
        if row is not None and not fmt.is_missing(row["found"]):
            figures.append(_key_figure(words, row))
    return tuple(figures)


def _key_figure(words: Words, row: Mapping[str, Any]) -> KeyFigure:
    number, _, unit = units.pair(row, words.unit)[0].partition("\u00a0")
    known = units.limit(row, words.unit)
    remark = "" if known == fmt.MISSING else words.text("key.limit", limit=known)
    return KeyFigure(words.of("quantity", row["quantity"]), number, unit, remark)
