"""Tables of the paper's reproduction: printed and simulated numbers side by side."""

from collections import Counter
from collections.abc import Callable, Iterable, Sequence

from posstats.contract.comparison import Compared
from posstats.papers.drift.comparison import TABLE3_AREA
from posstats.papers.drift.findings import known
from posstats.papers.drift.published import recomputed
from posstats.papers.drift.reproduction import Reproduction
from posstats.papers.drift.seeds import repeated, share, share_interval
from posstats.synthetic import Scenario

from ...document import format as fmt
from ...document.rows import rows
from ...document.table import Column, Table, count_column, number_column, p_column, text_column

MM_DECIMALS = 4  # as the paper prints them
METHODS = {
    "pos": "from the POS",
    "independent": "after relative orientation by independent pairs",
    "dependent": "after relative orientation by dependent pairs",
}
ORIENTATIONS = {"pos": "POS", "omega_corrected": "omega corrected"}
SOURCES = ("published", "simulated", "ratio")
CRITERIA = {
    "angles_dominate": "angle errors, not position errors, cause the parallax",
    "omega_is_the_source": "omega is the main source",
    "only_omega_is_linear": "strip 1: R² of omega > 0.95, p of phi and kappa > 0.05",
    "omega_alone_is_chosen": "the rules choose omega alone",
    "only_omega_helps": "only the omega correction reduces the parallax",
    "check_points_improve": "check points improve, H and V",
    "gains_as_published": "gain at check points in the ranges of the paper's text",
}
_TABLE1 = {
    "principal_distance_mm": ("principal distance, mm", 1),
    "width_px": ("image width, px", 0),
    "height_px": ("image height, px", 0),
    "pixel_size_mm": ("pixel size, mm", 3),
    "scale_denominator": ("scale, 1 :", 0),
    "forward_overlap": ("forward overlap", 2),
    "side_overlap": ("side overlap", 2),
    "n_strips": ("strips", 0),
    "n_images": ("images", 0),
    "n_control_points": ("control points, used as check points", 0),
    "n_tie_points": ("tie points", 0),
}


def areas(run: Reproduction) -> Table:
    """Table 1: the three areas as printed and as simulated."""
    columns = [text_column("Quantity", [title for title, _ in _TABLE1.values()])]
    for area in run.results:
        found = {each.quantity: each for each in _compared(run, 1, area=area)}
        shown = [(found[quantity], decimals) for quantity, (_, decimals) in _TABLE1.items()]
        for source, value in (("published", "published"), ("simulated", "reproduced")):
            cells = tuple(fmt.fixed(getattr(each, value), decimals) for each, decimals in shown)
            columns.append(Column(source, cells, group=f"Area {area}"))
    caption = (
        "The three test areas, as published and as simulated. All but the number of tie points "
        "are inputs of the simulation."
    )
    return Table("areas", caption, tuple(columns))


def simulated_errors(scenarios: dict[int, Scenario]) -> Table:
    """What the simulation adds to the truth: the parameters that were fitted."""
    lines: tuple[tuple[str, Callable[[Scenario], float]], ...] = (
        ("omega: constant, mrad", lambda s: 1e3 * s.errors.omega.constant_rad),
        ("omega: drift, 10⁻⁷ rad/s", lambda s: 1e7 * s.errors.omega.drift_rad_per_s),
        ("omega: noise, µrad", lambda s: 1e6 * s.errors.omega.noise_rad),
        ("phi: noise, µrad", lambda s: 1e6 * s.errors.phi.noise_rad),
        ("kappa: noise, µrad", lambda s: 1e6 * s.errors.kappa.noise_rad),
        ("position: noise, cm", lambda s: 1e2 * s.errors.position.noise_m),
        ("tie points: image noise, px", lambda s: s.errors.image_px),
        ("check points: image noise, px", lambda s: s.check_points.image_px),
        ("check points: survey error, m", lambda s: s.check_points.ground_m),
        ("flight: speed, m/s", lambda s: s.flight.speed_m_per_s),
        ("flight: turn between strips, s", lambda s: s.flight.turn_s),
        ("flight: tilts about level, mrad", lambda s: 1e3 * s.flight.tilt_rad),
        ("terrain: relief, m", lambda s: s.terrain.relief_m),
    )
    columns = [text_column("Quantity", [title for title, _ in lines])]
    for area, scenario in scenarios.items():
        cells = tuple(fmt.as_chosen(value(scenario)) for _, value in lines)
        columns.append(Column(f"Area {area}", cells))
    caption = (
        "Chosen: the errors that the simulation adds to the truth (noise as standard deviation), "
        "and what else of the flight the paper does not tell."
    )
    notes = (
        "Drift from the first exposure of the area on; phi and kappa have neither constant nor "
        "drift. Fitted to the mean parallaxes of Table 2: constant and drift of omega (in area 1 "
        "the published drift) and the image noise of tie points. The noise of omega in area 1 is "
        "what the published R² implies for this drift; the noise of phi (roll) was kept small, as "
        "more of it would spoil Figure 3. The noise of check points was chosen by hand.",
    )
    return Table("simulated_errors", caption, tuple(columns), notes)


def parallax(run: Reproduction, method: str) -> Table:
    """Table 2 for one way of orienting the models."""
    found = _compared(run, 2)
    places = list(dict.fromkeys((each.area, each.strip) for each in found))
    columns = [
        text_column("Area", [str(area) for area, _ in places]),
        text_column("Strip", [strip or "all" for _, strip in places]),
    ]
    for statistic, words in {"max": "maximum", "min": "minimum", "mean": "mean"}.items():
        quantity = f"{method}_{statistic}_mm"
        by_place = {(e.area, e.strip): e for e in found if e.quantity == quantity}
        shown = [by_place.get(place) for place in places]
        columns += _side_by_side(shown, MM_DECIMALS, "mm", words)
    caption = (
        f"RMS vertical parallax of the stereo models by strip {METHODS[method]}, mm at image "
        "scale; published, simulated, and simulated over published."
    )
    notes = ("all: mean over all models of the area. Means are fitted, maxima and minima "
             "predicted.",)  # fmt: skip
    whole = frozenset(k for k, (_, strip) in enumerate(places) if strip is None)
    by_area = tuple(Counter(area for area, _ in places).values())
    return Table(f"parallax_{method}", caption, tuple(columns), notes, whole, by_area)


def _side_by_side(
    shown: Sequence[Compared | None], decimals: int, unit: str, group: str
) -> list[Column]:
    published = [fmt.fixed(each.published if each else None, decimals) for each in shown]
    simulated = [fmt.fixed(each.reproduced if each else None, decimals) for each in shown]
    ratios = [fmt.fixed(each.ratio if each else None, 2) for each in shown]
    return [
        Column("publ.", tuple(published), unit, group=group),
        Column("sim.", tuple(simulated), unit, group=group),
        Column("ratio", tuple(ratios), group=group),
    ]


def held(run: Reproduction) -> Table:
    """Numbers behind Figure 1: parallax with angles held, and what each angle keeps."""
    found = list(run.findings.values())
    columns = [text_column("Area", [str(each.area) for each in found])]
    for name, words in (("angles", "all three"), ("omega", "omega"), ("phi", "phi"),
                        ("kappa", "kappa")):  # fmt: skip
        values = [getattr(each, f"held_{name}_mm") for each in found]
        columns.append(_millimetres(words, values, "held"))
    columns.append(_millimetres("none", [each.dependent_mm for each in found], "held"))
    for angle in ("omega", "phi", "kappa"):
        percent = [fmt.fixed(100.0 * each.kept_by[angle], 1) for each in found]
        columns.append(Column(angle, tuple(percent), "%", group="kept by holding"))
    caption = (
        "Mean RMS vertical parallax of all models after relative orientation with the named POS "
        "angles of the right image held, mm; and what holding one angle keeps, as a share of what "
        "holding all three adds."
    )
    return Table("held", caption, tuple(columns))


def one_strip(run: Reproduction) -> Table:
    """Table 3: published beside strip 1 of area 1."""
    angles = dict.fromkeys(each.angle for each in _compared(run, 3))
    by_angle = {
        angle: {each.quantity: each for each in _compared(run, 3, angle=angle)} for angle in angles
    }
    listed = [(angle, source) for angle in angles for source in SOURCES]

    def column(title: str, quantity: str, shown: Callable[[float | None], str]) -> Column:
        cells = [_cell(source, by_angle[angle][quantity], shown) for angle, source in listed]
        return Column(title, tuple(cells))

    columns = (
        text_column("Angle", [angle for angle, _ in listed]),
        text_column("", [source for _, source in listed]),
        text_column("Regression line y", [_equation(s, by_angle[angle]) for angle, s in listed]),
        column("R²", "r_squared", lambda value: fmt.fixed(value, 4)),
        column("F₀", "f_statistic", _statistic),
        column("p", "p_value", _probability),
    )
    caption = (
        "Regression of the angle errors on time by ordinary least squares, one strip of 60 images "
        "of area 1: published, simulated (strip 1), and simulated over published."
    )
    notes = (
        "Simulated: t in seconds from the middle of the strip. The paper names neither the unit of "
        "angle nor unit and origin of time, so lines have no ratio.",
        "F₀ has 1 and 58 degrees of freedom. Null hypothesis of p: the error does not change with "
        "time, errors of different images being independent. Predicted, but for omega: its drift "
        "is the published one, and its noise is what the published R² implies for that drift.",
    )
    return Table("one_strip", caption, columns, notes, together=(len(SOURCES),) * len(angles))


def _equation(source: str, found: dict[str, Compared]) -> str:
    intercept, slope = found["intercept"], found["slope_per_t"]
    if source == "ratio":
        return fmt.MISSING
    if source == "published":
        return f"{fmt.as_printed(intercept.published)} + {fmt.as_printed(slope.published)} t"
    if intercept.reproduced is None or slope.reproduced is None:
        return fmt.MISSING
    unit, rate = fmt.angle_unit([intercept.reproduced]), fmt.NANORADIAN_PER_SECOND
    constant = fmt.with_unit(unit.scaled(intercept.reproduced), unit.name)
    return f"{constant} + {fmt.with_unit(rate.scaled(slope.reproduced), rate.name)} t"


def _cell(source: str, each: Compared, shown: Callable[[float | None], str]) -> str:
    if source == "ratio":
        return fmt.fixed(each.ratio, 2)
    return shown(each.published if source == "published" else each.reproduced)


def _r_squared(value: float) -> str:
    return "< 0.0001" if value < 1e-4 else fmt.fixed(value, 4)


def _statistic(value: float | None) -> str:
    return fmt.fixed(value, 4) if value is not None and abs(value) < 10.0 else fmt.number(value, 5)


def _probability(value: float | None) -> str:
    return fmt.fixed(value, 4) if value is not None and value >= 5e-5 else "< 0.0001"


def lines(run: Reproduction) -> Table:
    """Regressions of all angles, of every block and strip."""
    made = [(area, row) for area, results in run.results.items()
            for row in rows(results.regression, frame="ground")]  # fmt: skip
    unit, rate = fmt.MICRORADIAN, fmt.NANORADIAN_PER_SECOND
    columns = (
        text_column("Area", [str(area) for area, _ in made]),
        text_column("Block or strip", [row.scope for _, row in made]),
        text_column("Angle", [row.angle for _, row in made]),
        count_column("n", [row.n for _, row in made]),
        number_column("a₀", unit.name, [unit.scaled(row.intercept_rad) for _, row in made]),
        number_column("a₁", rate.name, [rate.scaled(row.slope_rad_per_s) for _, row in made]),
        Column("R²", tuple(_r_squared(known(row.r_squared)) for _, row in made)),
        Column("F₀", tuple(_statistic(row.f_statistic) for _, row in made)),
        p_column("p", [row.p_value for _, row in made]),
        p_column("GLS p", [row.gls_p_value for _, row in made]),
    )
    caption = (
        "Simulated: regression y = a₀ + a₁ (t − t₀) of the angle errors for every block and every "
        "strip, t₀ in the middle of its exposures, by ordinary least squares; in the last column p "
        "by generalised least squares, which allows for correlated errors."
    )
    notes = ("n: images; F₀ has 1 and n − 2 degrees of freedom. Null hypothesis of p: no drift; it "
             "is true for phi and kappa.",)  # fmt: skip
    block = frozenset(k for k, (_, row) in enumerate(made) if row.scope == "block")
    return Table("lines", caption, columns, notes, block)


def corrected(run: Reproduction) -> Table:
    """Numbers behind Figure 3."""
    found = list(run.findings.values())
    columns = [
        text_column("Area", [str(each.area) for each in found]),
        _millimetres("POS", [each.pos_mm for each in found]),
        *(
            _millimetres(angle, [getattr(each, f"corrected_{angle}_mm") for each in found],
                         "corrected alone")
            for angle in ("omega", "phi", "kappa")
        ),
        _millimetres("relative orientation", [each.independent_mm for each in found]),
        Column(
            "omega ÷ relative",
            tuple(fmt.fixed(e.corrected_omega_mm / e.independent_mm, 2) for e in found),
        ),
    ]  # fmt: skip
    caption = (
        "Mean RMS vertical parallax of all models from the POS, with each angle corrected alone by "
        "its line of the block, and after relative orientation, mm at image scale."
    )
    return Table("corrected", caption, tuple(columns))


def _millimetres(title: str, values: Iterable[float], group: str = "") -> Column:
    return Column(title, tuple(fmt.fixed(v, MM_DECIMALS) for v in values), "mm", group=group)


def check_points(run: Reproduction) -> Table:
    """Table 4: published and simulated residuals, and their ratio, line by line."""
    found = _compared(run, 4)
    places = list(dict.fromkeys((each.area, each.orientation) for each in found))
    keyed = {(each.area, each.orientation, each.quantity): each for each in found}
    listed = [(area, orientation, source) for area, orientation in places for source in SOURCES]
    columns = [
        text_column("Area", [str(area) for area, *_ in listed]),
        text_column("Orientation", [ORIENTATIONS[str(name)] for _, name, _ in listed]),
        count_column("Points", [keyed[*place[:2], "n_check_points"].published for place in listed]),
        text_column("", [source for *_, source in listed]),
    ]
    for statistic, words in (("max", "maximum"), ("min", "minimum"), ("rmse", "RMSE")):
        for side, letter in (("horizontal", "H"), ("vertical", "V")):
            quantity = f"{statistic}_{side}_m"
            cells = [_metres(source, keyed[area, name, quantity]) for area, name, source in listed]
            columns.append(Column(letter, tuple(cells), "m", group=words))
    caption = (
        "Differences at check points after removal of their mean, from the POS and with the omega "
        "line taken off: published, simulated, and simulated over published. H: horizontal; V: "
        "vertical (absolute values)."
    )
    notes = (
        "Predicted: the error of omega follows from Table 2. The noise of check points was chosen "
        "by hand; with that of area 1, area 2 would often not improve vertically.",
    )
    ratios = frozenset(k for k, (*_, source) in enumerate(listed) if source == "ratio")
    triples = (len(SOURCES),) * len(places)
    return Table("check_points", caption, tuple(columns), notes, ratios, triples)


def _metres(source: str, each: Compared) -> str:
    return _cell(source, each, lambda value: fmt.fixed(value, 3))


def shares(run: Reproduction) -> Table:
    """How often each finding comes out over the stored seeds."""
    n_seeds = len(repeated()[min(run.results)])
    columns = [text_column("Finding", list(CRITERIA.values()))]
    for area in run.results:
        cells = [
            fmt.MISSING if name == "only_omega_is_linear" and area != 1
            else fmt.fixed(100.0 * share(name, area), 0)
            for name in CRITERIA
        ]  # fmt: skip
        columns.append(Column(f"Area {area}", tuple(cells), "% of seeds"))
    caption = (
        f"How often each finding comes out when the whole experiment is repeated with {n_seeds} "
        "different seeds of the random numbers."
    )
    notes = (
        f"What a finding means is told with the conclusions (Table B). {_interval_note()} "
        f"{fmt.MISSING}: the paper's Table 3 is about area 1. Stored with the package, made by "
        "benchmarks/paper_seeds.py of its sources.",
    )
    return Table("shares", caption, tuple(columns), notes)


def _interval_note() -> str:
    """What shares of a hundred seeds can tell."""
    low, high = share_interval("only_omega_is_linear", TABLE3_AREA)
    sure = share_interval("angles_dominate", TABLE3_AREA)[0]
    return (
        f"95 % interval of a share of 100 %: from {fmt.fixed(100.0 * sure, 0)} %; of "
        f"{fmt.fixed(100.0 * share('only_omega_is_linear', TABLE3_AREA), 0)} %: "
        f"{fmt.fixed(100.0 * low, 0)} to {fmt.fixed(100.0 * high, 0)} %."
    )


def printed_regression(df_resid: int) -> Table:
    """Table 3 recomputed from its own F0."""
    printed = recomputed(df_resid)
    columns = (
        text_column("Angle", [each.angle for each in printed]),
        Column("R²", tuple(fmt.fixed(each.r_squared, 5) for each in printed), group="recomputed"),
        Column("p", tuple(_long_p(each.p_value) for each in printed), group="recomputed"),
        Column("line crosses zero at t", tuple(fmt.count(e.zero_crossing_t) for e in printed)),
    )
    caption = (
        f"The published Table 3 recomputed from its F₀ with {df_resid} residual degrees of "
        "freedom: R² and p come out as printed, R² cut to three decimals and p to four."
    )
    return Table("printed_regression", caption, columns)


def _long_p(value: float) -> str:
    return fmt.fixed(value, 5) if value > 1e-5 else fmt.scientific(value, 2)


def _compared(run: Reproduction, table: int, **conditions: object) -> list[Compared]:
    return [
        each
        for each in run.compared
        if each.table == table and all(getattr(each, k) == v for k, v in conditions.items())
    ]
