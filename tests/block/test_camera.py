"""Lens distortion: the convention, its derivatives, its inverse and where there is none."""

import numpy as np
import pytest

from posstats.block.camera import Camera, Distortion
from posstats.errors import GeometryError

STRONG = [
    Distortion("radial", k1=-0.7),  # half as strong again as any lens; folds at r = 0.690
    Distortion("radial", k1=0.5, k2=-0.3),  # grows, then folds at r = 1.207
    Distortion("radial", k1=2.0, k2=3.0),
    Distortion("brown", k1=-0.7, k2=0.4, k3=-0.1, p1=3e-3, p2=-2e-3),
    Distortion("brown", k1=1.2, k2=0.3, k3=-0.56, p1=1.5e-3, p2=2.3e-3),  # folds at r = 1.068
]


def disk(radius: float) -> np.ndarray:
    """Points (2000, 2) of a disk, its centre and its rim among them."""
    rng = np.random.default_rng(5)
    angle = rng.uniform(0.0, 2.0 * np.pi, 2000)
    r = radius * np.sqrt(rng.uniform(0.0, 1.0, 2000))
    r[0], r[1:20] = 0.0, radius
    return np.stack([r * np.cos(angle), r * np.sin(angle)], axis=-1)


@pytest.mark.parametrize(
    ("distortion", "radius"), list(zip(STRONG, [0.68, 1.2, 3.0, 0.6, 1.05], strict=True))
)
def test_strong_distortion_is_inverted_up_to_its_fold(distortion, radius) -> None:
    """Oracle: the distortion itself."""
    ideal = disk(radius)
    assert np.allclose(distortion.undistorted(distortion.distorted(ideal)), ideal, atol=1e-12)


def test_random_distortions_are_inverted_where_they_are_one_to_one() -> None:
    """Oracle: the distortion itself, inside of where its determinant (numerical) turns."""
    rng = np.random.default_rng(8)
    n_tried = 0
    while n_tried < 200:
        k, p = rng.normal(0.0, 0.5, 3), rng.normal(0.0, 2e-3, 2)
        distortion = Distortion("brown", *k, *p)
        radius = rng.uniform(0.1, 1.2)
        r = np.linspace(0.0, radius, 500)
        if np.any(1 + 3 * k[0] * r**2 + 5 * k[1] * r**4 + 7 * k[2] * r**6 < 0.05):
            continue
        n_tried += 1
        ideal = disk(radius)
        assert np.allclose(distortion.undistorted(distortion.distorted(ideal)), ideal, atol=1e-11)


@pytest.mark.parametrize("measured", [0.47, 0.6, 5.0, 1e200, np.inf, np.nan])
def test_points_beyond_the_fold_are_refused(measured) -> None:
    """Oracle: r - 0.7 r^3 is at most 0.4600, at r = 0.690."""
    assert STRONG[0].undistorted(np.array([[0.0, 0.459]])).max() < 0.690
    with pytest.raises(GeometryError, match="cannot be inverted"):
        STRONG[0].undistorted(np.array([[0.1, 0.1], [0.0, measured]]))


def test_a_second_branch_is_not_taken() -> None:
    """r - r^3 + 0.3 r^5 folds at 0.665 and grows again from 1.228: larger radii are another image.

    Oracle: its greatest value before the fold is 0.4100.
    """
    distortion = Distortion("radial", k1=-1.0, k2=0.3)
    with pytest.raises(GeometryError, match="cannot be inverted"):
        distortion.undistorted(np.array([[0.42, 0.0]]))


def test_a_strong_tangential_distortion_is_refused_where_it_folds() -> None:
    """Along u the image is u + 3 p2 u^2: with p2 = -0.5 it turns back at u = 1/3."""
    distortion = Distortion("brown", p2=-0.5)
    inside = np.array([[0.3, 0.0], [-0.3, 0.0]])
    assert np.allclose(distortion.undistorted(distortion.distorted(inside)), inside)
    with pytest.raises(GeometryError, match="cannot be inverted"):
        distortion.undistorted(np.array([[0.17, 0.0]]))


@pytest.mark.parametrize("distortion", STRONG)
def test_jacobian_is_the_derivative(distortion) -> None:
    """Oracle: central differences."""
    uv, h = disk(0.9), 1e-6
    columns = [
        (distortion.distorted(uv + step) - distortion.distorted(uv - step)) / (2.0 * h)
        for step in h * np.eye(2)
    ]
    assert np.allclose(distortion.jacobian(uv), np.stack(columns, axis=-1), atol=1e-8)


def test_an_empty_array_has_an_empty_inverse() -> None:
    assert STRONG[3].undistorted(np.empty((0, 2))).shape == (0, 2)


def test_signs_are_those_of_opencv() -> None:
    """Oracle: cv2.projectPoints' formulas written out, for a point right of and below the middle.

    Columns count right and rows down, ideal y up.
    """
    camera = Camera(
        "", "", 4000.0, 3000.0, 2000.0, (2010.0, 1490.0), None,
        Distortion("brown", 0.1, -0.05, 0.01, 0.002, -0.003),
    )  # fmt: skip
    u, v = 0.3, 0.2
    r2 = 0.13
    radial = 1 + 0.1 * r2 - 0.05 * r2**2 + 0.01 * r2**3
    column = 2010 + 2000 * (u * radial + 2 * 0.002 * u * v - 0.003 * (r2 + 2 * u * u))
    row = 1490 + 2000 * (v * radial + 0.002 * (r2 + 2 * v * v) + 2 * -0.003 * u * v)
    assert np.allclose(camera.measured_from_ideal([600.0, -400.0]), [column, row], atol=1e-9)
    assert np.allclose(camera.ideal_from_measured([column, row]), [600.0, -400.0], atol=1e-9)
