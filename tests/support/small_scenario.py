"""A small simulated block with a drifting omega, for tests of whole analyses."""

from typing import Any

import numpy as np

from posstats.block.model import Block
from posstats.synthetic import load_scenario, simulate

OMEGA_CONSTANT_RAD = 0.018
OMEGA_DRIFT_RAD_PER_S = 4.68e-7
GOOD_POINTS = {"n": 9, "distribution": "grid", "image_px": 0.2, "ground_m": 0.02}


def scenario(**changes: dict[str, Any]) -> dict[str, Any]:
    """The scenario as plain values; each change replaces one table's entries."""
    values: dict[str, Any] = {
        "block": {"name": "small", "seed": 5},
        "camera": {
            "name": "DMC",
            "width_px": 13824,
            "height_px": 7680,
            "pixel_size_mm": 0.012,
            "principal_distance_mm": 120.0,
        },
        "flight": {
            "scale_denominator": 78000,
            "forward_overlap": 0.6,
            "side_overlap": 0.34,
            "n_strips": 4,
            "images_per_strip": 8,
            "headings_deg": [0, 180],
            "speed_m_per_s": 200.0,
            "turn_s": 300.0,
            "tilt_rad": 0.01,
            "position_jitter_m": 20.0,
        },
        "terrain": {"relief_m": 150.0, "wavelength_m": 12000.0},
        "tie_points": {"per_model": 60},
        "errors": {
            "image_px": 0.2,
            "position": {"noise_m": 0.05},
            "omega": {
                "constant_rad": OMEGA_CONSTANT_RAD,
                "drift_rad_per_s": OMEGA_DRIFT_RAD_PER_S,
                "noise_rad": 1.6e-5,
            },
            "phi": {"noise_rad": 1.6e-5},
            "kappa": {"noise_rad": 5e-5},
        },
        "check_points": {"n": 9, "distribution": "grid", "image_px": 0.5, "ground_m": 0.1},
        "accuracy": {"position_m": 0.05, "angle_deg": 0.005, "image_px": 0.2},
    }
    for table, entries in changes.items():
        values[table] = values.get(table, {}) | entries
    return values


def small_block(seed: int | None = None, **changes: dict[str, Any]) -> Block:
    """The scenario simulated."""
    return simulate(load_scenario(scenario(**changes)), seed)


def mean_px(rms_px: np.ndarray) -> float:
    """Mean over the models that have a value."""
    return float(np.nanmean(rms_px))
