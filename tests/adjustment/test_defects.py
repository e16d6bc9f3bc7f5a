"""Rank defects: real singular blocks are explained, and the remedy named there is one."""

from dataclasses import replace

import numpy as np
import pytest
from dense_bundle import noisy_problem

from posstats.adjustment.defects import defects, weak_parameters
from posstats.adjustment.significance import parameter_tests
from posstats.adjustment.undetermined import UndeterminedBlockError
from posstats.errors import UndeterminedError
from posstats.numerics.bundle import adjust
from posstats.numerics.bundle.parameters import (
    BORESIGHT,
    GNSS_DRIFTS,
    GNSS_SHIFTS,
    IMU_SHIFTS,
    LEVER_ARM,
    UNITS,
    CommonParameter,
    drift_parameters,
)
from posstats.numerics.bundle.rays import CAMERA_PARAMETERS
from posstats.reports.adjustment.wording import not_determined
from posstats.reports.adjustment.words import words_in

ENGLISH = words_in("en")
STRIPS, BLOCK = ("s0", "s1"), ("block",)
GNSS, IMU = "sigma_antenna_m", "sigma_angles_rad"


def free(*names):
    return tuple(CommonParameter(name) for name in names)


def without(problem, *observed, images=slice(None)):
    """The problem without these POS observations of images."""
    for name in observed:
        sigma = getattr(problem.pos, name).copy()
        sigma[images] = np.inf
        problem = replace(problem, pos=replace(problem.pos, **{name: sigma}))
    return problem


def far_too_weak(problem):
    """Standard deviations as large as files may state them."""
    n = len(problem.position_m)
    pos = replace(
        problem.pos,
        sigma_antenna_m=np.full((n, 3), 1e9),
        sigma_angles_rad=np.full((n, 3), 1e9),
    )
    return replace(problem, pos=pos)


def explained(problem):
    ids = [f"i{k}" for k in range(len(problem.position_m))]
    with pytest.raises(UndeterminedError) as caught:
        adjust(problem)
    return defects(problem, ids, caught.value)


def weak(problem):
    return weak_parameters(problem, parameter_tests(problem, adjust(problem)))


SINGULAR = {
    "no datum": (without(noisy_problem(n_control=0), GNSS, IMU),
                 "datum", noisy_problem(n_control=0)),
    "POS of no use": (far_too_weak(noisy_problem(n_control=0)),
                      "datum", noisy_problem(n_control=0)),
    "two points": (without(noisy_problem(n_control=2), GNSS, IMU),
                   "datum", without(noisy_problem(n_control=3), GNSS, IMU)),
    "angles alone": (without(noisy_problem(n_control=0), GNSS),
                     "datum_angles_alone", without(noisy_problem(n_control=2), GNSS)),
    "gnss shift": (noisy_problem(drift_parameters(GNSS_SHIFTS, BLOCK), n_control=0),
                   "gnss_of_block",
                   noisy_problem(drift_parameters(GNSS_SHIFTS, BLOCK), n_control=1)),
    "gnss of strips": (noisy_problem(drift_parameters(GNSS_SHIFTS, STRIPS), n_control=0),
                       "gnss_of_strips",
                       noisy_problem(drift_parameters(GNSS_SHIFTS, STRIPS, 0.3), n_control=0)),
    "boresight and IMU shift": (
        noisy_problem((*drift_parameters(IMU_SHIFTS, BLOCK), *free(*BORESIGHT))),
        "attitude_twice",
        noisy_problem((*drift_parameters(IMU_SHIFTS, BLOCK), *free(*BORESIGHT[:2])))),
    "lever arm without rotation": (
        noisy_problem((*drift_parameters(GNSS_SHIFTS, BLOCK), *free(*LEVER_ARM)), tilt_rad=0.0),
        "position_twice", noisy_problem(free(*LEVER_ARM))),
    "Bauer and Brown": (noisy_problem(free("camera_c", "bauer_s1", "brown_k1")),
                        "radial", noisy_problem(free("camera_c", "bauer_s1"))),
    "block and strips": (noisy_problem(drift_parameters(GNSS_SHIFTS, (*BLOCK, *STRIPS))),
                         "twice",
                         noisy_problem(drift_parameters(GNSS_SHIFTS, STRIPS))),
    "nothing observed": (without(noisy_problem(drift_parameters(IMU_SHIFTS, BLOCK)), IMU),
                         "unobserved", without(noisy_problem(), IMU)),
}  # fmt: skip


@pytest.mark.parametrize("case", SINGULAR)
def test_a_singular_block_is_explained_and_the_remedy_makes_it_regular(case):
    problem, code, remedied = SINGULAR[case]
    (defect,) = explained(problem)
    assert defect.reason.code == f"open_{code}"
    assert defect.reason.values == {"n_control": len(problem.control.point)}
    assert defect.remedy.code == f"helps_{code}"
    assert set(defect.parameters) <= set(problem.parameters)
    assert bool(defect.parameters) == bool(problem.parameters)
    assert np.isfinite(adjust(remedied).sigma0)


def flat_self_calibration(**layout):
    parameters = free("camera_x0", "camera_y0", *BORESIGHT)
    return noisy_problem(parameters, n_control=0, relief_m=0.0, **layout)


SHIFTS_AND_DRIFTS = (*GNSS_SHIFTS, *GNSS_DRIFTS)
WEAK = {
    "free drifts with one point": (
        noisy_problem(drift_parameters(SHIFTS_AND_DRIFTS, STRIPS), n_control=1),
        "gnss_of_strips",
        noisy_problem(drift_parameters(SHIFTS_AND_DRIFTS, STRIPS, 0.3), n_control=1)),
    "roll of a strip": (
        noisy_problem(drift_parameters(IMU_SHIFTS, BLOCK), n_control=0, n_strips=1),
        "imu",
        noisy_problem(drift_parameters(IMU_SHIFTS, BLOCK), n_control=0, n_strips=2)),
    "principal point": (flat_self_calibration(n_strips=1, tilt_rad=0.0),
                        "point_and_boresight", flat_self_calibration(n_strips=2)),
    "principal distance": (
        noisy_problem(free("camera_c"), n_control=0, relief_m=0.0),
        "distance",
        noisy_problem(free("camera_c"), n_control=10, relief_m=300.0, sigma_position_m=0.02)),
    "height and lever arm": (noisy_problem(free("gnss_z_shift", "lever_arm_w")),
                             "position_twice", noisy_problem(free("gnss_z_shift"))),
    "height and distance": (noisy_problem(free("gnss_z_shift", "camera_c"), relief_m=0.0),
                            "scale_and_height",
                            noisy_problem(free("gnss_z_shift"), relief_m=0.0)),
}  # fmt: skip


@pytest.mark.parametrize("case", WEAK)
def test_a_weak_block_is_explained_and_the_remedy_strengthens_it(case):
    problem, code, remedied = WEAK[case]
    assert f"open_{code}" in [defect.reason.code for defect in weak(problem)]
    assert weak(remedied) == ()


EVERY = [
    *((name, "block") for name in UNITS),
    *((name, "s1") for name in UNITS if name.endswith(("shift", "drift"))),
    *((name, "c") for name in CAMERA_PARAMETERS),
]


@pytest.mark.parametrize(("name", "scope"), EVERY)
def test_every_parameter_has_an_explanation_of_its_own(name, scope):
    problem = replace(noisy_problem(), parameters=(CommonParameter(name, scope),))
    (defect,) = defects(problem, [], UndeterminedError([], [0]))
    assert defect.parameters == problem.parameters
    sentence = not_determined(UndeterminedBlockError([defect], []))
    assert sentence.startswith(name)
    assert ENGLISH.notice(defect.reason) in sentence
    assert ENGLISH.notice(defect.remedy) in sentence


def test_a_camera_without_rays_is_named():
    problem = noisy_problem()
    exposures = replace(problem.exposures, camera_id=("c", "spare"))
    problem = replace(
        problem,
        exposures=exposures,
        distance_px=np.repeat(problem.distance_px, 2),
        mm_per_px=np.repeat(problem.mm_per_px, 2),
        parameters=(CommonParameter("camera_c", "spare"),),
    )
    (defect,) = explained(problem)
    assert defect.reason.code == "open_unseen"
    assert not_determined(UndeterminedBlockError([defect], [])).startswith("camera_c of spare ")


def test_an_image_without_rays_and_pos_is_named():
    problem = without(noisy_problem(), GNSS, IMU, images=[2])
    kept = problem.image != 2
    problem = replace(
        problem,
        **{name: getattr(problem, name)[kept] for name in ("point", "image", "xy_px", "sigma_px")},
    )
    (defect,) = explained(problem)
    assert defect.images == ("i2",)
    assert defect.reason.code == "open_images"
    assert defect.reason.values == {"n_rays": 0}
    assert "i2" in not_determined(UndeterminedBlockError([defect], []))


def test_a_datum_defect_is_one_of_all_images():
    problem = without(noisy_problem(n_control=0), GNSS, IMU)
    (defect,) = explained(problem)
    assert (defect.parameters, defect.images) == ((), ())
    sentence = not_determined(UndeterminedBlockError([defect], []))
    assert sentence.startswith(ENGLISH.text("defect.all_images"))
