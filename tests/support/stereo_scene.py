"""Stereo models of known truth, projected with numpy alone: oracle of the orientation tests."""

import numpy as np
from scipy.optimize import least_squares

from posstats.block.image_pairs import ImagePairs, StereoModels
from posstats.block.model import Orientations
from posstats.numerics.kernels.coplanarity import base_frames, y_parallax
from posstats.numerics.kernels.rotation import angles_from_rotation, rotation_from_angles

PRINCIPAL_DISTANCE_PX = np.array([10000.0, 8000.0])  # of two cameras
PIXEL_SIZE_MM = np.array([0.012, np.nan])
HEIGHT_M = 3000.0
BASE_M = 900.0
SYSTEMS = ("omega-phi-kappa", "phi-omega-kappa")
METHODS = ("independent", "dependent", "angles", "omega", "phi", "kappa")


def true_models(
    n_models=6,
    n_points=60,
    *,
    seed=0,
    system="omega-phi-kappa",
    tilt_rad=0.02,
    climb_m=30.0,
    relief_m=200.0,
    cameras=(0,),
):
    """Perfect models in all directions of flight; every model is a strip of its own."""
    rng = np.random.default_rng(seed)
    heading = rng.uniform(-np.pi, np.pi, n_models)
    forward = np.stack([np.cos(heading), np.sin(heading), np.zeros(n_models)], axis=1)
    left = rng.uniform(-1e4, 1e4, (n_models, 3)) + np.array([0.0, 0.0, 2e4])
    climb = rng.normal(0.0, climb_m, (n_models, 1)) * [0.0, 0.0, 1.0]
    position = np.stack([left, left + BASE_M * forward + climb], axis=1).reshape(-1, 3)
    turned = np.zeros((2 * n_models, 3))
    turned[:, 2] = np.repeat(heading, 2)
    level = rotation_from_angles(turned, system)
    tilt = rotation_from_angles(rng.normal(0.0, tilt_rad, (2 * n_models, 3)), system)
    camera = np.resize(np.asarray(cameras), 2 * n_models)
    middle = left + 0.5 * BASE_M * forward
    across = np.stack([-forward[:, 1], forward[:, 0], forward[:, 2]], axis=1)
    along_m, across_m, up_m = (
        rng.uniform(-size, size, (n_models, n_points, 1)) for size in (450.0, 1000.0, relief_m)
    )
    ground = middle[:, None] + along_m * forward[:, None] + across_m * across[:, None]
    ground += (up_m - HEIGHT_M) * [0.0, 0.0, 1.0]
    orientations = Orientations(
        image=np.array([f"i{k}" for k in range(2 * n_models)], dtype=object),
        strip=np.repeat(np.array([f"s{k}" for k in range(n_models)], dtype=object), 2),
        time_s=np.arange(2.0 * n_models),
        position_m=position,
        angles_rad=angles_from_rotation(level @ tilt, system),
        camera=camera,
        sigma_position_m=np.full((2 * n_models, 3), 0.05),
        sigma_angles_rad=np.full((2 * n_models, 3), 1e-4),
        system=system,
    )
    return models_of(orientations, ground)


def models_of(orientations, ground_m):
    """Models of images 2k and 2k + 1 over ground points (models, points, 3)."""
    n_models, n_points = ground_m.shape[:2]
    vectors = [
        np.concatenate([_seen(orientations, 2 * k + side, ground_m[k]) for k in range(n_models)])
        for side in (0, 1)
    ]
    n = n_models * n_points
    pairs = ImagePairs(
        left=np.arange(0, 2 * n_models, 2),
        right=np.arange(1, 2 * n_models, 2),
        offsets=np.arange(n_models + 1) * n_points,
        left_ray=np.arange(0, 2 * n, 2),
        right_ray=np.arange(1, 2 * n, 2),
    )
    pixel_size = PIXEL_SIZE_MM[orientations.camera[pairs.right]]
    return StereoModels(pairs, orientations, vectors[0], vectors[1], pixel_size)


def _seen(orientations, image, ground_m):
    """Image vectors by the collinearity equations."""
    line = ground_m - orientations.position_m[image]
    u = line @ orientations.ground_from_image[image]
    distance = PRINCIPAL_DISTANCE_PX[orientations.camera[image]]
    return -distance * u / u[:, 2:]


def with_angle_errors(models, sigma_rad, seed=1):
    """POS angles in error."""
    rng = np.random.default_rng(seed)
    true = models.orientations
    errors = rng.normal(0.0, 1.0, (len(true), 3)) * sigma_rad
    return models.with_orientations(true.with_angles(true.angles_rad + errors))


def with_image_noise(models, sigma_px, seed=2):
    """Image coordinates with normal errors."""
    rng = np.random.default_rng(seed)
    noise = rng.normal(0.0, sigma_px, (2, len(models.left_vectors), 3)) * [1.0, 1.0, 0.0]
    return with_vectors(models, models.left_vectors + noise[0], models.right_vectors + noise[1])


def with_vectors(models, left, right):
    return StereoModels(models.pairs, models.orientations, left, right, models.pixel_size_mm)


def relative_rotation(result):
    """(p, 3, 3) left_from_right."""
    return np.swapaxes(result.ground_from_left, 1, 2) @ result.ground_from_right


def noisy_models(**kwargs):
    return with_image_noise(with_angle_errors(true_models(**kwargs), 0.01), 0.2)


def least_of_scipy(models, k, **options):
    """Model k by scipy's Levenberg-Marquardt: change of the five angles (rad) and RMS (px)."""
    frame = base_frames(models.base_m)[k]
    base = (frame @ models.base_m[k])[None]
    images = [models.pairs.left[k], models.pairs.right[k]]
    rotation = frame @ models.orientations.ground_from_image[images]
    start = angles_from_rotation(rotation, "omega-phi-kappa").ravel()
    points = slice(*models.pairs.offsets[k : k + 2])
    vectors = models.left_vectors[points], models.right_vectors[points]
    offsets = np.array([0, len(vectors[0])])

    def residuals(free):
        angles = np.concatenate([start[:1], free]).reshape(2, 3)
        turned = rotation_from_angles(angles, "omega-phi-kappa")
        return y_parallax(*vectors, offsets, turned[:1], turned[1:], base)

    least = least_squares(residuals, start[1:], method="lm", xtol=1e-15, ftol=1e-15, **options)
    return least.x - start[1:], np.sqrt(np.mean(least.fun**2))
