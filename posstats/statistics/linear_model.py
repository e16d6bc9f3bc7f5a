"""Linear models through statsmodels: ordinary, and generalised with a known covariance.

Arrays only. The generalised model is y = X b + e with V = C + s2_white I + s2_strip Z Z'. C is
absolute, so the standard errors are those of V itself, never multiplied by a variance factor.
"""

from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from scipy.linalg import solve_triangular
from statsmodels.regression.linear_model import OLS  # statsmodels.api imports much else

from posstats.arrays import Floats
from posstats.statistics.reml import variance_components

MAX_DF = 1e6
"""Degrees of freedom of a variance that is known; a number, as results know no infinity. The
t quantiles agree with the normal distribution's to six digits."""


@dataclass(frozen=True, eq=False)
class LinearFit:
    """Estimates of the k coefficients of a linear model of n observations.

    Attributes
    ----------
    coefficients, covariance
        (k,), (k, k), in the units of y and X.
    df
        (k,) degrees of freedom of each coefficient's t distribution.
    residuals
        (n,) observation minus model, units of y.
    weighted_ss
        Residual sum of squares; for generalised least squares in the metric of V^-1.
    white_noise_variance, strip_effect_variance
        Estimated variance components, None where the model has none.
    """

    coefficients: Floats
    covariance: Floats
    df: Floats
    residuals: Floats
    weighted_ss: float
    white_noise_variance: float | None = None
    strip_effect_variance: float | None = None

    def rescaled(self, y_unit: float, coefficient_units: Floats) -> Self:
        """The fit in other units: y times `y_unit`, coefficients times that and theirs (k,)."""
        units = y_unit * coefficient_units
        squared = [
            None if variance is None else variance * y_unit**2
            for variance in (self.white_noise_variance, self.strip_effect_variance)
        ]
        return replace(
            self,
            coefficients=self.coefficients * units,
            covariance=self.covariance * np.outer(units, units),
            residuals=self.residuals * y_unit,
            white_noise_variance=squared[0],
            strip_effect_variance=squared[1],
        )


def ordinary_least_squares(y: Floats, design: Floats) -> LinearFit:
    """OLS of y (n,) on the columns of `design` (n, k), n > k."""
    fit = OLS(y, design).fit(method="qr")
    return LinearFit(
        coefficients=fit.params,
        covariance=fit.cov_params(),
        df=np.full(design.shape[1], float(fit.df_resid)),
        residuals=fit.resid,
        weighted_ss=float(fit.ssr),
    )


def generalised_least_squares(
    y: Floats, design: Floats, known: Floats, strips: Floats | None
) -> LinearFit:
    """GLS with variance components by REML.

    Parameters
    ----------
    y, design
        (n,) and (n, k).
    known
        (n, n) known covariance C of the observations, squared units of y.
    strips
        (n, S) matrix Z of the strip effect, or None.

    Raises
    ------
    numpy.linalg.LinAlgError
        If the estimated V is singular.

    Notes
    -----
    The degrees of freedom are Satterthwaite's, 2 v^2 / Var(v), with v the variance of the
    coefficient and Var(v) from the REML information of the components in it. A component
    estimated at zero counts as absent: keeping its few degrees of freedom there makes 95 %
    intervals cover 99.9 % when the component is really zero
    (`posstats.statistics.reml.WORTHWHILE` says what this rule covers). The covariance has Kenward
    and Roger's inflation for weights that are themselves estimated.
    """
    components = variance_components(y, design, known, strips)
    white, strip = (float(variance) for variance in components.variance)
    factors = [np.eye(len(y))] + ([] if strips is None else [strips])
    shapes = [factor @ factor.T for factor in factors]
    total = known + sum(v * g for v, g in zip(components.variance, shapes, strict=False))
    root = np.linalg.cholesky(total)
    whitened = solve_triangular(root, design, lower=True)
    fit = OLS(solve_triangular(root, y, lower=True), whitened).fit(method="qr")
    covariance = fit.normalized_cov_params
    spread = components.covariance[: len(factors), : len(factors)]
    # Column j of `gain` = V^-1 X Phi makes coefficient j of y.
    gain = solve_triangular(root, whitened @ covariance, lower=True, trans="T")
    pulled = [shape @ gain for shape in shapes]
    change = np.array([gain.T @ column for column in pulled])
    variance_change = np.array([np.diag(c) for c in change])
    return LinearFit(
        coefficients=fit.params,
        covariance=covariance + 2.0 * _weight_uncertainty(root, pulled, change, covariance, spread),
        df=_satterthwaite(
            np.diag(covariance), np.einsum("ij,ik,kj->j", variance_change, spread, variance_change)
        ),
        residuals=y - design @ fit.params,
        weighted_ss=float(fit.ssr),
        white_noise_variance=white,
        strip_effect_variance=None if strips is None else strip,
    )


def _weight_uncertainty(
    root: Floats,
    pulled: list[Floats],
    change: Floats,
    covariance: Floats,
    spread: Floats,
) -> Floats:
    """Kenward and Roger's Lambda (1997, eq. 5): what not knowing the weights costs.

    With `pulled` G_i V^-1 X Phi and `change` Phi X' V^-1 G_i V^-1 X Phi for the components i,
    and `spread` the sampling covariance of their variances.
    """
    precision = np.linalg.inv(covariance)
    turned = [solve_triangular(root, column, lower=True) for column in pulled]
    pairs = np.array(
        [
            [
                turned[i].T @ turned[j] - change[i] @ precision @ change[j]
                for j in range(len(pulled))
            ]
            for i in range(len(pulled))
        ]
    )
    cost: Floats = np.einsum("ij,ijkl->kl", spread, pairs)
    return cost


def _satterthwaite(variance: Floats, spread: Floats) -> Floats:
    """2 v^2 / Var(v), at most `MAX_DF`."""
    df: Floats = 2.0 * variance**2 / np.maximum(spread, 2.0 * variance**2 / MAX_DF)
    return df
