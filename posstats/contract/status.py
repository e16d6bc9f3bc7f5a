"""Whether a model could be oriented, a point intersected: values of the interface."""

from typing import Literal

PointStatus = Literal[
    "ok", "fewer than two rays", "parallel rays", "behind the camera", "not converged"
]
ModelStatus = Literal[
    "ok",
    "no orientation",
    "fewer than 6 points",
    "fewer than 6 points after rejection",
    "not converged",
    "degenerate: zero base",
    "degenerate: base without horizontal extent",
    "degenerate: the points do not determine the elements",
    "degenerate: the images turn by more than 60 degrees",
]
