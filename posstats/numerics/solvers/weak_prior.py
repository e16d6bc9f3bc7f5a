"""Priors that make unknowns solvable without deciding them."""

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]

_SMALLEST_ANGLE_PRIOR_RAD = float(np.radians(1.0))
_ANGLE_PRIOR_FACTOR = 10.0


def weak_prior_rad(sigma_angles_rad: _Floats) -> _Floats:
    """Standard deviations of POS angles that give an adjustment a solution, and hardly a pull."""
    weak: _Floats = np.maximum(_SMALLEST_ANGLE_PRIOR_RAD, _ANGLE_PRIOR_FACTOR * sigma_angles_rad)
    return weak
