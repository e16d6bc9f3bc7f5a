"""Data of an acceptance in words of its catalogue: requirements, reasons, orientation, product."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from posstats.contract.acceptance import Acceptance, JudgedRequirement, StatedProduct
from posstats.contract.notice import Value

from ..document import format as fmt
from ..document import words as document
from ..document.catalogue import catalogue
from . import units
from .units import Lengths

SIGNS = {"accepted": "✓", "rejected": "✗", "not assessable": "?",
         "pass": "✓", "fail": "✗", "not assessed": "?"}  # fmt: skip
DOMAINS = ("document", "notices", "acceptance")
NAMED = 3  # requirements named in the verdict
IN_A_LINE = ("class_h_m", "class_v_m", "map_scale", "gsd_m", "terrain")


@dataclass(frozen=True)
class Words(document.Words):
    """The catalogue of an acceptance document with its unit of length."""

    unit: Lengths

    def marked(self, family: str, key: str) -> str:
        """A verdict with its sign, so that it is never told by colour alone."""
        return f"{SIGNS[key]}\u00a0{self.of(family, key)}"

    def orientation(self, name: str) -> str:
        """An orientation in words."""
        return self.known("orientation", name)

    def requirements(self, rows: Sequence[JudgedRequirement]) -> list[str]:
        """Names of requirements; those of one quantity are told apart by their ids."""
        times = Counter(row.quantity for row in rows)
        names = [self.of("quantity", row.quantity) for row in rows]
        return [
            self.text("quantity_with_id", name=name, id=row.id)
            if times[row.quantity] > 1 else name
            for name, row in zip(names, rows, strict=True)
        ]  # fmt: skip

    def listed(self, names: Sequence[str], most: int | None = None) -> str:
        """Names in the middle of a sentence: without capitals, no more of them than wanted."""
        small = [n[:1].lower() + n[1:] if n[1:2].islower() else n for n in names]
        return self.first(small, len(small) if most is None else most, sentence=True)


def words_of(acceptance: Acceptance) -> Words:
    """The words that fit an acceptance."""
    return Words(catalogue(acceptance.language, *DOMAINS), units.lengths(acceptance))


def reason(words: Words, row: JudgedRequirement) -> str:
    """Why a requirement has its verdict."""
    code = row.reason_code
    if code in {"within", "exceeds", "investigate"} and row.quantity in units.AT_LEAST:
        code = f"{code} at least"
    found, limit = units.pair(row, words.unit)
    values = {name: _put(words, name, value) for name, value in row.reason_values.items()}
    return words.catalogue.of("reason", code, **values | {"found": found, "limit": limit})


def is_borderline(row: JudgedRequirement) -> bool:
    """Whether the interval of the found value includes the limit."""
    if row.low is None or row.limit is None or row.high is None:
        return False
    return row.low <= row.limit <= row.high


def evidence(words: Words, row: JudgedRequirement) -> str:
    """The reason of a requirement's verdict, and what would decide it if it is a near thing."""
    said = [reason(words, row)]
    if is_borderline(row):
        said.append(words.text("evidence.borderline"))
        said.append(
            words.text("evidence.points", n=fmt.count(row.n_to_decide)) if row.n_to_decide
            else words.text("evidence.undecidable")
        )  # fmt: skip
    if row.score is not None:
        said.append(words.text("evidence.score", score=fmt.fixed(row.score, 1)))
    return words.sentences(said)


def summary(words: Words, rows: Sequence[JudgedRequirement]) -> str:
    """The verdict in a sentence: how many requirements are met, which are not."""
    named: dict[str, list[str]] = {"pass": [], "fail": [], "open": [], "optional": []}
    for name, row in zip(words.requirements(rows), rows, strict=True):
        unsettled = "open" if row.mandatory else "optional"
        named[unsettled if row.verdict == "not assessed" else row.verdict].append(name)
    total = fmt.count(len(rows))
    all_met = len(named["pass"]) == len(rows) - len(named["optional"])
    said = [
        words.counted(f"summary.{kind}", len(some), names=words.listed(some, NAMED), total=total)
        for kind, some in named.items()
        if some and (kind != "pass" or all_met)
    ]
    return words.sentences(said) or words.text("summary.none")


def product(words: Words, stated: StatedProduct) -> list[tuple[str, str]]:
    """What the product has to be: names and values of what is stated."""
    return [(words.of("product", name), value) for name, value in _stated(words, stated).items()]


def classes(words: Words, stated: StatedProduct) -> str:
    """The class of the product in a line, or empty."""
    values = _stated(words, stated)
    said = [words.of("class", name, value=values[name]) for name in IN_A_LINE if name in values]
    return words.text("list.between").join(said)


def scale(denominator: float) -> str:
    """A map scale: ``1:10 000``, with thousands apart from 1:1 000 on."""
    return f"1:{denominator:,.0f}".replace(",", fmt.NARROW_SPACE)


def _stated(words: Words, stated: StatedProduct) -> dict[str, str]:
    """What is stated of a product, as text by its names."""
    values = {
        "class_h_m": _chosen(words, stated.class_h_m),
        "class_v_m": _chosen(words, stated.class_v_m),
        "gsd_m": _chosen(words, stated.gsd_m),
        "map_scale": None if stated.map_scale is None else scale(stated.map_scale),
        "terrain": None if stated.terrain is None else words.of("terrain", stated.terrain),
        "lot_size": _counted(stated.lot_size),
        "sample_size": _counted(stated.sample_size),
        "survey_sigma_h_m": _chosen(words, stated.survey_sigma_h_m),
        "survey_sigma_v_m": _chosen(words, stated.survey_sigma_v_m),
    }
    return {name: text for name, text in values.items() if text is not None}


def _chosen(words: Words, length_m: float | None) -> str | None:
    """A length that somebody chose."""
    if length_m is None:
        return None
    unit = words.unit.unit
    return f"{fmt.as_chosen(unit.per_si * length_m)}\u00a0{unit.name}"


def _counted(n: int | None) -> str | None:
    return None if n is None else fmt.count(n)


def _put(words: Words, name: str, value: Value) -> str:
    """A value of a reason as text: codes by their family, numbers by what they are."""
    if isinstance(value, str):
        if name == "name":
            return words.known("product_name", value)
        return words.known(name, value) if name in {"quantity", "orientation"} else value
    if isinstance(value, float):
        return fmt.fixed(value, 2) if name == "ratio" else fmt.number(value)
    return fmt.MISSING if value is None else str(value)
