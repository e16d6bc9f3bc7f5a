"""Variance components by restricted maximum likelihood (REML), bounded at zero.

Model: y = X b + e with covariance V = C + s2_white I + s2_strip Z Z', where C is known, in
absolute units, and Z (n, S) names the strip of every observation. The likelihood of error
contrasts K'y (K'X = 0) does not contain b (Patterson & Thompson 1971, Biometrika 58:545). With
K turned so that K'CK is diagonal, one evaluation costs O(n S^2) instead of O(n^3).
"""

from dataclasses import dataclass

import numpy as np

from posstats.arrays import Floats

MAX_ITERATIONS = 100
MAX_HALVINGS = 30
CONVERGED = 1e-10
"""Gain of log-likelihood at which the scoring stops."""
WORTHWHILE = np.array([0.12, 0.03])
"""Log-likelihood that white noise, and that a strip effect, must add to count as present.

A variance held at or above zero makes intervals too wide where the component is really absent,
and dropping it too easily makes them too narrow where it is small. For a slope that rests on
strip means (3 degrees of freedom), 95 % intervals cover, over all sizes of the strip effect,
94.1-97.0 % with 0, 93.1-96.5 % with 0.03, 92.6-96.4 % with 0.06; for white noise with 10 degrees
of freedom, 95.0-96.7 % with 0 and 94.4-96.1 % with 0.12.
"""


@dataclass(frozen=True, eq=False)
class VarianceComponents:
    """Estimated variances of white noise and strip effect, in squared units of y.

    Attributes
    ----------
    variance
        (2,) white noise, strip effect; zero where the likelihood wants none.
    covariance
        (2, 2) sampling covariance of the variances, inverse of the expected information; zero
        rows for components at zero, which are treated as absent.
    """

    variance: Floats
    covariance: Floats


@dataclass(frozen=True, eq=False)
class _Contrasts:
    """K'CK = diag(known), K'y, K'Z."""

    known: Floats
    y: Floats
    strips: Floats


@dataclass(frozen=True, eq=False)
class _Likelihood:
    """Restricted log-likelihood, its gradient and expected information in the two variances."""

    value: float
    score: Floats
    information: Floats


def variance_components(
    y: Floats, design: Floats, known: Floats, strips: Floats | None
) -> VarianceComponents:
    """REML estimates by Fisher scoring from several starts.

    Parameters
    ----------
    y
        (n,) observations, of order 1 (scale them).
    design
        (n, k) matrix X of full rank.
    known
        (n, n) known covariance C, positive semidefinite.
    strips
        (n, S) matrix Z of zeros and ones, or None for white noise only.
    """
    contrasts = _error_contrasts(y, design, known, strips)
    best, best_value = np.zeros(2), _likelihood(contrasts, np.zeros(2)).value
    for start in _starts(contrasts, with_strips=strips is not None):
        found, value = _maximised(contrasts, start)
        value -= float(WORTHWHILE @ (found > 0.0))
        if value > best_value:
            best, best_value = found, value
    return VarianceComponents(best, _sampling_covariance(contrasts, best))


def _error_contrasts(y: Floats, design: Floats, known: Floats, strips: Floats | None) -> _Contrasts:
    complete, _ = np.linalg.qr(design, mode="complete")
    contrasts = complete[:, design.shape[1] :]
    eigenvalues, turn = np.linalg.eigh(contrasts.T @ known @ contrasts)
    contrasts = contrasts @ turn
    return _Contrasts(
        known=np.maximum(eigenvalues, 0.0),
        y=contrasts.T @ y,
        strips=contrasts.T @ (np.zeros((len(y), 1)) if strips is None else strips),
    )


def _likelihood(contrasts: _Contrasts, variance: Floats) -> _Likelihood:
    """Log-likelihood and derivatives.

    With W the inverse of the diagonal part and W^1/2 U = Q S R' the strips' singular values,
    P = V^-1 = W^1/2 (I - Q diag(1 - keep) Q') W^1/2 with keep = 1 / (1 + s2_strip S^2): no
    difference of large numbers, however much the strip effect exceeds the rest.
    """
    white, strip = variance
    diagonal = contrasts.known + white
    if diagonal.min(initial=np.inf) <= 0.0:
        return _Likelihood(-np.inf, np.zeros(2), np.eye(2))
    weight = 1.0 / diagonal
    root = np.sqrt(weight)
    q, singular, _ = np.linalg.svd(root[:, None] * contrasts.strips, full_matrices=False)
    inflation = 1.0 + strip * singular**2
    keep, lost = 1.0 / inflation, strip * singular**2 / inflation
    y = root * contrasts.y
    along = q.T @ y
    across = y - q @ along
    py = root * (across + q @ (keep * along))
    qwq = q.T @ (weight[:, None] * q)
    trace_p = weight.sum() - lost @ np.diag(qwq)
    trace_pp = (weight**2).sum() - 2.0 * lost @ (q**2).T @ weight**2 + lost @ qwq**2 @ lost
    strip_information = singular**2 * keep
    cross = np.diag(qwq) @ (singular * keep) ** 2
    return _Likelihood(
        value=-0.5
        * float(
            np.log(diagonal).sum() + np.log(inflation).sum() + across @ across + keep @ along**2
        ),
        score=0.5
        * np.array(
            [py @ py - trace_p, np.sum((singular * keep * along) ** 2) - strip_information.sum()]
        ),
        information=0.5
        * np.array([[trace_pp, cross], [cross, strip_information @ strip_information]]),
    )


def _starts(contrasts: _Contrasts, *, with_strips: bool) -> list[Floats]:
    """White noise alone; strip effect alone; both. Sizes by robust moments."""
    square = contrasts.y**2
    white = float(np.median(square)) or float(np.mean(square))
    if not with_strips:
        return [np.array([white, 0.0])]
    strip_sums = contrasts.strips.T @ contrasts.y
    strip = float(np.mean(strip_sums**2) / np.sum(contrasts.strips**2, axis=0).mean() ** 2)
    return [np.array(start) for start in ((white, 0.0), (0.0, strip), (white / 2, strip / 2))]


def _maximised(contrasts: _Contrasts, start: Floats) -> tuple[Floats, float]:
    """Fisher scoring with step halving, over the components that the start has.

    A variance at zero is held there while its score is negative.
    """
    free, variance, state = start > 0.0, start, _likelihood(contrasts, start)
    for _ in range(MAX_ITERATIONS):
        moving = free & ((variance > 0.0) | (state.score > 0.0))
        if not np.isfinite(state.value) or not moving.any():
            break
        step = np.zeros(2)
        step[moving] = _solved(state.information[np.ix_(moving, moving)], state.score[moving])
        trial, trial_state = _uphill(contrasts, variance, step, state.value)
        gained = trial_state.value - state.value
        if gained > 0.0:
            variance, state = trial, trial_state
        if gained < CONVERGED:
            break
    return variance, state.value


def _uphill(
    contrasts: _Contrasts, variance: Floats, step: Floats, value: float
) -> tuple[Floats, _Likelihood]:
    """The longest of step, step/2, step/4 ... that raises the likelihood above `value`."""
    for _ in range(MAX_HALVINGS):
        trial = np.maximum(variance + step, 0.0)
        state = _likelihood(contrasts, trial)
        if state.value > value:
            break
        step = 0.5 * step
    return trial, state


def _solved(information: Floats, right: Floats) -> Floats:
    """Solution with unit diagonal; components that look alike share (pseudo-inverse)."""
    scale = np.diag(1.0 / np.sqrt(np.maximum(np.diag(information), 1e-300)))
    solution: Floats = (
        scale @ np.linalg.pinv(scale @ information @ scale, rcond=1e-10) @ scale @ right
    )
    return solution


def _sampling_covariance(contrasts: _Contrasts, variance: Floats) -> Floats:
    present = np.ix_(variance > 0.0, variance > 0.0)
    covariance = np.zeros((2, 2))
    information = _likelihood(contrasts, variance).information[present]
    if len(information):
        covariance[present] = _solved(information, np.eye(len(information)))
    return covariance
