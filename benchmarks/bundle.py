"""Bundle adjustment of a block of the size of area 1: posstats beside pycolmap.

Both solve the same free network (no POS but the first and the last image, which are held) from
the same start values (POS orientations and their intersections). posstats also computes the
covariances of all orientations and points, and the redundancy numbers.
"""

import argparse
import resource
import statistics
import time
from dataclasses import replace

import numpy as np

from posstats.bundle import adjust
from posstats.bundle_block import bundle_problem
from posstats.bundle_problem import AdjustedBundle, BundleProblem
from posstats.synthetic import load_scenario, simulate

try:
    import pycolmap
except ModuleNotFoundError:
    raise SystemExit(
        "this benchmark needs pycolmap, which is not installed: pip install pycolmap"
    ) from None

DOWN = np.diag([1.0, -1.0, -1.0])  # image frame of posstats <-> camera frame of COLMAP
HELD_M, HELD_RAD = 1e-7, 1e-10


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
            pycolmap.Image(
                name=str(image), points2D=points, camera_id=1, image_id=image + 1
            ),
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


def theirs(problem: BundleProblem, function_tolerance: float) -> tuple[np.ndarray, float, str]:
    """Points, seconds, and what the solver says."""
    model = reconstruction(problem)
    adjuster = pycolmap.create_default_bundle_adjuster(
        options(function_tolerance), configuration(problem), model
    )
    start = time.perf_counter()
    summary = adjuster.solve()
    seconds = time.perf_counter() - start
    points = model.points3D
    return np.array([points[i].xyz for i in sorted(points)]), seconds, summary.brief_report()


def timed(problem: BundleProblem, runs: int) -> tuple[AdjustedBundle, list[float]]:
    adjust(problem)
    seconds = []
    for _ in range(runs):
        start = time.perf_counter()
        result = adjust(problem)
        seconds.append(time.perf_counter() - start)
    return result, seconds


if __name__ == "__main__":
    problem = free_problem(bundle_problem(simulate(load_scenario("area1"))))
    ours, seconds = timed(problem, 3)
    print(seconds, ours.n_iterations, ours.groups, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss/1e6)
    for tol in (1e-6, 1e-9,1e-14):
        t=time.perf_counter()
        X,s,rep=theirs(problem,tol)
        print(tol,s,rep, time.perf_counter()-t)
        print(2.0*float(0), np.abs(X-ours.ground_m).max())
    print(0.5*0.2**2*ours.groups["image"].square_sum)
