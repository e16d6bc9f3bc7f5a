"""Tables of vertical parallax: by strip, by model, by angle held, by angle corrected."""

from collections.abc import Mapping, Sequence

from posstats.contract.results import Results, StripParallax

from ..document import format as fmt
from ..document.rows import first, rows
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
    StripMean,
    mean_over_models,
    orientation_label,
    strips,
    strips_with_models,
)

SHOWN_MODELS = 15


def by_strip(results: Results, unit: str) -> Table:
    """Maximum, minimum and mean parallax of the strips in one unit (``px`` or ``mm``)."""
    kept = strips_with_models(results)
    columns = [text_column("Strip", [*kept, "block"])]
    found = [first(results.parallax, strip=s) for s in kept]
    n_models = [row.n_models if row else None for row in found]
    columns.append(count_column("Models", [*n_models, sum(fmt.present(n_models))]))
    for method, words in METHODS.items():
        part = [first(results.parallax, strip=s, method=method) for s in kept]
        if any(row and not fmt.is_missing(row.mean_px) for row in part):
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


def _extremes(part: Sequence[StripParallax | None], unit: str, words: str) -> list[Column]:
    values = {
        name: [_number(row, f"{name}_{unit}") for row in part] for name in ("max", "min", "mean")
    }
    block = {
        "max": max(fmt.present(values["max"]), default=None),
        "min": min(fmt.present(values["min"]), default=None),
        "mean": mean_over_models(part, unit),
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


def _number(row: StripParallax | None, name: str) -> float | None:
    value: float | None = getattr(row, name, None)
    return value


def by_model(results: Results) -> Table:
    """The models of largest POS parallax (all, if there are few; then without a solution last)."""
    models = results.models
    ranked = sorted(models, key=lambda m: -(m.pos_px if m.pos_px is not None else float("-inf")))
    shown = ranked if len(models) <= 2 * SHOWN_MODELS else ranked[:SHOWN_MODELS]
    which = (
        "every stereo model" if len(shown) == len(models)
        else f"the {len(shown)} of {len(models)} stereo models with the largest POS parallax"
    )  # fmt: skip
    columns = (
        text_column("Left image", [m.left for m in shown]),
        text_column("Right image", [m.right for m in shown]),
        text_column("Strip", [m.strip for m in shown]),
        count_column("Points", [m.n_points for m in shown]),
        count_column("Rejected", [m.n_rejected for m in shown]),
        aligned_column("POS", "px", [m.pos_px for m in shown]),
        aligned_column("Corrected", "px", [m.corrected_px for m in shown]),
        aligned_column("Relative", "px", [m.independent_px for m in shown]),
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
        results, "error_sources",
        {words: rows(results.error_sources, fixed=name) for name, words in FIXED.items()},
        "Error sources: mean RMS vertical parallax of the strips after relative orientation in "
        "which the named POS angles of the right image are held fixed, px.",
    )  # fmt: skip


def corrected(results: Results) -> Table:
    """Mean parallax per strip after the correction of each angle alone and of the selected set."""
    names = ("omega", "phi", "kappa", "selected")
    present = {row.corrected for row in results.corrected_parallax}
    shown = [name for name in names if name in present]
    made = {
        orientation_label(name, results.verdict.corrected_angles): rows(
            results.corrected_parallax, corrected=name
        )
        for name in shown
    }
    table = _per_strip(
        results, "corrected_parallax", made,
        "Mean RMS vertical parallax of the strips from the POS as delivered, after the correction "
        "of each angle alone, after the selected corrections, and after relative orientation, px.",
    )  # fmt: skip
    kept = _strips_in(results, results.corrected_parallax)
    raw, free = (
        _means(kept, rows(results.parallax, method=method)) for method in ("pos", "independent")
    )
    columns = (
        table.columns[0],
        number_column("POS as delivered", "px", raw),
        *table.columns[1:],
        number_column("relative orientation", "px", free),
    )
    return Table(table.name, table.caption, columns, table.notes)


def _per_strip(
    results: Results, name: str, made: Mapping[str, Sequence[StripMean]], caption: str
) -> Table:
    """Mean parallax per strip, px, with a column for every orientation that was made."""
    kept = _strips_in(results, [row for part in made.values() for row in part])
    columns = [text_column("Strip", kept)]
    columns += [number_column(title, "px", _means(kept, part)) for title, part in made.items()]
    return Table(name, caption, tuple(columns), _left_out(results, kept))


def _means(kept: Sequence[str], part: Sequence[StripMean]) -> list[float | None]:
    found = (first(part, strip=strip) for strip in kept)
    return [row.mean_px if row else None for row in found]


def _strips_in(results: Results, part: Sequence[StripMean]) -> list[str]:
    """Strips with at least one value; strips without a model would be rows of dashes."""
    known = {row.strip for row in part if not fmt.is_missing(row.mean_px)}
    return [strip for strip in strips(results) if strip in known]


def _left_out(results: Results, kept: Sequence[str]) -> tuple[str, ...]:
    others = [strip for strip in strips(results) if strip not in kept]
    if not others:
        return ()
    return (f"Without a stereo model of six or more points: strip {fmt.joined(others)}.",)
