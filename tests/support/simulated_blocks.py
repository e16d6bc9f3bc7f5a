"""Scenarios of two strips, and what is true of the blocks simulated from them."""

import numpy as np
from minimal_scenario import changed

from posstats.block.image_pairs import stereo_models
from posstats.numerics.kernels.rotation import wrapped
from posstats.synthetic.scenario import load_scenario

SYSTEMS = ("omega-phi-kappa", "phi-omega-kappa")


LAMBERT_93 = {"crs": "EPSG:2154", "origin_m": [760_000.0, 6_300_000.0]}


UTM_33 = {"crs": "EPSG:32633", "origin_m": [640_000.0, 5_300_000.0]}


def scenario_with(**tables):
    """Two strips of five images, perfect but for what `tables` say."""
    flight = {"images_per_strip": 5} | tables.pop("flight", {})
    return load_scenario(changed(flight=flight, **tables))


def true_models(block):
    return stereo_models(block).with_orientations(block.adjusted)


def angle_errors(block):
    return wrapped(block.orientations.angles_rad - block.adjusted.angles_rad)


def intersected(block):
    """Ground points (p, 3): two-ray closest point of the first two rays, from the truth."""
    ties, truth = block.tie_points, block.adjusted
    first = np.searchsorted(ties.point, np.arange(len(ties.point_id)))
    distance = np.full(len(ties), -block.cameras[0].principal_distance_px)
    vectors = np.column_stack([ties.xy_px, distance])
    direction = np.einsum("mij,mj->mi", truth.ground_from_image[ties.image], vectors)
    a, b = direction[first], direction[first + 1]
    base = truth.position_m[ties.image[first + 1]] - truth.position_m[ties.image[first]]
    normal = np.cross(a, b)
    along = np.einsum("pi,pi->p", np.cross(base, b), normal) / (normal**2).sum(axis=1)
    return truth.position_m[ties.image[first]] + along[:, None] * a
