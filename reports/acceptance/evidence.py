"""Tables of the evidence behind an acceptance: check points, parallax, regression, decisions."""

from collections.abc import Mapping, Sequence
from typing import Any

from posstats.acceptance.evidence import PARALLAX_KEYS

from ..block.view import Results, Row, decided_by_strip, first, rows, setting, strips_with_models
from ..document import format as fmt
from ..document.table import (
    Column,
    Table,
    count_column,
    number_column,
    p_column,
    prose_column,
    text_column,
)
from . import units
from .words import Words

RELATIVE = "independent_px"
SHOWN_DECISIONS = 40
_DIFFERENCES = (("ΔX", "dx_m"), ("ΔY", "dy_m"), ("ΔZ", "dz_m"), ("ΔH", "dh_m"))


def check_points(words: Words, acceptance: Mapping[str, Any]) -> Table:
    """Every check point with its coordinates, differences and the accuracy of its survey."""
    points = acceptance["check_points"]
    columns = (
        text_column(words.text("column.point"), [p["point"] for p in points]),
        *(
            Column(title, tuple(fmt.fixed(p[key], 2) for p in points), "m",
                   group=words.text("group.given"))
            for title, key in (("X", "x_m"), ("Y", "y_m"), ("Z", "z_m"))
        ),
        *_differences(words, points),
        *_survey(words, points),
        count_column(words.text("column.rays"), [p["n_rays"] for p in points]),
        text_column(words.text("column.remark"), [_remark(words, p) for p in points]),
    )  # fmt: skip
    notes = (words.text("note.check_points"), words.text("note.check_point_survey"))
    return Table("check_points", words.text("table.check_points"), columns, notes)


def parallax_by_strip(words: Words, results: Results, orientation: str) -> Table:
    """Vertical parallax of the strips: POS, assessed orientation, relative orientation."""
    kept = strips_with_models(results)
    models = {strip: rows(results, "models", strip=strip) for strip in kept}
    columns = [
        text_column(words.text("column.strip"), [*kept, words.text("row.block")]),
        count_column(words.text("column.models"),
                     [*(len(part) for part in models.values()), len(rows(results, "models"))]),
    ]  # fmt: skip
    series = parallax_series(words, results, orientation)
    for key, title in series:
        every = [m[key] for m in rows(results, "models")]
        columns += _parallax(words, [*([m[key] for m in models[s]] for s in kept), every], title)
    notes = [words.text("note.parallax")]
    if PARALLAX_KEYS[orientation] not in dict(series):
        notes.append(
            words.text("note.parallax_missing", orientation=words.orientation(orientation))
        )
    strong = frozenset({len(kept)})
    return Table("parallax", words.text("table.parallax"), tuple(columns), tuple(notes), strong)


def parallax_series(words: Words, results: Results, orientation: str) -> list[tuple[str, str]]:
    """Keys of the models' parallax and their titles: POS, assessed if known, relative."""
    keys = {"pos_px": words.orientation("pos")}
    assessed = PARALLAX_KEYS[orientation]
    if fmt.present(m.get(assessed) for m in rows(results, "models")):
        keys[assessed] = words.orientation(orientation)
    keys[RELATIVE] = words.text("orientation.relative")
    return list(keys.items())


def regression(words: Words, results: Results) -> Table:
    """Lines of the angle errors over time, for the block (or the strips decided by)."""
    kept = _regressions(results)
    unit = fmt.rate_unit(
        row[key] for row in kept for key in ("slope_rad_per_s", "gls_slope_rad_per_s")
    )
    columns = (
        text_column(words.text("column.angle"), [words.known("angle", r["angle"]) for r in kept]),
        text_column(words.text("column.scope"), [_scope(words, r["scope"]) for r in kept]),
        count_column(words.text("column.images"), [r["n"] for r in kept]),
        number_column(words.text("column.slope"), unit.name,
                      [unit.scaled(r["slope_rad_per_s"]) for r in kept], group="OLS"),
        Column("R²", tuple(fmt.fixed(r["r_squared"], 3) for r in kept), group="OLS"),
        p_column("p", [r["p_value"] for r in kept], "OLS"),
        number_column(words.text("column.slope"), unit.name,
                      [unit.scaled(r["gls_slope_rad_per_s"]) for r in kept], group="GLS"),
        _slope_interval(words, kept, unit),
        p_column("p", [r["gls_p_value"] for r in kept], "GLS"),
    )  # fmt: skip
    return Table("regression", words.text("table.regression"), columns,
                 (words.text("note.regression"),))  # fmt: skip


def decisions(words: Words, results: Results) -> Table:
    """Which angle errors were taken off before the assessment."""
    chosen = rows(results, "selection")
    if decided_by_strip(results):
        chosen = [row for row in chosen if row["correct"]]
    shown = chosen[:SHOWN_DECISIONS]
    fits = [first(results, "regression", angle=r["angle"], frame=r["frame"],
                  scope=r.get("scope") or "block") for r in shown]  # fmt: skip
    columns = (
        text_column(words.text("column.angle"), [words.known("angle", r["angle"]) for r in shown]),
        text_column(words.text("column.frame"), [words.known("frame", r["frame"]) for r in shown]),
        text_column(words.text("column.scope"),
                    [_scope(words, r.get("scope") or "block") for r in shown]),
        Column("R²", tuple(fmt.fixed(fit.get("r_squared"), 3) for fit in fits)),
        p_column("p", [_decisive_p(*both) for both in zip(shown, fits, strict=True)]),
        text_column(words.text("column.decision"), [words.of("form", r["form"]) for r in shown]),
    )  # fmt: skip
    notes = [words.text("note.decisions", rules=_rules(words, results))]
    if len(shown) < len(chosen):
        notes.append(words.text("note.decisions_shown", shown=fmt.count(len(shown)),
                                total=fmt.count(len(chosen))))  # fmt: skip
    strong = frozenset(k for k, row in enumerate(shown) if row["correct"])
    strong = strong if len(strong) < len(shown) else frozenset()
    return Table("decisions", words.text("table.decisions"), columns, tuple(notes), strong)


def observability(words: Words, results: Results) -> Table:
    """What the tie points leave open; scopes of which the same is to be said share a row."""
    scopes: dict[tuple[str, int], list[str]] = {}
    for row in rows(results, "observability"):
        open_rotations = row.get("rotations") or row["unobservable"]  # words in earlier files
        if open_rotations:
            motions = words.joined(words.known("rotation", each) for each in open_rotations)
            scopes.setdefault((motions, len(row["images"])), []).append(_scope(words, row["scope"]))
    columns = (
        prose_column(words.text("column.scope"), map(words.catalogue.joined, scopes.values())),
        prose_column(words.text("column.unobservable"), [motions for motions, _ in scopes]),
        count_column(words.text("column.images_open"), [n for _, n in scopes]),
    )
    return Table("observability", words.text("table.observability"), columns)


def _differences(words: Words, points: Sequence[Row]) -> list[Column]:
    values = [p[key] for p in points for _, key in _DIFFERENCES]
    decimals = units.decimals_for(values, words.unit)
    unit = words.unit.unit
    return [
        Column(title, tuple(fmt.fixed(unit.scaled(p[key]), decimals) for p in points), unit.name,
               group=words.text("group.differences"))
        for title, key in _DIFFERENCES
    ]  # fmt: skip


def _survey(words: Words, points: Sequence[Row]) -> list[Column]:
    keys = (("column.plane", "survey_sigma_xy_m"), ("column.height", "survey_sigma_z_m"))
    values = [p[key] for p in points for _, key in keys]
    if not fmt.present(values):
        return []
    decimals, unit = units.decimals_for(values, words.unit), words.unit.unit
    return [
        Column(words.text(title), tuple(fmt.fixed(unit.scaled(p[key]), decimals) for p in points),
               unit.name, group=words.text("group.survey"))
        for title, key in keys
    ]  # fmt: skip


def _remark(words: Words, point: Row) -> str:
    if point["status"] != "ok":
        return words.known("status", point["status"])
    return words.text("status.blunder") if point["blunder"] else ""


def _parallax(
    words: Words, groups: Sequence[Sequence[float | None]], title: str
) -> tuple[Column, Column]:
    known = [fmt.present(part) for part in groups]
    means = [sum(part) / len(part) if part else None for part in known]
    largest = [max(part, default=None) for part in known]
    decimals = fmt.shared_decimals([*means, *largest])
    mean, most = (
        Column(words.text(name), tuple(fmt.fixed(value, decimals) for value in values), "px",
               group=title)
        for name, values in (("column.mean_of_models", means), ("column.largest", largest))
    )  # fmt: skip
    return mean, most


def _regressions(results: Results) -> list[Row]:
    by_strip = decided_by_strip(results)
    return [
        row for row in rows(results, "regression")
        if not row.get("reason") and (row["scope"] == "block" or by_strip)
    ][:SHOWN_DECISIONS]  # fmt: skip


def _slope_interval(words: Words, kept: Sequence[Row], unit: fmt.Unit) -> Column:
    bounds = [row.get("gls_slope_ci95") or (None, None) for row in kept]
    cells = tuple(
        words.interval(*(fmt.number(unit.scaled(each)) for each in both)) for both in bounds
    )
    return Column(words.text("column.interval"), cells, unit.name, group="GLS")


def _decisive_p(decision: Row, fit: Row) -> float | None:
    key = "gls_p_value" if decision.get("fit") == "gls" else "p_value"
    value: float | None = fit.get("constant_p_value" if decision["form"] == "constant" else key)
    return value


def _rules(words: Words, results: Results) -> str:
    return words.known("setting_value", setting(results, "rules", "paper"))


def _scope(words: Words, scope: str) -> str:
    return words.text("row.block") if scope == "block" else words.text("row.strip", strip=scope)
