"""Corrected orientations: injected errors come out again, in both frames and over the wrap."""

from dataclasses import replace

import numpy as np
import pytest

from posstats.analysis.angle_errors import AngleErrors
from posstats.analysis.correction import predicted_errors
from posstats.analysis.regression import regress
from posstats.analysis.rules import decide, load_rules
from posstats.block.model import Orientations
from posstats.block.turned import corrected
from posstats.numerics.kernels.rotation import angles_from_rotation, rotation_from_vector, wrapped

SYSTEMS = ["omega-phi-kappa", "phi-omega-kappa"]


def orientations(kappa_deg=0.0, system="omega-phi-kappa", n=40):
    rng = np.random.default_rng(7)
    angles = 0.01 * rng.standard_normal((n, 3))
    angles[:, 2] += np.radians(kappa_deg)
    return Orientations(
        image=np.arange(n).astype(str).astype(object),
        strip=np.repeat(["1", "2"], n // 2).astype(object),
        time_s=1.2e9 + 10.0 * np.arange(n),
        position_m=np.zeros((n, 3)),
        angles_rad=angles,
        camera=np.zeros(n, dtype=np.intp),
        sigma_position_m=np.full((n, 3), 0.05),
        sigma_angles_rad=np.full((n, 3), 1e-4),
        system=system,
    )


def errors_of(truth, error_rad, frame):
    return AngleErrors(
        frame=frame,
        source="adjusted",
        image=truth.image,
        strip=truth.strip,
        time_s=truth.time_s,
        error_rad=error_rad,
        covariance_rad2=None,
        used=np.full(len(truth), True),
    )


def drift_of(truth):
    since = truth.time_s - truth.time_s[0]
    return np.column_stack([0.018 + 4.68e-7 * since, -2e-7 * since, 0.01 - 1e-6 * since])


@pytest.mark.parametrize("system", SYSTEMS)
@pytest.mark.parametrize("frame", ["ground", "camera"])
@pytest.mark.parametrize("scope", ["block", "strip"])
def test_an_injected_drift_comes_out_to_rounding(system, frame, scope):
    truth = orientations(system=system)
    drift = drift_of(truth)
    if frame == "ground":
        pos = truth.with_angles(truth.angles_rad + drift)
    else:
        turned = truth.ground_from_image @ rotation_from_vector(drift)
        pos = truth.with_angles(angles_from_rotation(turned, system))
    regressions = regress(errors_of(truth, drift, frame))
    decisions = decide(regressions, load_rules("paper"), scope=scope)
    assert all(decision.form == "linear" for decision in decisions)
    predicted = predicted_errors(regressions, decisions, truth.time_s, truth.strip)
    np.testing.assert_allclose(predicted, drift, atol=1e-15)
    result = corrected(pos, predicted, frame)
    np.testing.assert_allclose(result.angles_rad, truth.angles_rad, atol=1e-15)


def test_constant_form_takes_the_mean_of_the_rules_fit():
    truth = orientations()
    error = 0.02 + 1e-6 * np.random.default_rng(1).standard_normal((40, 3))
    regressions = regress(errors_of(truth, error, "ground"))
    rules = replace(load_rules("strict"), forms=("constant",), min_parallax_gain=0.0)
    predicted = predicted_errors(regressions, decide(regressions, rules), truth.time_s, truth.strip)
    np.testing.assert_allclose(predicted, 0.02, atol=1e-6)
    assert np.ptp(predicted, axis=0).max() == 0.0


def test_only_the_decided_angle_is_predicted():
    truth = orientations()
    drift = drift_of(truth)
    regressions = regress(errors_of(truth, drift, "ground"))
    only_phi = [
        replace(decision, correct=decision.angle == "phi")
        for decision in decide(regressions, load_rules("paper"))
    ]
    predicted = predicted_errors(regressions, only_phi, truth.time_s, truth.strip)
    assert not predicted[:, [0, 2]].any()
    np.testing.assert_allclose(predicted[:, 1], drift[:, 1], atol=1e-16)


@pytest.mark.parametrize("frame", ["ground", "camera"])
def test_nothing_predicted_changes_no_digit(frame):
    pos = orientations(kappa_deg=180.0)
    result = corrected(pos, np.zeros((40, 3)), frame)
    assert np.array_equal(result.angles_rad, pos.angles_rad)


@pytest.mark.parametrize("frame", ["ground", "camera"])
@pytest.mark.parametrize("shift", [-0.05, 0.05])
def test_kappa_across_180_degrees(frame, shift):
    pos = orientations(kappa_deg=180.0)
    pos = pos.with_angles(wrapped(pos.angles_rad))
    error = np.tile([0.0, 0.0, shift], (40, 1))
    result = corrected(pos, error, frame)
    assert result.angles_rad[:, 2].min() >= -np.pi
    assert result.angles_rad[:, 2].max() < np.pi
    if frame == "ground":
        difference = wrapped(pos.angles_rad - result.angles_rad)
        np.testing.assert_allclose(difference, error, atol=1e-14)
    turned = result.ground_from_image @ rotation_from_vector(error)
    np.testing.assert_allclose(turned, pos.ground_from_image, atol=1e-14)


def test_kappa_recorded_from_0_to_360_stays_so():
    pos = orientations(kappa_deg=359.0)
    pos = pos.with_angles(
        np.where([False, False, True], pos.angles_rad % (2 * np.pi), pos.angles_rad)
    )
    result = corrected(pos, np.tile([0.0, 0.0, -0.02], (40, 1)), "ground")
    assert result.angles_rad[:, 2].min() >= 0.0
    assert result.angles_rad[:, 2].max() < 2 * np.pi
    difference = wrapped(pos.angles_rad - result.angles_rad)
    np.testing.assert_allclose(difference[:, 2], -0.02, atol=1e-14)
