"""Priors that make unknowns solvable without deciding them."""

import numpy as np

from posstats.arrays import Floats

_SMALLEST_ANGLE_PRIOR_RAD = float(np.radians(1.0))
_ANGLE_PRIOR_FACTOR = 10.0


def weak_prior_rad(sigma_angles_rad: Floats) -> Floats:
    """Standard deviations of POS angles that give an adjustment a solution, and hardly a pull."""
    weak: Floats = np.maximum(_SMALLEST_ANGLE_PRIOR_RAD, _ANGLE_PRIOR_FACTOR * sigma_angles_rad)
    return weak
