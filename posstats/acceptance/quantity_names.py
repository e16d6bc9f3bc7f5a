"""The quantities that a requirement can set a limit to: their unit, and on which side it lies."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

Sense = Literal["at most", "at least"]


@dataclass(frozen=True)
class Quantity:
    """What a requirement can speak of.

    Attributes
    ----------
    unit
        "m", "px", or "1" for counts, shares and ratios.
    sense
        Whether the found value must be at most or at least the limit.
    largest
        The largest value that there can be (shares and probabilities); None without one.
    """

    unit: str
    sense: Sense
    largest: float | None = None


_METRES = Quantity("m", "at most")

QUANTITIES: Mapping[str, Quantity] = MappingProxyType(
    {
        "rmse_x": _METRES,
        "rmse_y": _METRES,
        "rmse_h": _METRES,
        "rmse_v": _METRES,
        "rmse_3d": _METRES,
        "product_rmse_h": _METRES,
        "product_rmse_v": _METRES,
        "product_rmse_3d": _METRES,
        "accuracy_h_95": _METRES,
        "accuracy_v_95": _METRES,
        "mean_error_h": _METRES,
        "mean_error_v": _METRES,
        "largest_mean_error": _METRES,
        "largest_residual_h": _METRES,
        "largest_residual_v": _METRES,
        "survey_h": _METRES,
        "survey_v": _METRES,
        "largest_residual_h_over_rmse": Quantity("1", "at most"),
        "largest_residual_v_over_rmse": Quantity("1", "at most"),
        "n_check_points": Quantity("1", "at least"),
        "measured_share": Quantity("1", "at least", largest=1.0),
        "quadrant_share": Quantity("1", "at least", largest=0.25),
        "n_blunders_h": Quantity("1", "at most"),
        "n_blunders_v": Quantity("1", "at most"),
        "image_rms_px": Quantity("px", "at most"),
        "parallax_rms_px": Quantity("px", "at most"),
        "parallax_largest_px": Quantity("px", "at most"),
        "sigma0": Quantity("1", "at most"),
        "remaining_drift_p": Quantity("1", "at least", largest=1.0),
        "sample_size": Quantity("1", "at least"),
    }
)
"""Every quantity by name; docs/acceptance.md says how each is computed."""

COUNTED_BEYOND: Mapping[str, str] = MappingProxyType({"n_blunders_h": "m", "n_blunders_v": "m"})
"""Quantities that count residuals beyond a threshold, and the threshold's unit."""
