"""Small simulated blocks of known truth for the tests of the adjustment."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from posstats.block.camera import Camera
from posstats.block.frames import GroundFrame
from posstats.block.model import Accuracy, Block, Orientations, TiePoints
from posstats.numerics.kernels.rotation import AngleSystem, rotation_from_angles

CAMERA = Camera("c", "small", 4000.0, 6000.0, 5000.0, (2000.0, 3000.0), 0.01)


@dataclass(frozen=True)
class Layout:
    """A block of parallel strips; lengths in metres, angles in radians, image coordinates in px."""

    n_strips: int = 2
    n_images: int = 5
    base_m: float = 300.0
    strip_distance_m: float = 500.0
    height_m: float = 1000.0
    heading_rad: float = np.pi / 2
    jitter_m: float = 10.0
    tilt_rad: float = 0.01
    relief_m: float = 100.0
    n_points: int = 400
    sigma_position_m: float = 0.05
    sigma_image_px: float = 0.3
    system: AngleSystem = "omega-phi-kappa"
    seed: int = 1
    camera: Camera = CAMERA


def true_block(layout: Layout) -> Block:
    """The block without any error: true orientations and image coordinates."""
    rng = np.random.default_rng(layout.seed)
    strip, along = np.divmod(np.arange(layout.n_strips * layout.n_images), layout.n_images)
    forward = np.where(strip % 2 == 0, 1.0, -1.0)
    place = np.where(forward > 0, along, layout.n_images - 1 - along)
    n = len(strip)
    local = np.column_stack(
        [place * layout.base_m, strip * layout.strip_distance_m, np.full(n, layout.height_m)]
    ) + layout.jitter_m * rng.standard_normal((n, 3))
    cosine, sine = np.cos(layout.heading_rad), np.sin(layout.heading_rad)
    turn = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    kappa = layout.heading_rad - np.pi / 2 + np.where(forward > 0, 0.0, np.pi)
    angles = layout.tilt_rad * rng.standard_normal((n, 3))
    angles[:, 2] += (kappa + np.pi) % (2 * np.pi) - np.pi
    orientations = Orientations(
        image=np.array([f"i{k:03d}" for k in range(n)], dtype=object),
        strip=np.array([f"s{s}" for s in strip], dtype=object),
        time_s=along * 5.0 + strip * (layout.n_images * 5.0 + 300.0),
        position_m=local @ turn.T,
        angles_rad=angles,
        camera=np.zeros(n, dtype=np.intp),
        sigma_position_m=np.full((n, 3), layout.sigma_position_m),
        sigma_angles_rad=np.full((n, 3), 1e-4),
        system=layout.system,
    )
    ground = np.column_stack(
        [
            rng.uniform(-600.0, layout.n_images * layout.base_m + 300.0, layout.n_points),
            rng.uniform(-600.0, (layout.n_strips - 1) * layout.strip_distance_m + 600.0,
                        layout.n_points),
            layout.relief_m * rng.uniform(-1.0, 1.0, layout.n_points),
        ]
    ) @ turn.T  # fmt: skip
    return Block(
        name="small",
        cameras=(layout.camera,),
        orientations=orientations,
        tie_points=_measured(orientations, ground, layout.camera),
        frame=GroundFrame(),
        accuracy=Accuracy(layout.sigma_position_m, 1e-4, layout.sigma_image_px),
    )


def _measured(orientations: Orientations, ground: NDArray, camera: Camera) -> TiePoints:
    rotation = rotation_from_angles(orientations.angles_rad, orientations.system)
    point, image, xy = [], [], []
    for i, (r, centre) in enumerate(zip(rotation, orientations.position_m, strict=True)):
        v = (ground - centre) @ r
        projected = -camera.principal_distance_px * v[:, :2] / v[:, 2:]
        seen = np.flatnonzero(
            (v[:, 2] < 0)
            & (np.abs(projected[:, 0]) < camera.width_px / 2)
            & (np.abs(projected[:, 1]) < camera.height_px / 2)
        )
        point.append(seen)
        image.append(np.full(len(seen), i))
        xy.append(projected[seen])
    points, images = np.concatenate(point), np.concatenate(image)
    seen_often = np.bincount(points, minlength=len(ground))[points] >= 2
    order = np.lexsort((images, points))
    order = order[seen_often[order]]
    ids, number = np.unique(points[order], return_inverse=True)
    return TiePoints(
        point_id=np.array([f"p{k}" for k in ids], dtype=object),
        point=number,
        image=images[order],
        xy_px=np.concatenate(xy)[order],
    )


def observed_block(
    truth: Block, rng: np.random.Generator, error_rad: NDArray | float = 0.0, noise: float = 1.0
) -> Block:
    """The block as a POS gives it: angles off by `error_rad`, positions and images noisy."""
    pos, ties = truth.orientations, truth.tie_points
    noisy_ties = replace(
        ties,
        xy_px=ties.xy_px + noise * truth.accuracy.image_px * rng.standard_normal(ties.xy_px.shape),
    )
    noisy_pos = replace(
        pos,
        angles_rad=pos.angles_rad + error_rad,
        position_m=pos.position_m
        + noise * pos.sigma_position_m * rng.standard_normal(pos.position_m.shape),
    )
    return replace(truth, orientations=noisy_pos, tie_points=noisy_ties)
