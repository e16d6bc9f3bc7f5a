"""Results for the tests of the reports: made by formula, of the contract's own types."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
from report_check_points import check_point_residuals, check_points
from report_regression import ANGLES, regressions

from posstats.contract.notice import Notice, listing
from posstats.contract.results import (
    AnalysedBlock,
    AnalysisSettings,
    AngleErrorSummary,
    CorrectedParallax,
    ErrorSource,
    ImageAngleErrors,
    ModelParallax,
    Observability,
    Results,
    Selection,
    StripParallax,
    Units,
    Verdict,
)
from posstats.contract.survey import ImagePlace, InputFile
from posstats.reports.block.wording import with_words

NOTICES = listing("models_with_few_points", ["3_07 - 3_08"], n_needed=6)

PIXEL_MM = 0.012
_HELD = {"angles": 22.7, "omega": 22.4, "phi": 0.31, "kappa": 0.47, "none": 0.28}
_CORRECTED = {"omega": 0.40, "phi": 22.6, "kappa": 22.5, "selected": 0.40}


def with_rows(results: Results, name: str, change: Callable[[Any], Any]) -> Results:
    """The results with every row of a list changed by a function."""
    return replace(results, **{name: tuple(change(row) for row in getattr(results, name))})


def by_strips(results: Results) -> Results:
    """The results as if decided strip by strip: omega linear in strip 2, nothing else."""
    decided = [
        replace(row, scope=scope, correct=linear, form="linear" if linear else "none")
        for scope in dict.fromkeys(image.strip for image in results.images)
        for row in results.selection
        for linear in (row.angle == "omega" and scope == "2",)
    ]
    of_strips = replace(results.settings, scope="strip")
    return replace(results, settings=of_strips, selection=tuple(decided))


def area_results(n_strips: int = 5, per_strip: int = 60, seed: int = 1) -> Results:
    """A block like the paper's area 1: an omega error of 0.018 rad that grows by 4.68e-7 rad/s."""
    rng = np.random.default_rng(seed)
    images = _images(n_strips, per_strip)
    errors = _angle_errors(images, rng)
    models = _models(images, rng)
    strips = [str(k + 1) for k in range(n_strips)]
    made = Results(
        posstats_version="0.1.0",
        created="2026-01-05",
        versions={"posstats": "0.1.0", "python": "3.11.9", "numpy": "2.4.6"},
        block=_block(len(images), n_strips, len(models)),
        settings=_settings(),
        units=Units(mm=True),
        verdict=_verdict(),
        expected_noise_px=0.27,
        images=images,
        parallax=_parallax(models, strips),
        models=models,
        error_sources=tuple(
            ErrorSource(strip=s, fixed=name, n_models=per_strip - 1, **_mean(value, rng))
            for s in strips
            for name, value in _HELD.items()
        ),
        angle_errors=errors,
        angle_error_summary=_summary(errors),
        bundle=None,
        regression=regressions(errors, strips),
        frames=(),
        selection=(
            _decision("omega", "linear", 0.98),
            _decision("phi", "none", 0.01),
            _decision("kappa", "none", 0.06),
        ),
        corrected_parallax=tuple(
            CorrectedParallax(strip=s, corrected=name, n_models=per_strip - 1, **_mean(value, rng))
            for s in strips
            for name, value in _CORRECTED.items()
        ),
        check_points=check_points(),
        check_point_residuals=check_point_residuals(images, rng),
        observability=(
            Observability(scope="block", images=()),
            *(Observability(scope=s, rotations=("about_base_axis",), images=()) for s in strips),
        ),
        notices=NOTICES,
    )
    return with_words(made)


def coarse_results() -> Results:
    """A drone block: 17 strips, many of one image, POS angles wrong by degrees, px only."""
    results = area_results(n_strips=17, per_strip=9, seed=2)
    single = {str(k) for k in (3, 5, 8, 9, 12, 15)}
    images = _first_of(results.images, single)
    errors = tuple(_coarse_error(row, row.strip in single) for row in
                   _first_of(results.angle_errors, single))  # fmt: skip
    models = tuple(_coarse_model(row) for row in results.models if row.strip not in single)
    models = (*models[:4], _unsolved(models[4]), *models[5:])
    coarse = replace(
        results,
        created=None,
        expected_noise_px=None,
        units=Units(mm=False),
        images=images,
        angle_errors=errors,
        models=models,
        parallax=tuple(_coarse_strip(row) for row in results.parallax if row.strip not in single),
        error_sources=tuple(_coarse_mean(row, single) for row in results.error_sources),
        corrected_parallax=tuple(_coarse_mean(row, single) for row in results.corrected_parallax),
        angle_error_summary=_summary([row for row in errors if row.used]),
        regression=regressions(errors, [str(k + 1) for k in range(17)]),
        selection=tuple(_decision(angle, "none", 0.02) for angle in ANGLES),
        check_points=(),
        check_point_residuals=(),
        block=replace(results.block, name="seneca-like", simulated=False, n_images=len(images),
                      n_models=len(models), n_check_points=0),
        verdict=replace(results.verdict, raw_px=279.1, relative_px=1.04, corrected_px=272.0,
                        cause=None, corrected_angles=(), raw_mm=None, relative_mm=None,
                        corrected_mm=None),
    )  # fmt: skip
    return with_words(coarse)


def _first_of(listed: Iterable[Any], single: set[str]) -> tuple[Any, ...]:
    """Rows of strips; of single ones the first only."""
    seen: set[str] = set()
    kept = []
    for row in listed:
        if row.strip not in single or row.strip not in seen:
            kept.append(row)
        seen.add(row.strip)
    return tuple(kept)


def _coarse_error(row: ImageAngleErrors, is_unused: bool) -> ImageAngleErrors:
    if is_unused:
        return replace(row, used=False, **dict.fromkeys(
            f"{sigma}{angle}_rad" for sigma in ("", "sigma_") for angle in ANGLES))  # fmt: skip
    factors = zip(ANGLES, (3, 2000, 4000), strict=True)
    return replace(row, **{f"{a}_rad": getattr(row, f"{a}_rad") * f for a, f in factors})


def _coarse_model(row: ModelParallax) -> ModelParallax:
    return replace(row, pos_px=row.pos_px * 12.3, independent_px=row.independent_px * 3.7,
                   dependent_px=None, corrected_px=row.corrected_px * 680.0)  # fmt: skip


def _unsolved(row: ModelParallax) -> ModelParallax:
    return replace(row, n_points=4, pos_px=None, independent_px=None, corrected_px=None)


def _coarse_strip(row: StripParallax) -> StripParallax:
    factor = 12.3 if row.method == "pos" else 3.7
    return replace(row, max_px=row.max_px * factor, min_px=row.min_px * factor,
                   mean_px=row.mean_px * factor,
                   max_mm=None, min_mm=None, mean_mm=None)  # fmt: skip


def _coarse_mean(row: Any, single: set[str]) -> Any:
    mean = None if row.strip in single else row.mean_px * 12.0
    return replace(row, mean_px=mean, mean_mm=None)


def _mean(px: float, rng: np.random.Generator) -> dict[str, float]:
    return _both("mean", px * rng.uniform(0.95, 1.05))


def _both(name: str, px: float) -> dict[str, float]:
    return {f"{name}_px": px, f"{name}_mm": px * PIXEL_MM}


def _block(n_images: int, n_strips: int, n_models: int) -> AnalysedBlock:
    names = ("block.toml", "orientations.csv", "tie_points.csv")
    return AnalysedBlock(
        name="area 1, simulated",
        n_images=n_images,
        n_strips=n_strips,
        n_models=n_models,
        n_tie_points=114504,
        n_check_points=15,
        simulated=True,
        crs=None,
        angles="omega-phi-kappa",
        inputs=tuple(
            InputFile(file=name, sha256=f"{k:x}" * 64) for k, name in enumerate(names, 10)
        ),
    )


def _settings() -> AnalysisSettings:
    return AnalysisSettings(
        rules="paper",
        scope="block",
        errors="coplanarity",
        frame="ground",
        frame_setting="ground",
        robust=True,
        position_m=0.05,
        angle_rad=1.0e-4,
        image_px=0.3,
    )


def _verdict() -> Verdict:
    return Verdict(
        **_both("raw", 22.6),
        **_both("relative", 0.28),
        **_both("corrected", 0.40),
        raw_median_px=None,
        relative_median_px=None,
        corrected_median_px=None,
        cause="omega",
        cause_share=None,
        corrected_angles=("omega",),
    )


def _decision(angle: str, form: str, r_squared: float) -> Selection:
    values = {
        "significance": "significant", "slope_rad_per_s": 4.73e-7, "slope_se_rad_per_s": 5.5e-9,
        "p": 1e-9, "alpha": 0.05, "r_squared": r_squared, "min_r_squared": 0.8,
    }  # fmt: skip
    code = "drift_explains" if r_squared >= 0.8 else "drift_explains_little"
    return Selection(
        angle=angle,
        frame="ground",
        scope="block",
        correct=form != "none",
        form=form,
        rule="paper",
        fit="ols",
        notices=(Notice(code=code, values=values),),
    )


def _images(n_strips: int, per_strip: int) -> tuple[ImagePlace, ...]:
    half_x, half_y, base = 5400.0, 3000.0, 2400.0
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    made = []
    for k in range(n_strips):
        for i in range(per_strip):
            x = 400000.0 + k * 7128.0
            row = i if k % 2 == 0 else per_strip - 1 - i
            y = 4100000.0 + row * base
            made.append(
                ImagePlace(
                    image=f"{k + 1}_{i + 1:02d}",
                    strip=str(k + 1),
                    time_s=57000.0 + k * (per_strip * 12.0 + 300.0) + i * 12.0,
                    x_m=x,
                    y_m=y,
                    z_m=9500.0,
                    footprint=tuple((x + half_x * a, y + half_y * b) for a, b in corners),
                )
            )
    return tuple(made)


def _angle_errors(
    images: Sequence[ImagePlace], rng: np.random.Generator
) -> tuple[ImageAngleErrors, ...]:
    made = []
    for image in images:
        elapsed = image.time_s - images[0].time_s
        noise = rng.normal(0.0, (1.2e-4, 1.6e-5, 5e-5))
        made.append(
            ImageAngleErrors(
                image=image.image,
                strip=image.strip,
                time_s=image.time_s,
                omega_rad=float(0.018 + 4.68e-7 * elapsed + noise[0]),
                sigma_omega_rad=3e-5,
                phi_rad=float(noise[1]),
                sigma_phi_rad=8e-6,
                kappa_rad=float(noise[2]),
                sigma_kappa_rad=6e-6,
                used=True,
            )
        )
    return tuple(made)


def _models(images: Sequence[ImagePlace], rng: np.random.Generator) -> tuple[ModelParallax, ...]:
    made = []
    for left, right in pairwise(images):
        if left.strip == right.strip:
            relative = float(rng.normal(0.28, 0.02))
            made.append(
                ModelParallax(
                    left=left.image,
                    right=right.image,
                    strip=left.strip,
                    n_points=int(rng.integers(600, 900)),
                    n_rejected=0,
                    pos_px=float(rng.normal(22.6, 1.5)),
                    independent_px=relative,
                    dependent_px=relative,
                    corrected_px=float(rng.normal(0.40, 0.05)),
                    status="ok",
                )
            )
    return tuple(made)


def _parallax(models: Sequence[ModelParallax], strips: list[str]) -> tuple[StripParallax, ...]:
    made = []
    for strip in strips:
        for method in ("pos", "independent", "dependent"):
            values = [getattr(m, f"{method}_px") for m in models if m.strip == strip]
            made.append(
                StripParallax(
                    strip=strip,
                    method=method,
                    n_models=len(values),
                    **_both("max", max(values)),
                    **_both("min", min(values)),
                    **_both("mean", float(np.mean(values))),
                )
            )
    return tuple(made)


def _summary(errors: Sequence[ImageAngleErrors]) -> tuple[AngleErrorSummary, ...]:
    made = []
    for angle in ANGLES:
        values = np.array([getattr(row, f"{angle}_rad") for row in errors])
        made.append(
            AngleErrorSummary(
                angle=angle,
                frame="ground",
                n=len(values),
                mean_rad=float(values.mean()),
                rms_rad=float(np.sqrt(np.mean(values**2))),
                max_abs_rad=float(abs(values).max()),
                median_sigma_rad=getattr(errors[0], f"sigma_{angle}_rad"),
            )
        )
    return tuple(made)
