"""Bundle adjustment of a block of the size of area 1, and growth with the number of images.

posstats and pycolmap solve the same free network (no POS but the first and the last image, which
are held) from the same start values (POS orientations and their intersections), to the same sum
of squares. posstats also computes the covariances of all orientations and points, and the
redundancy numbers. With --growth blocks of more strips are adjusted with their POS and free
drifts of the IMU.
"""

import argparse
import multiprocessing
import os
import pickle
import resource
import statistics
import tempfile
import time
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # as the command sets it, before NumPy is there

import numpy as np

from posstats.adjustment.block_problem import bundle_problem
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.parameters import BLOCK, IMU_DRIFTS, IMU_SHIFTS, drift_parameters
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem
from posstats.synthetic import load_scenario, simulate

try:
    import pycolmap
except ModuleNotFoundError:
    raise SystemExit(
        "this benchmark needs pycolmap, which is not installed: pip install pycolmap"
    ) from None

DOWN = np.diag([1.0, -1.0, -1.0])  # image frame of posstats <-> camera frame of COLMAP
HELD_M, HELD_RAD = 1e-7, 1e-10
SEED = 1
SAME_COST = 1e-9  # relative change of the sum of squares at which pycolmap stops


def free_problem(problem: BundleProblem) -> BundleProblem:
    """Without POS, but with the first and the last image held."""
    held = np.zeros((len(problem.position_m), 1), dtype=bool)
    held[[0, -1]] = True
    shape = problem.position_m.shape
    pos = replace(
        problem.pos,
        sigma_antenna_m=np.broadcast_to(np.where(held, HELD_M, np.inf), shape),
        sigma_angles_rad=np.broadcast_to(np.where(held, HELD_RAD, np.inf), shape),
    )
    return replace(problem, pos=pos)


def reconstruction(problem: BundleProblem) -> pycolmap.Reconstruction:
    """The problem as COLMAP takes it; images count from 1, points in the order of their ids."""
    result = pycolmap.Reconstruction()
    distance = problem.distance_px[0]
    result.add_camera_with_trivial_rig(
        pycolmap.Camera(
            camera_id=1, model="PINHOLE", width=1, height=1, params=[distance, distance, 0.0, 0.0]
        )
    )
    camera_from_ground = DOWN @ np.swapaxes(problem.ground_from_image, 1, 2)
    number = np.empty(len(problem.point), dtype=int)  # of the rays in their images
    for image, (rotation, centre) in enumerate(
        zip(camera_from_ground, problem.position_m, strict=True)
    ):
        rays = np.flatnonzero(problem.image == image)
        number[rays] = np.arange(len(rays))
        pose = pycolmap.Rigid3d(pycolmap.Rotation3d(rotation), -rotation @ centre)
        points = [pycolmap.Point2D(xy) for xy in problem.xy_px[rays] * [1.0, -1.0]]
        result.add_image_with_trivial_frame(
            pycolmap.Image(name=str(image), points2D=points, camera_id=1, image_id=image + 1),
            pose,
        )
    bounds = np.searchsorted(problem.point, np.arange(len(problem.ground_m) + 1))
    for point, ground in enumerate(problem.ground_m):
        rays = range(bounds[point], bounds[point + 1])
        track = pycolmap.Track(
            [pycolmap.TrackElement(problem.image[r] + 1, number[r]) for r in rays]
        )
        result.add_point3D(ground, track)
    return result


def configuration(problem: BundleProblem) -> pycolmap.BundleAdjustmentConfig:
    config = pycolmap.BundleAdjustmentConfig()
    n = len(problem.position_m)
    for image in range(1, n + 1):
        config.add_image(image)
    config.set_constant_cam_intrinsics(1)
    for image in (1, n):
        config.set_constant_rig_from_world_pose(image)
    return config


def options(function_tolerance: float) -> pycolmap.BundleAdjustmentOptions:
    result = pycolmap.BundleAdjustmentOptions()
    result.print_summary = False
    solver = result.ceres.solver_options
    solver.max_num_iterations, solver.num_threads = 500, -1
    solver.function_tolerance, solver.gradient_tolerance = function_tolerance, 1e-12
    return result


class Theirs(NamedTuple):
    """What pycolmap found: sum of squares in units of ours, points, seconds, iterations."""

    square_sum: float
    ground_m: np.ndarray
    seconds: float
    n_iterations: int


def adjusted_by_colmap(problem: BundleProblem, function_tolerance: float) -> Theirs:
    model = reconstruction(problem)
    adjuster = pycolmap.create_default_bundle_adjuster(
        options(function_tolerance), configuration(problem), model
    )
    start = time.perf_counter()
    summary = adjuster.solve().ceres_summary
    seconds = time.perf_counter() - start
    points = model.points3D
    return Theirs(
        2.0 * summary.final_cost / problem.sigma_px[0] ** 2,
        np.array([points[i].xyz for i in sorted(points)]),
        seconds,
        summary.num_successful_steps + summary.num_unsuccessful_steps,
    )


def adjusted(problem: BundleProblem) -> tuple[AdjustedBundle, float]:
    start = time.perf_counter()
    result = adjust(problem)
    return result, time.perf_counter() - start


def compare(runs: int) -> None:
    problem = free_problem(bundle_problem(simulate(load_scenario("area1"), seed=SEED)))
    print(f"{len(problem.position_m)} images, {len(problem.ground_m)} points,"
          f" {len(problem.point)} rays")  # fmt: skip
    _, first = adjusted(problem)
    print(f"first call (compiling, or loading what was compiled): {first:.2f} s")
    ours_s, theirs_s = [], []
    for _ in range(runs):
        ours, seconds = adjusted(problem)
        ours_s.append(seconds)
        theirs = adjusted_by_colmap(problem, SAME_COST)
        theirs_s.append(theirs.seconds)
    square_sum = ours.groups["image"].square_sum
    for name, seconds, n in (("posstats, with covariances", ours_s, ours.n_iterations),
                             ("pycolmap", theirs_s, theirs.n_iterations)):  # fmt: skip
        print(f"{name}: median {statistics.median(seconds):.2f} s"
              f" ({min(seconds):.2f}-{max(seconds):.2f}), {n} iterations")  # fmt: skip
    print(f"pycolmap's sum of squares above ours: {theirs.square_sum / square_sum - 1.0:.1e}")
    ratio = statistics.median(theirs_s) / statistics.median(ours_s)
    print(f"posstats is {ratio:.1f} times as fast as pycolmap (medians)")
    tight = adjusted_by_colmap(problem, 0.0)
    print(f"pycolmap iterated to rounding, {tight.n_iterations} iterations: sum of squares above"
          f" ours {tight.square_sum / square_sum - 1.0:.1e}, largest difference of a point"
          f" {1e3 * np.abs(tight.ground_m - ours.ground_m).max():.4f} mm")  # fmt: skip
    print(f"peak memory of this process: {peak_gib():.2f} GiB")


def peak_gib() -> float:
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024**2


def write_problems(n_strips: int, folder: Path) -> None:
    """Area 1 with other numbers of strips of 60 images, drifts of the block and of each strip."""
    scenario = load_scenario("area1")
    flight = replace(scenario.flight, n_strips=n_strips)
    block = simulate(replace(scenario, flight=flight), seed=SEED)
    for scopes in ((BLOCK,), block.orientations.strips):
        drifts = drift_parameters((*IMU_SHIFTS, *IMU_DRIFTS), scopes)
        with (folder / f"{len(drifts)}.pickle").open("wb") as file:
            pickle.dump(bundle_problem(block, drifts), file)


def adjust_written(path: Path) -> None:
    with path.open("rb") as file:
        problem = pickle.load(file)  # noqa: S301 - written by this script
    before = peak_gib()
    adjusted(problem)
    result, seconds = adjusted(problem)
    print(
        f"{len(problem.position_m)} images, {len(problem.point)} rays, {len(problem.parameters)}"
        f" drift parameters: {seconds:.2f} s, {result.n_iterations} iterations, sigma0"
        f" {result.sigma0:.3f}, peak memory {peak_gib():.2f} GiB ({before:.2f} GiB before)"
    )


def grow() -> None:
    """Simulate and adjust in processes of their own: their peak memory is their own."""
    context = multiprocessing.get_context("spawn")
    for n_strips in (5, 15, 50):
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            steps = [(write_problems, (n_strips, folder))]
            steps += [
                (adjust_written, (folder / f"{6 * n_scopes}.pickle",)) for n_scopes in (1, n_strips)
            ]
            for step, arguments in steps:
                process = context.Process(target=step, args=arguments)
                process.start()
                process.join()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--runs", type=int, default=5)
    parser.add_argument("--growth", action="store_true")
    arguments = parser.parse_args()
    if arguments.growth:
        grow()
    else:
        compare(arguments.runs)


if __name__ == "__main__":
    main()
