"""Data of an acceptance in words of its catalogue: requirements, reasons, orientation, product."""

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from ..document import format as fmt
from ..document import words as document
from ..document.catalogue import catalogue
from . import units
from .units import Lengths, Row

SIGNS = {"accepted": "✓", "rejected": "✗", "not assessable": "?",
         "pass": "✓", "fail": "✗", "not assessed": "?"}  # fmt: skip
DOMAINS = ("document", "notices", "acceptance")
NAMED = 3  # requirements named in the verdict
PRODUCT = ("class_h_m", "class_v_m", "gsd_m", "map_scale", "terrain", "lot_size", "sample_size",
           "survey_sigma_h_m", "survey_sigma_v_m")  # fmt: skip


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

    def requirements(self, rows: Sequence[Row]) -> list[str]:
        """Names of requirements; those of one quantity are told apart by their ids."""
        times = Counter(row["quantity"] for row in rows)
        names = [self.of("quantity", row["quantity"]) for row in rows]
        return [
            self.text("quantity_with_id", name=name, id=row["id"])
            if times[row["quantity"]] > 1 else name
            for name, row in zip(names, rows, strict=True)
        ]  # fmt: skip

    def listed(self, names: Sequence[str], most: int | None = None) -> str:
        """Names in the middle of a sentence: without capitals, no more of them than wanted."""
        small = [n[:1].lower() + n[1:] if n[1:2].islower() else n for n in names]
        if most is None or len(small) <= most:
            return self.catalogue.joined(small)
        more = self.text("list.more", n=fmt.count(len(small) - most))
        return self.catalogue.joined([*small[:most], more])


def words_of(acceptance: Mapping[str, Any]) -> Words:
    """The words that fit an acceptance."""
    return Words(catalogue(acceptance["language"], *DOMAINS), units.lengths(acceptance))


def reason(words: Words, row: Row) -> str:
    """Why a requirement has its verdict.

    Parameters
    ----------
    words
        Of the document.
    row
        The requirement, with ``reason_code`` and ``reason_values``.
    """
    code = row["reason_code"]
    if code in {"within", "exceeds", "investigate"} and row["quantity"] in units.AT_LEAST:
        code = f"{code} at least"
    found, limit = units.pair(row, words.unit)
    values = {"found": found, "limit": limit}
    for name, value in (row.get("reason_values") or {}).items():
        if name not in values:
            values[name] = _put(words, name, value)
    return words.catalogue.of("reason", code, **values)


def reasons(acceptance: Mapping[str, Any]) -> list[str]:
    """The reason of every requirement, for ``acceptance.json``."""
    words = words_of(acceptance)
    return [reason(words, row) for row in acceptance["requirements"]]


def is_borderline(row: Row) -> bool:
    """Whether the interval of the found value includes the limit."""
    low, limit, high = row.get("low"), row.get("limit"), row.get("high")
    return low is not None and limit is not None and high is not None and low <= limit <= high


def evidence(words: Words, row: Row) -> str:
    """The reason of a requirement's verdict, and what would decide it if it is a near thing."""
    said = [reason(words, row)]
    if is_borderline(row):
        said.append(words.text("evidence.borderline"))
        n = row.get("n_to_decide")
        said.append(
            words.text("evidence.points", n=fmt.count(n)) if n
            else words.text("evidence.undecidable")
        )  # fmt: skip
    if row.get("score") is not None:
        said.append(words.text("evidence.score", score=fmt.fixed(row["score"], 1)))
    return words.text("sentence.between").join(said)


def summary(words: Words, acceptance: Mapping[str, Any]) -> str:
    """The verdict in a sentence: how many requirements are met, which are not."""
    rows = acceptance["requirements"]
    names = words.requirements(rows)
    part = {
        "pass": [n for n, r in zip(names, rows, strict=True) if r["verdict"] == "pass"],
        "fail": [n for n, r in zip(names, rows, strict=True) if r["verdict"] == "fail"],
        "open": [n for n, r in zip(names, rows, strict=True)
                 if r["verdict"] == "not assessed" and r["mandatory"]],
        "optional": [n for n, r in zip(names, rows, strict=True)
                     if r["verdict"] == "not assessed" and not r["mandatory"]],
    }  # fmt: skip
    total = fmt.count(len(rows))
    said = [
        words.counted(f"summary.{kind}", len(some), names=words.listed(some, NAMED), total=total)
        for kind, some in part.items()
        if some and (kind != "pass" or len(some) == len(rows) - len(part["optional"]))
    ]
    return words.text("sentence.between").join(said) or words.text("summary.none")


def orientation_reason(words: Words, acceptance: Mapping[str, Any]) -> str:
    """Why this orientation was assessed."""
    return words.of("orientation_reason", acceptance["orientation_reason"]["code"])


def product(words: Words, acceptance: Mapping[str, Any]) -> list[tuple[str, str]]:
    """What the product has to be: names and values of what is stated."""
    stated = acceptance["product"]
    return [
        (words.text(f"product.{key}"), _product_value(words, key, stated[key]))
        for key in PRODUCT
        if stated.get(key) not in (None, "")
    ]


def classes(words: Words, acceptance: Mapping[str, Any]) -> str:
    """The class of the product in a line, or empty."""
    stated = acceptance["product"]
    said = [
        words.text(f"class.{key}", value=_product_value(words, key, stated[key]))
        for key in ("class_h_m", "class_v_m", "map_scale", "gsd_m", "terrain")
        if stated.get(key) not in (None, "")
    ]
    return words.text("list.between").join(said)


def scale(denominator: float) -> str:
    """A map scale: ``1:10 000``, with thousands apart from 1:1 000 on."""
    return f"1:{denominator:,.0f}".replace(",", fmt.NARROW_SPACE)


def _product_value(words: Words, key: str, value: Any) -> str:
    if key.endswith("_m"):
        unit = words.unit.unit
        return f"{fmt.as_chosen(unit.per_si * value)}\u00a0{unit.name}"
    if key == "map_scale":
        return scale(value)
    return words.known("terrain", value) if key == "terrain" else fmt.count(value)


def _put(words: Words, name: str, value: Any) -> str:
    """A value of a reason as text."""
    forms: dict[str, Callable[[Any], str]] = {
        "quantity": lambda key: words.known("quantity", key),
        "orientation": words.orientation,
        "name": lambda key: words.known("product_name", key),
        "scale": scale,
        "scales": lambda many: words.catalogue.joined(scale(each) for each in many),
        "ratio": lambda number: fmt.fixed(number, 2),
    }
    if value is None:
        return fmt.MISSING
    if name in forms:
        return forms[name](value)
    return fmt.number(value) if isinstance(value, float) else str(value)
