"""``wucaps.json``: the second paper's experiment."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from msgspec import UNSET, UnsetType

from posstats.contract.about import about
from posstats.contract.conclusion import StatedConclusion

SCHEMA = "posstats-wucaps/1"


@dataclass(frozen=True, kw_only=True)
class SituationRow:
    """One way of orienting one situation; singular normal equations leave no accuracies."""

    situation: Annotated[str, about("`flat` or `mountain`")]
    method: Annotated[str, about("how it was oriented")]
    control: Annotated[str | None, about("control points used")]
    sigma0: Annotated[float | None, about("standard deviation of unit weight")]
    undetermined: Annotated[tuple[str, ...], about("parameters that are not determined")]
    determined: Annotated[bool, about("whether everything is")]
    horizontal_m: Annotated[float | UnsetType | None, about("RMSE of the check points")] = UNSET
    vertical_m: Annotated[float | UnsetType | None, about("RMSE of the check points")] = UNSET
    predicted_horizontal_m: Annotated[
        float | UnsetType | None, about("the same from the covariance")
    ] = UNSET
    predicted_vertical_m: Annotated[
        float | UnsetType | None, about("the same from the covariance")
    ] = UNSET
    position_horizontal_m: Annotated[
        float | UnsetType | None, about("RMS error of the projection centres")
    ] = UNSET
    position_vertical_m: Annotated[
        float | UnsetType | None, about("RMS error of the projection centres")
    ] = UNSET
    omega_rad: Annotated[float | UnsetType | None, about("RMS error of the angle")] = UNSET
    phi_rad: Annotated[float | UnsetType | None, about("RMS error of the angle")] = UNSET
    kappa_rad: Annotated[float | UnsetType | None, about("RMS error of the angle")] = UNSET
    parallax_mm: Annotated[float | UnsetType | None, about("mean RMS y-parallax")] = UNSET
    horizontal_over_reference: Annotated[
        float | UnsetType | None,
        about("RMSE over that without systematic errors and with all control"),
    ] = UNSET
    vertical_over_reference: Annotated[float | UnsetType | None, about("the same, vertical")] = (
        UNSET
    )


@dataclass(frozen=True, kw_only=True)
class SituationShare:
    """How often a finding comes out when the experiment is repeated with other seeds."""

    finding: Annotated[str, about("name of the finding")]
    situation: Annotated[str, about("`flat` or `mountain`")]
    n_seeds: Annotated[int, about("repetitions")]
    share: Annotated[float, about("share of them in which it holds")]


@dataclass(frozen=True, kw_only=True)
class Prediction:
    """RMSE of check points over all seeds, beside what the covariances predict."""

    situation: Annotated[str, about("`flat` or `mountain`")]
    adjustment: Annotated[str, about("how it was oriented, and with which control")]
    horizontal_m: Annotated[float, about("RMSE over all seeds")]
    vertical_m: Annotated[float, about("RMSE over all seeds")]
    predicted_horizontal_m: Annotated[float, about("as predicted")]
    predicted_vertical_m: Annotated[float, about("as predicted")]


@dataclass(frozen=True, kw_only=True)
class Wucaps:
    """All that the reproduction of the second paper found."""

    schema: Annotated[str, about('`"posstats-wucaps/1"`')] = SCHEMA
    posstats_version: Annotated[str, about("version of the package")]
    created: Annotated[str, about("ISO 8601 time")]
    simulated: Annotated[bool, about("always true")]
    seed: Annotated[int, about("of the simulation")]
    rows: Annotated[tuple[SituationRow, ...], about("one per situation and way of orienting")]
    relative_parallax_mm: Annotated[
        Mapping[str, float], about("what relative orientation leaves, by situation")
    ]
    conclusions: Annotated[tuple[StatedConclusion, ...], about("one per conclusion of the paper")]
    beyond: Annotated[tuple[StatedConclusion, ...], about("questions that the paper leaves")]
    seed_shares: Annotated[tuple[SituationShare, ...], about("one per finding and situation")]
    predictions: Annotated[tuple[Prediction, ...], about("one per situation and adjustment")]
