"""Tests of a bundle adjustment: of additional parameters, of single observations.

The local tests take the stated weights as the null hypothesis (sigma0 = 1), as Baarda's and the
global test do: blunders and wrong weights are what they look for. The t tests of the additional
parameters scale with the estimated sigma0, so that weights which are all wrong by one factor do
not make parameters significant.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy import stats

from posstats.arrays import Floats, Ints
from posstats.numerics.bundle.parameters import UNITS, CommonParameter, parameter_effects
from posstats.numerics.bundle.pos_observations import angles_by_rotation_vector
from posstats.numerics.bundle.problem import AdjustedBundle, BundleProblem
from posstats.numerics.bundle.rays import CAMERA_PARAMETERS

SIGNIFICANCE = 0.05
BLUNDER_ALPHA = 0.001
BLUNDER_POWER = 0.80
HIGH_CORRELATION = 0.95
LEAST_REDUNDANCY = 0.01
"""Of an observation that is tested: below, its error stays in the unknowns to 99 %."""
LEAST_CONTROL_REDUNDANCY = 1e-6
"""The same of a control point, beside rounding: a survey is far more accurate than what tie points
and POS say of the point, but gross errors show all the same."""
MOST_EFFECT = 10.0
"""Standard deviations of an observation by which an undetermined free parameter can move it."""


@dataclass(frozen=True)
class ParameterTest:
    """Student's test of one additional parameter against 0.

    Attributes
    ----------
    name, scope, unit
        Of the parameter.
    value, sigma
        Estimate and its standard deviation, see `parameter_covariance`.
    t, p
        Value over sigma, two-sided. Conservative for a prior that is no measurement but an
        assumption of 0: this draws the value to 0, which the sigma does not contain.
    significant
        p below `SIGNIFICANCE`.
    determined
        With a prior: the measurements alone know the parameter better than the prior does, that
        is, the variance is below half of the prior's, both of the stated weights. Free: one
        standard deviation moves no observation by more than `MOST_EFFECT` of its own.
    """

    name: str
    scope: str
    value: float
    sigma: float
    t: float
    p: float
    significant: bool
    determined: bool
    unit: str


@dataclass(frozen=True, eq=False)
class Correlations:
    """Correlations of k additional parameters.

    Attributes
    ----------
    first, second, value
        (q,) pairs of parameters above `HIGH_CORRELATION`, the strongest first.
    image, element, with_image
        (k,) image, element (omega, phi, kappa, X, Y, Z: 0 to 5) and value of the strongest
        correlation of every parameter with an orientation.
    """

    first: Ints
    second: Ints
    value: Floats
    image: Ints
    element: Ints
    with_image: Floats


@dataclass(frozen=True, eq=False)
class LocalTest:
    """Baarda's tests of n observations of q components; NaN where one is not tested.

    Attributes
    ----------
    w
        (n, q) standardised residuals, computed minus measured.
    blunder
        (n, q) estimate, measured minus true, if this component alone is wrong.
    detectable
        (n, q) smallest blunder found with the stated power.
    n_unchecked
        Observations with weight and a redundancy number below `LEAST_REDUNDANCY`.
    unit
        Of blunders.
    """

    w: Floats
    blunder: Floats
    detectable: Floats
    n_unchecked: int
    unit: str


def scale(result: AdjustedBundle) -> float:
    """sigma0, by which standard deviations are scaled; 1 without redundancy."""
    return result.sigma0 if result.dof > 0 else 1.0


def parameter_covariance(problem: BundleProblem, result: AdjustedBundle) -> Floats:
    """(k, k) of the additional parameters: sigma0 scales the measurements, not the priors.

    With Q the inverse of N + P, N of the measurements and P the weights of the priors, it is
    Q (sigma0^2 N + P) Q. What the measurements know is scaled by sigma0; what is known from its
    prior alone keeps the prior's standard deviation, of which residuals say nothing.
    """
    variance, q = scale(result) ** 2, result.common_covariance
    prior = np.array([parameter.weight for parameter in problem.parameters])
    covariance: Floats = variance * q + (1.0 - variance) * (q * prior) @ q
    return covariance


def parameter_tests(problem: BundleProblem, result: AdjustedBundle) -> tuple[ParameterTest, ...]:
    """Student's test of every additional parameter, with the adjustment's degrees of freedom."""
    stated = np.sqrt(np.diagonal(result.common_covariance))
    effect = stated * largest_effects(problem)
    sigma = np.sqrt(np.diagonal(parameter_covariance(problem, result)))
    t = result.common / sigma
    p = 2.0 * stats.t.sf(np.abs(t), result.dof) if result.dof > 0 else np.full(len(t), np.nan)
    return tuple(
        ParameterTest(
            parameter.name,
            parameter.scope,
            float(result.common[at]),
            float(sigma[at]),
            float(t[at]),
            float(p[at]),
            bool(p[at] < SIGNIFICANCE),
            _determined(parameter, float(stated[at]), float(effect[at])),
            UNITS[parameter.name],
        )
        for at, parameter in enumerate(problem.parameters)
    )


def _determined(parameter: CommonParameter, stated: float, effect: float) -> bool:
    if parameter.sigma is not None:
        return 2.0 * stated**2 < parameter.sigma**2
    return effect <= MOST_EFFECT


def largest_effects(problem: BundleProblem) -> Floats:
    """(k,) by how many of its standard deviations a unit of a parameter moves an observation.

    The most over all observations; lever arm and boresight as if along the axes they move.
    """
    effects = parameter_effects(problem.parameters, problem.exposures)
    root = np.sqrt(problem.pos.weight)
    gnss = (np.abs(effects.gnss) * root[:, :3, None]).max(axis=(0, 1))
    largest: Floats = np.maximum(gnss, (np.abs(effects.imu) * root[:, 3:, None]).max(axis=(0, 1)))
    largest[effects.lever_arm[effects.lever_arm >= 0]] = root[:, :3].max()
    largest[effects.boresight[effects.boresight >= 0]] = root[:, 3:].max()
    column = effects.camera_column[problem.exposures.camera[problem.image]]
    for number, by in enumerate(_image_effects(problem).T):
        seen = column[:, number] >= 0
        np.maximum.at(largest, effects.camera[column[seen, number]], by[seen])
    return largest


def _image_effects(problem: BundleProblem) -> Floats:
    """(m, 11) lengths in standard deviations of the derivatives by `CAMERA_PARAMETERS`."""
    camera = problem.exposures.camera[problem.image]
    c, mm = problem.distance_px[camera], problem.mm_per_px[camera]
    a, b = problem.xy_px.T / c
    r2, ring = a**2 + b**2, (mm * c) ** 2 * (a**2 + b**2) - problem.bauer_radius_mm**2
    r = np.sqrt(r2)
    one = np.ones(len(a)) / c
    lengths = {
        "camera_c": r / c, "camera_x0": one, "camera_y0": one,
        "bauer_s1": r * np.abs(ring), "bauer_s2": np.abs(a), "bauer_s3": r,
        "brown_k1": r * r2, "brown_k2": r * r2**2, "brown_k3": r * r2**3,
        "brown_p1": np.hypot(2.0 * a * b, r2 + 2.0 * b**2),
        "brown_p2": np.hypot(2.0 * a * b, r2 + 2.0 * a**2),
    }  # fmt: skip
    scale = (c / problem.sigma_px)[:, None]
    effects: Floats = scale * np.stack([lengths[name] for name in CAMERA_PARAMETERS], axis=1)
    return effects


def correlations(result: AdjustedBundle) -> Correlations:
    """High correlations among the additional parameters, and the highest with orientations."""
    sigma = np.sqrt(np.diagonal(result.common_covariance))
    among = result.common_covariance / np.outer(sigma, sigma)
    first, second = np.nonzero(np.triu(np.abs(among) > HIGH_CORRELATION, 1))
    order = np.argsort(-np.abs(among[first, second]), kind="stable")
    first, second = first[order], second[order]
    border = result.inverse.border.copy()
    border[:, :3] = angles_by_rotation_vector(result.angles_rad, result.system) @ border[:, :3]
    own = np.sqrt(np.diagonal(result.orientation_covariance, axis1=1, axis2=2))
    across = (border / own[:, :, None] / sigma).reshape(-1, len(sigma))
    at = np.abs(across).argmax(axis=0)
    image, element = np.divmod(at, 6)
    return Correlations(
        first, second, among[first, second], image, element, across[at, np.arange(len(sigma))]
    )


def critical_value(alpha: float = BLUNDER_ALPHA) -> float:
    """Of |w| for a two-sided test of size alpha."""
    return float(stats.norm.isf(0.5 * alpha))


def noncentrality(alpha: float = BLUNDER_ALPHA, power: float = BLUNDER_POWER) -> float:
    """Expectation of |w| at which a test of size alpha has this power (the far tail neglected)."""
    return critical_value(alpha) + float(stats.norm.ppf(power))


def local_tests(
    problem: BundleProblem,
    result: AdjustedBundle,
    alpha: float = BLUNDER_ALPHA,
    power: float = BLUNDER_POWER,
) -> Mapping[str, LocalTest]:
    """Test every observation of the groups ``image``, ``gnss``, ``imu`` and ``control``.

    With P the weights, v the residuals and Qv their cofactors, an observation has
    w = (P v) / sqrt(P Qv P), which is v / (sigma sqrt(r)) where P is diagonal, the blunder
    -(P v) / (P Qv P), and its smallest detectable one is `noncentrality` / sqrt(P Qv P).

    Parameters
    ----------
    problem, result
        Before and after the adjustment.
    alpha, power
        Of the two-sided test.
    """
    shift = noncentrality(alpha, power)
    image_weight = np.repeat(problem.sigma_px[:, None] ** -2.0, 2, axis=1)
    pos = problem.pos.weight
    kinds = (
        ("image", result.residual_px, result.redundancy_px, image_weight, "px"),
        ("gnss", result.residual_pos[:, :3], result.redundancy_pos[:, :3], pos[:, :3], "m"),
        ("imu", result.residual_pos[:, 3:], result.redundancy_pos[:, 3:], pos[:, 3:], "rad"),
    )
    tests = {
        name: _tested(weight * residual, weight * redundancy, redundancy, shift, unit)
        for name, residual, redundancy, weight, unit in kinds
    }
    gradient, curvature = control_moments(problem, result)
    tests["control"] = _tested(
        gradient,
        np.diagonal(curvature, axis1=1, axis2=2),
        result.redundancy_control,
        shift,
        "m",
        LEAST_CONTROL_REDUNDANCY,
    )
    return tests


def control_moments(problem: BundleProblem, result: AdjustedBundle) -> tuple[Floats, Floats]:
    """P v (g, 3) and P Qv P (g, 3, 3) of the control points, Qv = P^-1 less cov X."""
    weight = np.asarray(np.linalg.inv(problem.control.covariance_m2), dtype=float)
    gradient = (weight @ result.residual_control_m[:, :, None])[:, :, 0]
    adjusted = result.ground_covariance_m2[problem.control.point]
    return gradient, weight - weight @ adjusted @ weight


def _tested(
    gradient: Floats,
    curvature: Floats,
    redundancy: Floats,
    shift: float,
    unit: str,
    least: float = LEAST_REDUNDANCY,
) -> LocalTest:
    curvature = np.where(redundancy >= least, curvature, np.nan)
    root = np.sqrt(curvature)
    return LocalTest(
        gradient / root,
        -gradient / curvature,
        shift / root,
        int((redundancy < LEAST_REDUNDANCY).sum()),
        unit,
    )
