"""Variance components by restricted maximum likelihood (REML), bounded at zero.

Model: y = X b + e with covariance V = C + s2_white I + s2_strip Z Z', where C is known, in
absolute units, and Z (n, S) names the strip of every observation. The likelihood of error
contrasts K'y (K'X = 0) does not contain b (Patterson & Thompson 1971, Biometrika 58:545). With
K turned so that K'CK is diagonal, one evaluation costs O(n S^2) instead of O(n^3).
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]

MAX_ITERATIONS = 100
MAX_HALVINGS = 30
SAME_LIKELIHOOD = 1e-6
"""Log-likelihoods this close are the same to any test; the simpler model is then taken."""


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

    variance: _Floats
    covariance: _Floats


@dataclass(frozen=True, eq=False)
class _Contrasts:
    """K'CK = diag(known), K'y, K'Z."""

    known: _Floats
    y: _Floats
    strips: _Floats


@dataclass(frozen=True, eq=False)
class _Likelihood:
    """Restricted log-likelihood, its gradient and expected information in the two variances."""

    value: float
    score: _Floats
    information: _Floats


def variance_components(
    y: _Floats, design: _Floats, known: _Floats, strips: _Floats | None
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
    free = np.array([True, strips is not None])
    best = np.zeros(2)
    best_value = _likelihood(contrasts, best).value
    for start in _starts(contrasts, free):
        found, value = _maximised(contrasts, start, free)
        if value > best_value + SAME_LIKELIHOOD:
            best, best_value = found, value
    best = _without_idle_components(contrasts, best, best_value)
    return VarianceComponents(best, _sampling_covariance(contrasts, best))


def _error_contrasts(
    y: _Floats, design: _Floats, known: _Floats, strips: _Floats | None
) -> _Contrasts:
    complete, _ = np.linalg.qr(design, mode="complete")
    contrasts = complete[:, design.shape[1] :]
    eigenvalues, turn = np.linalg.eigh(contrasts.T @ known @ contrasts)
    contrasts = contrasts @ turn
    return _Contrasts(
        known=np.maximum(eigenvalues, 0.0),
        y=contrasts.T @ y,
        strips=contrasts.T @ (np.zeros((len(y), 1)) if strips is None else strips),
    )


def _likelihood(contrasts: _Contrasts, variance: _Floats) -> _Likelihood:
    """Log-likelihood and derivatives; P = V^-1 of the contrasts by Woodbury's identity."""
    white, strip = variance
    diagonal = contrasts.known + white
    if diagonal.min(initial=np.inf) <= 0.0:
        return _Likelihood(-np.inf, np.zeros(2), np.eye(2))
    weight, u = 1.0 / diagonal, contrasts.strips
    wu = weight[:, None] * u
    inner = np.eye(u.shape[1]) + strip * (u.T @ wu)
    inverse = np.linalg.inv(inner)
    pu = wu @ inverse  # P U
    py = weight * contrasts.y - strip * pu @ (wu.T @ contrasts.y)
    upu = u.T @ pu
    w2 = inverse @ (wu.T @ wu)
    trace_p = weight.sum() - strip * np.trace(w2)
    w3 = inverse @ (wu.T @ (weight[:, None] * wu))
    trace_pp = (weight**2).sum() - 2.0 * strip * np.trace(w3) + strip**2 * np.sum(w2 * w2.T)
    log_determinant = np.log(diagonal).sum() + np.linalg.slogdet(inner)[1]
    cross = np.sum(pu**2)
    return _Likelihood(
        value=-0.5 * float(log_determinant + contrasts.y @ py),
        score=0.5 * np.array([py @ py - trace_p, np.sum((u.T @ py) ** 2) - np.trace(upu)]),
        information=0.5 * np.array([[trace_pp, cross], [cross, np.sum(upu**2)]]),
    )


def _starts(contrasts: _Contrasts, free: NDArray[np.bool_]) -> list[_Floats]:
    """No component; each alone; both. Sizes are robust, as one strip may be far off."""
    square = contrasts.y**2
    size = np.array([float(np.median(square)) or float(np.mean(square)), 0.0])
    if free[1]:
        strip_sums = contrasts.strips.T @ contrasts.y
        size[1] = np.mean(strip_sums**2) / np.sum(contrasts.strips**2, axis=0).mean() ** 2
    faces = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.5]])
    return [face * size for face in faces if free[1] or face[1] == 0.0]


def _maximised(
    contrasts: _Contrasts, start: _Floats, free: NDArray[np.bool_]
) -> tuple[_Floats, float]:
    """Fisher scoring with step halving; a variance at zero is held while its score is negative."""
    variance, state = start, _likelihood(contrasts, start)
    for _ in range(MAX_ITERATIONS):
        moving = free & ((variance > 0.0) | (state.score > 0.0))
        if not np.isfinite(state.value) or not moving.any():
            break
        step = np.zeros(2)
        step[moving] = _solved(state.information[np.ix_(moving, moving)], state.score[moving])
        for _ in range(MAX_HALVINGS):
            trial = np.maximum(variance + step, 0.0)
            trial_state = _likelihood(contrasts, trial)
            if trial_state.value > state.value:
                break
            step *= 0.5
        else:
            break
        gained = trial_state.value - state.value
        variance, state = trial, trial_state
        if gained < 1e-10:
            break
    return variance, state.value


def _solved(information: _Floats, right: _Floats) -> _Floats:
    """Solution with unit diagonal; components that look alike share (pseudo-inverse)."""
    scale = 1.0 / np.sqrt(np.maximum(np.diag(information), 1e-300))
    solution: _Floats = scale * (
        np.linalg.pinv(scale[:, None] * information * scale, rcond=1e-10) @ (scale * right)
    )
    return solution


def _without_idle_components(contrasts: _Contrasts, variance: _Floats, value: float) -> _Floats:
    """Set a component to zero where the likelihood does not notice."""
    for component in (1, 0):
        reduced = variance.copy()
        reduced[component] = 0.0
        if _likelihood(contrasts, reduced).value >= value - SAME_LIKELIHOOD:
            variance = reduced
    return variance


def _sampling_covariance(contrasts: _Contrasts, variance: _Floats) -> _Floats:
    present = np.ix_(variance > 0.0, variance > 0.0)
    covariance = np.zeros((2, 2))
    information = _likelihood(contrasts, variance).information[present]
    if len(information):
        covariance[present] = _solved_inverse(information)
    return covariance


def _solved_inverse(information: _Floats) -> _Floats:
    return np.column_stack([_solved(information, unit) for unit in np.eye(len(information))])
