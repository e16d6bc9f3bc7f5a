"""Out-of-sample parallax of simulated blocks whose errors are known."""

from dataclasses import replace

import numpy as np
import pytest
from small_scenario import small_block

from posstats.analysis.angle_errors import AngleErrors, adjusted_errors, in_camera_frame
from posstats.analysis.correction import predicted_errors
from posstats.analysis.out_of_sample import LEAVE_HALF_OUT, LEAVE_STRIP_OUT, out_of_sample_parallax
from posstats.analysis.regression import regress
from posstats.analysis.rules import decide, load_rules
from posstats.block.image_pairs import stereo_models
from posstats.block.turned import corrected
from posstats.geometry.stereo.parallax import model_rms_px


def block(n_strips=3, **errors):
    """A block whose only errors are those given, and those of the image points."""
    none = {name: {} for name in ("omega", "phi", "kappa", "position")}
    return small_block(
        3, flight={"n_strips": n_strips}, tie_points={"per_model": 20}, errors=none | errors
    )


def true_errors(simulated) -> AngleErrors:
    """POS minus truth, with a small known covariance."""
    errors = adjusted_errors(simulated)
    n = len(errors)
    covariance = np.zeros((n, 3, n, 3))
    for axis in range(3):
        covariance[:, axis, :, axis] = 1e-12 * np.eye(n)
    return replace(errors, covariance_rad2=covariance)


def drifting(n_strips=3):
    return block(
        n_strips,
        omega={"constant_rad": 0.018, "drift_rad_per_s": 4.68e-7, "noise_rad": 1e-6},
        phi={"noise_rad": 1e-6},
        kappa={"noise_rad": 1e-6},
    )


@pytest.mark.parametrize(("n_strips", "method"), [(3, LEAVE_STRIP_OUT), (1, LEAVE_HALF_OUT)])
def test_a_drift_is_predicted_for_unseen_images(n_strips, method):
    simulated = drifting(n_strips)
    models, errors = stereo_models(simulated), true_errors(simulated)
    decisions = decide(regress(errors), load_rules("paper"))
    found = out_of_sample_parallax(models, errors, decisions)
    assert found.method == method
    assert found.gain > 0.95
    # The model across the two halves of the only strip does not count.
    assert found.n_models == (21 if n_strips == 3 else 6)


def test_raw_parallax_is_that_of_the_models():
    simulated = drifting()
    models, errors = stereo_models(simulated), true_errors(simulated)
    decisions = [replace(d, correct=False) for d in decide(regress(errors), load_rules("paper"))]
    found = out_of_sample_parallax(models, errors, decisions)
    assert found.raw_px == pytest.approx(model_rms_px(models).mean())
    assert found.gain == 0.0


def test_a_fit_of_pure_noise_gains_nothing_out_of_sample():
    """In the sample every line gains; a random constant per strip is not predictable."""
    simulated = block(omega={"strip_rad": 1e-3})
    models, errors = stereo_models(simulated), true_errors(simulated)
    regressions = regress(errors)
    line = [
        replace(d, correct=d.angle == "omega", form="linear")
        for d in decide(regressions, load_rules("paper"))
    ]
    inside = predicted_errors(regressions, line, errors.time_s, errors.strip)
    after = models.with_orientations(corrected(models.orientations, inside, "ground"))
    in_sample = 1.0 - model_rms_px(after).mean() / model_rms_px(models).mean()
    assert out_of_sample_parallax(models, errors, line).gain < min(0.05, in_sample)


def test_a_boresight_is_predictable_in_the_camera_frame_only():
    simulated = block(pitch={"constant_rad": 0.018})
    models, ground = stereo_models(simulated), true_errors(simulated)
    camera = in_camera_frame(ground, simulated.orientations)
    rules = load_rules("strict")
    corrections = {}
    for errors in (ground, camera):

        def judge(decisions, errors=errors):
            return out_of_sample_parallax(models, errors, decisions)

        decisions = decide(regress(errors), rules, out_of_sample=judge)
        corrections[errors.frame] = [d.form for d in decisions if d.correct]
    assert corrections["camera"] == ["constant"]
    assert corrections["ground"] == []


def test_strip_decisions_are_tested_on_their_own_strip():
    simulated = drifting()
    models, errors = stereo_models(simulated), true_errors(simulated)
    decisions = decide(regress(errors), load_rules("paper"), scope="strip")
    second = [d for d in decisions if d.scope == errors.strip[-1]]
    found = out_of_sample_parallax(models, errors, second)
    assert found.n_models == 6
    assert found.method == LEAVE_HALF_OUT
    raw = model_rms_px(models)[models.strip == errors.strip[-1]]
    assert raw.min() < found.raw_px < raw.max()


def test_halves_too_short_for_a_line_are_not_testable():
    simulated = drifting(1)
    models, errors = stereo_models(simulated), true_errors(simulated)
    used = np.arange(len(errors)) < 4
    decisions = decide(regress(replace(errors, used=used)), load_rules("paper"))
    assert decisions[0].correct
    # The second half has no used image: nothing can be fitted there for the first half.
    found = out_of_sample_parallax(models, replace(errors, used=used), decisions)
    assert found.n_models == 3
    none = out_of_sample_parallax(
        models, replace(errors, used=np.arange(len(errors)) % 4 == 0), decisions
    )
    assert none.n_models == 0
    assert np.isnan(none.gain)
