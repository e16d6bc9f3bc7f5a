"""Results and evidence made by hand, for tests of the acceptance."""

import numpy as np

from posstats.acceptance.evidence import evidence
from posstats.acceptance.product import Product

SQUARE = [[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]]


def residual_rows(difference_m, orientation="selected", sigma_xy_m=0.01, sigma_z_m=0.02):
    """Check points on a circle around the middle of the block."""
    difference_m = np.asarray(difference_m, dtype=float).reshape(-1, 3)
    around = np.linspace(0.1, 0.1 + 2.0 * np.pi, len(difference_m), endpoint=False)
    return [
        {
            "orientation": orientation, "point": f"C{k}", "status": "ok", "n_rays": 4,
            "x_m": 50.0 + 40.0 * np.cos(at), "y_m": 50.0 + 40.0 * np.sin(at), "z_m": 10.0,
            "dx_m": d[0], "dy_m": d[1], "dz_m": d[2],
            "sigma_x_m": 0.02, "sigma_y_m": 0.02, "sigma_z_m": 0.04,
            "survey_sigma_xy_m": sigma_xy_m, "survey_sigma_z_m": sigma_z_m,
        }
        for k, (at, d) in enumerate(zip(around, difference_m, strict=True))
    ]  # fmt: skip


def regression_rows(p_values, frame="ground"):
    return [
        {"frame": frame, "angle": angle, "scope": "block", "p_value": 1e-9, "gls_p_value": p}
        for angle, p in p_values.items()
    ]


def results_of(difference_m, orientations=("pos", "selected"), **changed):
    """A results dictionary with what an acceptance reads."""
    rows = [row for name in orientations for row in residual_rows(difference_m, name)]
    values = {
        "block": {"name": "made", "inputs": [], "simulated": False},
        "settings": {"rules": "paper"},
        "warnings": [],
        "check_points": [{"orientation": name} for name in orientations],
        "check_point_residuals": rows,
        "images": [{"footprint": SQUARE}],
        "models": [
            {"pos_px": 20.0, "corrected_px": 0.3, "adjusted_px": None, "bundle_px": 0.2},
            {"pos_px": 22.0, "corrected_px": 0.4, "adjusted_px": None, "bundle_px": 0.25},
        ],
        "bundle": None,
        "regression": regression_rows({"omega": 1e-6, "phi": 0.02, "kappa": 0.5}),
        "selection": [
            {"frame": "ground", "angle": "omega", "scope": "block", "form": "linear"},
            {"frame": "ground", "angle": "phi", "scope": "block", "form": "none"},
            {"frame": "ground", "angle": "kappa", "scope": "block", "form": "none"},
        ],
    }
    return values | changed


def evidence_of(difference_m, product=None, orientation="selected", **changed):
    return evidence(results_of(difference_m, **changed), orientation, product or Product())
