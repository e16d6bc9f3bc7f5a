"""The additional parameters of an adjustment that follow from its settings."""

import numpy as np

from posstats.block.model import Block
from posstats.contract.choices import SelfCalibration
from posstats.errors import PosstatsError
from posstats.numerics.bundle.parameters import (
    BLOCK,
    BORESIGHT,
    GNSS_DRIFTS,
    GNSS_SHIFTS,
    IMU_DRIFTS,
    IMU_SHIFTS,
    LEVER_ARM,
    CommonParameter,
    drift_parameters,
)
from posstats.settings import AdjustmentSettings

_DEFORMATION: dict[SelfCalibration, tuple[str, ...]] = {
    "none": (),
    "bauer": ("bauer_s1", "bauer_s2", "bauer_s3"),
    "brown": ("brown_k1", "brown_k2", "brown_k3", "brown_p1", "brown_p2"),
}
INTERIOR = ("camera_c", "camera_x0", "camera_y0")


def additional_parameters(
    block: Block, settings: AdjustmentSettings
) -> tuple[CommonParameter, ...]:
    """The additional unknowns of a block.

    Raises
    ------
    PosstatsError
        If Bauer's parameters, which count in mm, are wanted of a camera without pixel size.
    """
    arm = LEVER_ARM if settings.lever_arm else ()
    return (
        *_pos_parameters(block, settings),
        *drift_parameters(arm, (BLOCK,), settings.priors.lever_arm_m),
        *_image_parameters(block, settings),
    )


def _pos_parameters(block: Block, settings: AdjustmentSettings) -> tuple[CommonParameter, ...]:
    """Boresight, and equations 7 and 8 for every scope; drifts where there is a time to drift."""
    if settings.drift == "none":
        return ()
    pos, priors = block.orientations, settings.priors
    scopes = pos.strips if settings.drift == "strip" else (BLOCK,)
    inside = {scope: (pos.strip == scope) | (scope == BLOCK) for scope in scopes}
    lasting = [scope for scope in scopes if np.ptp(pos.time_s[inside[scope]]) > 0.0]
    return (
        *drift_parameters(BORESIGHT, (BLOCK,), priors.boresight_rad),
        *drift_parameters(GNSS_SHIFTS, scopes, priors.shift_m),
        *drift_parameters(GNSS_DRIFTS, lasting, priors.drift_m_per_s),
        *drift_parameters(IMU_SHIFTS, scopes, priors.shift_rad),
        *drift_parameters(IMU_DRIFTS, lasting, priors.drift_rad_per_s),
    )


def _image_parameters(block: Block, settings: AdjustmentSettings) -> tuple[CommonParameter, ...]:
    """Free parameters of every camera: interior orientation and deformation."""
    model = settings.self_calibration
    if model == "bauer" and any(camera.pixel_size_mm is None for camera in block.cameras):
        raise PosstatsError(
            "self-calibration after Bauer counts in mm: it needs the pixel size of the camera"
            " (camera.pixel_size_mm)"
        )
    several = len(block.cameras) > 1
    scopes = [camera.id for camera in block.cameras] if several else [BLOCK]
    interior = INTERIOR if settings.camera else ()
    return drift_parameters((*interior, *_DEFORMATION[model]), scopes)
