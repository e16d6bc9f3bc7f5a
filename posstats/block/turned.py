"""Orientations turned by angle errors."""

import numpy as np

from posstats.arrays import Floats
from posstats.block.model import Orientations
from posstats.numerics.kernels.rotation import angles_from_rotation, rotation_from_vector

FULL_TURN = 2.0 * np.pi


def corrected(orientations: Orientations, predicted_rad: Floats, frame: str) -> Orientations:
    """Orientations without the predicted errors.

    Parameters
    ----------
    predicted_rad
        (n, 3) errors. Frame "ground": POS minus true omega, phi, kappa. Frame "camera": rotation
        vector e about image x, y, z with R_pos = R_true exp([e]x).
    frame
        "ground" or "camera".

    Notes
    -----
    An image whose predicted errors are zero keeps its angles to the last digit.
    """
    recorded = orientations.angles_rad
    if frame == "ground":
        angles = recorded - predicted_rad
    else:
        rotation = orientations.ground_from_image @ rotation_from_vector(-predicted_rad)
        angles = angles_from_rotation(rotation, orientations.system)
    touched = np.any(predicted_rad != 0.0, axis=1)[:, None]
    return orientations.with_angles(np.where(touched, _in_turn_of(angles, recorded), recorded))


def _in_turn_of(angles_rad: Floats, recorded_rad: Floats) -> Floats:
    """Angles in the turn that the recorded ones use: 0 to 360 degrees, else -180 to 180."""
    start = np.where(
        (np.nanmin(recorded_rad, 0) >= 0) & (np.nanmax(recorded_rad, 0) > np.pi), 0.0, -np.pi
    )
    outside = (angles_rad < start) | (angles_rad >= start + FULL_TURN)
    return np.where(outside, (angles_rad - start) % FULL_TURN + start, angles_rad)
