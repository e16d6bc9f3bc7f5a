"""What results.json holds about one orientation: the evidence that requirements are held against.

The mean shift of the check points is kept everywhere: a shift estimated from the points that
judge a product would flatter it.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import get_args

import numpy as np

from posstats.acceptance.product import Product
from posstats.arrays import Floats
from posstats.contract.check_points import CheckPointResidual
from posstats.contract.choices import JudgedOrientation
from posstats.contract.results import ModelParallax, Regression, Results
from posstats.contract.survey import ImagePlace
from posstats.errors import PosstatsError
from posstats.numerics.kernels.rotation import ANGLE_NAMES
from posstats.statistics.holm import holm

ORIENTATIONS: tuple[JudgedOrientation, ...] = get_args(JudgedOrientation)
"""What can be assessed; without a choice the first that the results hold. The order is that of
what entered the orientation, never that of the outcome at the check points."""


def model_parallax_px(model: ModelParallax, orientation: JudgedOrientation) -> float | None:
    """Vertical parallax of a stereo model from an orientation; None if it is not known."""
    return {
        "pos": model.pos_px,
        "selected": model.corrected_px,
        "adjusted": model.adjusted_px,
        "bundle": model.bundle_px,
    }[orientation]


@dataclass(frozen=True, eq=False)
class Evidence:
    """n check points and p stereo models of one orientation.

    Attributes
    ----------
    orientation
        One of `ORIENTATIONS`.
    point
        (n,) ids of the check points that were intersected.
    difference_m
        (n, 3) computed minus given, crs axes.
    survey_h_m, survey_v_m
        (n,) accuracy of their survey: radial horizontal, vertical; NaN where nobody states it.
    n_given
        Check points of the block, intersected or not.
    quadrant_share
        Smallest share of the n points in a quadrant of the block; NaN without points or plan.
    parallax_px
        (p,) RMS y-parallax of the models from this orientation.
    image_rms_px, sigma0
        Of the bundle adjustment that the orientation comes from; NaN for others.
    drift_p
        Smallest of the p-values, after Holm, of drifts that were not taken off, null hypothesis: no
        drift; 1 if every one was taken off; NaN where they are not known.
    """

    orientation: JudgedOrientation
    point: tuple[str, ...]
    difference_m: Floats
    survey_h_m: Floats
    survey_v_m: Floats
    n_given: int
    quadrant_share: float
    parallax_px: Floats
    image_rms_px: float
    sigma0: float
    drift_p: float

    def __len__(self) -> int:
        return len(self.point)


def best_orientation(results: Results) -> JudgedOrientation:
    """The first of `ORIENTATIONS` that the results hold.

    Raises
    ------
    PosstatsError
        If they hold none.
    """
    held = _held(results)
    if not held:
        raise PosstatsError("the results hold no orientation that could be assessed")
    return held[0]


def _held(results: Results) -> list[JudgedOrientation]:
    named = {row.orientation for row in results.check_points}
    return [name for name in ORIENTATIONS if name in named]


def evidence(results: Results, orientation: JudgedOrientation, product: Product) -> Evidence:
    """Collect the evidence.

    Parameters
    ----------
    product
        Its accuracy of the survey counts where the block states none, or a smaller one.

    Raises
    ------
    PosstatsError
        If the results do not hold the orientation.
    """
    held = _held(results)
    if orientation not in held:
        raise PosstatsError(
            f"the results hold no orientation {orientation}: choose one of {', '.join(held)}"
        )
    rows = [row for row in results.check_point_residuals if row.orientation == orientation]
    good = [row for row in rows if row.status == "ok"]
    survey_h, survey_v = _survey(good, product)
    bundle = results.bundle if orientation == "bundle" else None
    return Evidence(
        orientation=orientation,
        point=tuple(row.point for row in good),
        difference_m=_columns((row.dx_m, row.dy_m, row.dz_m) for row in good),
        survey_h_m=survey_h,
        survey_v_m=survey_v,
        n_given=len(rows),
        quadrant_share=_quadrant_share(results.images, good),
        parallax_px=_parallax(results.models, orientation),
        image_rms_px=float("nan") if bundle is None else _number(bundle.image_rms_px),
        sigma0=float("nan") if bundle is None else _number(bundle.sigma0),
        drift_p=_remaining_drift(results, orientation),
    )


def _number(value: float | None) -> float:
    return float("nan") if value is None else value


def _columns(rows: Iterable[tuple[float | None, float | None, float | None]]) -> Floats:
    """(n, 3), NaN where nothing is known."""
    values = [[_number(value) for value in row] for row in rows]
    return np.array(values, dtype=float).reshape(len(values), 3)


def _survey(rows: Sequence[CheckPointResidual], product: Product) -> tuple[Floats, Floats]:
    """(n,) radial horizontal and vertical; sigma_xy is that of X and of Y.

    Where both block and product state one, the larger counts: neither may flatter the product.
    """
    horizontal = np.sqrt(2.0) * np.array([_number(row.survey_sigma_xy_m) for row in rows])
    vertical = np.array([_number(row.survey_sigma_z_m) for row in rows])
    return (
        np.fmax(horizontal, _number(product.survey_sigma_h_m)),
        np.fmax(vertical, _number(product.survey_sigma_v_m)),
    )


def _quadrant_share(images: Sequence[ImagePlace], points: Sequence[CheckPointResidual]) -> float:
    """Quadrants of the rectangle, along the crs axes, around the ground that the images show."""
    corners = [corner for image in images for corner in image.footprint or ()]
    if not corners or not points:
        return float("nan")
    plan = np.array(corners, dtype=float)
    middle = 0.5 * (plan.min(axis=0) + plan.max(axis=0))
    east, north = (np.array([(point.x_m, point.y_m) for point in points]) > middle).T
    counts = np.bincount(2 * east + north, minlength=4)
    return float(counts.min() / len(points))


def _parallax(models: Sequence[ModelParallax], orientation: JudgedOrientation) -> Floats:
    numbers = (_number(model_parallax_px(model, orientation)) for model in models)
    return np.array([number for number in numbers if np.isfinite(number)], dtype=float)


def _remaining_drift(results: Results, orientation: JudgedOrientation) -> float:
    if orientation == "pos":
        tested = [("ground", angle, "block") for angle in ANGLE_NAMES]
    elif orientation == "selected":
        tested = [
            (row.frame, row.angle, row.scope) for row in results.selection if row.form != "linear"
        ]
    else:
        return float("nan")
    fits = {(row.frame, row.angle, row.scope): row for row in results.regression}
    p = [_drift_p(fits[each]) for each in tested if each in fits]
    if len(p) < len(tested) or any(np.isnan(p)):
        return float("nan")
    return min((each for each in holm(p) if each is not None), default=1.0)


def _drift_p(fit: Regression) -> float:
    """Of GLS, which is honest about correlated errors; of OLS where errors have no covariance."""
    return _number(fit.p_value if fit.gls_p_value is None else fit.gls_p_value)
