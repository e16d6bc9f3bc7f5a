"""Compile all kernels into numba's cache, in two processes, before tests in several need them."""

import multiprocessing

from small_scenario import GOOD_POINTS, small_block

from posstats.adjustment import AdjustmentSettings, adjust_block
from posstats.analysis.steps import analyse

FEW = {"flight": {"n_strips": 3, "images_per_strip": 5}, "tie_points": {"per_model": 30}}


def analysed() -> None:
    """Parallax, relative orientation, coplanarity."""
    analyse(small_block(**FEW))


def adjusted() -> None:
    """The bundle, with all that can be estimated."""
    settings = AdjustmentSettings(control="corners", self_calibration="brown")
    adjust_block(small_block(check_points=GOOD_POINTS, **FEW), settings)


if __name__ == "__main__":
    context = multiprocessing.get_context("spawn")
    running = [context.Process(target=each) for each in (analysed, adjusted)]
    for process in running:
        process.start()
    for process in running:
        process.join()
    raise SystemExit(any(process.exitcode for process in running))
