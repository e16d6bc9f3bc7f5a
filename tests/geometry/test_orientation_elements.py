"""Which elements of a relative orientation can be solved, and which are held."""

from itertools import chain, combinations

import numpy as np
import pytest
from stereo_scene import (
    METHODS,
    noisy_models,
    true_models,
)

from posstats.block.image_pairs import stereo_models
from posstats.errors import GeometryError
from posstats.geometry.stereo.parallax import model_rms_px
from posstats.geometry.stereo.relative_orientation import (
    DEPENDENT,
    ELEMENTS,
    INDEPENDENT,
    check_solvable,
    orient,
    orient_elements,
)
from posstats.numerics.kernels.coplanarity import base_frames, y_parallax_derivatives
from posstats.synthetic import load_scenario, simulate


def test_holding_more_leaves_more():
    rms = {m: orient(noisy_models(), m).y_parallax_rms_px for m in METHODS}
    for angle in ("omega", "phi", "kappa"):
        assert (rms["dependent"] <= rms[angle] * (1 + 1e-9)).all()
        assert (rms[angle] <= rms["angles"] * (1 + 1e-9)).all()


def all_subsets():
    return chain.from_iterable(combinations(ELEMENTS, n) for n in range(1, 8))


def is_solvable(subset):
    try:
        check_solvable(subset)
    except GeometryError:
        return False
    return True


def test_the_rule_of_solvable_elements_is_the_rank_of_the_jacobian():
    # Vertical images over relief, exact geometry: rank by singular values of q's derivatives.
    models = true_models(n_models=1, n_points=200, tilt_rad=0.0, climb_m=0.0)
    frame = base_frames(models.base_m)
    base = np.einsum("pij,pj->pi", frame, models.base_m)
    r1 = frame @ models.orientations.ground_from_image[models.pairs.left]
    r2 = frame @ models.orientations.ground_from_image[models.pairs.right]
    generators = np.array([np.cross(np.eye(3), axis) for axis in -np.eye(3)])
    _, left, right, by_base, _ = y_parallax_derivatives(
        np.concatenate([models.left_vectors, models.right_vectors]),
        np.arange(200),
        np.arange(200, 400),
        models.pairs.pair_of_point,
        r1,
        r2,
        np.einsum("aij,pjk->paik", generators, r1),
        np.einsum("aij,pjk->paik", generators, r2),
        base,
    )
    columns = {
        "phi1": left[:, 1],
        "kappa1": left[:, 2],
        "BY": by_base[:, 1],
        "BZ": by_base[:, 2],
        "phi2": right[:, 1],
        "omega2": right[:, 0],
        "kappa2": right[:, 2],
    }
    solvable = 0
    for subset in all_subsets():
        jacobian = np.stack([columns[e] / np.linalg.norm(columns[e]) for e in subset], axis=1)
        full_rank = np.linalg.svd(jacobian, compute_uv=False)[-1] > 1e-6
        assert is_solvable(subset) == full_rank, subset
        solvable += full_rank
    assert solvable == 97
    assert sum(is_solvable(s) for s in combinations(ELEMENTS, 5)) == 9


def test_every_solvable_choice_of_five_leaves_the_same_rms():
    models = noisy_models(n_models=4)
    expected = orient(models).y_parallax_rms_px
    for subset in combinations(ELEMENTS, 5):
        if is_solvable(subset):
            result = orient_elements(models, subset)
            np.testing.assert_allclose(result.y_parallax_rms_px, expected, rtol=1e-4)


def test_single_elements_can_be_solved():
    models = noisy_models(n_models=2)
    raw = model_rms_px(models)
    for element in ELEMENTS:
        result = orient_elements(models, [element])
        assert result.converged.all()
        assert (result.y_parallax_rms_px <= raw).all()


@pytest.mark.parametrize(
    ("free", "named"),
    [
        (ELEMENTS, "kappa1, BY, kappa2"),
        (("phi1", "phi2", "BZ"), "phi1, BZ, phi2"),
        (("phi3",), "phi3"),
        ((), "at least one"),
    ],
)
def test_unsolvable_requests_name_the_elements(free, named):
    with pytest.raises(GeometryError, match=named):
        orient_elements(true_models(1), free)


def test_an_unknown_method_is_refused():
    with pytest.raises(GeometryError, match="conditional"):
        orient(true_models(1), "conditional")


def test_ground_omega_keeps_the_parallax_of_north_south_strips():
    # area 1 of the paper, short: an omega error of the ground frame tilts along the flight
    # direction's perpendicular in ground terms, and is another element in the base frame
    models = stereo_models(simulate(load_scenario("area1-small")))
    held_ground = orient(models, "omega").y_parallax_rms_mm.mean()
    held_base = orient_elements(models, [e for e in DEPENDENT if e != "omega2"])
    assert held_ground == pytest.approx(0.120, rel=0.1)
    assert held_base.y_parallax_rms_mm.mean() == pytest.approx(0.0034, rel=0.1)


def test_independent_elements_are_the_default_ones():
    models = noisy_models()
    np.testing.assert_array_equal(
        orient(models).y_parallax_rms_px, orient_elements(models, INDEPENDENT).y_parallax_rms_px
    )
