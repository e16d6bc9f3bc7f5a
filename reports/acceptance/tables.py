"""Tables of the acceptance document on requirements, accuracy and provenance."""

from collections.abc import Mapping, Sequence
from typing import Any

from posstats.contract.files import as_values
from posstats.contract.results import Results

from ..document import format as fmt
from ..document.table import (
    Column,
    Table,
    count_column,
    p_column,
    pairs,
    prose_column,
    text_column,
)
from . import units
from .units import Row
from .words import Words, evidence, product

Acceptance = Mapping[str, Any]


def requirements_in_short(words: Words, acceptance: Acceptance) -> Table:
    """Name, found value, limit and verdict of every requirement, for the first page."""
    rows = acceptance["requirements"]
    columns = (
        text_column(words.text("column.requirement"), words.requirements(rows)),
        *_found_and_limit(words, rows),
        _verdicts(words, rows),
    )
    return Table("requirements_in_short", words.text("table.requirements_in_short"), columns)


def requirements(words: Words, acceptance: Acceptance) -> Table:
    """Every requirement in numbers."""
    rows, between = acceptance["requirements"], words.text("interval.between")
    columns = (
        text_column(words.text("column.clause"), [row["clause"] or None for row in rows]),
        text_column(words.text("column.requirement"), words.requirements(rows)),
        *_found_and_limit(words, rows),
        Column(words.text("column.margin"), tuple(units.margin(r, words.unit) for r in rows)),
        Column(words.text("column.interval"),
               tuple(units.interval(r, words.unit, between) for r in rows)),
        _verdicts(words, rows),
    )  # fmt: skip
    notes = [words.text("note.margin"), words.text("note.interval")]
    if not all(row["mandatory"] for row in rows):
        optional = [n for n, r in zip(words.requirements(rows), rows, strict=True)
                    if not r["mandatory"]]  # fmt: skip
        notes.append(words.text("note.optional", names=words.listed(optional)))
    return Table("requirements", words.text("table.requirements"), columns, tuple(notes))


def evidence_and_sources(words: Words, acceptance: Acceptance) -> Table:
    """Why each requirement has its verdict, and where its limit comes from."""
    rows = acceptance["requirements"]
    columns = (
        text_column(words.text("column.requirement"), words.requirements(rows)),
        prose_column(words.text("column.evidence"), [evidence(words, row) for row in rows]),
        prose_column(words.text("column.source"), [_source(words, row) for row in rows]),
    )
    return Table("evidence", words.text("table.evidence"), columns)


def rmse(words: Words, acceptance: Acceptance) -> Table:
    """RMSE of the check points with intervals, and of the product."""
    rows = acceptance["accuracy"]["rmse"]
    columns = (
        text_column(words.text("column.component"), [words.of("component", r["component"])
                                                     for r in rows]),
        _lengths(words, "column.rmse", [r["value_m"] for r in rows]),
        _intervals(words, rows),
        Column(words.text("column.df"), tuple(fmt.fixed(r["df"], 1) for r in rows)),
        _lengths(words, "column.product", [r["product_m"] for r in rows]),
        _measures(words, rows),
    )  # fmt: skip
    notes = (words.text("note.rmse"), words.text("note.product"))
    return Table("rmse", words.text("table.rmse"), columns, notes)


def mean_errors(words: Words, acceptance: Acceptance) -> Table:
    """Mean differences with their standard errors."""
    rows = acceptance["accuracy"]["mean_error"]
    columns = (
        text_column(words.text("column.component"), [words.of("component", r["component"])
                                                     for r in rows]),
        _lengths(words, "column.mean", [r["value_m"] for r in rows]),
        _lengths(words, "column.se", [r["se_m"] for r in rows]),
        p_column(words.text("column.p"), [r["p"] for r in rows]),
        _measures(words, rows),
    )  # fmt: skip
    note = words.text("note.mean")
    return Table("mean_errors", words.text("table.mean_errors"), columns, (note,))


def percentiles(words: Words, acceptance: Acceptance) -> Table:
    """Circular and linear errors at 90 % and 95 %."""
    rows = acceptance["accuracy"]["percentiles"]
    columns = (
        text_column(words.text("column.measure"), [r["name"] for r in rows]),
        text_column(words.text("column.meaning"), [words.of("percentile", r["name"])
                                                   for r in rows]),
        _lengths(words, "column.value", [r["value_m"] for r in rows]),
        _intervals(words, rows),
        _lengths(words, "column.normal", [r["normal_m"] for r in rows]),
        _measures(words, rows),
    )  # fmt: skip
    note = words.text("note.percentiles")
    return Table("percentiles", words.text("table.percentiles"), columns, (note,))


def significance(words: Words, acceptance: Acceptance) -> Table:
    """Tests on the differences, each with its null hypothesis in words."""
    rows = [_mean_shift(words, acceptance["accuracy"]["mean_shift"])]
    rows += [_normality(words, row) for row in acceptance["accuracy"]["normality"]]
    rows += [_largest(words, row) for row in acceptance["accuracy"]["largest_residual"]]
    names, null, statistic, p = zip(*rows, strict=True)
    columns = (
        text_column(words.text("column.test"), names),
        prose_column(words.text("column.null"), null),
        text_column(words.text("column.statistic"), statistic),
        p_column(words.text("column.p"), p),
    )
    return Table("tests", words.text("table.tests"), columns, (words.text("note.tests"),))


def product_and_contract(words: Words, acceptance: Acceptance) -> Table:
    """What was agreed: class, scale, lot and what else is stated of the product."""
    titles = words.text("column.item"), words.text("column.stated")
    return pairs("product", words.text("table.product"), titles, product(words, acceptance))


def files(words: Words, name: str, listed: Sequence[Row]) -> Table:
    """Files with their SHA-256; `name` is ``inputs``, ``rules`` or ``attachments``."""
    columns = [text_column(words.text("column.file"), [row["file"] for row in listed])]
    if name == "attachments":
        kinds = [words.known("relationship", row["relationship"]) for row in listed]
        columns.append(text_column(words.text("column.relationship"), kinds))
    columns.append(text_column("SHA-256", [row["sha256"] for row in listed]))
    return Table(f"{name}_files", words.text(f"table.{name}"), tuple(columns))


def software(words: Words, acceptance: Acceptance) -> Table:
    """Versions of the software."""
    listed = [(str(name), str(version)) for name, version in acceptance["versions"].items()]
    titles = words.text("column.package"), words.text("column.version")
    return pairs("software", words.text("table.software"), titles, listed)


def settings(words: Words, results: Results) -> Table:
    """Settings of the analysis that the acceptance rests on."""
    stated = as_values(results.settings)
    accuracies = {"position_m": ("m", 1.0), "angle_rad": ("mrad", 1e3), "image_px": ("px", 1.0)}
    shown = [
        (words.text(f"setting.{key}"), words.known("setting_value", str(stated[key])))
        for key in ("rules", "scope", "errors", "frame", "robust")
        if stated.get(key) is not None
    ]
    shown += [
        (words.text(f"setting.{key}"), fmt.with_unit(stated[key] * factor, unit))
        for key, (unit, factor) in accuracies.items()
        if stated.get(key) is not None
    ]
    titles = words.text("column.setting"), words.text("column.value")
    return pairs("settings", words.text("table.settings"), titles, shown)


def _found_and_limit(words: Words, rows: Sequence[Row]) -> tuple[Column, Column]:
    return (
        Column(words.text("column.found"), tuple(units.pair(r, words.unit)[0] for r in rows)),
        Column(words.text("column.limit"), tuple(units.limit(r, words.unit) for r in rows)),
    )


def _verdicts(words: Words, rows: Sequence[Row]) -> Column:
    said = [words.marked("finding", row["verdict"]) for row in rows]
    return text_column(words.text("column.verdict"), said)


def _lengths(words: Words, title: str, values_m: Sequence[float | None]) -> Column:
    cells = tuple(words.unit.number(value) for value in values_m)
    return Column(words.text(title), cells, words.unit.unit.name)


def _intervals(words: Words, rows: Sequence[Row]) -> Column:
    bounds = [(words.unit.number(r["low_m"]), words.unit.number(r["high_m"])) for r in rows]
    cells = tuple(words.interval(*both) for both in bounds)
    return Column(words.text("column.interval"), cells, words.unit.unit.name)


def _measures(words: Words, rows: Sequence[Row]) -> Column:
    return count_column(words.text("column.iso"), [row["iso_19157"] for row in rows])


def _source(words: Words, row: Row) -> str:
    formula = str(row.get("limit_formula") or "")
    if not any(letter.isalpha() for letter in formula):
        return str(row["source"])
    return words.text("source.with_formula", source=str(row["source"]), formula=formula)


def _mean_shift(words: Words, row: Row) -> tuple[str, str, str, float | None]:
    if row["p"] is None:
        statistic = words.known("untestable", str(row["reason"] or ""))
    else:
        statistic = words.text(
            "statistic.mean_shift", t2=fmt.number(row["t2"]), f=fmt.number(row["f"]),
            df1=fmt.count(row["df1"]), df2=fmt.count(row["df2"]),
        )  # fmt: skip
    return words.text("test.mean_shift"), words.text("null.mean_shift"), statistic, row["p"]


def _normality(words: Words, row: Row) -> tuple[str, str, str, float | None]:
    component = words.of("component", row["component"])
    statistic = (
        words.known("untestable", str(row["reason"] or "")) if row["p"] is None
        else words.text("statistic.normality", w=fmt.fixed(row["w"], 3))
    )  # fmt: skip
    null = words.text("null.normality", component=component)
    return words.text("test.normality", component=component), null, statistic, row["p"]


def _largest(words: Words, row: Row) -> tuple[str, str, str, float | None]:
    component = words.of("component", row["component"])
    statistic = (
        words.known("untestable", str(row["reason"] or "")) if row["p"] is None
        else words.text("statistic.largest", value=words.unit.text(row["value_m"]),
                        point=str(row["point"]))
    )  # fmt: skip
    null = words.text("null.largest", component=component)
    return words.text("test.largest", component=component), null, statistic, row["p"]
