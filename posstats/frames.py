"""Ground frames: the map grid of the files and the Cartesian frame of the computation."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]


@dataclass(frozen=True)
class GroundFrame:
    """Cartesian frame taken as it is (no crs, or ``frame = "grid"``)."""

    crs: str | None = None
