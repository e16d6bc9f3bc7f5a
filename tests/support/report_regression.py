"""Regressions of made-up angle errors on time, by the closed forms of a straight line."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from posstats.contract.notice import Notice
from posstats.contract.results import (
    ImageAngleErrors,
    Regression,
)

ANGLES = ("omega", "phi", "kappa")


def regressions(errors: Sequence[ImageAngleErrors], strips: list[str]) -> tuple[Regression, ...]:
    made = []
    for angle in ANGLES:
        for scope in ("block", *strips):
            part = [row for row in errors if row.used and scope in ("block", row.strip)]
            made.append(_line(angle, scope, part))
    return tuple(made)


def _line(angle: str, scope: str, part: Sequence[ImageAngleErrors]) -> Regression:
    known = dict.fromkeys(Regression.__dataclass_fields__)
    known |= {"angle": angle, "frame": "ground", "scope": scope, "n": len(part), "df_model": 1}
    known |= {"n_strips": len({row.strip for row in part}), "n_time_clusters": 1}
    known |= {"covariance_known": True}
    if len(part) < 3:
        few = {"n": len(part), "n_needed": 3}
        return Regression(**known | {"notice": Notice(code="too_few_images", values=few)})
    return Regression(**known | _fit(angle, scope, part) | {"n_time_clusters": known["n_strips"]})


def _fit(angle: str, scope: str, part: Sequence[ImageAngleErrors]) -> dict[str, Any]:
    t = np.array([row.time_s for row in part])
    y = np.array([getattr(row, f"{angle}_rad") for row in part])
    n, origin = len(t), float(t.mean())
    s_tt = float(((t - origin) ** 2).sum())
    slope = float(((t - origin) * (y - y.mean())).sum() / s_tt)
    residual = y - y.mean() - slope * (t - origin)
    sigma = math.sqrt(float(residual @ residual) / (n - 2))
    se = sigma / math.sqrt(s_tt)
    f_statistic = (slope / se) ** 2
    return {
        "intercept_rad": float(y.mean()),
        "slope_rad_per_s": slope,
        "time_origin_s": origin,
        "r_squared": f_statistic / (f_statistic + n - 2),
        "f_statistic": f_statistic,
        "df_resid": float(n - 2),
        "p_value": math.erfc(math.sqrt(f_statistic / 2.0)),
        "slope_se": se,
        "slope_ci95": (slope - 1.97 * se, slope + 1.97 * se),
        "gls_slope_rad_per_s": slope * 1.01,
        "gls_slope_se": 5.0 * se,
        "gls_slope_ci95": (slope * 1.01 - 9.8 * se, slope * 1.01 + 9.8 * se),
        "gls_p_value": math.erfc(math.sqrt(f_statistic / 50.0)),
        "intercept_se_rad": sigma / math.sqrt(n),
        "cov_intercept_slope": 0.0,
        "sigma_rad": sigma,
        "gls_intercept_rad": float(y.mean()) + sigma / 10.0,
        "gls_intercept_se": 5.0 * sigma / math.sqrt(n),
        "gls_cov_intercept_slope": 0.0,
        "gls_df_resid": float(n - 2),
        "white_noise_sigma_rad": 0.8 * sigma,
        "strip_effect_sigma_rad": 0.3 * sigma if scope == "block" else None,
        "constant_rad": float(y.mean()),
        "constant_se_rad": sigma / math.sqrt(n),
    }
