"""``comparison.json``: the first paper's numbers, published and reproduced."""

from dataclasses import dataclass
from typing import Annotated, Literal

from posstats.contract.about import about
from posstats.contract.conclusion import StatedConclusion

SCHEMA = "posstats-comparison/1"

Basis = Literal["given", "fitted", "predicted"]


@dataclass(frozen=True, kw_only=True)
class Compared:
    """A printed number beside the reproduced one."""

    table: Annotated[int, about("of the paper, 1 to 4")]
    area: Annotated[int, about("test area, 1 to 3")]
    strip: Annotated[
        str | None,
        about("strip, where the table has it; Table 2 without is the mean over all models"),
    ]
    angle: Annotated[str | None, about("angle, where the table has it")]
    orientation: Annotated[str | None, about("orientation, where the table has it")]
    quantity: Annotated[str, about("column of the table, with its unit")]
    published: Annotated[int | float, about("as printed")]
    reproduced: Annotated[int | float | None, about("as simulated and analysed")]
    ratio: Annotated[
        float | None,
        about(
            "reproduced over published; `null` where either is missing, the published one is zero,"
            " or the units are not known (slopes and intercepts of Table 3)"
        ),
    ]
    basis: Annotated[
        Basis,
        about(
            "`given`: an input of the simulation; `fitted`: its errors were chosen to give the"
            " mean of these numbers; `predicted`: nothing was chosen for it"
        ),
    ]


@dataclass(frozen=True, kw_only=True)
class AreaShare:
    """How often a finding comes out when the experiment is repeated with other seeds."""

    finding: Annotated[str, about("name of the finding")]
    area: Annotated[int, about("test area, 1 to 3")]
    n_seeds: Annotated[int, about("repetitions")]
    share: Annotated[float, about("share of them in which it holds")]


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """All that the reproduction of the first paper found."""

    schema: Annotated[str, about('`"posstats-comparison/1"`')] = SCHEMA
    posstats_version: Annotated[str, about("version of the package")]
    created: Annotated[str, about("ISO 8601 time")]
    simulated: Annotated[bool, about("always true: the photographs are not public")]
    seed: Annotated[int, about("of the simulation")]
    rows: Annotated[tuple[Compared, ...], about("one per published number")]
    conclusions: Annotated[tuple[StatedConclusion, ...], about("one per conclusion of the paper")]
    seed_shares: Annotated[tuple[AreaShare, ...], about("one per finding and area")]
