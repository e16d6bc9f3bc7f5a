"""Types of arrays, said once; shapes and units stand where the arrays do."""

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.intp]
Bools = NDArray[np.bool_]
Ids = NDArray[np.object_]
"""Ids of images, points, strips: text."""
