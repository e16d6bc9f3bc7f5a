"""Results and evidence made by hand, for tests of the acceptance."""

from dataclasses import replace

import numpy as np
from report_results import area_results

from posstats.acceptance.evidence import evidence
from posstats.acceptance.product import Product
from posstats.contract.check_points import CheckPointResidual
from posstats.contract.results import Regression, Results

SQUARE = ((0.0, 0.0), (100.0, 0.0), (100.0, 100.0), (0.0, 100.0))
_MADE = area_results(n_strips=1, per_strip=3)


def residual_rows(difference_m, orientation="selected", sigma_xy_m=0.01, sigma_z_m=0.02):
    """Check points on a circle around the middle of the block."""
    difference_m = np.asarray(difference_m, dtype=float).reshape(-1, 3)
    around = np.linspace(0.1, 0.1 + 2.0 * np.pi, len(difference_m), endpoint=False)
    return tuple(
        CheckPointResidual(
            orientation=orientation, point=f"C{k}", status="ok", n_rays=4,
            x_m=50.0 + 40.0 * np.cos(at), y_m=50.0 + 40.0 * np.sin(at), z_m=10.0,
            dx_m=d[0], dy_m=d[1], dz_m=d[2],
            sigma_x_m=0.02, sigma_y_m=0.02, sigma_z_m=0.04,
            survey_sigma_xy_m=sigma_xy_m, survey_sigma_z_m=sigma_z_m,
        )
        for k, (at, d) in enumerate(zip(around, difference_m, strict=True))
    )  # fmt: skip


def regression_rows(p_values, frame="ground") -> tuple[Regression, ...]:
    """Lines of the block with their p-values by GLS."""
    return tuple(
        replace(_MADE.regression[0], angle=angle, frame=frame, scope="block", p_value=1e-9,
                gls_p_value=p)
        for angle, p in p_values.items()
    )  # fmt: skip


def decision(angle, form, frame="ground", scope="block"):
    """What is taken off of an angle."""
    return replace(_MADE.selection[0], angle=angle, frame=frame, scope=scope, form=form)


def parallax(pos_px, corrected_px, bundle_px):
    """A stereo model."""
    return replace(_MADE.models[0], pos_px=pos_px, corrected_px=corrected_px, adjusted_px=None,
                   bundle_px=bundle_px)  # fmt: skip


def of_orientations(*names):
    """Statistics of check points, one row each."""
    return tuple(replace(_MADE.check_points[0], orientation=name) for name in names)


def results_of(difference_m, orientations=("pos", "selected"), **changed) -> Results:
    """Results with what an acceptance reads."""
    made = {
        "block": replace(_MADE.block, name="made", inputs=(), simulated=False),
        "warnings": (),
        "check_points": of_orientations(*orientations),
        "check_point_residuals": tuple(
            row for name in orientations for row in residual_rows(difference_m, name)
        ),
        "images": (replace(_MADE.images[0], footprint=SQUARE),),
        "models": (parallax(20.0, 0.3, 0.2), parallax(22.0, 0.4, 0.25)),
        "bundle": None,
        "regression": regression_rows({"omega": 1e-6, "phi": 0.02, "kappa": 0.5}),
        "selection": (
            decision("omega", "linear"), decision("phi", "none"), decision("kappa", "none")
        ),
    }  # fmt: skip
    return replace(_MADE, **made | changed)


def evidence_of(difference_m, product=None, orientation="selected", **changed):
    return evidence(results_of(difference_m, **changed), orientation, product or Product())
