"""Published and reproduced numbers side by side, row by row."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from posstats.contract.comparison import Basis, Compared
from posstats.contract.results import Results
from posstats.papers.drift.areas import AREAS, area_scenario
from posstats.papers.drift.findings import STRIP, known, only_row
from posstats.papers.drift.published import published
from posstats.synthetic import Scenario

TABLE3_AREA = 1
_METHODS = ("pos", "independent", "dependent")
_STATISTICS = ("max", "min", "mean")
_NO_RATIO = ("intercept", "slope_per_t")
_REGRESSION_KEYS = {
    "intercept": "intercept_rad",
    "slope_per_t": "slope_rad_per_s",
    "r_squared": "r_squared",
    "f_statistic": "f_statistic",
    "p_value": "p_value",
}
_TABLE4_QUANTITIES = tuple(
    f"{statistic}_{side}_m"
    for statistic in ("max", "min", "rmse")
    for side in ("horizontal", "vertical")
)
_ORIENTATIONS = {"pos": "pos", "omega_corrected": "omega"}


def compare(results: Mapping[int, Results]) -> tuple[Compared, ...]:
    """Every number of Tables 1 to 4 beside its reproduction.

    Parameters
    ----------
    results
        Results by area (1, 2, 3); Table 3 is compared with strip `STRIP` of area 1.
    """
    return tuple(
        each
        for table in (_table1, _table2, _table3, _table4)
        for area in AREAS
        for each in table(area, results[area])
    )


def _table1(area: int, results: Results) -> Iterator[Compared]:
    (row,) = published(1, area=area)
    place = _Place(1, area)
    flown = _as_flown(area_scenario(area), results)
    for quantity, value in flown.items():
        yield place.compared(quantity, getattr(row, quantity), value, "given")
    n_tie_points = results.block.n_tie_points
    yield place.compared("n_tie_points", row.n_tie_points, n_tie_points, "fitted")


def _as_flown(scenario: Scenario, results: Results) -> dict[str, float | None]:
    camera, flight, block = scenario.camera, scenario.flight, results.block
    return {
        "principal_distance_mm": camera.principal_distance_mm,
        "width_px": camera.width_px,
        "height_px": camera.height_px,
        "pixel_size_mm": camera.pixel_size_mm,
        "scale_denominator": flight.scale_denominator,
        "forward_overlap": flight.forward_overlap,
        "side_overlap": flight.side_overlap,
        "n_strips": block.n_strips,
        "n_images": block.n_images,
        "n_control_points": block.n_check_points,
    }


def _table2(area: int, results: Results) -> Iterator[Compared]:
    means: dict[str, list[tuple[int, float, float]]] = {}
    for row in published(2, area=area):
        place = _Place(2, area, strip=row.strip)
        for method in _METHODS:
            strip = only_row(results.parallax, strip=row.strip, method=method)
            for statistic in _STATISTICS:
                basis: Basis = "fitted" if statistic == "mean" else "predicted"
                quantity = f"{method}_{statistic}_mm"
                reproduced = getattr(strip, f"{statistic}_mm")
                yield place.compared(quantity, getattr(row, quantity), reproduced, basis)
            mean = f"{method}_mean_mm"
            means.setdefault(mean, []).append(
                (strip.n_models, getattr(row, mean), known(strip.mean_mm))
            )
    for mean, strips in means.items():
        n_models, *both = zip(*strips, strict=True)
        printed, found = (_weighted(values, n_models) for values in both)
        yield _Place(2, area).compared(mean, printed, found, "fitted")


def _weighted(values: Sequence[float], n_models: Sequence[int]) -> float:
    """Mean over the models of an area, from the means of its strips."""
    total = sum(n * value for n, value in zip(n_models, values, strict=True))
    return total / sum(n_models)


def _table3(area: int, results: Results) -> Iterator[Compared]:
    if area != TABLE3_AREA:
        return
    for row in published(3):
        place = _Place(3, area, strip=STRIP, angle=row.angle)
        line = only_row(results.regression, angle=row.angle, scope=STRIP, frame="ground")
        for quantity, key in _REGRESSION_KEYS.items():
            published_drift = (row.angle, quantity) == ("omega", "slope_per_t")
            basis: Basis = "given" if published_drift else "predicted"
            yield place.compared(quantity, getattr(row, quantity), getattr(line, key), basis)


def _table4(area: int, results: Results) -> Iterator[Compared]:
    for row in published(4, area=area):
        place = _Place(4, area, orientation=row.orientation)
        points = only_row(
            results.check_points,
            orientation=_ORIENTATIONS[row.orientation],
            translation_removed=True,
        )
        yield place.compared("n_check_points", row.n_check_points, points.n, "given")
        for quantity in _TABLE4_QUANTITIES:
            printed, reproduced = (getattr(each, quantity) for each in (row, points))
            yield place.compared(quantity, printed, reproduced, "predicted")


@dataclass(frozen=True)
class _Place:
    """Where in the paper's tables a number stands."""

    table: int
    area: int
    strip: str | None = None
    angle: str | None = None
    orientation: str | None = None

    def compared(
        self, quantity: str, printed: float, reproduced: float | None, basis: Basis
    ) -> Compared:
        """The printed number beside the reproduced one."""
        ratio = None
        if reproduced is not None and printed != 0 and quantity not in _NO_RATIO:
            ratio = reproduced / printed
        return Compared(
            **vars(self),
            quantity=quantity,
            published=printed,
            reproduced=reproduced,
            ratio=ratio,
            basis=basis,
        )
