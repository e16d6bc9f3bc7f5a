"""Results and evidence made by hand, for tests of the acceptance."""

from dataclasses import replace

import numpy as np
from report_results import area_results

from posstats.acceptance.evidence import Evidence, evidence
from posstats.acceptance.product import Product
from posstats.contract.check_points import CheckPointResidual
from posstats.contract.record import record
from posstats.contract.results import Regression, Results, Selection

SQUARE = ((0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0))
PLAIN = area_results(n_strips=1, per_strip=3)


def residual_rows(difference_m, orientation="selected", sigma_xy_m=0.01, sigma_z_m=0.02):
    """Check points on a circle around the middle of the block."""
    difference_m = np.asarray(difference_m, dtype=float).reshape(-1, 3)
    around = np.linspace(0.1, 0.1 + 2.0 * np.pi, len(difference_m), endpoint=False)
    return tuple(
        record(CheckPointResidual, {
            "orientation": orientation, "point": f"C{k}", "status": "ok", "n_rays": 4,
            "x_m": 50.0 + 40.0 * np.cos(at), "y_m": 50.0 + 40.0 * np.sin(at), "z_m": 10.0,
            "dx_m": d[0], "dy_m": d[1], "dz_m": d[2],
            "sigma_x_m": 0.02, "sigma_y_m": 0.02, "sigma_z_m": 0.04,
            "survey_sigma_xy_m": sigma_xy_m, "survey_sigma_z_m": sigma_z_m,
        })
        for k, (at, d) in enumerate(zip(around, difference_m, strict=True))
    )  # fmt: skip


def regression_rows(p_values: dict[str, float | None], frame="ground") -> tuple[Regression, ...]:
    return tuple(
        replace(
            PLAIN.regression[0], frame=frame, angle=angle, scope="block", p_value=1e-9,
            gls_p_value=p,
        )
        for angle, p in p_values.items()
    )  # fmt: skip


def selection_rows(forms: dict[str, str]) -> tuple[Selection, ...]:
    return tuple(
        record(Selection, {
            "angle": angle, "frame": "ground", "scope": "block", "correct": form != "none",
            "form": form, "rule": "paper", "fit": "ols",
        })
        for angle, form in forms.items()
    )  # fmt: skip


def results_of(difference_m, orientations=("pos", "selected"), **changed) -> Results:
    """Results with what an acceptance reads."""
    values = {
        "check_points": tuple(
            replace(PLAIN.check_points[0], orientation=name) for name in orientations
        ),
        "check_point_residuals": tuple(
            row for name in orientations for row in residual_rows(difference_m, name)
        ),
        "images": (replace(PLAIN.images[0], footprint=SQUARE),),
        "models": (
            replace(PLAIN.models[0], pos_px=20.0, corrected_px=0.3, bundle_px=0.2),
            replace(PLAIN.models[0], pos_px=22.0, corrected_px=0.4, bundle_px=0.25),
        ),
        "bundle": None,
        "regression": regression_rows({"omega": 1e-6, "phi": 0.02, "kappa": 0.5}),
        "selection": selection_rows({"omega": "linear", "phi": "none", "kappa": "none"}),
        "warnings": (),
    }
    return replace(PLAIN, **values | changed)


def evidence_of(difference_m, product=None, orientation="selected", **changed) -> Evidence:
    return evidence(results_of(difference_m, **changed), orientation, product or Product())
