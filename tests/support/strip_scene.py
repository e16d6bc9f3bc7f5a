"""A strip of known truth, projected with numpy alone: the oracle of the kernel tests."""

import numpy as np

from posstats.block.camera import Camera
from posstats.block.frames import GroundFrame
from posstats.block.model import Accuracy, Block, GroundPoints, Orientations, TiePoints
from posstats.numerics.kernels.rotation import rotation_from_angles

CAMERA = Camera("c", "test", 12000.0, 8000.0, 10000.0, (6000.0, 4000.0), 0.012)


def orientations(position_m, angles_rad, system="omega-phi-kappa", sigma_m=0.05, sigma_rad=1e-4):
    n = len(position_m)
    return Orientations(
        image=np.array([f"i{k}" for k in range(n)], dtype=object),
        strip=np.array(["1"] * n, dtype=object),
        time_s=np.arange(n, dtype=float),
        position_m=np.asarray(position_m, dtype=float),
        angles_rad=np.asarray(angles_rad, dtype=float),
        camera=np.zeros(n, dtype=np.intp),
        sigma_position_m=np.full((n, 3), sigma_m),
        sigma_angles_rad=np.full((n, 3), sigma_rad),
        system=system,
    )


def projected(oriented, ground_m, point, image):
    """Collinearity equations, written once more in numpy."""
    rotation = rotation_from_angles(oriented.angles_rad, oriented.system)[image]
    line = np.asarray(ground_m)[point] - oriented.position_m[image]
    u = np.einsum("mji,mj->mi", rotation, line)
    return -CAMERA.principal_distance_px * u[:, :2] / u[:, 2:]


def measurements(oriented, ground_m):
    """Every point in every image, format ignored."""
    n, p = len(oriented), len(ground_m)
    point, image = np.repeat(np.arange(p), n), np.tile(np.arange(n), p)
    return TiePoints(
        point_id=np.array([f"p{k}" for k in range(p)], dtype=object),
        point=point,
        image=image,
        xy_px=projected(oriented, ground_m, point, image),
    )


def block(oriented, ground_m, is_check=None, frame=None, image_px=0.2, **points):
    p = len(ground_m)
    nan = np.full(p, np.nan)
    ground = GroundPoints(
        point=np.array([f"p{k}" for k in range(p)], dtype=object),
        position_m=np.asarray(ground_m, dtype=float),
        is_check=np.ones(p, dtype=bool) if is_check is None else np.asarray(is_check),
        sigma_xy_m=points.get("sigma_xy_m", nan),
        sigma_z_m=points.get("sigma_z_m", nan),
    )
    return Block(
        name="small",
        cameras=(CAMERA,),
        orientations=oriented,
        tie_points=measurements(oriented, ground_m),
        frame=frame or GroundFrame(),
        accuracy=Accuracy(image_px=image_px),
        ground_points=ground,
    )


def scene(seed=0, n_images=5, n_points=12, system="omega-phi-kappa", **sigma):
    """A strip of tilted images 1,000 m above rough ground."""
    rng = np.random.default_rng(seed)
    position = np.column_stack(
        [np.arange(n_images) * 300.0, rng.normal(0, 100, n_images), rng.normal(1000, 20, n_images)]
    )
    angles = rng.normal([0.0, 0.0, 0.7], 0.05, (n_images, 3))
    middle = position[:, 0].mean()
    ground = rng.uniform([middle - 300, -200, 0], [middle + 300, 200, 150], (n_points, 3))
    return orientations(position, angles, system, **sigma), ground
