"""A small block of perfect data, built here without `posstats.synthetic`, and its files."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from posstats.block.camera import Camera, Distortion
from posstats.block.frames import GroundFrame
from posstats.block.image_pairs import stereo_models
from posstats.block.model import Accuracy, Block, GroundPoints, Orientations, TiePoints
from posstats.formats.block_folder import write_block
from posstats.numerics.kernels.rotation import rotation_from_angles

SCALE_NUMBER = 78_000
CAMERA = Camera("", "DMC", 13824.0, 7680.0, 10_000.0, (6900.0, 3850.0), 0.012)
MIDDLE = {
    "EPSG:32631": (700_000.0, 5_500_000.0),
    "EPSG:2154": (200_000.0, 6_800_000.0),
    "EPSG:32733": (250_000.0, 6_200_000.0),
}


def perfect_block(
    crs: str | None = "EPSG:32631",
    system: str = "omega-phi-kappa",
    n_strips: int = 2,
    n_images: int = 4,
    distortion: Distortion | None = None,
    seed: int = 1,
) -> Block:
    """Rays of ground points, projected exactly; 60 % end lap, 30 % side lap, tilts of 1 degree."""
    rng = np.random.default_rng(seed)
    frame = GroundFrame() if crs is None else GroundFrame.tangent(crs, [(*MIDDLE[crs], 0.0)])
    height = SCALE_NUMBER * 0.12
    width, length = 13824 * 12e-6 * SCALE_NUMBER, 7680 * 12e-6 * SCALE_NUMBER
    strip, number = np.divmod(np.arange(n_strips * n_images), n_images)
    flown = np.where(strip % 2 == 0, number, n_images - 1 - number)
    position = np.column_stack([0.7 * width * strip, 0.4 * length * flown, 0.0 * strip + height])
    position += rng.normal(0.0, 20.0, position.shape)
    angles = rng.normal(0.0, np.radians(1.0), position.shape)
    angles[:, 2] += np.where(strip % 2 == 0, 0.0, np.pi)
    camera = replace(CAMERA, distortion=distortion or Distortion())
    low, high = position.min(axis=0) - 4000.0, position.max(axis=0) + 4000.0
    ground = rng.uniform(low, high, (600, 3))
    ground[:, 2] = 300.0 + 400.0 * np.sin(ground[:, 0] / 5000.0)
    point, image, xy = project(ground, position, rotation_from_angles(angles, system), camera)
    accuracy = Accuracy()
    n = len(position)
    orientations = Orientations(
        image=np.array(
            [f"{s + 1}_{k:03d}" for s, k in zip(strip, number, strict=True)], dtype=object
        ),
        strip=np.array([f"{s + 1}" for s in strip], dtype=object),
        time_s=1000.0 + 500.0 * strip + 10.0 * number,
        position_m=position,
        angles_rad=angles,
        camera=np.zeros(n, dtype=np.intp),
        sigma_position_m=np.full((n, 3), accuracy.position_m),
        sigma_angles_rad=np.full((n, 3), accuracy.angle_rad),
        system=system,
    )
    ids = np.array([f"P{k:04d}" for k in range(len(ground))], dtype=object)
    seen, number_of_point = np.unique(point, return_inverse=True)
    return Block(
        name="perfect",
        cameras=(camera,),
        orientations=orientations,
        tie_points=TiePoints(ids[seen], number_of_point, image, xy),
        frame=frame,
        ground_points=GroundPoints(
            ids[seen[:5]],
            ground[seen[:5]],
            np.array([True, True, True, False, False]),
            np.array([0.1, 0.1, 0.1, np.nan, np.nan]),
            np.full(5, np.nan),
        ),
        adjusted=orientations,
    )


def project(ground, position, rotation, camera):
    """Rays sorted by point and image: point (m,), image (m,), ideal xy (m, 2)."""
    vectors = np.einsum("nji,pnj->pni", rotation, ground[:, None] - position)
    xy = -camera.principal_distance_px * vectors[..., :2] / vectors[..., 2:]
    half = 0.5 * np.array([camera.width_px, camera.height_px]) - 150.0
    point, image = np.nonzero(np.all(np.abs(xy) < half, axis=-1))
    several = np.bincount(point, minlength=len(ground))[point] > 1
    point, image = point[several], image[several]
    return point, image, xy[point, image]


def largest_parallax_mm(block: Block) -> float:
    """Largest vertical parallax of all models, mm."""
    models = stereo_models(block)
    assert len(models) >= 4
    return float(np.abs(models.y_parallax_px()).max() * block.cameras[0].pixel_size_mm)


def written(block: Block, folder: Path) -> Path:
    write_block(block, folder)
    return folder


def edit(folder: Path, name: str, *changes: tuple[str, str]) -> None:
    """Replace text in one file of a folder; every change must apply."""
    path = folder / name
    text = path.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text, (name, old)
        text = text.replace(old, new, 1)
    path.write_text(text, encoding="utf-8")
