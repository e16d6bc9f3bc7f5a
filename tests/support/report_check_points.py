"""Made-up check points and their residuals."""

import math
from collections.abc import Sequence

import numpy as np

from posstats.contract.check_points import CheckPointResidual, CheckPointStatistics
from posstats.contract.survey import ImagePlace


def check_points() -> tuple[CheckPointStatistics, ...]:
    made = []
    sizes = {"pos": 7.1, "omega": 0.96, "phi": 7.0, "kappa": 7.2, "selected": 0.96}
    for orientation, size in sizes.items():
        for removed in (True, False):
            shift = (12.3 * size, -168.0 if size > 5 else -1.2, 3.4)
            scale = size if removed else size + math.hypot(shift[0], shift[1])
            made.append(
                CheckPointStatistics(
                    orientation=orientation,
                    translation_removed=removed,
                    n=15,
                    max_horizontal_m=1.9 * scale,
                    max_vertical_m=2.1 * scale,
                    min_horizontal_m=0.2 * scale,
                    min_vertical_m=0.1 * scale,
                    rmse_horizontal_m=scale,
                    rmse_vertical_m=1.34 * scale,
                    shift_m=shift,
                )
            )
    return tuple(made)


def check_point_residuals(
    images: Sequence[ImagePlace], rng: np.random.Generator
) -> tuple[CheckPointResidual, ...]:
    x = [image.x_m for image in images]
    y = [image.y_m for image in images]
    places = [
        (float(rng.uniform(min(x), max(x))), float(rng.uniform(min(y), max(y)))) for _ in range(15)
    ]
    made = []
    for orientation, size in (("pos", 7.1), ("omega", 0.96), ("selected", 0.96)):
        for k, (px, py) in enumerate(places):
            dx, dy, dz = rng.normal(0.0, size / 1.4, 3)
            made.append(
                CheckPointResidual(
                    orientation=orientation,
                    point=f"CP{k + 1:02d}",
                    n_rays=int(rng.integers(2, 7)),
                    status="ok",
                    survey_sigma_xy_m=None,
                    survey_sigma_z_m=None,
                    x_m=px,
                    dx_m=float(dx) + (80.0 if orientation == "pos" else 0.3),
                    sigma_x_m=0.3,
                    y_m=py,
                    dy_m=float(dy) - (150.0 if orientation == "pos" else 0.2),
                    sigma_y_m=0.3,
                    z_m=120.0,
                    dz_m=float(dz) * 1.3,
                    sigma_z_m=0.6,
                )
            )
    return tuple(made)
