"""Independent orientation of a block of the size of area 1: posstats beside PoseLib.

Both get the same point pairs as prepared arrays and the same start values (the POS), and both
iterate to convergence with plain least squares; PoseLib minimises Sampson errors. The remaining
y-parallax is computed by posstats' formula for both solutions.
"""

import argparse
import statistics
import time
from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np

from posstats.block.image_pairs import StereoModels, stereo_models
from posstats.geometry.stereo.relative_orientation import orient
from posstats.numerics.kernels.coplanarity import base_frames, y_parallax
from posstats.numerics.kernels.rotation import rotation_from_vector
from posstats.synthetic import load_scenario, simulate

try:
    import poselib
except ModuleNotFoundError:
    raise SystemExit(
        "this benchmark needs PoseLib, which is not installed: pip install poselib"
    ) from None

SEED = 1
DOWN = np.diag([1.0, -1.0, -1.0])  # image frame of posstats <-> camera frame of PoseLib
OPTIONS = {"max_iterations": 100, "loss_type": "TRIVIAL", "gradient_tol": 1e-12, "step_tol": 1e-12}


class Pair(NamedTuple):
    """One stereo model as PoseLib takes it: x right, y down, the camera looks along +z."""

    left_xy: np.ndarray
    right_xy: np.ndarray
    start: poselib.CameraPose
    left_camera: dict
    right_camera: dict


def as_poselib(models: StereoModels) -> Iterator[Pair]:
    ground_from_camera = models.orientations.ground_from_image @ DOWN
    for k, (left, right) in enumerate(zip(models.pairs.left, models.pairs.right, strict=True)):
        points = slice(*models.pairs.offsets[k : k + 2])
        right_from_left = ground_from_camera[right].T @ ground_from_camera[left]
        translation = -ground_from_camera[right].T @ models.base_m[k]
        yield Pair(
            models.left_vectors[points, :2] * [1.0, -1.0],
            models.right_vectors[points, :2] * [1.0, -1.0],
            pose(right_from_left, translation / np.linalg.norm(translation)),
            pinhole(-models.left_vectors[points.start, 2]),
            pinhole(-models.right_vectors[points.start, 2]),
        )


def pose(rotation: np.ndarray, translation: np.ndarray) -> poselib.CameraPose:
    result = poselib.CameraPose()
    result.R, result.t = rotation, translation
    return result


def pinhole(principal_distance_px: float) -> dict:
    return {
        "model": "SIMPLE_PINHOLE",
        "width": 1,
        "height": 1,
        "params": [principal_distance_px, 0.0, 0.0],
    }


def refined(pairs: list[Pair]) -> list[poselib.CameraPose]:
    return [
        poselib.refine_relative_pose(
            pair.left_xy, pair.right_xy, pair.start, pair.left_camera, pair.right_camera, OPTIONS
        )[0]
        for pair in pairs
    ]


def poselib_rms_px(models: StereoModels, poses: list[poselib.CameraPose]) -> np.ndarray:
    """RMS of the y-parallax that PoseLib's poses leave.

    The model is turned as a whole, which makes no parallax: the left image as POS gives it, then
    the base into the direction of the POS base by the smallest rotation.
    """
    right_from_left = DOWN @ np.array([pose.R for pose in poses]) @ DOWN
    translation = np.array([pose.t for pose in poses]) @ DOWN
    ground_from_left = models.orientations.ground_from_image[models.pairs.left]
    ground_from_right = ground_from_left @ np.swapaxes(right_from_left, 1, 2)
    base = -np.einsum("pij,pj->pi", ground_from_right, translation)
    turn = smallest_turn(base, models.base_m)
    base_from_ground = base_frames(models.base_m)
    q = y_parallax(
        models.left_vectors,
        models.right_vectors,
        models.pairs.offsets,
        base_from_ground @ turn @ ground_from_left,
        base_from_ground @ turn @ ground_from_right,
        np.einsum("pij,pj->pi", base_from_ground, models.base_m),
    )
    return np.sqrt(np.bincount(models.pairs.pair_of_point, q**2) / models.pairs.n_points)


def smallest_turn(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """Rotations (p, 3, 3) of the directions `start` (p, 3) into `end`, a few degrees apart."""
    a = start / np.linalg.norm(start, axis=1, keepdims=True)
    b = end / np.linalg.norm(end, axis=1, keepdims=True)
    axis = np.cross(a, b)
    sine = np.linalg.norm(axis, axis=1)
    return rotation_from_vector(axis / np.sinc(np.arcsin(sine) / np.pi)[:, None])


def milliseconds(solve: Callable[[], object], runs: int) -> list[float]:
    times = []
    for _ in range(runs):
        start = time.perf_counter()
        solve()
        times.append(1e3 * (time.perf_counter() - start))
    return times


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=15)
    runs = parser.parse_args().runs
    models = stereo_models(simulate(load_scenario("area1"), seed=SEED))
    pairs = list(as_poselib(models))
    print(
        f"{len(models)} stereo models, {len(models.left_vectors)} point pairs; all solved per run"
    )
    start = time.perf_counter()
    ours = orient(models)
    print(
        f"first call (compiling, or loading what was compiled): {time.perf_counter() - start:.2f} s"
    )
    solvers = {
        "posstats": lambda: orient(models),
        "posstats, robust": lambda: orient(models, robust=True),
        "PoseLib": lambda: refined(pairs),
    }
    median = {}
    for name, solve in solvers.items():
        times = milliseconds(solve, runs)
        median[name] = statistics.median(times)
        print(f"{name}: median {median[name]:.1f} ms, least {min(times):.1f} ms")
    ratio = median["PoseLib"] / median["posstats"]
    print(f"plain posstats is {ratio:.1f} times as fast as PoseLib (medians)")
    theirs = poselib_rms_px(models, refined(pairs))
    pixel_um = 1e3 * models.pixel_size_mm
    for name, rms_px in (("posstats", ours.y_parallax_rms_px), ("PoseLib", theirs)):
        print(f"y-parallax RMS, mean over models, {name}: {np.mean(rms_px * pixel_um):.7f} um")
    print(f"models where PoseLib leaves less: {np.sum(theirs < ours.y_parallax_rms_px)}")


if __name__ == "__main__":
    main()
