"""What a delivered product is stated to be: the values that limits are functions of."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, fields, replace
from types import MappingProxyType

from posstats.contract.choices import TerrainKind
from posstats.formats.toml_document import Conflict
from posstats.formats.toml_types import Count, Positive

FORMULA_NAMES: Mapping[str, str] = MappingProxyType(
    {
        "class_h": "class_h_m",
        "class_v": "class_v_m",
        "gsd": "gsd_m",
        "scale": "map_scale",
        "lot": "lot_size",
    }
)
"""Name in a formula -> attribute of the product."""

TERRAIN = "terrain"
GIVEN_NAMES = (*FORMULA_NAMES, TERRAIN)
"""Names by which a profile asks whether the product states something."""


@dataclass(frozen=True)
class Product:
    """The product as contract or customer state it; None where nothing is stated.

    Attributes
    ----------
    class_h_m, class_v_m
        Accuracy class, m: the horizontal (radial) and the vertical RMSE that is to be met.
    gsd_m
        Ground sampling distance, m.
    map_scale
        Denominator of the map scale.
    terrain
        "flat" (and hilly) or "mountain".
    lot_size, sample_size
        Units that were delivered together, and those of them that were inspected.
    survey_sigma_h_m, survey_sigma_v_m
        Accuracy of the check points' survey, m: radial horizontal, and vertical.
    """

    class_h_m: Positive | None = None
    class_v_m: Positive | None = None
    gsd_m: Positive | None = None
    map_scale: Positive | None = None
    terrain: TerrainKind | None = None
    lot_size: Count | None = None
    sample_size: Count | None = None
    survey_sigma_h_m: Positive | None = None
    survey_sigma_v_m: Positive | None = None

    def conflicts(self) -> Iterable[Conflict]:
        """Values of a file that contradict each other."""
        lot, sample = self.lot_size, self.sample_size
        if lot is not None and sample is not None and sample > lot:
            yield ("sample_size",), f"found {sample}, expected at most the lot_size, {lot}"

    def value(self, name: str) -> float | None:
        """The value that a formula's name stands for, None if the product states none."""
        value: float | None = getattr(self, FORMULA_NAMES[name])
        return value

    def states(self, name: str) -> bool:
        """Whether the product states what `name` (one of `GIVEN_NAMES`) stands for."""
        if name == TERRAIN:
            return self.terrain is not None
        return self.value(name) is not None

    def updated(self, other: "Product") -> "Product":
        """The same product, with what `other` states in place of its own."""
        given = {each.name: getattr(other, each.name) for each in fields(other)}
        return replace(self, **{name: v for name, v in given.items() if v is not None})
