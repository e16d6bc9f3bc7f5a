"""Tables of vertical parallax: by strip, by model, by angle held, by angle corrected."""

from collections.abc import Sequence

from ..document import format as fmt
from ..document.table import (
    Column,
    Table,
    aligned_column,
    count_column,
    number_column,
    text_column,
)
from .view import (
    FIXED,
    METHODS,
    Results,
    Row,
    first,
    mean_over_models,
    orientation_label,
    rows,
    strips,
    strips_with_models,
)

SHOWN_MODELS = 15


def by_strip(results: Results, unit: str) -> Table:
    """Maximum, minimum and mean parallax of the strips in one unit (``px`` or ``mm``)."""
    kept = strips_with_models(results)
    columns = [text_column("Strip", [*kept, "block"])]
    n_models = [first(results, "parallax", strip=s).get("n_models") for s in kept]
    columns.append(count_column("Models", [*n_models, sum(fmt.present(n_models))]))
    for method, words in METHODS.items():
        part = [first(results, "parallax", strip=s, method=method) for s in kept]
        if any(not fmt.is_missing(row.get("mean_px")) for row in part):
            columns += _extremes(part, unit, words)
    place = "on the image, " if unit == "px" else "at image scale, "
    caption = (
        f"Vertical parallax by strip {place}{unit}: maximum, minimum and mean over the stereo "
        "models of a strip of the RMS parallax of a model."
    )
    notes = (
        "Independent: both images turn, the base stays. Dependent: the right image turns and "
        "moves, the left stays. Both leave the same parallax up to rounding and rejected points.",
    )
    return Table(f"parallax_{unit}", caption, tuple(columns), notes, frozenset({len(kept)}))


def _extremes(part: Sequence[Row], unit: str, words: str) -> list[Column]:
    values = {name: [row.get(f"{name}_{unit}") for row in part] for name in ("max", "min", "mean")}
    block = {
        "max": max(fmt.present(values["max"]), default=None),
        "min": min(fmt.present(values["min"]), default=None),
        "mean": mean_over_models(part, f"mean_{unit}"),
    }
    decimals = fmt.shared_decimals([v for column in values.values() for v in column])
    return [
        Column(
            name,
            tuple(fmt.fixed(value, decimals) for value in [*column, block[name]]),
            unit,
            group=words,
        )
        for name, column in values.items()
    ]


def by_model(results: Results) -> Table:
    """The models of largest POS parallax (all, if there are few; then without a solution last)."""
    models = rows(results, "models")
    ranked = sorted(
        models, key=lambda m: -(m["pos_px"] if m["pos_px"] is not None else float("-inf"))
    )
    shown = ranked if len(models) <= 2 * SHOWN_MODELS else ranked[:SHOWN_MODELS]
    which = (
        "every stereo model" if len(shown) == len(models)
        else f"the {len(shown)} of {len(models)} stereo models with the largest POS parallax"
    )  # fmt: skip
    columns = (
        text_column("Left image", [m["left"] for m in shown]),
        text_column("Right image", [m["right"] for m in shown]),
        text_column("Strip", [m["strip"] for m in shown]),
        count_column("Points", [m["n_points"] for m in shown]),
        count_column("Rejected", [m["n_rejected"] for m in shown]),
        aligned_column("POS", "px", [m["pos_px"] for m in shown]),
        aligned_column("Corrected", "px", [m["corrected_px"] for m in shown]),
        aligned_column("Relative", "px", [m["independent_px"] for m in shown]),
    )
    caption = (
        f"RMS vertical parallax of {which}: from the POS as delivered, after the selected "
        "correction, and after (independent) relative orientation. All models: tables/models.csv."
    )
    notes = (
        "POS and corrected: all points. Relative: the points that the robust orientation kept; "
        "Rejected: the others.",
        f"{fmt.MISSING}: fewer than six points in common, or no solution.",
    )
    return Table("models", caption, columns, notes)


def error_sources(results: Results) -> Table:
    """Mean parallax per strip with POS angles of the right image held."""
    return _per_strip(
        results, "error_sources", "fixed", FIXED,
        "Error sources: mean RMS vertical parallax of the strips after relative orientation in "
        "which the named POS angles of the right image are held fixed, px.",
    )  # fmt: skip


def corrected(results: Results) -> Table:
    """Mean parallax per strip after the correction of each angle alone and of the selected set."""
    names = ("omega", "phi", "kappa", "selected")
    present = {row["corrected"] for row in rows(results, "corrected_parallax")}
    words = {n: orientation_label(results, n) for n in names if n in present}
    words |= {n: orientation_label(results, n) for n in sorted(present - set(names))}
    table = _per_strip(
        results, "corrected_parallax", "corrected", words,
        "Mean RMS vertical parallax of the strips from the POS as delivered, after the correction "
        "of each angle alone, after the selected corrections, and after relative orientation, px.",
    )  # fmt: skip
    kept = _strips_in(results, "corrected_parallax")
    raw = [first(results, "parallax", strip=s, method="pos").get("mean_px") for s in kept]
    free = [first(results, "parallax", strip=s, method="independent").get("mean_px") for s in kept]
    columns = (
        table.columns[0],
        number_column("POS as delivered", "px", raw),
        *table.columns[1:],
        number_column("relative orientation", "px", free),
    )
    return Table(table.name, table.caption, columns, table.notes)


def _per_strip(results: Results, key: str, name: str, words: dict[str, str], caption: str) -> Table:
    kept = _strips_in(results, key)
    columns = [text_column("Strip", kept)]
    for value, title in words.items():
        means = [first(results, key, strip=s, **{name: value}).get("mean_px") for s in kept]
        columns.append(number_column(title, "px", means))
    return Table(key, caption, tuple(columns), _left_out(results, kept))


def _strips_in(results: Results, key: str) -> list[str]:
    """Strips with at least one value; strips without a model would be rows of dashes."""
    known = {row["strip"] for row in rows(results, key) if not fmt.is_missing(row.get("mean_px"))}
    return [strip for strip in strips(results) if strip in known]


def _left_out(results: Results, kept: Sequence[str]) -> tuple[str, ...]:
    others = [strip for strip in strips(results) if strip not in kept]
    if not others:
        return ()
    return (f"Without a stereo model of six or more points: strip {fmt.joined(others)}.",)
