"""Check points of a block by one orientation, as in ``results.json`` and ``adjustment.json``."""

from dataclasses import dataclass
from typing import Annotated

from posstats.contract.about import about
from posstats.contract.status import PointStatus


@dataclass(frozen=True, kw_only=True)
class CheckPointStatistics:
    """Statistics of the check points by one orientation, the translation kept or removed."""

    orientation: Annotated[
        str,
        about(
            "`pos`, `omega`, `phi`, `kappa`, `selected`; `adjusted` if the block has it; `bundle`"
            " with `--errors bundle`"
        ),
    ]
    translation_removed: Annotated[
        bool,
        about(
            "whether the mean difference was taken off (then the RMSE has the divisor n - 1, and"
            " is no figure for acceptance)"
        ),
    ]
    n: Annotated[int, about("check points intersected")]
    max_horizontal_m: Annotated[float | None, about("largest hypot(dX, dY)")]
    max_vertical_m: Annotated[float | None, about("largest abs(dZ)")]
    min_horizontal_m: Annotated[float | None, about("smallest hypot(dX, dY)")]
    min_vertical_m: Annotated[float | None, about("smallest abs(dZ)")]
    rmse_horizontal_m: Annotated[float | None, about("of hypot(dX, dY)")]
    rmse_vertical_m: Annotated[float | None, about("of dZ")]
    shift_m: Annotated[
        tuple[float, float, float] | None,
        about("mean difference `[dX, dY, dZ]`, in either case; `null` without points"),
    ]


@dataclass(frozen=True, kw_only=True)
class _OfAnOrientation:
    orientation: Annotated[str, about("as above")]


@dataclass(frozen=True, kw_only=True)
class CheckPointDifference:
    """A check point and its difference from an orientation, whichever that is."""

    point: Annotated[str, about("id of the point")]
    n_rays: Annotated[int, about("images that show it")]
    status: Annotated[
        PointStatus,
        about("whether it was intersected, or why not"),
    ]
    survey_sigma_xy_m: Annotated[
        float | None, about("standard deviation of the surveyed position; `null` if not stated")
    ]
    survey_sigma_z_m: Annotated[float | None, about("the same of the height")]
    x_m: Annotated[float, about("given")]
    dx_m: Annotated[float | None, about("difference")]
    sigma_x_m: Annotated[float | None, about("standard deviation of the difference")]
    y_m: Annotated[float, about("given")]
    dy_m: Annotated[float | None, about("difference")]
    sigma_y_m: Annotated[float | None, about("standard deviation of the difference")]
    z_m: Annotated[float, about("given")]
    dz_m: Annotated[float | None, about("difference")]
    sigma_z_m: Annotated[float | None, about("standard deviation of the difference")]


@dataclass(frozen=True, kw_only=True)
class CheckPointResidual(CheckPointDifference, _OfAnOrientation):
    """A check point by one orientation: computed minus given, translation kept, crs axes.

    A point that cannot be intersected has no differences.
    """
