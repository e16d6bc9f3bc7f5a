"""Results dictionaries for the tests of the reports: made by formula, shaped like results.json."""

import copy
import math
from itertools import pairwise
from typing import Any

import numpy as np

PIXEL_MM = 0.012
ANGLES = ("omega", "phi", "kappa")

ROW_KEYS = {
    "parallax": "strip method n_models max_mm min_mm mean_mm max_px min_px mean_px",
    "models": "left right strip n_points n_rejected pos_px independent_px dependent_px"
    " corrected_px",
    "error_sources": "strip fixed n_models mean_mm mean_px",
    "angle_errors": "image strip time_s omega_rad phi_rad kappa_rad sigma_omega_rad sigma_phi_rad"
    " sigma_kappa_rad used",
    "regression": "angle frame scope n n_time_clusters intercept_rad slope_rad_per_s time_origin_s"
    " r_squared f_statistic df_model df_resid p_value slope_se slope_ci95 gls_slope_rad_per_s"
    " gls_slope_se gls_slope_ci95 gls_p_value n_strips intercept_se_rad cov_intercept_slope"
    " sigma_rad gls_intercept_rad gls_intercept_se gls_cov_intercept_slope gls_df_resid"
    " white_noise_sigma_rad strip_effect_sigma_rad constant_rad constant_se_rad reason",
    "selection": "angle frame scope correct form rule reason",
    "corrected_parallax": "strip corrected n_models mean_mm mean_px",
    "check_points": "orientation translation_removed n max_horizontal_m max_vertical_m"
    " min_horizontal_m min_vertical_m rmse_horizontal_m rmse_vertical_m shift_m",
    "check_point_residuals": "orientation point x_m y_m z_m dx_m dy_m dz_m n_rays sigma_x_m"
    " sigma_y_m sigma_z_m",
    "observability": "scope unobservable images",
    "images": "image strip time_s x_m y_m z_m footprint",
    "angle_error_summary": "angle frame n mean_rad rms_rad max_abs_rad median_sigma_rad",
}


def assert_schema(results: dict[str, Any]) -> None:
    """The made-up results have exactly the keys that the results schema names."""
    for name, keys in ROW_KEYS.items():
        for row in results[name]:
            assert set(row) == set(keys.split()), name


def area_results(n_strips: int = 5, per_strip: int = 60, seed: int = 1) -> dict[str, Any]:
    """A block like the paper's area 1: an omega error of 0.018 rad that grows by 4.68e-7 rad/s."""
    rng = np.random.default_rng(seed)
    images = _images(n_strips, per_strip)
    errors = _angle_errors(images, rng)
    models = _models(images, rng)
    strips = [str(k + 1) for k in range(n_strips)]
    corrected = {"omega": 0.40, "phi": 22.6, "kappa": 22.5, "selected": 0.40}
    held = {"angles": 22.7, "omega": 22.4, "phi": 0.31, "kappa": 0.47, "none": 0.28}
    return {
        "schema": "posstats-results/1",
        "posstats_version": "0.1.0",
        "block": {
            "name": "area 1, simulated",
            "n_images": len(images),
            "n_strips": n_strips,
            "n_models": len(models),
            "n_tie_points": 114504,
            "n_check_points": 15,
            "simulated": True,
            "inputs": [
                {"file": name, "sha256": f"{k:x}" * 64}
                for k, name in enumerate(("block.toml", "orientations.csv", "tie_points.csv"), 10)
            ],
        },
        "settings": {
            "rules": "paper",
            "scope": "block",
            "errors": "coplanarity",
            "frame": "ground",
            "frame_reason": None,
            "robust": True,
        },
        "units": {"mm": True},
        "verdict": {
            **_both("raw", 22.6),
            **_both("relative", 0.28),
            **_both("corrected", 0.40),
            "cause": "omega",
            "corrected_angles": ["omega"],
        },
        "expected_noise_px": 0.27,
        "images": images,
        "parallax": _parallax(models, strips),
        "models": models,
        "error_sources": [
            {
                "strip": s,
                "fixed": name,
                "n_models": per_strip - 1,
                **_both("mean", value * rng.uniform(0.95, 1.05)),
            }
            for s in strips
            for name, value in held.items()
        ],
        "angle_errors": errors,
        "angle_error_summary": _summary(errors),
        "regression": _regression(errors, strips),
        "selection": [
            _decision("omega", "linear", "R2 0.98 reaches 0.8 and p < 0.001 is below 0.05"),
            _decision("phi", "none", "R2 0.01 is below 0.8"),
            _decision("kappa", "none", "R2 0.06 is below 0.8"),
        ],
        "corrected_parallax": [
            {
                "strip": s,
                "corrected": name,
                "n_models": per_strip - 1,
                **_both("mean", value * rng.uniform(0.95, 1.05)),
            }
            for s in strips
            for name, value in corrected.items()
        ],
        "check_points": _check_points(),
        "check_point_residuals": _residuals(images, rng),
        "observability": [
            {"scope": "block", "unobservable": [], "images": []},
            *(
                {"scope": s, "unobservable": ["rotation about the base axis"], "images": []}
                for s in strips
            ),
        ],
        "warnings": ["Strip 3: image 3_07 has fewer than 6 points in common with its neighbour."],
        "versions": {"posstats": "0.1.0", "python": "3.11.9", "numpy": "2.4.6"},
        "created": "2026-01-05",
    }


def coarse_results() -> dict[str, Any]:
    """A drone block: 17 strips, many of one image, POS angles wrong by degrees, px only."""
    results = area_results(n_strips=17, per_strip=9, seed=2)
    single = {str(k) for k in (3, 5, 8, 9, 12, 15)}
    for key in ("images", "angle_errors"):
        seen: set[str] = set()
        results[key] = [
            row
            for row in results[key]
            if row["strip"] not in single or not (row["strip"] in seen or seen.add(row["strip"]))
        ]
    for key in ("models", "parallax"):
        results[key] = [row for row in results[key] if row["strip"] not in single]
    for key in ("error_sources", "corrected_parallax"):
        for row in results[key]:
            row["mean_px"] = None if row["strip"] in single else row["mean_px"] * 12.0
    for row in results["models"]:
        row["pos_px"] *= 12.3
        row["independent_px"] *= 3.7
        row["dependent_px"] = None
        row["corrected_px"] *= 680.0
    results["models"][4] |= {
        "n_points": 4,
        "pos_px": None,
        "independent_px": None,
        "corrected_px": None,
    }
    for row in results["parallax"]:
        factor = 12.3 if row["method"] == "pos" else 3.7
        row.update({k: row[k] * factor for k in ("max_px", "min_px", "mean_px")})
    for row in results["angle_errors"]:
        row.update(
            {f"{a}_rad": row[f"{a}_rad"] * f for a, f in zip(ANGLES, (3, 2000, 4000), strict=True)}
        )
        row["used"] = row["strip"] not in single
        if not row["used"]:
            row.update(
                {f"{a}_rad": None for a in ANGLES} | {f"sigma_{a}_rad": None for a in ANGLES}
            )
    results["angle_error_summary"] = _summary([r for r in results["angle_errors"] if r["used"]])
    results["regression"] = _regression(results["angle_errors"], [str(k + 1) for k in range(17)])
    results["selection"] = [_decision(a, "none", "R2 0.02 is below 0.8") for a in ANGLES]
    results["block"] |= {
        "name": "seneca-like",
        "simulated": False,
        "n_images": len(results["images"]),
        "n_strips": 17,
        "n_models": len(results["models"]),
        "n_check_points": 0,
    }
    results["verdict"] |= {"raw_px": 279.1, "relative_px": 1.04, "corrected_px": 272.0}
    results["verdict"] |= {"cause": None, "corrected_angles": []}
    results["check_points"] = []
    results["check_point_residuals"] = []
    results["created"] = None
    results["expected_noise_px"] = None
    return _without_mm(results)


def _without_mm(results: dict[str, Any]) -> dict[str, Any]:
    stripped = copy.deepcopy(results)
    stripped["units"]["mm"] = False
    for key in ("parallax", "error_sources", "corrected_parallax"):
        for row in stripped[key]:
            row.update({name: None for name in row if name.endswith("_mm")})
    stripped["verdict"].update(raw_mm=None, relative_mm=None, corrected_mm=None)
    return stripped


def _both(name: str, px: float) -> dict[str, float]:
    return {f"{name}_px": px, f"{name}_mm": px * PIXEL_MM}


def _decision(angle: str, form: str, reason: str) -> dict[str, Any]:
    return {
        "angle": angle,
        "frame": "ground",
        "scope": "block",
        "correct": form != "none",
        "form": form,
        "rule": "paper",
        "reason": reason,
    }


def _images(n_strips: int, per_strip: int) -> list[dict[str, Any]]:
    half_x, half_y, base = 5400.0, 3000.0, 2400.0
    made = []
    for k in range(n_strips):
        for i in range(per_strip):
            x = 400000.0 + k * 7128.0
            row = i if k % 2 == 0 else per_strip - 1 - i
            y = 4100000.0 + row * base
            corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
            made.append(
                {
                    "image": f"{k + 1}_{i + 1:02d}",
                    "strip": str(k + 1),
                    "time_s": 57000.0 + k * (per_strip * 12.0 + 300.0) + i * 12.0,
                    "x_m": x,
                    "y_m": y,
                    "z_m": 9500.0,
                    "footprint": [[x + half_x * a, y + half_y * b] for a, b in corners],
                }
            )
    return made


def _angle_errors(images: list[dict[str, Any]], rng: np.random.Generator) -> list[dict[str, Any]]:
    made = []
    for image in images:
        elapsed = image["time_s"] - images[0]["time_s"]
        noise = rng.normal(0.0, (1.2e-4, 1.6e-5, 5e-5))
        values = (0.018 + 4.68e-7 * elapsed + noise[0], noise[1], noise[2])
        made.append(
            {
                "image": image["image"],
                "strip": image["strip"],
                "time_s": image["time_s"],
                **{f"{a}_rad": float(v) for a, v in zip(ANGLES, values, strict=True)},
                "sigma_omega_rad": 3e-5,
                "sigma_phi_rad": 8e-6,
                "sigma_kappa_rad": 6e-6,
                "used": True,
            }
        )
    return made


def _models(images: list[dict[str, Any]], rng: np.random.Generator) -> list[dict[str, Any]]:
    made = []
    for left, right in pairwise(images):
        if left["strip"] == right["strip"]:
            relative = float(rng.normal(0.28, 0.02))
            made.append(
                {
                    "left": left["image"],
                    "right": right["image"],
                    "strip": left["strip"],
                    "n_points": int(rng.integers(600, 900)),
                    "n_rejected": 0,
                    "pos_px": float(rng.normal(22.6, 1.5)),
                    "independent_px": relative,
                    "dependent_px": relative,
                    "corrected_px": float(rng.normal(0.40, 0.05)),
                }
            )
    return made


def _parallax(models: list[dict[str, Any]], strips: list[str]) -> list[dict[str, Any]]:
    made = []
    for strip in strips:
        for method in ("pos", "independent", "dependent"):
            values = [m[f"{method}_px"] for m in models if m["strip"] == strip]
            made.append(
                {
                    "strip": strip,
                    "method": method,
                    "n_models": len(values),
                    **_both("max", max(values)),
                    **_both("min", min(values)),
                    **_both("mean", float(np.mean(values))),
                }
            )
    return made


def _summary(errors: list[dict[str, Any]]) -> list[dict[str, Any]]:
    made = []
    for angle in ANGLES:
        values = np.array([row[f"{angle}_rad"] for row in errors])
        made.append(
            {
                "angle": angle,
                "frame": "ground",
                "n": len(values),
                "mean_rad": float(values.mean()),
                "rms_rad": float(np.sqrt(np.mean(values**2))),
                "max_abs_rad": float(abs(values).max()),
                "median_sigma_rad": errors[0][f"sigma_{angle}_rad"],
            }
        )
    return made


def _regression(errors: list[dict[str, Any]], strips: list[str]) -> list[dict[str, Any]]:
    made = []
    for angle in ANGLES:
        for scope in ("block", *strips):
            part = [r for r in errors if r["used"] and scope in ("block", r["strip"])]
            made.append(_line(angle, scope, part))
    return made


def _line(angle: str, scope: str, part: list[dict[str, Any]]) -> dict[str, Any]:
    keys = ROW_KEYS["regression"].split()
    row: dict[str, Any] = dict.fromkeys(keys)
    row |= {"angle": angle, "frame": "ground", "scope": scope, "n": len(part), "df_model": 1}
    row |= {"n_strips": len({r["strip"] for r in part}), "n_time_clusters": 1}
    if len(part) < 3:
        return row | {"reason": "fewer than 3 images with a determined error"}
    t = np.array([r["time_s"] for r in part])
    y = np.array([r[f"{angle}_rad"] for r in part])
    n, origin = len(t), float(t.mean())
    s_tt = float(((t - origin) ** 2).sum())
    slope = float(((t - origin) * (y - y.mean())).sum() / s_tt)
    residual = y - y.mean() - slope * (t - origin)
    sigma = math.sqrt(float(residual @ residual) / (n - 2))
    se = sigma / math.sqrt(s_tt)
    f_statistic = (slope / se) ** 2
    return row | {
        "n_time_clusters": row["n_strips"],
        "intercept_rad": float(y.mean()),
        "slope_rad_per_s": slope,
        "time_origin_s": origin,
        "r_squared": f_statistic / (f_statistic + n - 2),
        "f_statistic": f_statistic,
        "df_resid": n - 2,
        "p_value": math.erfc(math.sqrt(f_statistic / 2.0)),
        "slope_se": se,
        "slope_ci95": [slope - 1.97 * se, slope + 1.97 * se],
        "gls_slope_rad_per_s": slope * 1.01,
        "gls_slope_se": 5.0 * se,
        "gls_slope_ci95": [slope * 1.01 - 9.8 * se, slope * 1.01 + 9.8 * se],
        "gls_p_value": math.erfc(math.sqrt(f_statistic / 50.0)),
        "intercept_se_rad": sigma / math.sqrt(n),
        "cov_intercept_slope": 0.0,
        "sigma_rad": sigma,
        "gls_intercept_rad": float(y.mean()) + sigma / 10.0,
        "gls_intercept_se": 5.0 * sigma / math.sqrt(n),
        "gls_cov_intercept_slope": 0.0,
        "gls_df_resid": n - 2,
        "white_noise_sigma_rad": 0.8 * sigma,
        "strip_effect_sigma_rad": 0.3 * sigma if scope == "block" else None,
        "constant_rad": float(y.mean()),
        "constant_se_rad": sigma / math.sqrt(n),
    }


def _check_points() -> list[dict[str, Any]]:
    made = []
    for orientation, size in (
        ("pos", 7.1),
        ("omega", 0.96),
        ("phi", 7.0),
        ("kappa", 7.2),
        ("selected", 0.96),
    ):
        for removed in (True, False):
            shift = [12.3 * size, -168.0 if size > 5 else -1.2, 3.4]
            scale = size if removed else size + math.hypot(shift[0], shift[1])
            made.append(
                {
                    "orientation": orientation,
                    "translation_removed": removed,
                    "n": 15,
                    "max_horizontal_m": 1.9 * scale,
                    "max_vertical_m": 2.1 * scale,
                    "min_horizontal_m": 0.2 * scale,
                    "min_vertical_m": 0.1 * scale,
                    "rmse_horizontal_m": scale,
                    "rmse_vertical_m": 1.34 * scale,
                    "shift_m": shift,
                }
            )
    return made


def _residuals(images: list[dict[str, Any]], rng: np.random.Generator) -> list[dict[str, Any]]:
    x = [image["x_m"] for image in images]
    y = [image["y_m"] for image in images]
    places = [
        (float(rng.uniform(min(x), max(x))), float(rng.uniform(min(y), max(y)))) for _ in range(15)
    ]
    made = []
    for orientation, size in (("pos", 7.1), ("omega", 0.96), ("selected", 0.96)):
        for k, (px, py) in enumerate(places):
            dx, dy, dz = rng.normal(0.0, size / 1.4, 3)
            made.append(
                {
                    "orientation": orientation,
                    "point": f"CP{k + 1:02d}",
                    "x_m": px,
                    "y_m": py,
                    "z_m": 120.0,
                    "dx_m": float(dx) + (80.0 if orientation == "pos" else 0.3),
                    "dy_m": float(dy) - (150.0 if orientation == "pos" else 0.2),
                    "dz_m": float(dz) * 1.3,
                    "n_rays": int(rng.integers(2, 7)),
                    "sigma_x_m": 0.3,
                    "sigma_y_m": 0.3,
                    "sigma_z_m": 0.6,
                }
            )
    return made
