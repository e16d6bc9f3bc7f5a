"""Tables of the report on an adjustment."""

from collections.abc import Sequence

from ..block.view import scope_label
from ..document import format as fmt
from ..document.table import (
    Column,
    Table,
    aligned_column,
    count_column,
    number_column,
    p_column,
    prose_column,
    text_column,
)
from .view import GROUPS, KINDS, Results, Row, parameter_words, rows, shown_unit

SHOWN_BLUNDERS = 25
SHOWN_POINTS = 60
SHOWN_CORRELATIONS = 25
ELEMENTS = {"x": "X", "y": "Y", "z": "Z"}


def groups(results: Results) -> Table:
    """Groups of observations with their residuals and variance factors."""
    kept = [row for row in rows(results, "groups") if row["n"]]
    units = [fmt.DEGREE if row["unit"] == "rad" else fmt.Unit(row["unit"], 1.0) for row in kept]
    pairs = list(zip(kept, units, strict=True))
    columns = [
        text_column("Observations", [GROUPS[row["group"]] for row in kept]),
        count_column("Number", [row["n"] for row in kept]),
        number_column("Redundancy", "", [row["redundancy"] for row in kept], 4),
        number_column("RMS residual", "", [unit.scaled(row["rms"]) for row, unit in pairs]),
        number_column(
            "Detectable", "", [unit.scaled(row["median_detectable"]) for row, unit in pairs]
        ),
        text_column("Unit", ["σ" if u.name == "standard deviations" else u.name for u in units]),
        number_column("Variance factor", "", [row["variance_factor"] for row in kept]),
    ]
    if any(row["weight_factor"] is not None for row in kept):
        columns.append(
            number_column("Estimated variance", "× stated", [row["weight_factor"] for row in kept])
        )
    notes = (
        "The variance factor is the weighted sum of squares over the redundancy: 1 where the "
        "weights are right, above 1 where the observations are worse than stated.",
        "Detectable: the median of the smallest blunders that a test of size 0.1 % finds with a "
        "probability of 80 %. Data snooping tests all observations together at 5 %, each "
        "at less: what it surely finds is somewhat larger.",
    )
    return Table("groups", "Groups of observations of the adjustment.", tuple(columns), notes)


def parameters(results: Results) -> Table:
    """Additional parameters and their tests."""
    kept = rows(results, "parameters")
    scaled = [shown_unit(row["unit"]) for row in kept]
    columns = (
        text_column("Parameter", [parameter_words(row["name"]) for row in kept]),
        text_column("Scope", [scope_label(row["scope"]) for row in kept]),
        Column("Value", _to_sigma(kept, scaled)),
        number_column("Std. dev.", "", _scaled(kept, "sigma", scaled), 2),
        text_column("Unit", [unit.name for unit in scaled]),
        aligned_column("t", "", [row["t"] for row in kept]),
        p_column("p", [row["p"] for row in kept]),
        text_column("Significant", ["yes" if row["significant"] else "no" for row in kept]),
        text_column("Known from", [_source(row) for row in kept]),
    )
    notes = [
        "Values are measured minus true; shifts are those at the first exposure of their scope. "
        "1 nrad/s is 0.000206°/h."
    ]
    if rows(results, "cameras"):
        notes.append("Principal distance and point: what is added to the stated ones, y upwards.")
    if any(row["prior_released"] for row in kept):
        notes.append(
            "Freed: the measurements contradict the prior value 0 with its standard deviation, so "
            "this took no part."
        )
    strong = frozenset(k for k, row in enumerate(kept) if row["significant"])
    caption = "Additional parameters, with Student's t test against zero."
    return Table("parameters", caption, columns, tuple(notes), strong)


def cameras(results: Results) -> Table:
    """Stated and adjusted interior orientation."""
    kept = rows(results, "cameras")
    points = [[*row["stated_principal_point_px"], *row["principal_point_px"]] for row in kept]
    columns = [text_column("Camera", [row["camera"] for row in kept])]
    for offset, prefix, group in ((0, "stated_", "stated"), (2, "", "adjusted")):
        distance = [row[f"{prefix}principal_distance_px"] for row in kept]
        columns.append(_hundredths("Principal distance", distance, group))
        for axis, title in enumerate(("Column", "Row")):
            columns.append(_hundredths(title, [point[offset + axis] for point in points], group))
    note = (
        "The adjusted orientations belong to the adjusted camera. Standard deviations are those of "
        "the parameters in the table above."
    )
    caption = "Principal distance and principal point of the cameras, in the terms of block.toml."
    return Table("cameras", caption, tuple(columns), (note,))


def _hundredths(title: str, values_px: Sequence[float], group: str) -> Column:
    """Lengths of thousands of pixels, of which hundredths count."""
    return Column(title, tuple(fmt.fixed(value, 2) for value in values_px), "px", group=group)


def _scaled(kept: Sequence[Row], key: str, units: Sequence[fmt.Unit]) -> list[float | None]:
    return [unit.scaled(row[key]) for row, unit in zip(kept, units, strict=True)]


def _to_sigma(kept: Sequence[Row], units: Sequence[fmt.Unit]) -> tuple[str, ...]:
    """Values with the decimals that two digits of their standard deviations have."""
    values, sigmas = _scaled(kept, "value", units), _scaled(kept, "sigma", units)
    return tuple(
        fmt.number(value)
        if fmt.is_missing(sigma) or not 1e-4 < abs(sigma or 0.0) < 1e6
        else fmt.fixed(value, fmt.shared_decimals([sigma], 2))
        for value, sigma in zip(values, sigmas, strict=True)
    )


def _source(row: Row) -> str:
    """What a parameter is known from."""
    if not row["determined"]:
        return "prior" if row["prior_sigma"] is not None else "hardly determined"
    if row["prior_released"]:
        return "measurements (freed)"
    return "measurements"


def dropped(results: Results) -> Table:
    """Parameters that were dropped, in order."""
    kept = rows(results, "dropped")
    columns = (
        text_column("Parameter", [parameter_words(row["name"]) for row in kept]),
        text_column("Scope", [scope_label(row["scope"]) for row in kept]),
        text_column("Reason", [row["reason"] for row in kept]),
    )
    return Table("dropped", "Parameters that were dropped, in this order.", columns)


def correlations(results: Results) -> Table:
    """Correlations above 0.95."""
    found = sorted(rows(results, "correlations"), key=lambda row: -abs(row["value"]))
    kept = found[:SHOWN_CORRELATIONS]
    columns = (
        text_column("Parameter", [_named(row, "first") for row in kept]),
        text_column("With", [_named(row, "second") for row in kept]),
        aligned_column("Correlation", "", [row["value"] for row in kept]),
    )
    caption = "Correlations above 0.95, of parameters with each other and with orientations."
    n_more = len(found) - len(kept)
    notes = (f"{fmt.count(n_more)} smaller ones are in adjustment.json.",) if n_more else ()
    return Table("correlations", caption, columns, notes)


def _named(row: Row, which: str) -> str:
    name, scope = row[which], row[f"{which}_scope"]
    if "_" not in name:
        return f"{ELEMENTS.get(name, name)} of image {scope}"
    words = parameter_words(name)
    return words if scope == "block" else f"{words}, {scope_label(scope)}"


def observability(results: Results) -> Table:
    """What the measurements leave open."""
    alike: dict[tuple[object, ...], list[Row]] = {}
    for row in rows(results, "observability"):
        scope = row["scope"] == "block"
        alike.setdefault((row["kind"], scope, *row["names"], row["reason"]), []).append(row)
    kept = [same[0] for same in alike.values()]
    columns = (
        prose_column("What", [_subject(same) for same in alike.values()]),
        prose_column("Why", [row["reason"] for row in kept]),
        prose_column("What would determine it", [row["remedy"] for row in kept]),
    )
    return Table("observability", "What the measurements do not determine.", columns)


def _subject(same: Sequence[Row]) -> str:
    """What is open, in all scopes in which it is open alike."""
    names, scopes = same[0]["names"], [row["scope"] for row in same]
    if same[0]["kind"] == "parameter":
        words = fmt.joined(parameter_words(name) for name in names)
        plural = "s" if len(scopes) > 1 else ""
        return words if scopes == ["block"] else f"{words} of strip{plural} {fmt.joined(scopes)}"
    more = f" and {len(names) - 12} more" if len(names) > 12 else ""
    return ", ".join(names[:12]) + more


def blunders(results: Results) -> Table:
    """What was taken out, the largest first among image rays."""
    found = rows(results, "blunders")
    kept = found[:SHOWN_BLUNDERS]
    units = [fmt.DEGREE if row["unit"] == "rad" else fmt.Unit(row["unit"], 1.0) for row in kept]
    sizes = [
        ", ".join(fmt.number(unit.scaled(value)) for value in row["size"])
        for row, unit in zip(kept, units, strict=True)
    ]
    columns = (
        text_column("Observation", [KINDS[row["kind"]] for row in kept]),
        text_column("Image", [row["image"] for row in kept]),
        text_column("Point", [row["point"] for row in kept]),
        number_column("w", "", [row["w"] for row in kept]),
        text_column("Measured minus adjusted", sizes),
        text_column("Unit", [unit.name for unit in units]),
        text_column("Found by", [_how(row) for row in kept]),
    )
    notes = _not_shown(found, SHOWN_BLUNDERS)
    return Table("blunders", "Observations that the others contradict.", columns, notes)


def _how(row: Row) -> str:
    how = "data snooping" if row["found_by"] == "snooping" else "robust adjustment"
    return how if row["taken_out"] else f"{how}; kept, as the block needs it"


def orientations(results: Results) -> Table:
    """Accuracy of the adjusted orientations, and what the POS differs from them."""
    kept = rows(results, "orientations")
    units = [fmt.DEGREE if row["unit"] == "rad" else fmt.METRE for row in kept]
    words = {"median_sigma": "median", "max_sigma": "largest", "pos_mean": "mean", "pos_rms": "RMS"}
    heads = {"median_sigma": "standard deviation", "max_sigma": "standard deviation",
             "pos_mean": "POS minus adjusted", "pos_rms": "POS minus adjusted"}  # fmt: skip
    columns = [
        text_column("Element", [ELEMENTS.get(row["element"], row["element"]) for row in kept]),
        text_column("Unit", [unit.name for unit in units]),
    ]
    columns += [
        number_column(title, "", _scaled(kept, key, units), group=heads[key])
        for key, title in words.items()
    ]
    caption = "Adjusted orientations: how well they are known, and how far the POS is from them."
    return Table("orientations", caption, tuple(columns))


def control_points(results: Results) -> Table:
    """Residuals of the control points."""
    found = rows(results, "control_points")
    kept = found[:SHOWN_POINTS]
    columns = [text_column("Point", [row["point"] for row in kept])]
    for axis, title in (("x", "east"), ("y", "north"), ("z", "up")):
        values = [row[f"d{axis}_m"] for row in kept]
        columns.append(aligned_column(title, "m", values, group="adjusted minus given"))
    columns.append(aligned_column("Largest w", "", [row["largest_w"] for row in kept]))
    caption = "Control points after the adjustment."
    return Table("control_points", caption, tuple(columns), _not_shown(found, SHOWN_POINTS))


def _not_shown(found: Sequence[Row], shown: int) -> tuple[str, ...]:
    """A note on rows that the table leaves out."""
    more = len(found) - shown
    return (f"{fmt.count(more)} more are in adjustment.json.",) if more > 0 else ()


def check_point_list(results: Results) -> Table:
    """Every check point with its standard deviations."""
    found = rows(results, "check_point_residuals", orientation="bundle")
    kept = found[:SHOWN_POINTS]
    columns = [
        text_column("Point", [row["point"] for row in kept]),
        count_column("Rays", [row["n_rays"] for row in kept]),
    ]
    axes = (("x", "east"), ("y", "north"), ("z", "up"))
    for key, group in (("d{}_m", "computed minus given"), ("sigma_{}_m", "standard deviation")):
        for axis, title in axes:
            values = [row[key.format(axis)] for row in kept]
            columns.append(aligned_column(title, "m", values, group=group))
    caption = (
        "Check points, intersected from the adjusted orientations; standard deviations hold those "
        "of the orientations, the image coordinates and the survey."
    )
    return Table("check_point_list", caption, tuple(columns), _not_shown(found, SHOWN_POINTS))
