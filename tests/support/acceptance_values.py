"""Made-up acceptances for the tests of the document."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any, TypeVar

import numpy as np
from report_results import area_results

from posstats.contract.acceptance import SCHEMA, Acceptance
from posstats.contract.files import as_values, from_values
from posstats.contract.results import Results

D = TypeVar("D", Acceptance, Results)

FULL = 64  # points from which there are a blunder and a point that cannot be intersected
HOSTILE = "<script>alert(1)</script>"
FORMULA = "{{7*7}}"
LONG_ID = "P" + "1234567890" * 20
CHINESE = "成都市双流区检查点三号"

CITED = "ASPRS Positional Accuracy Standards for Digital Geospatial Data, Edition 2, Version 2"
STATEMENT = (
    "This data set was tested to meet ASPRS Positional Accuracy Standards for Digital Geospatial "
    "Data, Edition 2, Version 2 (2024) for a 10.0 (cm) RMSE_H Horizontal Positional Accuracy "
    "Class. The tested horizontal positional accuracy was found to be RMSE_H = {h:.1f} (cm)."
)


def results(simulated: bool = True) -> Results:
    """Results as the acceptance rests on."""
    made = area_results(per_strip=12)
    block = replace(made.block, simulated=simulated, n_check_points=200, crs="EPSG:32648")
    settings = replace(made.settings, position_m=0.05, angle_rad=1.0e-4, image_px=0.3)
    regression = tuple(replace(row, constant_p_value=0.2) for row in made.regression)
    return replace(made, block=block, settings=settings, regression=regression)


def edited(document: D, edit: Callable[[dict[str, Any]], object]) -> D:
    """A document with its values changed by a function."""
    values = as_values(document)
    edit(values)
    return from_values(values, type(document), "edited")


def acceptance(
    n: int = 200,
    sigma_m: float = 0.045,
    *,
    mean_m: float = 0.0,
    language: str = "en",
    seed: int = 7,
    orientation: str = "selected",
    simulated: bool = True,
) -> Acceptance:
    """An acceptance of `n` check points by the ASPRS standard, class 10 cm."""
    base = results(simulated)
    points = _points(n, sigma_m, mean_m, seed)
    accuracy = _accuracy(points)
    requirements = _requirements(accuracy, points)
    values = {
        "schema": SCHEMA,
        "posstats_version": "0.1.0",
        "versions": {"posstats": "0.1.0", "python": "3.11.9", "numpy": "2.4.6"},
        "created": "2026-01-05T00:00:00+00:00",
        "document_id": "PA-3F2A-91C0-77DE",
        "language": language,
        "verdict": verdict(requirements),
        "statements": [],
        "statement": STATEMENT.format(h=100.0 * accuracy["rmse"][2]["product_m"]) if n else "",
        "orientation": orientation,
        "orientation_reason": {"code": orientation, "values": {}},
        "profile": {
            "name": "asprs-2024",
            "edition": "Edition 2, Version 2 (2024)",
            "title": "ASPRS Positional Accuracy Standards for Digital Geospatial Data",
            "source": CITED,
            "files": [{"file": "profiles/asprs-2024.toml", "sha256": "a" * 64}],
            "notes": ["The number of check points by area is a setting of this profile."],
            "omitted": ["quadrants"],
        },
        "product": {
            "class_h_m": 0.1, "class_v_m": 0.1, "gsd_m": None, "map_scale": None, "terrain": None,
            "lot_size": None, "sample_size": None, "survey_sigma_h_m": None,
            "survey_sigma_v_m": None,
        },
        "contract": {
            "number": "2026-017", "title": "Aerial survey of area 1",
            "client": "Land Survey Office", "contractor": "Aerial Mapping Ltd",
            "inspector": "Institute for Quality of Surveys", "flight": "1-5",
            "flight_date": "2025-10-12", "sensor": "frame camera, 12 µm, f = 120 mm",
            "place": "Area 1", "remarks": "",
        },
        "block": as_values(base.block) | {"n_check_points": n},
        "results": {"file": "results.json", "sha256": "b" * 64},
        "settings": as_values(base.settings),
        "requirements": requirements,
        "quality_grade": None,
        "accuracy": accuracy,
        "check_points": points,
        "attachments": [
            {"file": name, "sha256": f"{k:x}" * 64, "relationship": kind}
            for k, (name, kind) in enumerate((
                ("block.toml", "Source"), ("profiles/asprs-2024.toml", "Source"),
                ("results.json", "Data"), ("tables/check_points.csv", "Supplement"),
            ))
        ],
        "warnings": ["Check point CP007 lies within 50 m of a control point."] if n else [],
    }  # fmt: skip
    return from_values(values, Acceptance, "made up")


def cases() -> dict[str, Acceptance]:
    """Every kind of acceptance that the document has to show."""
    return {
        "accepted": acceptance(),
        "rejected": acceptance(sigma_m=0.12, mean_m=0.06),
        "not assessable": edited(acceptance(FULL), _without_survey),
        "borderline": acceptance(FULL, sigma_m=0.062, seed=3),
        "few": acceptance(12),
        "none": acceptance(0),
        "long": edited(acceptance(), _long),
        "hostile": edited(acceptance(FULL), _hostile),
        "chinese names": edited(acceptance(FULL), _chinese),
    }


def verdict(requirements: list[dict[str, Any]]) -> str:
    if any(row["verdict"] == "fail" for row in requirements):
        return "rejected"
    unsettled = [r for r in requirements if r["verdict"] == "not assessed" and r["mandatory"]]
    return "not assessable" if unsettled else "accepted"


def _points(n: int, sigma: float, mean: float, seed: int) -> list[dict[str, Any]]:
    rng = np.random.default_rng(seed)
    made = []
    for k in range(n):
        d = rng.normal(mean, sigma, 3)
        blunder = n >= FULL and k == 33
        d = d * 5.0 if blunder else d
        lost = n >= FULL and k == 60
        made.append({
            "point": f"CP{k + 1:03d}",
            "x_m": 400000.0 + float(rng.uniform(0, 28500)),
            "y_m": 4100000.0 + float(rng.uniform(0, 26400)),
            "z_m": 120.0 + float(rng.normal(0, 20)),
            **dict(zip(("dx_m", "dy_m", "dz_m"),
                       (None,) * 3 if lost else map(float, d), strict=True)),
            "dh_m": None if lost else math.hypot(d[0], d[1]),
            "sigma_x_m": 0.03, "sigma_y_m": 0.03, "sigma_z_m": 0.06,
            "survey_sigma_xy_m": 0.015, "survey_sigma_z_m": 0.02,
            "n_rays": 1 if lost else int(rng.integers(2, 9)),
            "status": "fewer than two rays" if lost else "ok",
            "blunder": blunder,
        })  # fmt: skip
    return made


def _accuracy(points: list[dict[str, Any]]) -> dict[str, Any]:
    known = [p for p in points if p["status"] == "ok"]
    d = np.array([(p["dx_m"], p["dy_m"], p["dz_m"]) for p in known]).reshape(-1, 3)
    n = len(known)
    parts = {"x": d[:, :1], "y": d[:, 1:2], "h": d[:, :2], "v": d[:, 2:], "3d": d}
    measures = {"x": 39, "y": 39, "h": 47, "v": 39, "3d": None}
    dh, dv = np.hypot(d[:, 0], d[:, 1]), np.abs(d[:, 2])
    return {
        "n": n, "n_given": len(points), "survey_known": n > 0,
        "survey_h_m": 0.015 * math.sqrt(2) if n else None, "survey_v_m": 0.02 if n else None,
        "rmse": [_rmse(c, part, measures[c]) for c, part in parts.items()],
        "mean_error": [
            {"component": c, "iso_19157": 128, "value_m": float(d[:, k].mean()) if n else None,
             "se_m": float(d[:, k].std(ddof=1) / math.sqrt(n)) if n > 1 else None,
             "p": 0.31 + 0.2 * k if n > 1 else None}
            for k, c in enumerate("xyz")
        ],
        "percentiles": [
            _percentile(name, iso, dh if name[0] == "C" else dv)
            for name, iso in (("CE90", 44), ("CE95", 45), ("LE90", 35), ("LE95", 36))
        ],
        "covariance_iso_19157": 32,
        "covariance_m2": np.cov(d.T).tolist() if n > 1 else 3 * [3 * [None]],
        "mean_shift": {"t2": 4.21, "f": 1.389, "df1": 3, "df2": n - 3, "p": 0.247, "reason": None}
        if n > 3 else
        {"t2": None, "f": None, "df1": 3, "df2": n - 3, "p": None, "reason": "no_points"},
        "normality": [
            {"component": c, "w": 0.993 if n > 2 else None, "p": 0.46 if n > 2 else None,
             "reason": None if n > 2 else "no_points"}
            for c in "xyz"
        ],
        "largest_residual": [
            {"component": c, "point": known[int(np.abs(d[:, k]).argmax())]["point"] if n else None,
             "value_m": float(np.abs(d[:, k]).max()) if n else None, "p": 0.04 if n else None,
             "reason": None if n else "no_points"}
            for k, c in enumerate("xyz")
        ],
    }  # fmt: skip


def _rmse(component: str, part: Any, measure: int | None) -> dict[str, Any]:
    n = len(part)
    value = float(np.sqrt((part**2).sum() / n)) if n else None
    survey = {"x": 0.015, "y": 0.015, "h": 0.0212, "v": 0.02, "3d": 0.0292}[component]
    return {
        "component": component, "iso_19157": measure, "value_m": value,
        "low_m": value * (1 - 1.3 / math.sqrt(2 * n)) if n else None,
        "high_m": value * (1 + 1.5 / math.sqrt(2 * n)) if n else None,
        "df": float(n * part.shape[1]) if n else None,
        "product_m": math.hypot(value, survey) if n else None,
    }  # fmt: skip


def _percentile(name: str, measure: int, lengths: Any) -> dict[str, Any]:
    if not len(lengths):
        return {"name": name, "iso_19157": measure,
                "value_m": None, "low_m": None, "high_m": None, "normal_m": None,
                "n_for_high": 36}  # fmt: skip
    value = float(np.percentile(lengths, float(name[2:])))
    return {"name": name, "iso_19157": measure, "value_m": value, "low_m": 0.92 * value,
            "high_m": 1.09 * value, "normal_m": 0.98 * value, "n_for_high": 36}  # fmt: skip


def _requirements(accuracy: dict[str, Any], points: list[dict[str, Any]]) -> list[dict[str, Any]]:
    rmse = {row["component"]: row for row in accuracy["rmse"]}
    mean = [row["value_m"] for row in accuracy["mean_error"]]
    largest = max(map(abs, mean)) if accuracy["n"] else None
    blunders = float(sum(p["blunder"] for p in points))
    n = float(accuracy["n"])
    h, v = rmse["h"], rmse["v"]
    return [
        _row("rmse_h", "7.5", "product_rmse_h", h["product_m"], 0.1, "class_h", h),
        _row("rmse_v", "7.6", "product_rmse_v", v["product_m"], 0.1, "class_v", v),
        _row("mean_error", "7.2", "largest_mean_error", largest, 0.025,
             "0.25 * min(class_h, class_v)", exceeding="investigate"),
        _row("survey_h", "7.12", "survey_h", accuracy["survey_h_m"], 0.05, "class_h / 2"),
        _row("survey_v", "7.12", "survey_v", accuracy["survey_v_m"], 0.05, "class_v / 2"),
        _row("points", "7.13", "n_check_points", n, 30.0, "30", unit="1"),
        _row("blunders_h", "7.13", "n_blunders_h", blunders if n else None, 2.0, "2", unit="1",
             threshold=0.3),
        _row("drift", "", "remaining_drift_p", 0.21 if n else None, 0.05, "0.05", unit="1",
             mandatory=False),
        _row("parallax", "", "parallax_rms_px", 0.4, 0.667, "0.667", unit="px", mandatory=False),
    ]  # fmt: skip


def _row(
    name: str, clause: str, quantity: str, found: float | None, limit: float, formula: str,
    around: dict[str, Any] | None = None, *, unit: str = "m", mandatory: bool = True,
    exceeding: str = "fail", threshold: float | None = None,
) -> dict[str, Any]:  # fmt: skip
    at_least = quantity in {"n_check_points", "remaining_drift_p"}
    margin = None if found is None else (found - limit if at_least else limit - found)
    low, high = (around["low_m"], around["high_m"]) if around else (None, None)
    row = {
        "id": name, "clause": clause, "quantity": quantity,
        "source": f"{CITED}, {clause or 'contract'}.",
        "mandatory": mandatory, "exceeding": exceeding, "threshold": threshold, "found": found,
        "limit": limit, "limit_formula": formula, "unit": unit, "margin": margin,
        "verdict": "not assessed", "reason": "", "reason_code": "no check points",
        "reason_values": {}, "low": low, "high": high, "n_to_decide": None, "score": None,
    }  # fmt: skip
    if margin is not None:
        beyond = "investigate" if exceeding == "investigate" else "exceeds"
        row["reason_code"] = "within" if margin >= 0 else beyond
        row["reason_values"] = {"found": found, "limit": limit}
        row["verdict"] = (
            "pass" if margin >= 0 else "fail" if beyond == "exceeds" else "not assessed"
        )
    if low is not None and low <= limit <= high:
        row["n_to_decide"] = 2431
    return row


def _without_survey(made: dict[str, Any]) -> None:
    made["accuracy"] |= {"survey_known": False, "survey_h_m": None, "survey_v_m": None}
    for row in made["accuracy"]["rmse"]:
        row["product_m"] = None
    for point in made["check_points"]:
        point |= {"survey_sigma_xy_m": None, "survey_sigma_z_m": None}
    for row in made["requirements"]:
        if row["quantity"].startswith(("survey", "product")):
            row |= {"found": None, "margin": None, "verdict": "not assessed", "low": None,
                    "high": None, "reason_code": "survey accuracy not stated",
                    "reason_values": {}}  # fmt: skip
    made["verdict"] = verdict(made["requirements"])


def _long(made: dict[str, Any]) -> None:
    made["contract"] |= {
        "title": "Digital aerial photography, aerial triangulation and orthophoto production for "
        "the third national land survey, lot 14, counties of the upper valley and the basin",
        "client": "State Office for Surveying, Geographic Information, Cadastre and Land "
        "Consolidation of the Upper Valley, Department 4 (Remote Sensing)",
        "contractor": "Consortium of " + " and ".join(f"Surveying Partner {k} Ltd" for k in "ABCD"),
        "remarks": "Night flights excluded. " * 6,
    }
    made["check_points"][3]["point"] = LONG_ID
    made["check_points"][33]["point"] = LONG_ID[::-1]
    made["attachments"][0]["file"] = "a_very_long_name_of_a_file_" * 4 + ".toml"


def _hostile(made: dict[str, Any]) -> None:
    made["contract"] |= {"title": HOSTILE, "client": FORMULA, "sensor": "a\u202eb & \"c\" 'd'"}
    made["contract"]["inspector"] = "{report.version} %s </style>"
    made["document_id"] = 'PA"; } </style>' + HOSTILE
    made["check_points"][0]["point"] = HOSTILE
    made["check_points"][33]["point"] = FORMULA
    made["attachments"][0]["file"] = HOSTILE
    made["warnings"] = [HOSTILE, FORMULA]
    made["profile"]["title"] = HOSTILE
    made["accuracy"]["largest_residual"][0]["point"] = HOSTILE


def _chinese(made: dict[str, Any]) -> None:
    made["contract"] |= {"title": "成都市航空摄影测量", "client": "成都市自然资源局"}
    made["check_points"][5]["point"] = CHINESE


def chinese_contract(document: Acceptance) -> Acceptance:
    """The same acceptance of a contract in Chinese."""
    return edited(document, _in_chinese)


def _in_chinese(made: dict[str, Any]) -> None:
    made["language"] = "zh"
    made["contract"] |= {
        "title": "某市 1:2000 数字航空摄影测量项目",
        "client": "某市自然资源和规划局", "contractor": "某航空遥感有限公司",
        "inspector": "某省测绘产品质量监督检验站", "flight": "第 1～5 架次",
        "sensor": "框幅式数字航摄仪，像元 12 µm，焦距 120 mm", "place": "第一测区",
    }  # fmt: skip
